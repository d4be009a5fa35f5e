#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/sequence_argument.h"
#include "eval/mapping_run.h"
#include "eval/output_folder.h"
#include "eval/run_folder.h"
#include "mapper/core/error.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

struct MapSettings {
  std::string input;
  std::string poses;
  std::string final_poses;
  std::string loops;
  MapperOptions mapper;

  void Visit(OptionsVisitor& v) {
    v.Text("input", input, "the recorded sequence");
    v.Text("poses", poses, "SLAM's live poses");
    v.Text("final_poses", final_poses, "SLAM's poses after all corrections");
    v.Text("loops", loops, "SLAM's events");
    v.Group("mapper", mapper, "the mapper");
  }
};

struct Input {
  std::unique_ptr<FrameSource> source;
  Trajectory final_poses;  // SLAM's own; empty if unknown
};

Input OpenDepthFolder(const MapArguments& arguments) {
  if (arguments.poses.empty()) {
    throw InputError("--poses", "is missing: a depth sequence needs SLAM's poses, a TUM file");
  }
  if (arguments.loops.empty() && arguments.final_poses.empty()) {
    return {OpenTumFolder(arguments.input, SlamOutputOf(ReadTrajectory(arguments.poses))), {}};
  }
  SlamOutput slam = ReadSlamFiles({arguments.poses, arguments.final_poses, arguments.loops},
                                  FrameStamps(arguments.input));
  auto source = OpenTumFolder(arguments.input, slam);
  return {std::move(source), std::move(slam.final)};
}

Input OpenInput(const MapArguments& arguments) {
  if (!fs::exists(arguments.input)) throw InputError(arguments.input, "no such file or folder");
  if (fs::is_directory(arguments.input)) return OpenDepthFolder(arguments);
  for (const std::string& file : {arguments.poses, arguments.final_poses, arguments.loops}) {
    if (!file.empty()) throw InputError(file, "a laser log brings its own poses");
  }
  return {OpenCarmenLog(arguments.input), {}};
}

}  // namespace

void Map(const MapArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  MapSettings settings;
  Config config;
  for (const std::string& assignment : arguments.common.set) config.Set(assignment);
  config.Read(settings);
  settings.input = arguments.input;
  settings.poses = arguments.poses;
  settings.final_poses = arguments.final_poses;
  settings.loops = arguments.loops;
  OutputFolder folder(arguments.common.output, arguments.common.force);
  const Input input = OpenInput(arguments);
  ProgressBar bar("mapping");
  const MappingRun run =
      MapFrames(*input.source, settings.mapper, input.final_poses, bar.AsProgress());
  RunRecord record;
  record.title = arguments.input;
  record.settings = ToYaml(settings);
  record.mapping = &run;
  record.scan = settings.mapper.scan;
  record.wall_s_total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_s_total = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  WriteRunFolder(folder, record);
  folder.Commit();
  Warn(run.warnings);
}

std::string MapKeys() { return ListKeys(MapSettings{}); }

}  // namespace depthgrid::cli
