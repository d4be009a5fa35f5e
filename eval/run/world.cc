#include "eval/run/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "eval/experiment/shipped.h"
#include "eval/files/hash.h"
#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/usual_step.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/trajectory_file.h"
#include "sim/mesh/scene_limits.h"
#include "sim/path/trajectory.h"

namespace depthgrid {
namespace {

void AddMesh(const TriangleMesh& mesh, ContentHash& hash) {
  for (const Eigen::Vector3f& v : mesh.vertices) hash.Bytes(v.data(), sizeof(float) * 3);
  for (const auto& t : mesh.triangles) hash.Bytes(t.data(), sizeof t);
}

std::string HashOf(const Scene& scene) {
  ContentHash hash;
  AddMesh(scene.mesh, hash);
  hash.Value(scene.floor_z_m);
  return hash.Hex();
}

// Without movers, the hash of the room.
std::string HashWithMovers(const Scene& scene) {
  std::string room = HashOf(scene);
  if (scene.movers.empty()) return room;
  ContentHash hash;
  hash.Text(room);
  for (const Mover& mover : scene.movers) {
    AddMesh(mover.mesh, hash);
    hash.Value(mover.options.ahead_m);
    hash.Text(ToYaml(mover.options));
    for (const MoverWaypoint& waypoint : mover.options.waypoints) hash.Text(ToYaml(waypoint));
  }
  return hash.Hex();
}

// An experiment may have several scenes, so the message names the one that lacks a name.
std::string OfScene(const std::string& message, const ExperimentOptions& options) {
  return fmt::format("{} (scene {})", message, options.scene);
}

// The scene with the experiment's movers.
Scene SceneOf(const ExperimentOptions& options) {
  Scene scene = LoadNamedScene(options.scene);
  try {
    KeepMovers(options.movers, scene.movers);
  } catch (const SettingError& error) {
    throw SettingError(error.key(), OfScene(error.message(), options));
  }
  return scene;
}

const std::string& NamedTrajectory(const Scene& scene, const ExperimentOptions& options) {
  const std::string& name = options.trajectory;
  const std::string& place =
      options.trajectory_place.empty() ? options.scene : options.trajectory_place;
  std::vector<std::string> names;
  for (const auto& [candidate, path] : scene.trajectories) names.push_back(candidate);
  if (names.empty()) {
    throw InputError(place, "the scene names no trajectory: 'trajectory' must be a TUM file");
  }
  if (name.empty()) return scene.trajectories.begin()->first;
  const auto found = scene.trajectories.find(name);
  if (found != scene.trajectories.end()) return found->first;
  throw InputError(
      place, OfScene(fmt::format("trajectory is '{}', must be one of {} or a TUM file{}", name,
                                 fmt::join(names, ", "), DidYouMean(name, names)),
                     options));
}

CameraSpace SpaceOf(const Scene& scene) {
  return {BoundsOf(scene.mesh).cast<double>(), !scene.ceiling_z_m.has_value()};
}

Trajectory FromScene(const Scene& scene, const RayScene& rays, const MoverScene& movers,
                     const ExperimentOptions& options) {
  const std::string& name = NamedTrajectory(scene, options);
  const TrajectoryOptions& path = scene.trajectories.at(name);
  const int whole = MinimumFrames(path);
  Trajectory trajectory =
      MakeTrajectory(path, std::max(options.frames, whole), kFrameRateHz, options.trajectory_seed);
  if (options.frames > 0) trajectory.resize(static_cast<std::size_t>(options.frames));
  CheckPath(trajectory, path, scene, rays);
  CheckMovers(trajectory, path, scene, movers);
  return trajectory;
}

void RequireTrajectoryFile(const ExperimentOptions& options) {
  std::error_code error;
  if (std::filesystem::exists(options.trajectory, error)) return;
  throw InputError(options.trajectory_place, options.trajectory + ": no such file");
}

// The first line of a trajectory's file with this stamp.
std::string PlaceOfStamp(const std::string& path, double stamp_s) {
  const std::string text = ReadFile(path);
  for (const TextRow& row : SplitRows(text)) {
    const auto stamp = ParseNumber(row.fields.front());
    if (stamp && *stamp == stamp_s) return PlaceOfLine(path, row.line);
  }
  return path;
}

// Poses in wrong units would make the true map, which contains the whole path, larger than memory.
// Stamps must differ because frames are named by them.
void RequireFramesOfTheScene(const Trajectory& trajectory, const Eigen::AlignedBox3d& scene,
                             const std::string& path) {
  double before_s = -std::numeric_limits<double>::infinity();
  for (const auto& [stamp_s, pose] : trajectory) {
    const Eigen::Vector3d& at = pose.translation;
    const double away_m = scene.exteriorDistance(at);
    if (away_m > kMaxSceneExtentM) {
      throw InputError(
          PlaceOfStamp(path, stamp_s),
          fmt::format("the pose at ({:.2f}, {:.2f}, {:.2f}) is {:.0f} m from the scene, must be at "
                      "most {:.0f} m",
                      at.x(), at.y(), at.z(), away_m, kMaxSceneExtentM));
    }
    if (IsSameStamp(stamp_s, before_s)) {
      throw InputError(PlaceOfStamp(path, stamp_s),
                       fmt::format("stamp {} is that of the pose before it to the microsecond: "
                                   "frames are named by six decimals",
                                   stamp_s));
    }
    before_s = stamp_s;
  }
}

// A moving camera gives several frames per second, so larger steps mean stamps in other units.
void RequireSecondsBetweenFrames(const Trajectory& trajectory, const std::string& path) {
  constexpr double kMostStepS = 5.0;
  if (trajectory.size() < 2) return;
  const double step_s = UsualStepBetween(trajectory, &StampedPose::stamp_s);
  if (step_s <= kMostStepS) return;
  throw InputError(path, fmt::format("its stamps, which must be seconds, are {:g} apart (median), "
                                     "must be at most {:g}",
                                     step_s, kMostStepS));
}

Trajectory PathIn(const ExperimentOptions& options, std::vector<std::string>& warnings) {
  const std::string& path = options.trajectory;
  RequireTrajectoryFile(options);
  TrajectoryFile file = ReadTrajectoryFile(path);
  if (file.poses.size() == 1 && file.doubled_stamps.count > 0) {
    throw InputError(path, fmt::format("all of its {} poses have the stamp {}, must each have a "
                                       "later one than the pose before",
                                       1 + file.doubled_stamps.count, file.poses[0].stamp_s));
  }
  Trajectory trajectory = PosesOf(std::move(file), path, warnings);
  RequireSecondsBetweenFrames(trajectory, path);
  return trajectory;
}

Trajectory FromFile(const ExperimentOptions& options, const Eigen::AlignedBox3d& scene,
                    std::vector<std::string>& warnings) {
  Trajectory trajectory = PathIn(options, warnings);
  const auto wanted = static_cast<std::size_t>(options.frames);
  if (wanted > trajectory.size()) {
    throw SettingError("frames",
                       fmt::format("is {}, must be at most the {} of {}", wanted,
                                   Counted(trajectory.size(), "pose"), options.trajectory));
  }
  if (wanted > 0) trajectory.resize(wanted);
  RequireFramesOfTheScene(trajectory, scene, options.trajectory);
  return trajectory;
}

// A camera's housing keeps its centre at least this far from everything.
constexpr double kLeastClearanceM = 0.05;

Occlusion OcclusionIn(const RayScene& rays) {
  return [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return rays.Occluded(from.cast<float>(), to.cast<float>());
  };
}

std::optional<std::string> DoubtOfFile(const Trajectory& trajectory, const Scene& scene,
                                       const RayScene& rays, const ExperimentOptions& options) {
  constexpr float kFarM = 10.0F;
  const PathScene around = {SpaceOf(scene),
                            [&](const Eigen::Vector3d& point) -> double {
                              return rays.DistanceToSurface(point.cast<float>(), kFarM);
                            },
                            OcclusionIn(rays)};
  const auto doubt = DoubtOfPath(trajectory, around, kLeastClearanceM);
  if (!doubt) return {};
  return options.trajectory + ": " + *doubt;
}

void AddPathFile(const ExperimentOptions& options, ContentHash& hash) {
  RequireTrajectoryFile(options);
  hash.Text(ReadFile(options.trajectory));
}

void AddPath(const Scene& scene, const ExperimentOptions& options, ContentHash& hash) {
  if (IsFileName(options.trajectory)) return AddPathFile(options, hash);
  const TrajectoryOptions& path = scene.trajectories.at(NamedTrajectory(scene, options));
  hash.Text(ToYaml(path));
  for (const Waypoint& waypoint : path.waypoints) hash.Text(ToYaml(waypoint));
}

WorldHashes HashesOf(const Scene& scene, const ExperimentOptions& options) {
  ContentHash path;
  AddPath(scene, options, path);
  return {HashOf(scene), HashWithMovers(scene), path.Hex()};
}

}  // namespace

std::string PlaceOfPath(const Scene& scene, const ExperimentOptions& options) {
  if (IsFileName(options.trajectory)) return options.trajectory;
  return scene.trajectories.at(NamedTrajectory(scene, options)).place;
}

WorldHashes HashesOf(const ExperimentOptions& options) {
  return HashesOf(SceneOf(options), options);
}

std::string HashOfPathFile(const ExperimentOptions& options) {
  ContentHash hash;
  AddPathFile(options, hash);
  return hash.Hex();
}

std::string WorldHash(const ExperimentOptions& options) {
  const Scene scene = SceneOf(options);
  ContentHash hash;
  hash.Text(HashWithMovers(scene));
  AddPath(scene, options, hash);
  return hash.Hex();
}

void RequireMovers(const ExperimentOptions& options) { SceneOf(options); }

void RequireNames(const ExperimentOptions& options) {
  const Scene scene = SceneOf(options);
  if (!IsFileName(options.trajectory)) {
    NamedTrajectory(scene, options);
    return;
  }
  std::vector<std::string> warnings;
  PathIn(options, warnings);
}

// DistanceToSurface works in floats: a distance of exactly the limit may be returned slightly too
// short.
constexpr double kFloatSlackM = 1e-5;

void CheckPath(const Trajectory& trajectory, const TrajectoryOptions& path, const Scene& scene,
               const RayScene& rays) {
  const auto distance_m = [&](const Eigen::Vector3d& point) -> double {
    return rays.DistanceToSurface(point.cast<float>(), static_cast<float>(path.clearance_m));
  };
  CheckInside(trajectory, SpaceOf(scene), path.place);
  CheckClearance(trajectory, distance_m, path.clearance_m - kFloatSlackM, path.place);
  CheckWay(trajectory, OcclusionIn(rays), path.place);
}

void CheckMovers(const Trajectory& trajectory, const TrajectoryOptions& path, const Scene& scene,
                 const MoverScene& movers) {
  const auto near = NearMoverText(trajectory, scene, movers, path.clearance_m - kFloatSlackM);
  if (near) throw InputError(path.place, *near);
}

// Warns of movers given by name that are never seen; for `all`, only if none is seen.
std::optional<std::string> DoubtOfMovers(const ExperimentOptions& options, const World& world) {
  std::vector<std::string> unseen =
      UnseenMovers(world.trajectory, world.scene, world.rays, world.movers, world.camera,
                   world.depth_range.max_m);
  if (unseen.empty()) return {};
  if (options.movers == kAllMovers && unseen.size() < world.movers.size()) return {};
  return fmt::format("movers: {}: no frame of this path shows {}", fmt::join(unseen, ", "),
                     unseen.size() == 1 ? "it" : "them");
}

World LoadWorld(const ExperimentOptions& options, int build_threads) {
  Scene scene = SceneOf(options);
  RayScene rays(scene.mesh, options.sensor.isa, build_threads);
  MoverScene movers(scene, options.sensor.isa);
  const PinholeCamera camera = SensorCamera(options.sensor);
  std::vector<std::string> doubts;
  Trajectory trajectory;
  if (IsFileName(options.trajectory)) {
    trajectory = FromFile(options, BoundsOf(scene.mesh).cast<double>(), doubts);
    const auto doubt = DoubtOfFile(trajectory, scene, rays, options);
    if (doubt) doubts.push_back(*doubt);
    const auto near = NearMoverText(trajectory, scene, movers, kLeastClearanceM);
    if (near) doubts.push_back(options.trajectory + ": " + *near);
  } else {
    trajectory = FromScene(scene, rays, movers, options);
  }
  WorldHashes hashes = HashesOf(scene, options);
  World world = {
      std::move(scene), std::move(hashes),           std::move(rays),       std::move(movers),
      camera,           SensorRange(options.sensor), std::move(trajectory), std::move(doubts)};
  if (const auto doubt = DoubtOfMovers(options, world)) world.path_doubts.push_back(*doubt);
  return world;
}

}  // namespace depthgrid
