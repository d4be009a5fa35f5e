#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/mapping_run.h"
#include "eval/output_folder.h"
#include "eval/run_folder.h"
#include "mapper/core/error.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

struct MapSettings {
  std::string input;
  std::string poses;
  MapperOptions mapper;

  void Visit(OptionsVisitor& v) {
    v.Text("input", input, "the recorded sequence");
    v.Text("poses", poses, "SLAM's poses");
    v.Group("mapper", mapper, "the mapper");
  }
};

std::unique_ptr<FrameSource> OpenInput(const MapArguments& arguments) {
  if (!fs::exists(arguments.input)) throw InputError(arguments.input, "no such file or folder");
  if (!fs::is_directory(arguments.input)) return OpenCarmenLog(arguments.input);
  if (arguments.poses.empty()) {
    throw InputError("--poses", "is missing: a depth sequence needs SLAM's poses, a TUM file");
  }
  return OpenTumFolder(arguments.input, SlamOutputOf(ReadTrajectory(arguments.poses)));
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
  OutputFolder folder(arguments.common.output, arguments.common.force);
  const std::unique_ptr<FrameSource> source = OpenInput(arguments);
  ProgressBar bar("mapping");
  const MappingRun run = MapFrames(*source, settings.mapper, {}, bar.AsProgress());
  RunRecord record;
  record.title = arguments.input;
  record.settings = ToYaml(settings);
  record.mapping = &run;
  record.wall_s_total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_s_total = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  WriteRunFolder(folder, record);
  folder.Commit();
  Warn(run.warnings);
}

}  // namespace depthgrid::cli
