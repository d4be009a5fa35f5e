#include "eval/cli/scene_facts.h"

#include <fmt/format.h>

#include <array>

#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/output_file.h"
#include "eval/scene_plan.h"
#include "eval/shipped.h"
#include "eval/world.h"
#include "mapper/core/error.h"
#include "mapper/io/png.h"

namespace depthgrid::cli {
namespace {

struct ScenePath {
  std::string name;
  TrajectoryOptions options;
  Trajectory poses;     // empty: it cannot be made
  std::string refusal;  // empty: it can be taken
};

std::vector<ScenePath> PathsOf(const Scene& scene) {
  const RayScene rays(scene.mesh);
  std::vector<ScenePath> paths;
  for (const auto& [name, options] : scene.trajectories) {
    ScenePath path = {name, options, {}, ""};
    try {
      path.poses = MakeTrajectory(options, MinimumFrames(options), kFrameRateHz,
                                  ExperimentOptions{}.trajectory_seed);
      CheckPath(path.poses, options, scene, rays);
    } catch (const InputError& error) {
      path.refusal = error.what();
    }
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

void WritePlan(const std::string& file, const Scene& scene, const std::vector<ScenePath>& paths) {
  // Those of a second round are dashed, of a third with a dot behind each dash, and so on.
  constexpr std::array kColours = {palette::kEstimate, palette::kSlam, palette::kTruth,
                                   palette::kMissed, palette::kInvented};
  std::vector<Path> drawn;
  for (const ScenePath& path : paths) {
    if (path.poses.empty()) continue;
    const std::size_t round = drawn.size() / kColours.size();
    drawn.push_back({path.name, kColours[drawn.size() % kColours.size()], path.poses,
                     PathStyle::kLine, static_cast<int>(round) - 1});
  }
  WriteRgbPng(file, PlanOf(scene, drawn));
}

// No scene, nor what it includes or takes its meshes from, is called so: none is overwritten.
void RequirePlanFile(const std::string& file, bool force) {
  if (!file.ends_with(".png")) throw InputError(file, "must end in .png");
  RequireNewFile(file, force);
}

}  // namespace

void ShowScene(const ScenesArguments& arguments) {
  if (!arguments.plan.empty()) RequirePlanFile(arguments.plan, arguments.force);
  if (IsFileName(arguments.scene) && IsExperiment(arguments.scene)) {
    throw InputError(arguments.scene, "is an experiment, must be a scene or mesh file");
  }
  const Scene scene = LoadScene(ResolveName(arguments.scene, ShippedKind::kScene));
  const std::vector<ScenePath> paths = PathsOf(scene);
  fmt::print("{}", Facts(scene));
  if (!paths.empty()) fmt::print("\n{}", PathTable(paths));
  for (const ScenePath& path : paths) {
    if (!path.refusal.empty()) fmt::print("refused: {}\n", path.refusal);
  }
  if (arguments.plan.empty()) return;
  WritePlan(arguments.plan, scene, paths);
  fmt::print("look at {}\n", arguments.plan);
}

}  // namespace depthgrid::cli
