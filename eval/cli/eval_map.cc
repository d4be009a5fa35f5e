#include <fmt/format.h>

#include <algorithm>

#include "eval/cli/commands.h"
#include "eval/cli/compared_maps.h"
#include "eval/cli/console.h"
#include "eval/cli/eval_map_doubts.h"
#include "eval/cli/map_score_table.h"
#include "eval/metrics/cell_maps.h"
#include "eval/metrics/map_metrics.h"
#include "eval/run/metrics_json.h"

namespace depthgrid::cli {
namespace {

// A trinary file has only states, so its calibration is meaningless.
bool HoldsProbabilities(const OccupancyMap& map) {
  return std::any_of(map.occupied_prob.begin(), map.occupied_prob.end(),
                     [](float prob) { return prob > 0.0F && prob < 1.0F; });
}

// The walls of a redrawn map as its own cells have them, but for coarsened maps.
PlacedWalls WallsToPlace(const MapFile& estimate, const ComparedMaps& maps) {
  if (maps.IsRedrawn() && !maps.AreCoarsened()) {
    return {CellsIn(StatesOf(estimate.map), CellState::kOccupied), estimate.world_from_grid};
  }
  return {CellsIn(StatesOf(maps.estimate), CellState::kOccupied), {}};
}

// `world_from_truth`: the pose of the reference's cells.
MapScore ScoreOf(const ComparedMaps& maps, const PlacedWalls& walls,
                 const Pose2& world_from_truth) {
  MapScore score = ScoreMap(maps.truth, StatesOf(maps.estimate), maps.observable);
  score.quality = ScoreMapQuality(maps.truth, maps.estimate, maps.observable, {}, walls);
  if (auto& found = score.quality->registration) {
    Pose2& motion = found->truth_from_estimate;
    motion = world_from_truth * motion * Inverse(world_from_truth);
  }
  if (maps.AreCoarsened()) score.compared_cell_m = maps.truth.geometry.resolution_m;
  return score;
}

void PrintComparison(const ComparedMaps& maps, const MapScore& score) {
  for (const std::string& note : {maps.redrawn_note, maps.coarsened_note}) {
    if (!note.empty()) fmt::print("{}\n\n", Printable(note));
  }
  PrintMapScore(score);
}

}  // namespace

void EvalMap(const EvalMapArguments& arguments) {
  const MapFiles files = ReadMapFiles(arguments);
  Warn(files.reference.doubts);
  Warn(files.estimate.doubts);
  const ComparedMaps maps = OnOneGrid(files, arguments);
  const PlacedWalls walls = WallsToPlace(files.estimate, maps);
  MapScore score = ScoreOf(maps, walls, files.reference.world_from_grid);
  Warn(DoubtsOfComparison(arguments, files, maps, walls, score));
  if (!HoldsProbabilities(maps.estimate)) score.quality->calibration.reset();
  if (arguments.json) {
    fmt::print("{}", MetricsJson({}, &score));
  } else {
    PrintComparison(maps, score);
  }
}

}  // namespace depthgrid::cli
