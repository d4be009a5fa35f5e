#include "eval/cli/map_doubts.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/cli/finished_map.h"
#include "eval/cli/pose_doubt_text.h"
#include "eval/cli/way_warnings.h"
#include "eval/doubts/floor_check.h"
#include "eval/doubts/view_check.h"
#include "eval/run/prior_run.h"

namespace depthgrid::cli {
namespace {

using MapDoubts = std::vector<std::string>;

void AddDoubt(const std::optional<std::string>& doubt, MapDoubts& doubts) {
  if (doubt) doubts.push_back(*doubt);
}

void AddDoubts(const MapDoubts& more, MapDoubts& doubts) {
  doubts.insert(doubts.end(), more.begin(), more.end());
}

// The file or folder that the poses are from.
const std::string& PlaceOfPoses(const MapArguments& arguments) {
  return arguments.poses.empty() ? arguments.input : arguments.poses;
}

// Warns of a wrong up axis: its map is a vertical section of the room, but looks like a map.
std::optional<std::string> DoubtOfUpAxis(const Config& config, const Sequence& sequence,
                                         const RecordingOptions& options) {
  if (!sequence.up_doubt) return {};
  return config.PlaceOfKey("sequence.world_up") + ": " + UpDoubtText(*sequence.up_doubt, options);
}

// Warns of poses in a world whose floor is not at height 0.
std::optional<std::string> DoubtOfFloor(const MapArguments& arguments, const Sequence& sequence,
                                        const ScanOptions& scan, const MappingRun& run) {
  const auto& seen_z_m = sequence.seen_floor_z_m;
  if (!seen_z_m || !MapsFloor(run, *seen_z_m, scan)) return {};
  return fmt::format(
      "{}: the floor seen in the images lies at z = {:.2f}, but {:g} is taken for it, so it is "
      "drawn as walls: --set mapper.scan.floor_z_m={:.2f} says where it is",
      PlaceOfPoses(arguments), *seen_z_m, scan.floor_z_m, *seen_z_m);
}

// Warns of images in which no scan has anything to match.
std::optional<std::string> DoubtOfImages(const std::string& input, const MappingRun& run,
                                         const MapperOptions& options,
                                         const std::optional<double>& depth_scale_per_m) {
  const auto doubt = DoubtOfView(run, options);
  if (!doubt) return {};
  // Its last words are the range of depths, if any were measured.
  const bool may_be_scale = depth_scale_per_m && doubt->ends_with(" m");
  return input + ": " + *doubt +
         (may_be_scale
              ? fmt::format(", read with {:g} units a metre (depth_scale)", *depth_scale_per_m)
              : "");
}

std::string TextOfEmptyScans(const std::string& input, const CarmenLogOptions& laser) {
  return fmt::format("{}: no scan has a return between {:g} m (sequence.laser.min_range_m) and {}",
                     input, laser.min_range_m,
                     laser.max_range_m > 0.0
                         ? fmt::format("{:g} m (max_range_m)", laser.max_range_m)
                         : "the log's own maximum, 80 m at most (max_range_m)");
}

// Warns of poses that were not checked by matches, because their map looks like any other.
MapDoubts DoubtsOfMatches(const MapRequest& request, const Sequence& sequence,
                          const MappingRun& run) {
  const std::string& input = request.arguments.input;
  const MapSettings& settings = request.settings;
  const auto images = DoubtOfImages(input, run, settings.mapper, sequence.depth_scale_per_m);
  if (images) return {*images};
  MapDoubts doubts;
  if (!run.camera && SawNothing(run)) {
    doubts.push_back(TextOfEmptyScans(input, settings.sequence.laser));
  }
  const auto& reports = run.reports;
  if (reports.size() < 2 || settings.mapper.fusion.TrustsSlamAlone()) return doubts;
  if (const auto scans = run.camera ? std::nullopt : DoubtOfScans(run)) {
    doubts.push_back(input + ": " + *scans);
  }
  const bool any = std::any_of(reports.begin(), reports.end(),
                               [](const FrameReport& report) { return report.match.found; });
  if (!any) doubts.push_back(input + ": no scan could be matched, the poses are those given");
  return doubts;
}

// Warnings about the finished map that the run continued in.
MapDoubts DoubtsOfPriorMap(const MapRequest& request, const MapStart& start,
                           const MappingRun& run) {
  MapDoubts doubts;
  AddDoubt(DoubtOfPrior(request.arguments.map, request.settings.mapper, run.camera.has_value()),
           doubts);
  AddDoubt(DoubtOfHeight(request, run), doubts);
  AddDoubts(DoubtsOfPlace(request, start, run), doubts);
  return doubts;
}

std::optional<std::string> DoubtOfWalls(const std::string& input, const MappingRun& run,
                                        const std::optional<Crossing>& crossing) {
  if (!crossing) return {};
  const auto doubt = DoubtOfCrossing(*crossing, run.camera.has_value());
  return doubt ? std::optional(input + ": " + *doubt) : std::nullopt;
}

}  // namespace

std::optional<std::string> DoubtOfGivenPoses(const MapArguments& arguments,
                                             const Sequence& sequence) {
  const auto& doubt = sequence.pose_doubt;
  if (!doubt) return {};
  return PlaceOfPoses(arguments) + ": " + PoseDoubtText(*doubt);
}

std::vector<std::string> DoubtsOfMapRun(const MapArguments& given, const MapRequest& request,
                                        const MapInput& input, const MappingRun& run,
                                        const std::optional<Crossing>& crossing) {
  const MapArguments& arguments = request.arguments;
  const SequenceOptions& options = request.settings.sequence;
  const Sequence& sequence = input.sequence;
  MapDoubts doubts = run.warnings;
  AddDoubt(DoubtOfGivenPoses(arguments, sequence), doubts);
  AddDoubt(DoubtOfUpAxis(request.config, sequence, options.recording), doubts);
  AddDoubt(DoubtOfFloor(arguments, sequence, request.settings.mapper.scan, run), doubts);
  AddDoubts(DoubtsOfSettings(given, request), doubts);
  // Misread poses differ in scale as well.
  if (!sequence.pose_doubt) {
    CheckScale(arguments.input, sequence.depth_scale_per_m, run, doubts);
  }
  CheckDirections(arguments.input, options.laser, run, doubts);
  AddDoubts(DoubtsOfMatches(request, sequence, run), doubts);
  if (input.start) AddDoubts(DoubtsOfPriorMap(request, *input.start, run), doubts);
  AddDoubt(DoubtOfWalls(arguments.input, run, crossing), doubts);
  if (arguments.localise) AddDoubts(DoubtsOfKeptMap(request, run.result.map), doubts);
  return doubts;
}

}  // namespace depthgrid::cli
