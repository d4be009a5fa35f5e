// Scan matching: a furnished room mapped from its walk, 58 degrees, 6 m. References: the plain
// exhaustive search and Ceres.
#include "bench/bench_data.h"
#include "bench/bench_table.h"
#include "mapper/core/rng.h"
#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"
#include "mapper/match/correlative_search.h"
#include "mapper/match/least_squares.h"
#include "mapper/match/scan_matcher.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid::bench {
namespace {

// Every sixth scan of the walk is matched, the others are mapped.
constexpr std::size_t kMatchedEvery = 6;

const OccupancyMap& RoomMap(double resolution_m) {
  static std::map<double, ProbabilityGrid> grids;
  auto grid = grids.find(resolution_m);
  if (grid == grids.end()) {
    GridOptions options;
    options.resolution_m = resolution_m;
    grid = grids.try_emplace(resolution_m, options).first;
    const LaserWalk& walk = LaserWalkOf(640);
    ScanRasterizer rasterizer;
    for (std::size_t k = 0; k < walk.scans.size(); ++k) {
      if (k % kMatchedEvery == 0) continue;
      grid->second.Insert(rasterizer.Rasterize(*walk.scans[k], walk.truth[k], resolution_m));
    }
  }
  return grid->second.map();
}

struct MatchCase {
  std::shared_ptr<const Scan> scan;
  MatchPoints points;
  Pose2 predicted;  // some centimetres off
};

const std::vector<MatchCase>& CasesOf(int beams) {
  static std::map<int, std::vector<MatchCase>> all;
  std::vector<MatchCase>& cases = all[beams];
  if (!cases.empty()) return cases;
  const LaserWalk& walk = LaserWalkOf(beams);
  RandomStream random(2, RandomStage::kTest);
  for (std::size_t k = 0; k < walk.scans.size(); k += kMatchedEvery) {
    MatchCase& c = cases.emplace_back();
    c.scan = walk.scans[k];
    c.points.Assign(*c.scan);
    c.predicted = walk.truth[k] * Pose2{random.Uniform(-0.03, 0.03), random.Uniform(-0.03, 0.03),
                                        random.Uniform(-0.02, 0.02)};
  }
  return cases;
}

struct Window {
  int beams = 640;
  int degrees = 20;
  int centimetres = 10;
  double resolution_m = 0.05;
  bool slow = false;
};

void AddSearchCase(const Window& w) {
  const std::string size = std::to_string(w.beams) + " beams, +-" + std::to_string(w.degrees) +
                           " deg, +-" + std::to_string(w.centimetres) + " cm, " +
                           std::to_string(static_cast<int>(1000.0 * w.resolution_m)) + " mm";
  const auto search = [=](SearchMethod method) {
    return [=](benchmark::State& state) {
      const auto& cases = CasesOf(w.beams);
      const ProbabilityView view = ViewOf(RoomMap(w.resolution_m));
      CorrelativeSearch correlative({.method = method,
                                     .window_m = 0.01 * w.centimetres,
                                     .window_deg = static_cast<double>(w.degrees)});
      std::size_t i = 0;
      for (auto _ : state) {
        const MatchCase& c = cases[i++ % cases.size()];
        benchmark::DoNotOptimize(correlative.Search(c.points, view, c.predicted));
      }
    };
  };
  AddFloor("exhaustive search @ " + size, search(SearchMethod::kReference));
  AddCase({"correlative search", size, "exhaustive search @ " + size, search(SearchMethod::kFast),
           w.slow});
}

// Starts with the first case in every repetition, so that all do the same work.
Loop SolveLoop(int beams, SolverMethod method) {
  return [=](benchmark::State& state) {
    const auto& cases = CasesOf(beams);
    const ProbabilityView view = ViewOf(RoomMap(0.05));
    const LeastSquaresOptions options{.method = method};
    FastMatchCost cost;
    std::size_t i = 0;
    for (auto _ : state) {
      const MatchCase& c = cases[i++ % cases.size()];
      cost.Prepare(c.points, view, c.predicted);
      benchmark::DoNotOptimize(SolveLeastSquares(options, cost, c.predicted, c.predicted));
    }
  };
}

std::string AddCeres(int beams) {
  const std::string name = "Ceres, bicubic, same scan @ " + std::to_string(beams);
  AddFloor(name, SolveLoop(beams, SolverMethod::kCeres));
  return name;
}

// The map is queried twice for each scan; the second time the scan is already cut into surfels.
void AddSurfelCase(int beams, bool with_cutting) {
  const std::string what = with_cutting ? " beams, with cutting the scan" : " beams, cut before";
  AddCase(
      {"surfel match", std::to_string(beams) + what, AddCeres(beams), [=](benchmark::State& state) {
         const LaserWalk& walk = LaserWalkOf(640);
         SurfelMap map({});
         for (std::size_t k = 0; k < walk.scans.size(); ++k) {
           if (k % kMatchedEvery == 0) continue;
           map.Insert(walk.scans[k], walk.truth[k], Eigen::Matrix3d::Zero());
         }
         const auto& cases = CasesOf(beams);
         Prediction prediction;
         prediction.covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-4).asDiagonal();
         std::size_t i = 0;
         for (auto _ : state) {
           const MatchCase& c = cases[i++ % cases.size()];
           prediction.map_from_base = c.predicted;
           if (!with_cutting) {
             state.PauseTiming();
             map.Match(c.scan, prediction);
             state.ResumeTiming();
           }
           benchmark::DoNotOptimize(map.Match(c.scan, prediction));
         }
       }});
}

[[maybe_unused]] const bool added = [] {
  for (const int beams : {160, 320, 640}) {
    AddSearchCase({beams, 5});
    AddSearchCase({beams, 20});
  }
  AddSearchCase({640, 20, 10, 0.025});
  AddSearchCase({640, 20, 50, 0.05, true});
  for (const int beams : {160, 320, 640}) {
    AddCase({"least squares", std::to_string(beams) + " beams", AddCeres(beams),
             SolveLoop(beams, SolverMethod::kFast)});
  }
  for (const int beams : {160, 320, 640}) {
    AddCase({"paper match, search and solver", std::to_string(beams) + " beams", AddCeres(beams),
             [=](benchmark::State& state) {
               const auto& cases = CasesOf(beams);
               const ProbabilityView view = ViewOf(RoomMap(0.05));
               ScanMatcher matcher({});
               std::size_t i = 0;
               for (auto _ : state) {
                 const MatchCase& c = cases[i++ % cases.size()];
                 benchmark::DoNotOptimize(matcher.Match(*c.scan, view, c.predicted));
               }
             }});
  }
  for (const int beams : {160, 320, 640}) {
    AddSurfelCase(beams, true);
    AddSurfelCase(beams, false);
  }
  return true;
}();

}  // namespace
}  // namespace depthgrid::bench
