#include "eval/cli/scene_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/doubts/storey_check.h"
#include "eval/doubts/units_check.h"
#include "eval/experiment/shipped.h"
#include "eval/output/output_file.h"
#include "eval/pictures/scene_plan.h"
#include "eval/run/world.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/io/config.h"
#include "mapper/io/png.h"

namespace depthgrid::cli {
namespace {

struct ScenePath {
  std::string name;
  TrajectoryOptions options;
  Trajectory poses;     // empty if the path is invalid
  std::string refusal;  // why the path cannot be used; else empty
  std::string meeting;  // why it cannot be used with all movers; else empty
  std::string doubt;    // empty: none
};

std::string MeetingOf(const ScenePath& path, const Scene& scene, const MoverScene& movers) {
  if (!path.refusal.empty()) return "";
  try {
    CheckMovers(path.poses, path.options, scene, movers);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<ScenePath> PathsOf(const Scene& scene) {
  const RayScene rays(scene.mesh);
  const MoverScene movers(scene, rays.isa());
  std::vector<ScenePath> paths;
  for (const auto& [name, options] : scene.trajectories) {
    ScenePath path = {name, options, {}, "", "", ""};
    try {
      path.poses = MakeTrajectory(options, MinimumFrames(options), kFrameRateHz,
                                  ExperimentOptions{}.trajectory_seed);
      CheckPath(path.poses, options, scene, rays);
      const auto doubt = DoubtOfStorey(path.poses, scene, rays);
      if (doubt) path.doubt = options.place + ": " + *doubt;
    } catch (const InputError& error) {
      path.refusal = error.what();
    }
    path.meeting = MeetingOf(path, scene, movers);
    paths.push_back(std::move(path));
  }
  return paths;
}

std::string Facts(const Scene& scene) {
  const Eigen::AlignedBox3f bounds = BoundsOf(scene.mesh);
  const Eigen::Vector3f &low = bounds.min(), &high = bounds.max();
  const std::string ceiling = scene.ceiling_z_m
                                  ? fmt::format("ceiling at z = {} m", Number(scene.ceiling_z_m, 2))
                                  : "no ceiling";
  const auto span = [](float from, float to) { return Number(from, 2) + " to " + Number(to, 2); };
  return fmt::format("{}: {} triangles, x {}, y {}, z {} m\nfloor at z = {} m, {}\n", scene.name,
                     scene.mesh.triangles.size(), span(low.x(), high.x()), span(low.y(), high.y()),
                     span(low.z(), high.z()), Number(scene.floor_z_m, 2), ceiling);
}

std::string PathTable(const std::vector<ScenePath>& paths) {
  std::vector<std::vector<std::string>> rows = {{"trajectory", "kind", "path", "frames"}};
  for (const ScenePath& path : paths) {
    const bool is_made = !path.poses.empty();
    rows.push_back({path.name, path.options.kind == TrajectoryKind::kPlanar ? "planar" : "handheld",
                    is_made ? fmt::format("{:.1f} m", PathLengthM(path.options)) : "-",
                    is_made ? fmt::format("{}", path.poses.size()) : "-"});
  }
  return Table(rows);
}

// One round along its waypoints, sampled like a camera path.
Trajectory RoundOf(const Mover& mover) {
  const MoverPath path(mover.options);
  const int frames = static_cast<int>(std::ceil(path.RoundS() * kFrameRateHz));
  Trajectory round;
  for (int i = 0; i <= frames; ++i) {
    const double time_s = std::min(i / kFrameRateHz, path.RoundS());
    const auto pose = path.At(mover.options.from_s + time_s, {});
    if (pose) round.push_back({time_s, CameraOf(*pose, 0.0)});
  }
  return round;
}

std::string WayText(const MoverOptions& options) {
  if (options.ahead_m > 0.0) return fmt::format("{:g} m ahead of the camera", options.ahead_m);
  if (!options.closed && !options.there_and_back) return "once";
  const std::string way = options.closed ? "round" : "there and back";
  return options.laps > 0.0 ? fmt::format("{}, laps: {:g}", way, options.laps) : way;
}

std::string MoverTable(const std::vector<Mover>& movers) {
  std::vector<std::vector<std::string>> rows = {{"mover", "goes", "from s", "path", "takes"}};
  for (const Mover& mover : movers) {
    const bool walks = mover.options.ahead_m == 0.0;
    const Trajectory round = walks ? RoundOf(mover) : Trajectory();
    rows.push_back({mover.name, WayText(mover.options), fmt::format("{:g}", mover.options.from_s),
                    walks ? fmt::format("{:.1f} m", LengthM(round)) : "-",
                    walks ? fmt::format("{:.1f} s", MoverPath(mover.options).RoundS()) : "-"});
  }
  return Table(rows);
}

void WritePlan(const std::string& file, const Scene& scene, const std::vector<ScenePath>& paths) {
  // When the colours are used up they repeat with dashed lines, then with dash-dotted ones, and so
  // on.
  constexpr std::array kColours = {palette::kEstimate, palette::kSlam, palette::kTruth,
                                   palette::kMissed, palette::kInvented};
  std::vector<Path> drawn;
  const auto add = [&](const std::string& name, const Trajectory& poses) {
    const auto round = static_cast<int>(drawn.size() / kColours.size());
    drawn.push_back(
        {name, kColours[drawn.size() % kColours.size()], poses, PathStyle::kLine, round - 1});
  };
  for (const ScenePath& path : paths) {
    if (!path.poses.empty()) add(path.name, path.poses);
  }
  for (const Mover& mover : scene.movers) {
    if (mover.options.ahead_m == 0.0) add(mover.name, RoundOf(mover));
  }
  WriteRgbPng(file, PlanOf(scene, drawn));
}

// Only .png files are written, so that no scene, include or mesh is overwritten.
void RequirePlanFile(const std::string& file, bool force) {
  if (!file.ends_with(".png")) throw InputError(file, "must end in .png");
  RequireNewFile(file, force);
}

void RefuseSweep(const std::string& path) {
  if (!path.ends_with(".yaml") && !path.ends_with(".yml")) return;
  if (!Config::FromFile(path).Has("axes")) return;
  throw InputError(path, "is a sweep, must be a scene or mesh file");
}

// Fails for scripts, at the end, when everything has been printed and drawn.
void RequireNoneRefused(const std::string& scene, const std::vector<ScenePath>& paths) {
  std::vector<std::string> refused;
  for (const ScenePath& path : paths) {
    if (!path.refusal.empty()) refused.push_back(path.name);
  }
  if (refused.empty()) return;
  const bool is_one = refused.size() == 1;
  throw InputError(scene, fmt::format("{} '{}' {} refused: no run can take {}",
                                      is_one ? "path" : "paths", fmt::join(refused, "', '"),
                                      is_one ? "is" : "are", is_one ? "it" : "them"));
}

}  // namespace

void ShowScene(const ScenesArguments& arguments) {
  if (!arguments.plan.empty()) RequirePlanFile(arguments.plan, arguments.force);
  if (IsFileName(arguments.scene) && IsExperiment(arguments.scene)) {
    throw InputError(arguments.scene, "is an experiment, must be a scene or mesh file");
  }
  const std::string file = ResolveName(arguments.scene, ShippedKind::kScene);
  RefuseSweep(file);
  const Scene scene = LoadNamedScene(arguments.scene);
  const std::vector<ScenePath> paths = PathsOf(scene);
  fmt::print("{}", Facts(scene));
  if (const auto doubt = DoubtOfUnits(scene)) fmt::print("warning: {}\n", *doubt);
  if (!paths.empty()) fmt::print("\n{}", PathTable(paths));
  for (const ScenePath& path : paths) {
    if (!path.refusal.empty()) fmt::print("refused: {}\n", path.refusal);
    if (!path.doubt.empty()) fmt::print("warning: {}\n", path.doubt);
  }
  if (!scene.movers.empty()) {
    fmt::print("\n{}they are there with movers: all, or by name, in an experiment\n",
               MoverTable(scene.movers));
  }
  for (const ScenePath& path : paths) {
    if (!path.meeting.empty()) fmt::print("refused with movers: {}\n", path.meeting);
  }
  if (!arguments.plan.empty()) {
    WritePlan(arguments.plan, scene, paths);
    fmt::print("look at {}\n", arguments.plan);
  }
  RequireNoneRefused(arguments.scene, paths);
}

}  // namespace depthgrid::cli
