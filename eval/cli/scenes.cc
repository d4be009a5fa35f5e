#include <fmt/format.h>

#include <Eigen/Geometry>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/scene_facts.h"
#include "eval/experiment/experiment_options.h"
#include "eval/experiment/shipped.h"
#include "eval/experiment/study.h"
#include "eval/sweep/sweep_plan.h"
#include "mapper/core/error.h"
#include "sim/path/trajectory.h"
#include "sim/scene/scene.h"

namespace depthgrid::cli {
namespace {

std::string SizeText(const TriangleMesh& mesh) {
  const Eigen::Vector3f size_m = BoundsOf(mesh).sizes();
  return fmt::format("{:.1f} x {:.1f} x {:.1f} m", size_m.x(), size_m.y(), size_m.z());
}

using Rows = std::vector<std::vector<std::string>>;

void AddSceneRows(const std::string& name, Rows& rows) {
  const Scene scene = LoadNamedScene(name);
  std::string first_of_scene = name;
  std::string size = SizeText(scene.mesh);
  std::string triangles = fmt::format("{}", scene.mesh.triangles.size());
  std::string movers = fmt::format("{}", scene.movers.size());
  for (const auto& [path_name, path] : scene.trajectories) {
    const int frames = MinimumFrames(path);
    rows.push_back({first_of_scene, size, triangles, movers, path_name,
                    fmt::format("{:.1f} m", PathLengthM(path)), fmt::format("{}", frames)});
    first_of_scene = size = triangles = movers = "";
  }
  if (scene.trajectories.empty()) rows.push_back({name, size, triangles, movers, "none", "", ""});
}

Rows SceneRows() {
  Rows rows = {{"scene", "size", "triangles", "movers", "trajectory", "path", "frames"}};
  for (const std::string& name : ShippedNames(ShippedKind::kScene)) AddSceneRows(name, rows);
  return rows;
}

std::vector<std::string> ExperimentRow(const std::string& name) {
  const Config config = Config::FromFile(ResolveName(name, ShippedKind::kExperiment));
  if (IsStudy(config)) {
    return {name, Counted(ReadStudyOutline(config).cases.size(), "case"), "", ""};
  }
  const ExperimentOptions options = ReadExperiment(config, ShippedFolder(ShippedKind::kExperiment));
  return {name, options.scene, options.trajectory.empty() ? "first" : options.trajectory,
          options.frames > 0 ? fmt::format("{}", options.frames) : "whole path"};
}

Rows ExperimentRows() {
  Rows rows = {{"experiment", "scene", "trajectory", "frames"}};
  for (const std::string& name : ShippedNames(ShippedKind::kExperiment)) {
    rows.push_back(ExperimentRow(name));
  }
  return rows;
}

Rows SweepRows() {
  Rows rows = {{"sweep", "runs", "of"}};
  for (const std::string& name : ShippedNames(ShippedKind::kSweep)) {
    const SweepPlan plan = ReadSweepPlan(ResolveName(name, ShippedKind::kSweep), {});
    rows.push_back({name, fmt::format("{}", plan.runs.size()), plan.size_text});
  }
  return rows;
}

}  // namespace

void ListScenes(const ScenesArguments& arguments) {
  if (arguments.force && arguments.plan.empty()) {
    Warn({"--force: has no effect without --plan"});
  }
  if (!arguments.scene.empty()) return ShowScene(arguments);
  if (!arguments.plan.empty()) throw InputError("--plan", "draws one scene, which must be given");
  // All are read before the first is printed: a broken file then gives an error alone.
  const Rows scenes = SceneRows(), experiments = ExperimentRows(), sweeps = SweepRows();
  fmt::print("{}\n{}\n{}", Table(scenes), Table(experiments), Table(sweeps));
}

}  // namespace depthgrid::cli
