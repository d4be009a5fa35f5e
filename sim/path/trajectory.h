// Camera paths: hand-held motion through waypoints and planar robot motion, with bounded speed and
// turn rate. A path is a C2 curve, timed so that no bound is exceeded; `frames` poses sample it
// uniformly in time from end to end. More frames than the bounds need make the motion slower.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/config.h"

namespace depthgrid {

constexpr double kFrameRateHz = 30.0;  // ICL-NUIM, TUM RGB-D

enum class TrajectoryKind { kHandheld, kPlanar };

struct Waypoint {
  std::vector<double> at;       // x y z in world; x y for a planar path
  std::vector<double> look_at;  // the point the optical axis goes through; hand-held only

  void Visit(OptionsVisitor& v);
};

struct TrajectoryOptions {
  TrajectoryKind kind = TrajectoryKind::kHandheld;
  double speed_mps = 0.5;       // a person looking around; ICL-NUIM's paths stay below
  double turn_rate_dps = 40.0;  // deg/s; above, rolling shutter and blur trouble SLAM
  double shake_deg = 0.0;       // rms about each camera axis, not subject to the bounds
  double shake_m = 0.0;         // rms along each camera axis, not subject to the bounds
  double height_m = 0.6;        // planar: of the camera above z = 0
  double pitch_deg = 0.0;       // planar: of the optical axis, up is positive
  double clearance_m = 0.2;     // least distance from geometry
  bool closed = false;          // the path returns to its first waypoint
  double laps = 1.0;            // closed: number of rounds, may be fractional for an overlap
  std::vector<Waypoint> waypoints;
  std::string place;  // file and line, for errors

  void Visit(OptionsVisitor& v);
};

// Reads and checks one entry of a scene file's `trajectories`. Throws InputError.
TrajectoryOptions ReadTrajectoryOptions(Config spec);

// The least number of frames that keeps speed and turn rate within their bounds.
int MinimumFrames(const TrajectoryOptions& options, double rate_hz = kFrameRateHz);

// Stamps are i / rate_hz rounded to 6 decimals, as files carry them. The seed affects only the
// shake. Throws InputError for fewer frames than the bounds need.
Trajectory MakeTrajectory(const TrajectoryOptions& options, int frames, double rate_hz,
                          std::uint64_t seed);

double LengthM(const Trajectory& trajectory);

// The length of the path without hand shake.
double PathLengthM(const TrajectoryOptions& options);

// Throws InputError naming `place`, the first frame nearer to geometry than clearance_m, its
// position and its distance, and how many stretches of the path are too near.
void CheckClearance(const Trajectory& trajectory,
                    const std::function<double(const Eigen::Vector3d&)>& distance_m,
                    double clearance_m, const std::string& place);

// The first frame nearer to `what` than clearance_m, with its position, and how many stretches of
// the path are too near; nothing when none is.
std::optional<std::string> NearText(const Trajectory& trajectory,
                                    const std::function<double(std::size_t frame)>& distance_m,
                                    double clearance_m, const std::string& what);

// Where a camera may be: within the bounds, and in open scenes also above them, to look over walls.
struct CameraSpace {
  Eigen::AlignedBox3d bounds;
  bool open_above = false;

  bool Contains(Eigen::Vector3d position_m) const;
};

// Whether a surface lies between the two points.
using Occlusion = std::function<bool(const Eigen::Vector3d& from, const Eigen::Vector3d& to)>;

struct PathScene {
  CameraSpace space;
  std::function<double(const Eigen::Vector3d&)> distance_m;
  Occlusion occluded;
};

// Checks a path that was not made for this scene. Describes the first frame, with its position,
// that is nearer to geometry than clearance_m, hidden by a surface from the frame before, or
// outside the scene.
std::optional<std::string> DoubtOfPath(const Trajectory& trajectory, const PathScene& scene,
                                       double clearance_m);

// Throws InputError naming the first frame that a surface hides from the frame before: the path
// passes through the surface, even if no frame is near it.
void CheckWay(const Trajectory& trajectory, const Occlusion& occluded, const std::string& place);

// Throws InputError naming the first frame outside the scene.
void CheckInside(const Trajectory& trajectory, const CameraSpace& space, const std::string& place);

}  // namespace depthgrid
