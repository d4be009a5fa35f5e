#include "eval/cli/map_input.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "eval/cli/console.h"
#include "eval/cli/finished_map.h"
#include "eval/run/prior_run.h"
#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/slam_files.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

void SayLines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) fmt::print("{}\n", line);
}

// Rejects options that make no sense for a laser log, which contains its own planar poses and no
// images.
void RefuseForLaserLog(const MapArguments& arguments) {
  for (const std::string& file : {arguments.poses, arguments.final_poses}) {
    if (!file.empty()) throw InputError(file, "a laser log brings its own poses");
  }
  if (!arguments.camera.empty()) {
    throw InputError("--camera " + arguments.camera, "a laser log has no depth images");
  }
  if (!arguments.world_up.empty()) {
    throw InputError("--up " + arguments.world_up, "a laser log's poses are level already");
  }
}

// Reads SLAM's files, if any.
std::optional<SlamInput> ReadSlam(const MapArguments& arguments, const SequenceOptions& options) {
  const bool laser = FormatOf(arguments.input, options) == SequenceFormat::kCarmen;
  if (laser) RefuseForLaserLog(arguments);
  if (laser && !arguments.loops.empty()) {
    return ReadLoops(arguments.loops, SequenceFrames(arguments.input, options),
                     options.recording.max_stamp_difference_s);
  }
  if (arguments.poses.empty()) {
    for (const std::string& file : {arguments.final_poses, arguments.loops}) {
      if (file.empty()) continue;
      throw InputError("--poses", "is missing: the poses that " + file + " refers to");
    }
    return {};
  }
  SlamReading reading{options.recording.max_stamp_difference_s, options.recording.interpolate_poses,
                      options.recording.max_interpolation_gap_s};
  if (!options.camera_mount.empty()) reading.mount = ReadCameraMount(options.camera_mount);
  return ReadSlamFiles({arguments.poses, arguments.final_poses, arguments.loops},
                       SequenceFrames(arguments.input, options), reading);
}

// The floor's height as written by the program that rendered the folder.
std::optional<double> RenderedFloor(const std::string& render_file) {
  std::error_code error;  // such as: name too long
  if (!fs::is_regular_file(render_file, error)) return {};
  return ParseNumber(Config::FromFile(render_file).Text("mapper.scan.floor_z_m"));
}

// If up was given and so no floor was searched: takes the floor of a rendered folder. Poses from
// elsewhere may have another origin of heights, which the images show.
void TakeRenderedFloor(const MapArguments& arguments, const Config& config, Sequence& sequence,
                       MapSettings& settings) {
  const std::string file = (fs::path(arguments.input) / "render.yaml").string();
  if (settings.sequence.world_up != WorldUp::kZ || config.Has("mapper.scan.floor_z_m")) return;
  const auto floor_z_m = RenderedFloor(file);
  if (!floor_z_m || *floor_z_m == settings.mapper.scan.floor_z_m) return;
  const auto& seen_z_m = sequence.seen_floor_z_m;
  const bool fits =
      seen_z_m ? std::abs(*seen_z_m - *floor_z_m) < std::abs(*seen_z_m) : arguments.poses.empty();
  if (!fits) return;
  settings.mapper.scan.floor_z_m = *floor_z_m;
  sequence.notes.push_back(fmt::format("the floor is at z = {:.2f}, as {} says", *floor_z_m, file));
}

// Rejects what needs the truth or a simulated SLAM.
void RefuseForRecording(const FusionOptions& fusion) {
  if (fusion.mode == FusionMode::kOracle) {
    throw SettingError("mapper.fusion.mode",
                       "is oracle, must be another one: of a recording no truth is known");
  }
  if (fusion.slam_noise.source == SlamNoiseSource::kProfile) {
    throw SettingError("mapper.fusion.slam_noise.source",
                       "is profile, must be another one: of a recording no profile is known");
  }
}

// Takes the floor's height that was found in the sequence, unless one is set.
void TakeFloor(const MapArguments& arguments, const Config& config, Sequence& sequence,
               MapSettings& settings) {
  if (!config.Has("mapper.scan.floor_z_m") && sequence.floor_z_m) {
    settings.mapper.scan.floor_z_m = *sequence.floor_z_m;
  }
  TakeRenderedFloor(arguments, config, sequence, settings);
}

Sequence OpenWith(const std::optional<SlamInput>& slam, const MapRequest& request) {
  return OpenSequence(request.arguments.input, request.settings.sequence,
                      slam ? std::optional(slam->slam) : std::nullopt);
}

// Only the sequence, and the warnings about SLAM's files.
MapInput OpenToMap(MapRequest& request) {
  const MapArguments& arguments = request.arguments;
  MapSettings& settings = request.settings;
  const auto slam = ReadSlam(arguments, settings.sequence);
  MapInput input;
  input.sequence = OpenWith(slam, request);
  Sequence& sequence = input.sequence;
  // Without a file of final poses, none are known to be final.
  if (slam && arguments.final_poses.empty()) sequence.final_poses.clear();
  RefuseForRecording(settings.mapper.fusion);
  TakeFloor(arguments, request.config, sequence, settings);
  fmt::print("{}: {}, {}\n", arguments.input, sequence.kind,
             Counted(sequence.source->FrameCount(), "frame"));
  SayLines(sequence.notes);
  if (!slam) return input;
  SayLines(slam->notes);
  input.warnings = slam->warnings;
  return input;
}

// Looks for the start in a source of its own: frames can be taken from a source only once.
MapStart BeginAnew(PriorMap& prior, MapRequest& request, std::vector<std::string>& warnings) {
  const auto slam = ReadSlam(request.arguments, request.settings.sequence);
  const Sequence sequence = OpenWith(slam, request);
  return BeginIn(prior, request, *sequence.source, request.settings.mapper, warnings);
}

}  // namespace

MapInput OpenMapInput(const MapArguments& given, MapRequest& request) {
  std::optional<PriorMap> prior = OpenPrior(request);
  const std::string prior_hash = prior ? HashOfPriorRun(request.arguments.map) : "";
  MapInput input = OpenToMap(request);
  input.prior = std::move(prior);
  input.prior_hash = prior_hash;
  const auto another_map = DoubtOfMapRecord(given, request, input.prior_hash);
  if (another_map) input.warnings.push_back(*another_map);
  if (input.prior) input.start = BeginAnew(*input.prior, request, input.warnings);
  return input;
}

}  // namespace depthgrid::cli
