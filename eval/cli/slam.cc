#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "eval/cli/command_output.h"
#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/slam_settings.h"
#include "eval/files/one_result.h"
#include "eval/files/shell_word.h"
#include "mapper/core/error.h"
#include "mapper/core/trajectory.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid::cli {
namespace {

// The true pose of each frame of a TUM folder, at the frame's stamp.
Trajectory TrueFrames(const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) {
    RequireFile(folder);
    throw InputError(folder, "is a file, must be a sequence's folder with a groundtruth.txt");
  }
  const std::string truth_path = folder + "/groundtruth.txt";
  std::vector<std::string> warnings;
  const Trajectory truth = ReadTrajectory(truth_path, warnings);
  Warn(warnings);
  const std::vector<double> stamps_s = StampsOf(truth);
  const RecordingOptions options;
  Trajectory frames;
  const Recording recording = ListTumFolder(folder, options);
  Warn(recording.warnings);
  for (const RecordedImage& image : recording.images) {
    const auto nearest = NearestStamp(stamps_s, image.stamp_s, options.max_stamp_difference_s);
    if (!nearest) {
      throw InputError(truth_path, "has no pose for the image at " + std::to_string(image.stamp_s));
    }
    frames.push_back({image.stamp_s, truth[*nearest].world_from_camera});
  }
  return frames;
}

void SayNext(const SlamArguments& arguments, const SlamOutput& slam) {
  const std::string& output = arguments.common.output;
  const auto posed = std::count_if(slam.live.begin(), slam.live.end(),
                                   [](const SlamPose& pose) { return pose.slam_from_camera; });
  fmt::print("SLAM gives {} of {} a pose and closes {}: {}/slam.txt\n", posed,
             Counted(slam.live.size(), "frame"), Counted(slam.loops.size(), "loop"), output);
  // The world has z up, as in `run`. Estimated from the images it would be affected by the poses'
  // drift.
  fmt::print("go on with: depthgrid map {} --poses {} --loops {} --up z -o OUT\n",
             ShellWord(arguments.sequence), ShellWord(output + "/slam.txt"),
             ShellWord(output + "/loops.csv"));
}

}  // namespace

void Slam(const SlamArguments& arguments) {
  Config config;
  config.Set("slam.profile", arguments.profile, "--profile " + arguments.profile);
  for (const std::string& assignment : arguments.common.set) config.Set(assignment);
  // Seed keys of experiments.
  for (const char* key : {"slam_seed", "seed"}) {
    if (config.Has(key)) throw InputError(config.PlaceOfKey(key), "give --seed N");
  }
  SlamSettings settings;
  config.Read(settings);
  RequireOneResult(arguments.sequence, {kMarkOfRender});
  const Trajectory truth = TrueFrames(arguments.sequence);
  OutputFolder folder = OpenOutput(arguments.common, ResultKind::kSlam, {arguments.sequence});
  const SlamOutput slam = DisturbTrajectory(truth, settings.slam, arguments.seed);
  WriteSlamFiles(folder.work().string(), slam);
  WriteFile(folder.File("slam.yaml"), ToYaml(settings));
  folder.Commit();
  SayNext(arguments, slam);
}

}  // namespace depthgrid::cli
