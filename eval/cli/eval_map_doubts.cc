#include "eval/cli/eval_map_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/map_turns.h"

namespace depthgrid::cli {
namespace {

int KnownToBoth(const CellScores& scores) {
  int known = 0;
  for (const CellState truth : {CellState::kFree, CellState::kOccupied}) {
    for (const CellState estimate : {CellState::kFree, CellState::kOccupied}) {
      known +=
          scores.confusion[static_cast<std::size_t>(truth)][static_cast<std::size_t>(estimate)];
    }
  }
  return known;
}

// Share of the observable cells that are unknown in the truth.
double UnknownShare(const CellScores& observable) {
  const auto& unknown = observable.confusion[static_cast<std::size_t>(CellState::kUnknown)];
  return std::accumulate(unknown.begin(), unknown.end(), 0.0) /
         std::max(1, observable.scored_cells);
}

// Warns of maps that may not belong together, because their scores look like those of a bad map.
std::vector<std::string> DoubtsOfScore(const EvalMapArguments& arguments, const MapScore& score,
                                       const std::string& observable_path) {
  // In the shipped rooms the truth knows all cells that its own poses see; of another room's
  // observable cells it knows a share of 0.97 to 1.
  constexpr double kMostUnknown = 0.01;
  // Share of walls within two cells of the truth's: 0.33 to 0.48 for misplaced maps of the shipped
  // rooms, 0.88 for maps drawn at SLAM's own poses with 0.29 m error.
  constexpr double kLeastNearWalls = 0.5;
  constexpr int kFewWallCells = 20;
  std::vector<std::string> doubts;
  for (const bool is_estimate : {false, true}) {
    const StateScore& exact = score.all.occupied.front();
    if ((is_estimate ? exact.estimated_cells : exact.true_cells) > 0) continue;
    doubts.push_back(fmt::format("{}: has no occupied cell: scores of walls need some in both maps",
                                 is_estimate ? arguments.estimate : arguments.reference));
  }
  if (KnownToBoth(score.all) == 0) {
    doubts.push_back(fmt::format(
        "{}: shares no known cell with {}: maps of different places, or in different frames",
        arguments.estimate, arguments.reference));
  }
  const StateScore& walls = score.all.occupied.back();
  if (walls.estimated_cells >= kFewWallCells && walls.precision &&
      *walls.precision < kLeastNearWalls) {
    doubts.push_back(
        fmt::format("{}: {:.0f} % of its walls lie within {} of walls of {}: in another frame (a "
                    "map lies in that of its poses), of another place, or wrong",
                    arguments.estimate, 100.0 * *walls.precision,
                    Counted(score.all.occupied.size() - 1, "cell"), arguments.reference));
  }
  if (!score.observable) return doubts;
  if (score.observable->scored_cells == 0) {
    doubts.push_back(observable_path +
                     ": has no free cell; free cells are those that could be seen");
  } else if (const double share = UnknownShare(*score.observable); share > kMostUnknown) {
    doubts.push_back(
        fmt::format("{}: of the cells that could be seen, {} does not know {:.0f} %: of "
                    "another place, or in another frame",
                    observable_path, arguments.reference, 100.0 * share));
  }
  return doubts;
}

// Warns of a map whose black and white are swapped: it is free where the other has walls.
std::optional<std::string> DoubtOfShades(const EvalMapArguments& arguments,
                                         const CellScores& scores, const MapFiles& files) {
  // Any two maps are mostly free in both.
  constexpr double kSwapped = 0.8;
  constexpr int kFewCells = 20;
  const auto cells = [&](CellState truth, CellState estimated) {
    return scores.confusion[static_cast<std::size_t>(truth)][static_cast<std::size_t>(estimated)];
  };
  const auto walls_free = cells(CellState::kOccupied, CellState::kFree);
  const auto swapped = cells(CellState::kFree, CellState::kOccupied) + walls_free;
  const double known = KnownToBoth(scores);
  if (known < kFewCells || walls_free == 0 || swapped < kSwapped * known) return std::nullopt;
  return fmt::format(
      "{}: of the cells known to both maps {:.0f} % are free in one and occupied in the other: is "
      "negate, {} here and {} in {}, right in both?",
      arguments.estimate, 100.0 * swapped / known, files.estimate.negate ? 1 : 0,
      files.reference.negate ? 1 : 0, arguments.reference);
}

// Registration always finds the best motion nearby, even if it fits badly; warns of that.
std::optional<std::string> DoubtOfRegistration(const EvalMapArguments& arguments,
                                               const MapQuality& quality, const ScoredMaps& maps,
                                               const PlacedWalls& walls, bool is_doubted) {
  // The living room's true map mirrored has 0.52; maps of it drawn at SLAM's own poses 0.78 and
  // 0.92.
  constexpr double kLiesOver = 0.6;
  if (!quality.walls.chamfer_m) return std::nullopt;  // no walls in one of the maps
  const double f1 = quality.registered ? quality.registered->f1_10cm.value_or(0.0) : 0.0;
  if (f1 >= kLiesOver) return std::nullopt;
  if (const auto turn = TurnOf(maps.truth, walls, maps.scored, f1)) {
    std::string what = turn->mirrored ? "mirrored" : "";
    if (turn->quarters > 0) {
      what += fmt::format("{}turned by {} degrees", turn->mirrored ? " and " : "",
                          90 * (turn->quarters < 3 ? turn->quarters : -1));
    }
    return fmt::format(
        "{}: {}, it would lie over {}: are its axes or the order of its image's rows different?",
        arguments.estimate, what, arguments.reference);
  }
  if (is_doubted) return std::nullopt;
  return fmt::format(
      "{}: no motion lays its walls over those of {} (F1 at 10 cm {:.2f} after the best one found, "
      "of those up to about 0.8 m): farther off, turned, of another place, or wrong",
      arguments.estimate, arguments.reference, f1);
}

}  // namespace

std::vector<std::string> DoubtsOfComparison(const EvalMapArguments& arguments,
                                            const MapFiles& files, const ComparedMaps& maps,
                                            const PlacedWalls& walls, const MapScore& score) {
  std::vector<std::string> doubts = DoubtsOfScore(arguments, score, maps.observable_path);
  const ScoredMaps scored = OnOneGeometry(maps.truth, StatesOf(maps.estimate), maps.observable);
  const auto registration =
      DoubtOfRegistration(arguments, *score.quality, scored, walls, !doubts.empty());
  if (registration) doubts.push_back(*registration);
  const auto shades = DoubtOfShades(arguments, score.all, files);
  if (shades) doubts.push_back(*shades);
  return doubts;
}

}  // namespace depthgrid::cli
