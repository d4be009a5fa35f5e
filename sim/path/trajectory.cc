#include "sim/path/trajectory.h"

#include <fmt/format.h>

#include <cmath>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "sim/path/camera_path.h"
#include "sim/path/hand_shake.h"

namespace depthgrid {
namespace {

void RequireSize(const std::vector<double>& values, std::size_t size, const char* key,
                 const std::string& place) {
  if (values.size() == size) return;
  if (size == 0) throw InputError(place, fmt::format("{} is for hand-held paths only", key));
  if (values.empty()) {
    throw InputError(place, fmt::format("{} is missing, must be {} numbers", key, size));
  }
  throw InputError(
      place, fmt::format("{} has {}, must have {}", key, Counted(values.size(), "number"), size));
}

double RoundedStamp(int frame, double rate_hz) { return std::round(frame / rate_hz * 1e6) / 1e6; }

// The tolerance avoids an extra frame from rounding when the duration is a whole number of frames.
int FramesFor(double duration_s, double rate_hz) {
  return static_cast<int>(std::ceil(duration_s * rate_hz - 1e-6)) + 1;
}

std::string Shown(int frame, const Eigen::Vector3d& position_m) {
  return fmt::format("frame {} at ({:.2f}, {:.2f}, {:.2f})", frame, position_m.x(), position_m.y(),
                     position_m.z());
}

}  // namespace

void Waypoint::Visit(OptionsVisitor& v) {
  v.Numbers("at", at, {}, "x y z in world, metres; x y for a planar path");
  v.Numbers("look_at", look_at, {}, "the point the optical axis goes through; hand-held only");
}

void TrajectoryOptions::Visit(OptionsVisitor& v) {
  v.Choice("kind", kind,
           {{TrajectoryKind::kHandheld, "handheld"}, {TrajectoryKind::kPlanar, "planar"}},
           "6-DoF motion of a hand, or of a robot on the floor");
  v.Number("speed_mps", speed_mps, {0.001, 10.0}, "upper bound of the speed");
  v.Number("turn_rate_dps", turn_rate_dps, {0.1, 360.0}, "upper bound of the turn rate, deg/s");
  v.Number("shake_deg", shake_deg, {0.0, 10.0}, "rms shake about each camera axis, degrees");
  v.Number("shake_m", shake_m, {0.0, 0.2}, "rms shake along each camera axis, metres");
  v.Number("height_m", height_m, {-100.0, 100.0}, "planar: z of the camera in world");
  v.Number("pitch_deg", pitch_deg, {-80.0, 80.0}, "planar: pitch of the camera, up is positive");
  v.Number("clearance_m", clearance_m, {0.0, 5.0}, "least distance from geometry");
  v.Flag("closed", closed, "the path returns to its first waypoint");
  v.Number("laps", laps, {0.1, 100.0}, "closed: how often it goes round");
}

namespace {

// Hand-held paths take heights and pitches from their waypoints.
void RequirePlanarKeysOnPlanarPaths(const Config& spec, TrajectoryKind kind) {
  if (kind == TrajectoryKind::kPlanar) return;
  for (const char* key : {"height_m", "pitch_deg"}) {
    if (!spec.Has(key)) continue;
    throw InputError(spec.PlaceOfKey(key), fmt::format("{} is for planar paths only: kind is "
                                                       "'handheld'",
                                                       key));
  }
}

}  // namespace

TrajectoryOptions ReadTrajectoryOptions(Config spec) {
  TrajectoryOptions options;
  options.place = spec.Place();
  const std::vector<Config> waypoints = spec.TakeMaps("waypoints");
  spec.Read(options);
  RequirePlanarKeysOnPlanarPaths(spec, options.kind);
  const bool planar = options.kind == TrajectoryKind::kPlanar;
  for (const Config& entry : waypoints) {
    Waypoint waypoint;
    entry.Read(waypoint);
    RequireSize(waypoint.at, planar ? 2 : 3, "at", entry.Place());
    RequireSize(waypoint.look_at, planar ? 0 : 3, "look_at", entry.Place());
    options.waypoints.push_back(waypoint);
  }
  if (options.waypoints.size() < 2) {
    throw InputError(options.place, fmt::format("has {}, must have at least 2",
                                                Counted(options.waypoints.size(), "waypoint")));
  }
  if (options.laps != 1.0 && !options.closed) {
    throw InputError(options.place, "laps needs closed: true");
  }
  return options;
}

int MinimumFrames(const TrajectoryOptions& options, double rate_hz) {
  return FramesFor(CameraPath(options).DurationS(), rate_hz);
}

Trajectory MakeTrajectory(const TrajectoryOptions& options, int frames, double rate_hz,
                          std::uint64_t seed) {
  const CameraPath path(options);
  const int least = FramesFor(path.DurationS(), rate_hz);
  if (frames < least) {
    throw InputError(
        options.place,
        fmt::format("frames is {}, must be at least {} at {} Hz to keep within {} m/s and {} deg/s",
                    frames, least, rate_hz, options.speed_mps, options.turn_rate_dps));
  }
  const HandShake shake({RadFromDeg(options.shake_deg), options.shake_m}, seed);
  Trajectory trajectory;
  for (int i = 0; i < frames; ++i) {
    const double stamp_s = RoundedStamp(i, rate_hz);
    const PathPose pose = path.At(static_cast<double>(i) / (frames - 1));
    trajectory.push_back({stamp_s, CameraPoseOf(pose) * shake.At(stamp_s)});
  }
  return trajectory;
}

double LengthM(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length_m += (trajectory[i].world_from_camera.translation -
                 trajectory[i - 1].world_from_camera.translation)
                    .norm();
  }
  return length_m;
}

double PathLengthM(const TrajectoryOptions& options) {
  TrajectoryOptions still = options;
  still.shake_m = 0.0;
  still.shake_deg = 0.0;
  return LengthM(MakeTrajectory(still, MinimumFrames(still), kFrameRateHz, 0));
}

std::optional<std::string> NearText(const Trajectory& trajectory,
                                    const std::function<double(std::size_t frame)>& distance_m,
                                    double clearance_m, const std::string& what) {
  std::string first;
  int stretches = 0;
  bool was_near = false;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double distance = distance_m(i);
    const bool is_near = distance < clearance_m;
    if (is_near && !was_near && stretches++ == 0) {
      first = fmt::format("{} is {:.3f} m from {}, must be at least {:.3f} m (clearance_m)",
                          Shown(static_cast<int>(i), trajectory[i].world_from_camera.translation),
                          distance, what, clearance_m);
    }
    was_near = is_near;
  }
  if (stretches == 0) return {};
  if (stretches > 1) first += fmt::format("; the first of {} places that are too near", stretches);
  return first;
}

void CheckClearance(const Trajectory& trajectory,
                    const std::function<double(const Eigen::Vector3d&)>& distance_m,
                    double clearance_m, const std::string& place) {
  const auto of_frame = [&](std::size_t frame) {
    return distance_m(trajectory[frame].world_from_camera.translation);
  };
  const auto near = NearText(trajectory, of_frame, clearance_m, "geometry");
  if (near) throw InputError(place, *near);
}

namespace {

constexpr const char* kBehindSurface =
    "behind a surface as seen from the frame before: the path goes through it";

std::string OutsideText(int frame, const Eigen::Vector3d& position_m,
                        const Eigen::AlignedBox3d& bounds) {
  return fmt::format(
      "{} is outside the scene, which spans ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f})",
      Shown(frame, position_m), bounds.min().x(), bounds.min().y(), bounds.min().z(),
      bounds.max().x(), bounds.max().y(), bounds.max().z());
}

}  // namespace

bool CameraSpace::Contains(Eigen::Vector3d position_m) const {
  if (open_above) position_m.z() = std::min(position_m.z(), bounds.max().z());
  return bounds.contains(position_m);
}

std::optional<std::string> DoubtOfPath(const Trajectory& trajectory, const PathScene& scene,
                                       double clearance_m) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const int frame = static_cast<int>(i);
    const Eigen::Vector3d& position_m = trajectory[i].world_from_camera.translation;
    const double distance = scene.distance_m(position_m);
    const std::string near =
        fmt::format("{} is {:.3f} m from geometry", Shown(frame, position_m), distance);
    if (i > 0 && scene.occluded(trajectory[i - 1].world_from_camera.translation, position_m)) {
      return fmt::format("{}, {}", near, kBehindSurface);
    }
    if (distance < clearance_m) return near + ", nearer than a camera can be";
    if (!scene.space.Contains(position_m)) {
      return OutsideText(frame, position_m, scene.space.bounds);
    }
  }
  return {};
}

void CheckWay(const Trajectory& trajectory, const Occlusion& occluded, const std::string& place) {
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Eigen::Vector3d& position_m = trajectory[i].world_from_camera.translation;
    if (!occluded(trajectory[i - 1].world_from_camera.translation, position_m)) continue;
    throw InputError(
        place, fmt::format("{} is {}", Shown(static_cast<int>(i), position_m), kBehindSurface));
  }
}

void CheckInside(const Trajectory& trajectory, const CameraSpace& space, const std::string& place) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Vector3d& position_m = trajectory[i].world_from_camera.translation;
    if (space.Contains(position_m)) continue;
    throw InputError(place, OutsideText(static_cast<int>(i), position_m, space.bounds));
  }
}

}  // namespace depthgrid
