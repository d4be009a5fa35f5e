// Scan insertion: the plain reference, the fast one, and what a frame of the paper's chain inserts.
#include <benchmark/benchmark.h>

#include "mapper/grid/map_drawing.h"
#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"
#include "mapper/grid/submap.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

// What issue 5 measures: 640 beams over 58 degrees, up to 6 m, in a room with clutter.
struct Walk {
  std::vector<Scan> scans;
  std::vector<Pose2> poses;
};

Walk MakeWalk(int beams) {
  PlanarWorld world = RectangleWorld(0.0, 0.0, 6.0, 5.0);
  for (const auto& [x, y] : {std::pair{1.0, 1.2}, {4.6, 0.9}, {3.1, 4.2}, {0.8, 3.9}}) {
    const PlanarWorld box = RectangleWorld(x, y, x + 0.63, y + 0.41);
    world.insert(world.end(), box.begin(), box.end());
  }
  Walk walk;
  for (int i = 0; i < 64; ++i) {
    const double angle_rad = 2.0 * kPi * i / 64;
    walk.poses.push_back(
        {3.0 + std::cos(angle_rad), 2.4 + std::sin(angle_rad), WrapAngle(angle_rad + kPi)});
    walk.scans.push_back(
        ScanOf(world, walk.poses.back(),
               {.beams = beams, .field_of_view_rad = RadFromDeg(58.0), .sigma_of_range = 0.01}, 1,
               static_cast<std::uint32_t>(i)));
  }
  return walk;
}

void BM_CellsPlain(benchmark::State& state) {
  const Walk walk = MakeWalk(static_cast<int>(state.range(0)));
  const double resolution_m = static_cast<double>(state.range(1)) * 1e-3;
  SegmentBuilder builder;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        CellsOfScanPlain(builder.Build(walk.scans[i], walk.poses[i], resolution_m)));
    i = (i + 1) % walk.scans.size();
  }
}
BENCHMARK(BM_CellsPlain)->Args({640, 50})->Args({160, 50})->Args({640, 25});

void BM_CellsFast(benchmark::State& state) {
  const Walk walk = MakeWalk(static_cast<int>(state.range(0)));
  const double resolution_m = static_cast<double>(state.range(1)) * 1e-3;
  ScanRasterizer rasterizer;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rasterizer.Rasterize(walk.scans[i], walk.poses[i], resolution_m));
    i = (i + 1) % walk.scans.size();
  }
}
BENCHMARK(BM_CellsFast)->Args({640, 50})->Args({160, 50})->Args({640, 25});

// All that a frame of the paper's chain inserts: both active submaps.
void BM_InsertIntoTwoSubmaps(benchmark::State& state) {
  const Walk walk = MakeWalk(640);
  const bool plain = state.range(0) == 0;
  SegmentBuilder builder;
  ScanRasterizer rasterizer;
  ActiveSubmaps submaps({}, {});
  std::size_t i = 0;
  for (auto _ : state) {
    if (plain) {
      submaps.Insert(CellsOfScanPlain(builder.Build(walk.scans[i], walk.poses[i], 0.05)));
    } else {
      submaps.Insert(rasterizer.Rasterize(walk.scans[i], walk.poses[i], 0.05));
    }
    benchmark::DoNotOptimize(submaps.matching()->map().occupied_prob.data());
    i = (i + 1) % walk.scans.size();
  }
}
BENCHMARK(BM_InsertIntoTwoSubmaps)->Arg(0)->Arg(1);

void BM_DrawIntoFinishedMap(benchmark::State& state) {
  const Walk walk = MakeWalk(640);
  MapDrawing drawing{GridOptions{}};
  std::size_t i = 0;
  for (auto _ : state) {
    drawing.Add(walk.scans[i], walk.poses[i]);
    i = (i + 1) % walk.scans.size();
  }
}
BENCHMARK(BM_DrawIntoFinishedMap);

}  // namespace
}  // namespace depthgrid
