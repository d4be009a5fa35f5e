#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/map_score_table.h"
#include "eval/files/one_grid.h"
#include "eval/files/one_result.h"
#include "eval/files/shell_word.h"
#include "eval/metrics/cell_maps.h"
#include "eval/metrics/map_metrics.h"
#include "eval/metrics/map_turns.h"
#include "eval/run/metrics_json.h"
#include "mapper/core/error.h"
#include "mapper/io/map_file.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

// Rejects a run's folder, which contains both maps.
void RequireNoFolder(const std::string& path, const char* name) {
  const fs::path inside = fs::path(path) / name;
  if (!fs::exists(inside)) return;
  throw InputError(path, fmt::format("is a folder, must be a map's YAML file, such as {}",
                                     ShellWord(inside.string())));
}

// A trinary file has only states, so its calibration is meaningless.
bool HoldsProbabilities(const OccupancyMap& map) {
  return std::any_of(map.occupied_prob.begin(), map.occupied_prob.end(),
                     [](float prob) { return prob > 0.0F && prob < 1.0F; });
}

// Suggests redrawing a run's map with other cells; empty for maps that are not from a run.
std::string RemedyOf(const std::string& map, double resolution_m) {
  const fs::path beside = fs::path(map).parent_path();
  if (!fs::exists(beside / "run.yaml") || !fs::exists(beside / "scans.bin")) return "";
  return fmt::format("; `depthgrid regrid {} --resolution {}` draws it so",
                     beside.empty() ? "." : ShellWord(beside.string()), resolution_m);
}

// Ratio of the cell sizes; empty unless it is a whole number to within 1e-6, because files give
// lengths in decimal.
std::optional<int> TimesLarger(double fine_m, double coarse_m) {
  constexpr double kRelativeTolerance = 1e-6;
  const double times = std::round(coarse_m / fine_m);
  const bool is_whole = times >= 1.0 && times <= std::numeric_limits<int>::max() &&
                        std::abs(times * fine_m - coarse_m) <= kRelativeTolerance * coarse_m;
  return is_whole ? std::optional(static_cast<int>(times)) : std::nullopt;
}

// The compared maps, both in cells of the larger of the two sizes.
struct ComparedMaps {
  StateMap truth;
  OccupancyMap estimate;
  std::string note;  // how one of them was coarsened; empty if neither was

  bool AreCoarsened() const { return !note.empty(); }
};

std::string NoteOf(const std::string& fine, int times, double fine_m, const std::string& coarse,
                   double coarse_m) {
  return fmt::format(
      "{}: {} x {} of its cells of {} m count as one of {} m, as {} has them: occupied if any is, "
      "else free if any is",
      fine, times, times, fine_m, coarse_m, coarse);
}

// `estimate` must be on the truth's grid.
ComparedMaps InOneSize(StateMap truth, OccupancyMap estimate, const EvalMapArguments& paths) {
  const double truth_m = truth.geometry.resolution_m;
  const double estimate_m = estimate.geometry.resolution_m;
  ComparedMaps maps;
  if (const auto times = TimesLarger(estimate_m, truth_m)) {
    if (*times > 1) {
      estimate = CertainMap(Coarsened(StatesOf(estimate), *times, truth_m));
      maps.note = NoteOf(paths.estimate, *times, estimate_m, paths.reference, truth_m);
    }
    estimate.geometry.resolution_m = truth_m;
  } else if (const auto fewer = TimesLarger(truth_m, estimate_m)) {
    truth = Coarsened(truth, *fewer, estimate_m);
    maps.note = NoteOf(paths.reference, *fewer, truth_m, paths.estimate, estimate_m);
  } else {
    throw InputError(
        paths.estimate,
        fmt::format("resolution is {}, must be the {} of {}, a whole multiple or a "
                    "whole part of it{}",
                    estimate_m, truth_m, paths.reference, RemedyOf(paths.estimate, truth_m)));
  }
  maps.truth = std::move(truth);
  maps.estimate = std::move(estimate);
  return maps;
}

// The note for an estimate whose grid is rotated or shifted by part of a cell against the truth's
// and is therefore resampled.
std::string RedrawnNote(const MapFile& estimate, const EvalMapArguments& paths) {
  const Pose2& off = estimate.world_from_grid;
  const std::string turned =
      off.yaw_rad == 0.0 ? "" : fmt::format(", turned by {:.3f} deg", DegFromRad(off.yaw_rad));
  return fmt::format(
      "{}: its cells lie off those of {} (by x {:.4f} m, y {:.4f} m{}): each of the latter takes "
      "what its centre falls into",
      paths.estimate, paths.reference, off.x_m, off.y_m, turned);
}

PlacedWalls WallsOf(const MapFile& estimate) {
  return {CellsIn(StatesOf(estimate.map), CellState::kOccupied), estimate.world_from_grid};
}

// The map of observable cells: the given one, or the one beside the true map; empty without one.
std::string ObservableFile(const EvalMapArguments& arguments) {
  const fs::path beside = fs::path(arguments.reference).parent_path() / "observable.yaml";
  return arguments.observable.empty() && fs::exists(beside) ? beside.string()
                                                            : arguments.observable;
}

// The free cells of a map, in cells of size `cell_m`: those that contain a free cell.
CellSet ReadObservable(const std::string& path, const Pose2& world_from_frame, double cell_m,
                       const std::string& place_of_cells) {
  StateMap states = ReadStates(path, world_from_frame);
  const auto times = TimesLarger(states.geometry.resolution_m, cell_m);
  if (!times) {
    throw InputError(path,
                     fmt::format("resolution is {}, must be the {} of {} or a whole part of it",
                                 states.geometry.resolution_m, cell_m, place_of_cells));
  }
  std::replace(states.states.begin(), states.states.end(), CellState::kOccupied,
               CellState::kUnknown);
  return CellsIn(Coarsened(states, *times, cell_m), CellState::kFree);
}

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
std::vector<std::string> DoubtsOf(const EvalMapArguments& arguments, const MapScore& score,
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
                                         const CellScores& scores, const MapFile& reference,
                                         const MapFile& estimate) {
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
      arguments.estimate, 100.0 * swapped / known, estimate.negate ? 1 : 0,
      reference.negate ? 1 : 0, arguments.reference);
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

void EvalMap(const EvalMapArguments& arguments) {
  RequireNoFolder(arguments.reference, "truth_map.yaml");
  RequireNoFolder(arguments.estimate, "map.yaml");
  for (const std::string& file : {arguments.reference, arguments.estimate, arguments.observable}) {
    RequireOneResultAround(file);
  }
  // All on the reference's grid; the reference is not resampled.
  const MapFile reference = ReadMap(arguments.reference);
  const Pose2& world_from_truth = reference.world_from_grid;
  const MapFile given = ReadMap(arguments.estimate, world_from_truth);
  Warn(reference.doubts);
  Warn(given.doubts);
  const ComparedMaps compared = InOneSize(StatesOf(reference.map), AlignedMap(given), arguments);
  const StateMap& truth = compared.truth;
  const OccupancyMap& estimate = compared.estimate;
  const bool redrawn = given.world_from_grid != Pose2{};
  const GridGeometry both =
      OneGridAround(truth.geometry, arguments.reference, estimate.geometry, arguments.estimate);
  const std::string observable_path = ObservableFile(arguments);
  std::optional<CellSet> observable;
  if (!observable_path.empty()) {
    observable =
        ReadObservable(observable_path, world_from_truth, truth.geometry.resolution_m,
                       compared.AreCoarsened() ? "the larger cells compared" : arguments.reference);
    OneGridAround(both, arguments.reference, observable->geometry, observable_path);
  }
  MapScore score = ScoreMap(truth, StatesOf(estimate), observable);
  // The walls of a redrawn map as its own cells have them, but for coarsened maps.
  const PlacedWalls walls =
      redrawn && !compared.AreCoarsened()
          ? WallsOf(given)
          : PlacedWalls{CellsIn(StatesOf(estimate), CellState::kOccupied), {}};
  score.quality = ScoreMapQuality(truth, estimate, observable, {}, walls);
  if (auto& found = score.quality->registration) {
    Pose2& motion = found->truth_from_estimate;
    motion = world_from_truth * motion * Inverse(world_from_truth);
  }
  if (compared.AreCoarsened()) score.compared_cell_m = truth.geometry.resolution_m;
  std::vector<std::string> doubts = DoubtsOf(arguments, score, observable_path);
  const ScoredMaps maps = OnOneGeometry(truth, StatesOf(estimate), observable);
  if (const auto doubt =
          DoubtOfRegistration(arguments, *score.quality, maps, walls, !doubts.empty())) {
    doubts.push_back(*doubt);
  }
  if (const auto doubt = DoubtOfShades(arguments, score.all, reference, given)) {
    doubts.push_back(*doubt);
  }
  Warn(doubts);
  if (!HoldsProbabilities(estimate)) score.quality->calibration.reset();
  if (arguments.json) {
    fmt::print("{}", MetricsJson({}, &score));
  } else {
    if (redrawn) fmt::print("{}\n\n", Printable(RedrawnNote(given, arguments)));
    if (compared.AreCoarsened()) fmt::print("{}\n\n", Printable(compared.note));
    PrintMapScore(score);
  }
}

}  // namespace depthgrid::cli
