#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "eval/cli/command_output.h"
#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/finished_map.h"
#include "eval/cli/interrupts.h"
#include "eval/cli/map_settings.h"
#include "eval/cli/pose_doubt_text.h"
#include "eval/cli/video_output.h"
#include "eval/cli/way_warnings.h"
#include "eval/doubts/crossing_check.h"
#include "eval/doubts/floor_check.h"
#include "eval/doubts/view_check.h"
#include "eval/output/run_folder.h"
#include "eval/report/run_report.h"
#include "eval/run/mapping_run.h"
#include "eval/run/prior_run.h"
#include "mapper/core/angle.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/sequence.h"
#include "mapper/io/slam_files.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

void Say(const std::vector<std::string>& lines) {
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
  return ReadSlamFiles(
      {arguments.poses, arguments.final_poses, arguments.loops},
      SequenceFrames(arguments.input, options),
      {options.recording.max_stamp_difference_s, options.recording.interpolate_poses,
       options.recording.max_interpolation_gap_s});
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

Sequence OpenInput(const MapArguments& arguments, const Config& config, MapSettings& settings,
                   std::vector<std::string>& warnings) {
  const auto slam = ReadSlam(arguments, settings.sequence);
  Sequence sequence = OpenSequence(arguments.input, settings.sequence,
                                   slam ? std::optional(slam->slam) : std::nullopt);
  // Without a file of final poses, none are known to be final.
  if (slam && arguments.final_poses.empty()) sequence.final_poses.clear();
  if (settings.mapper.fusion.mode == FusionMode::kOracle) {
    throw SettingError("mapper.fusion.mode",
                       "is oracle, must be another one: of a recording no truth is known");
  }
  if (settings.mapper.fusion.slam_noise.source == SlamNoiseSource::kProfile) {
    throw SettingError("mapper.fusion.slam_noise.source",
                       "is profile, must be another one: of a recording no profile is known");
  }
  if (!config.Has("mapper.scan.floor_z_m") && sequence.floor_z_m) {
    settings.mapper.scan.floor_z_m = *sequence.floor_z_m;
  }
  TakeRenderedFloor(arguments, config, sequence, settings);
  fmt::print("{}: {}, {}\n", arguments.input, sequence.kind,
             Counted(sequence.source->FrameCount(), "frame"));
  Say(sequence.notes);
  if (slam) {
    Say(slam->notes);
    warnings = slam->warnings;
  }
  return sequence;
}

MapStart BeginAnew(PriorMap& prior, MapRequest& request, std::vector<std::string>& warnings) {
  const MapArguments& arguments = request.arguments;
  const SequenceOptions& options = request.settings.sequence;
  const auto slam = ReadSlam(arguments, options);
  const Sequence sequence =
      OpenSequence(arguments.input, options, slam ? std::optional(slam->slam) : std::nullopt);
  return BeginIn(prior, request, *sequence.source, request.settings.mapper, warnings);
}

void CheckPoses(const MapArguments& arguments, const Sequence& sequence,
                std::vector<std::string>& warnings) {
  const auto& doubt = sequence.pose_doubt;
  if (!doubt) return;
  const std::string& poses = arguments.poses.empty() ? arguments.input : arguments.poses;
  warnings.push_back(poses + ": " + PoseDoubtText(*doubt));
}

// Warns of a wrong up axis: its map is a vertical section of the room, but looks like a map.
void CheckUp(const Config& config, const Sequence& sequence, const RecordingOptions& options,
             std::vector<std::string>& warnings) {
  if (!sequence.up_doubt) return;
  warnings.push_back(config.PlaceOfKey("sequence.world_up") + ": " +
                     UpDoubtText(*sequence.up_doubt, options));
}

// Warns of poses in a world whose floor is not at height 0.
void CheckFloor(const MapArguments& arguments, const Sequence& sequence, const ScanOptions& scan,
                const MappingRun& run, std::vector<std::string>& warnings) {
  const auto& seen_z_m = sequence.seen_floor_z_m;
  if (!seen_z_m || !MapsFloor(run, *seen_z_m, scan)) return;
  warnings.push_back(
      fmt::format("{}: the floor seen in the images lies at z = {:.2f}, but {:g} is taken for it, "
                  "so it is drawn as walls: --set mapper.scan.floor_z_m={:.2f} says where it is",
                  arguments.poses.empty() ? arguments.input : arguments.poses, *seen_z_m,
                  scan.floor_z_m, *seen_z_m));
}

// Warns of poses that were not checked by matches, because their map looks like any other.
void CheckMatches(const MapArguments& arguments, const MapSettings& settings,
                  const std::optional<double>& depth_scale_per_m, const MappingRun& run,
                  std::vector<std::string>& warnings) {
  if (const auto doubt = DoubtOfView(run, settings.mapper)) {
    // Its last words are the range of depths, if any were measured.
    const bool may_be_scale = depth_scale_per_m && doubt->ends_with(" m");
    warnings.push_back(arguments.input + ": " + *doubt +
                       (may_be_scale ? fmt::format(", read with {:g} units a metre (depth_scale)",
                                                   *depth_scale_per_m)
                                     : ""));
    return;
  }
  if (!run.camera && SawNothing(run)) {
    const CarmenLogOptions& laser = settings.sequence.laser;
    warnings.push_back(
        fmt::format("{}: no scan has a return between {:g} m (sequence.laser.min_range_m) and {}",
                    arguments.input, laser.min_range_m,
                    laser.max_range_m > 0.0 ? fmt::format("{:g} m (max_range_m)", laser.max_range_m)
                                            : "the log's own maximum, 80 m at most (max_range_m)"));
  }
  const FusionOptions& fusion = settings.mapper.fusion;
  const auto& reports = run.reports;
  const bool any = std::any_of(reports.begin(), reports.end(),
                               [](const FrameReport& report) { return report.match.found; });
  if (reports.size() < 2 || fusion.TrustsSlamAlone()) return;
  if (const auto doubt = run.camera ? std::nullopt : DoubtOfScans(run)) {
    warnings.push_back(arguments.input + ": " + *doubt);
  }
  if (any) return;
  warnings.push_back(arguments.input + ": no scan could be matched, the poses are those given");
}

void SayResult(const MappingRun& run, bool localised, const std::optional<Crossing>& crossing) {
  int posed = 0, well_seen = 0;
  for (const FrameReport& report : run.reports) {
    posed += report.slam_from_camera ? 1 : 0;
    well_seen += report.well_seen ? 1 : 0;
  }
  const auto& mapped = run.result.mapped;
  const auto added =
      std::count_if(mapped.begin(), mapped.end(), [](const auto& m) { return m.frame >= 0; });
  if (localised) {
    fmt::print("placed {} of {}", posed, Counted(run.reports.size(), "frame"));
  } else {
    fmt::print("mapped {} of {}", added + well_seen, Counted(run.reports.size(), "frame"));
    if (well_seen > 0) fmt::print(", the scans of {} kept", added);
  }
  if (const auto lost = static_cast<int>(run.reports.size()) - posed; lost > 0) {
    fmt::print(", {} without a pose", lost);
  }
  // Other loops in the graph are the mapper's own.
  const auto is_given = [&](const PlanarLoop& loop) {
    const auto frame = [&](int i) { return mapped[static_cast<std::size_t>(i)].frame; };
    return std::any_of(run.loops.begin(), run.loops.end(), [&](const LoopClosure& given) {
      return given.first_frame == frame(loop.first) && given.second_frame == frame(loop.second);
    });
  };
  const auto taken = std::count_if(run.result.loops.begin(), run.result.loops.end(), is_given);
  const auto found = static_cast<std::ptrdiff_t>(run.result.loops.size()) - taken;
  if (!run.loops.empty()) {
    fmt::print("; {} of {} taken", taken, Counted(run.loops.size(), "loop closure"));
  }
  if (found > 0) fmt::print("; {} found", Counted(found, "loop closure"));
  fmt::print("\n");
  if (!crossing) return;
  fmt::print("{:.1f} % of the beams lead through walls of the map\n", 100.0 * crossing->share);
}

// Warnings about the run; `begin`: its start in a finished map, if any.
std::vector<std::string> DoubtsOfRun(const MapArguments& given, const MapRequest& request,
                                     const Sequence& input, const std::optional<MapStart>& begin,
                                     const MappingRun& run) {
  const MapArguments& arguments = request.arguments;
  const MapSettings& settings = request.settings;
  std::vector<std::string> warnings = run.warnings;
  CheckPoses(arguments, input, warnings);
  CheckUp(request.config, input, settings.sequence.recording, warnings);
  CheckFloor(arguments, input, settings.mapper.scan, run, warnings);
  const std::vector<std::string> doubts = DoubtsOfSettings(given, request);
  warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  // Misread poses differ in scale as well.
  if (!input.pose_doubt) CheckScale(arguments.input, input.depth_scale_per_m, run, warnings);
  CheckDirections(arguments.input, settings.sequence.laser, run, warnings);
  CheckMatches(arguments, settings, input.depth_scale_per_m, run, warnings);
  if (!begin) return warnings;
  const auto doubt = DoubtOfPrior(arguments.map, settings.mapper, run.camera.has_value());
  if (doubt) warnings.push_back(*doubt);
  if (const auto height = DoubtOfHeight(request, run)) warnings.push_back(*height);
  for (std::string& line : DoubtsOfPlace(request, *begin, run)) warnings.push_back(std::move(line));
  return warnings;
}

// The run's record, without run times.
RunRecord RecordOf(const MapRequest& request, const MappingRun& run, const std::string& map_hash,
                   const std::vector<std::string>& warnings) {
  MapSettings settings = request.settings;
  settings.sequence.camera = FromEverywhere(settings.sequence.camera);
  RunRecord record;
  for (const std::string& warning : warnings) record.warnings.push_back(Printable(warning));
  record.settings = ToYaml(settings);
  record.mapping = &run;
  record.scan = settings.mapper.scan;
  record.map_mode = request.arguments.output.map_mode;
  record.map_hash = map_hash;
  return record;
}

void MapRequested(const MapArguments& given, MapRequest request) {
  const auto start = std::chrono::steady_clock::now();
  const MapArguments& arguments = request.arguments;
  MapSettings& settings = request.settings;
  const std::vector<std::string> inputs = InputsOf(given, request);
  RequireVideoFile(arguments.output, arguments.common, inputs);
  OutputFolder folder = OpenOutput(arguments.common, ResultKind::kMap, inputs);
  std::optional<PriorMap> prior = OpenPrior(request);
  const std::string map_hash = prior ? HashOfPriorRun(arguments.map) : "";
  std::vector<std::string> warnings;
  const Sequence input = OpenInput(arguments, request.config, settings, warnings);
  const auto another_map = DoubtOfMapRecord(given, request, map_hash);
  if (another_map) warnings.push_back(*another_map);
  std::optional<MapStart> begin;
  if (prior) begin = BeginAnew(*prior, request, warnings);
  ProgressBar bar("mapping");
  MappingRun run;
  try {
    run = MapFrames(*input.source, settings.mapper,
                    {.final_poses = input.final_poses,
                     .progress = bar.AsProgress(kFinishingMap),
                     .prior = prior ? &*prior : nullptr});
  } catch (const InputError&) {
    // Poses in millimetres span too large a map; what was noticed before says why.
    bar.Clear();
    CheckPoses(arguments, input, warnings);
    Warn(warnings);
    throw;
  }
  run.base_from_laser = settings.sequence.laser.mount.base_from_laser();
  bar.Say("writing the map and the report");
  const std::vector<std::string> doubts = DoubtsOfRun(given, request, input, begin, run);
  warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  const auto crossing = CrossingOf(run.result);
  if (const auto doubt =
          crossing ? DoubtOfCrossing(*crossing, run.camera.has_value()) : std::nullopt) {
    warnings.push_back(arguments.input + ": " + *doubt);
  }
  if (arguments.localise) {
    const std::vector<std::string> of_map = DoubtsOfKeptMap(request, run.result.map);
    warnings.insert(warnings.end(), of_map.begin(), of_map.end());
  }
  RunRecord record = RecordOf(request, run, map_hash, warnings);
  record.wall_s_total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_s_total = ProcessCpuS();
  WriteRunFolder(folder, record);
  if (arguments.localise) {
    KeepMap(arguments.map, folder);
    // The page shows the map that is kept, which may have been edited since it was made.
    WriteRunReport(folder.work().string(), {folder.work().string()});
  }
  folder.Commit();
  NoteResult("the map is in " + arguments.common.output);
  WriteVideo(arguments.output, arguments.common, run, settings.mapper.grid);
  bar.Clear();
  SayResult(run, arguments.localise, crossing);
  SayReport(arguments.common.output);
  std::fflush(stdout);
  Warn(warnings);
}

}  // namespace

void Map(const MapArguments& given) {
  const MapRequest request = ReadMapRequest(given);
  NamingPlaces([&](const std::string& key) { return PlaceOfKey({&request.config}, key); },
               [&] { MapRequested(given, request); });
}

std::string MapKeys() { return ListKeys(MapSettings{}); }

}  // namespace depthgrid::cli
