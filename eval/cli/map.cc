#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "eval/cli/command_output.h"
#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/finished_map.h"
#include "eval/cli/interrupts.h"
#include "eval/cli/map_doubts.h"
#include "eval/cli/map_input.h"
#include "eval/cli/map_settings.h"
#include "eval/cli/video_output.h"
#include "eval/output/run_folder.h"
#include "eval/report/run_report.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {
namespace {

MappingRun MapSequence(const MapRequest& request, const MapInput& input, ProgressBar& bar) {
  const MapSettings& settings = request.settings;
  try {
    MappingRun run = MapFrames(*input.sequence.source, settings.mapper,
                               {.final_poses = input.sequence.final_poses,
                                .progress = bar.AsProgress(kFinishingMap),
                                .prior = input.prior ? &*input.prior : nullptr});
    run.base_from_laser = settings.sequence.laser.mount.base_from_laser();
    return run;
  } catch (const InputError&) {
    // Poses in millimetres span too large a map; what was noticed before says why.
    bar.Clear();
    Warn(input.warnings);
    if (const auto poses = DoubtOfGivenPoses(request.arguments, input.sequence)) Warn({*poses});
    throw;
  }
}

// The run's record, without run times.
RunRecord RecordOf(const MapRequest& request, const MappingRun& run, const std::string& map_hash,
                   const std::vector<std::string>& warnings) {
  MapSettings settings = request.settings;
  settings.sequence.camera = FromEverywhere(settings.sequence.camera);
  settings.sequence.camera_mount = FromEverywhere(settings.sequence.camera_mount);
  RunRecord record;
  for (const std::string& warning : warnings) record.warnings.push_back(Printable(warning));
  record.settings = ToYaml(settings);
  record.mapping = &run;
  record.scan = settings.mapper.scan;
  record.map_mode = request.arguments.output.map_mode;
  record.map_hash = map_hash;
  return record;
}

void WriteMapFolder(const MapRequest& request, const RunRecord& record, OutputFolder& folder) {
  WriteRunFolder(folder, record);
  if (request.arguments.localise) {
    KeepMap(request.arguments.map, folder);
    // The page shows the map that is kept, which may have been edited since it was made.
    WriteRunReport(folder.work().string(), {folder.work().string()});
  }
  folder.Commit();
  NoteResult("the map is in " + request.arguments.common.output);
}

void SayFrames(const MappingRun& run, bool localised) {
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
}

void SayLoops(const MappingRun& run) {
  const auto& mapped = run.result.mapped;
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
}

void SayResult(const MappingRun& run, bool localised, const std::optional<Crossing>& crossing) {
  SayFrames(run, localised);
  SayLoops(run);
  fmt::print("\n");
  if (!crossing) return;
  fmt::print("{:.1f} % of the beams lead through walls of the map\n", 100.0 * crossing->share);
}

void MapRequested(const MapArguments& given, MapRequest request) {
  const auto start = std::chrono::steady_clock::now();
  const MapArguments& arguments = request.arguments;
  const std::vector<std::string> files = InputsOf(given, request);
  RequireVideoFile(arguments.output, arguments.common, files);
  OutputFolder folder = OpenOutput(arguments.common, ResultKind::kMap, files);
  const MapInput input = OpenMapInput(given, request);
  ProgressBar bar("mapping");
  const MappingRun run = MapSequence(request, input, bar);
  bar.Say("writing the map and the report");
  const auto crossing = CrossingOf(run.result);
  std::vector<std::string> warnings = input.warnings;
  const std::vector<std::string> doubts = DoubtsOfMapRun(given, request, input, run, crossing);
  warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  RunRecord record = RecordOf(request, run, input.prior_hash, warnings);
  record.wall_s_total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_s_total = ProcessCpuS();
  WriteMapFolder(request, record, folder);
  WriteVideo(arguments.output, arguments.common, run, request.settings.mapper.grid);
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
