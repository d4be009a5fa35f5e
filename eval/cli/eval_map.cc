#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/metrics/map_metrics.h"
#include "eval/metrics_json.h"
#include "mapper/core/error.h"
#include "mapper/io/map_file.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

using Row = std::vector<std::string>;

std::string Number(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

StateMap ReadStates(const std::string& path) { return StatesOf(AlignedMap(ReadMap(path))); }

CellSet ReadObservable(const std::string& path) {
  const StateMap states = ReadStates(path);
  CellSet observable(states.geometry);
  for (std::size_t i = 0; i < states.states.size(); ++i) {
    observable.members[i] = states.states[i] == CellState::kFree;
  }
  return observable;
}

// The same length to a millionth: files print it in decimal.
void RequireSameResolution(const GridGeometry& a, const std::string& place_a, GridGeometry& b,
                           const std::string& place_b) {
  constexpr double kRelativeTolerance = 1e-6;
  if (std::abs(a.resolution_m - b.resolution_m) > kRelativeTolerance * a.resolution_m) {
    throw InputError(place_b, fmt::format("resolution is {}, must be the {} of {}", b.resolution_m,
                                          a.resolution_m, place_a));
  }
  b.resolution_m = a.resolution_m;
}

void AddRows(const std::string& name, const CellScores& scores, std::vector<Row>& rows) {
  for (std::size_t tolerance = 0; tolerance < scores.occupied.size(); ++tolerance) {
    const StateScore& walls = scores.occupied[tolerance];
    const StateScore& free = scores.free[tolerance];
    rows.push_back({fmt::format("{}, {} cells tolerance", name, tolerance),
                    Number(walls.precision, 4), Number(walls.recall, 4), Number(walls.f1, 4),
                    Number(walls.iou, 4), Number(free.precision, 4), Number(free.recall, 4),
                    Number(free.f1, 4), Number(free.iou, 4)});
  }
}

void AddDistanceRow(const std::string& name, const CellScores& scores, std::vector<Row>& rows) {
  rows.push_back({name, Number(scores.chamfer_m, 4), Number(scores.hausdorff95_m, 4),
                  Number(scores.coverage, 4)});
}

void PrintTable(const MapScore& score) {
  std::vector<Row> cells = {
      {"cells", "precision", "recall", "F1", "IoU", "free precision", "recall", "F1", "IoU"}};
  std::vector<Row> distances = {{"cells", "chamfer m", "Hausdorff 95 % m", "coverage"}};
  if (score.observable) {
    AddRows("observable", *score.observable, cells);
    AddDistanceRow("observable", *score.observable, distances);
  }
  AddRows("all", score.all, cells);
  AddDistanceRow("all", score.all, distances);
  fmt::print("{}\n{}", Table(cells), Table(distances));
}

}  // namespace

void EvalMap(const EvalMapArguments& arguments) {
  const StateMap truth = ReadStates(arguments.reference);
  StateMap estimate = ReadStates(arguments.estimate);
  RequireSameResolution(truth.geometry, arguments.reference, estimate.geometry, arguments.estimate);
  std::string observable_path = arguments.observable;
  const fs::path beside = fs::path(arguments.reference).parent_path() / "observable.yaml";
  if (observable_path.empty() && fs::exists(beside)) observable_path = beside.string();
  std::optional<CellSet> observable;
  if (!observable_path.empty()) {
    observable = ReadObservable(observable_path);
    RequireSameResolution(truth.geometry, arguments.reference, observable->geometry,
                          observable_path);
  }
  const MapScore score = ScoreMap(truth, estimate, observable);
  if (arguments.json) {
    fmt::print("{}", MetricsJson({}, &score));
  } else {
    PrintTable(score);
  }
}

}  // namespace depthgrid::cli
