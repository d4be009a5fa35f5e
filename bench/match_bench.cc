// Speed of scan matching: a furnished room mapped from 90 noisy scans, 58 degrees, 6 m, 5 cm cells.
// Floors: the plain exhaustive search and Ceres in the same process.
#include <benchmark/benchmark.h>

#include <vector>

#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"
#include "mapper/match/correlative_search.h"
#include "mapper/match/least_squares.h"
#include "mapper/match/scan_matcher.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

PlanarLaser LaserOf(int beams) {
  PlanarLaser laser;
  laser.beams = beams;
  laser.field_of_view_rad = RadFromDeg(58.0);
  laser.sigma_of_range = 0.01;
  return laser;
}

Pose2 PathPose(int k) { return {2.2 + 0.012 * k, 1.2 + 0.005 * k, 0.4 + 0.02 * k}; }

const OccupancyMap& RoomMap() {
  static ProbabilityGrid grid = [] {
    ProbabilityGrid built({});
    for (int k = 0; k < 90; ++k) {
      const Scan scan =
          ScanOf(FurnishedRoom(), PathPose(k), LaserOf(640), 1, static_cast<std::uint32_t>(k));
      built.Insert(ScanRasterizer().Rasterize(scan, PathPose(k), 0.05));
    }
    return built;
  }();
  return grid.map();
}

struct Case {
  Scan scan;
  MatchPoints points;
  Pose2 predicted;
};

// Scans the map has not seen, each with a prediction some centimetres off.
std::vector<Case> CasesOf(int beams) {
  RandomStream random(2, RandomStage::kTest);
  std::vector<Case> cases(16);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Pose2 truth = PathPose(static_cast<int>(5 * i + 5));
    cases[i].scan =
        ScanOf(FurnishedRoom(), truth, LaserOf(beams), 3, static_cast<std::uint32_t>(i));
    cases[i].points.Assign(cases[i].scan);
    cases[i].predicted = truth * Pose2{random.Uniform(-0.03, 0.03), random.Uniform(-0.03, 0.03),
                                       random.Uniform(-0.02, 0.02)};
  }
  return cases;
}

// Arguments: beams, half window in degrees, half window in centimetres.
void Correlative(benchmark::State& state, SearchMethod method) {
  const std::vector<Case> cases = CasesOf(static_cast<int>(state.range(0)));
  CorrelativeSearch search({.method = method,
                            .window_m = 0.01 * static_cast<double>(state.range(2)),
                            .window_deg = static_cast<double>(state.range(1))});
  std::size_t i = 0;
  for (auto _ : state) {
    const Case& c = cases[i++ % cases.size()];
    benchmark::DoNotOptimize(search.Search(c.points, ViewOf(RoomMap()), c.predicted));
  }
}
void CorrelativeWindows(benchmark::internal::Benchmark* b) {
  for (const int beams : {160, 320, 640}) b->Args({beams, 5, 10})->Args({beams, 20, 10});
  b->Args({640, 20, 50});
  b->Unit(benchmark::kMicrosecond);
}
BENCHMARK_CAPTURE(Correlative, fast, SearchMethod::kFast)->Apply(CorrelativeWindows);
BENCHMARK_CAPTURE(Correlative, reference, SearchMethod::kReference)->Apply(CorrelativeWindows);

// Argument: beams.
void Bicubic(benchmark::State& state, SolverMethod method) {
  const std::vector<Case> cases = CasesOf(static_cast<int>(state.range(0)));
  const LeastSquaresOptions options{.method = method};
  FastMatchCost cost;
  std::size_t i = 0;
  int iterations = 0;
  for (auto _ : state) {
    const Case& c = cases[i++ % cases.size()];
    cost.Prepare(c.points, ViewOf(RoomMap()), c.predicted);
    const LeastSquaresMatch match = SolveLeastSquares(options, cost, c.predicted, c.predicted);
    iterations += match.iterations;
    benchmark::DoNotOptimize(match);
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}
BENCHMARK_CAPTURE(Bicubic, fast, SolverMethod::kFast)
    ->Arg(160)
    ->Arg(320)
    ->Arg(640)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Bicubic, ceres, SolverMethod::kCeres)
    ->Arg(160)
    ->Arg(320)
    ->Arg(640)
    ->Unit(benchmark::kMicrosecond);

// The whole matcher at its defaults. Argument: beams.
void MatchScan(benchmark::State& state) {
  const std::vector<Case> cases = CasesOf(static_cast<int>(state.range(0)));
  ScanMatcher matcher({});
  std::size_t i = 0;
  for (auto _ : state) {
    const Case& c = cases[i++ % cases.size()];
    benchmark::DoNotOptimize(matcher.Match(c.scan, ViewOf(RoomMap()), c.predicted));
  }
}
BENCHMARK(MatchScan)->Arg(160)->Arg(320)->Arg(640)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace depthgrid
