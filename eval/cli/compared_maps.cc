#include "eval/cli/compared_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "eval/files/one_grid.h"
#include "eval/files/one_result.h"
#include "eval/files/shell_word.h"
#include "eval/metrics/cell_maps.h"
#include "mapper/core/angle.h"
#include "mapper/core/error.h"

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

// Suggests redrawing a run's map with other cells; empty for maps that are not from a run.
std::string RedrawRemedy(const std::string& map, double resolution_m) {
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

struct SizedMaps {
  StateMap truth;
  OccupancyMap estimate;
  std::string note;  // how one of them was coarsened; empty if neither was
};

std::string NoteOf(const std::string& fine, int times, double fine_m, const std::string& coarse,
                   double coarse_m) {
  return fmt::format(
      "{}: {} x {} of its cells of {} m count as one of {} m, as {} has them: occupied if any is, "
      "else free if any is",
      fine, times, times, fine_m, coarse_m, coarse);
}

// `estimate` must be on the truth's grid.
SizedMaps InOneSize(StateMap truth, OccupancyMap estimate, const EvalMapArguments& paths) {
  const double truth_m = truth.geometry.resolution_m;
  const double estimate_m = estimate.geometry.resolution_m;
  SizedMaps maps;
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
                    estimate_m, truth_m, paths.reference, RedrawRemedy(paths.estimate, truth_m)));
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

}  // namespace

MapFiles ReadMapFiles(const EvalMapArguments& arguments) {
  RequireNoFolder(arguments.reference, "truth_map.yaml");
  RequireNoFolder(arguments.estimate, "map.yaml");
  for (const std::string& file : {arguments.reference, arguments.estimate, arguments.observable}) {
    RequireOneResultAround(file);
  }
  MapFiles files;
  files.reference = ReadMap(arguments.reference);
  files.estimate = ReadMap(arguments.estimate, files.reference.world_from_grid);
  return files;
}

ComparedMaps OnOneGrid(const MapFiles& files, const EvalMapArguments& arguments) {
  SizedMaps sized = InOneSize(StatesOf(files.reference.map), AlignedMap(files.estimate), arguments);
  ComparedMaps maps;
  maps.truth = std::move(sized.truth);
  maps.estimate = std::move(sized.estimate);
  maps.coarsened_note = std::move(sized.note);
  if (files.estimate.world_from_grid != Pose2{}) {
    maps.redrawn_note = RedrawnNote(files.estimate, arguments);
  }
  const GridGeometry both = OneGridAround(maps.truth.geometry, arguments.reference,
                                          maps.estimate.geometry, arguments.estimate);
  maps.observable_path = ObservableFile(arguments);
  if (maps.observable_path.empty()) return maps;
  maps.observable = ReadObservable(
      maps.observable_path, files.reference.world_from_grid, maps.truth.geometry.resolution_m,
      maps.AreCoarsened() ? "the larger cells compared" : arguments.reference);
  OneGridAround(both, arguments.reference, maps.observable->geometry, maps.observable_path);
  return maps;
}

}  // namespace depthgrid::cli
