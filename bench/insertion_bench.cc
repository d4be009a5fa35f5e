// Scan insertion. Reference: the plain rasteriser, beam by beam through every cell.
#include "bench/bench_data.h"
#include "bench/bench_table.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/grid/scan_rasterizer.h"
#include "mapper/grid/submap.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid::bench {
namespace {

std::string SizeText(int beams, int resolution_mm) {
  return std::to_string(beams) + " beams, " + std::to_string(resolution_mm) + " mm";
}

// `use` is called with each scan and its pose.
template <typename Use>
void ForEachScan(int beams, benchmark::State& state, Use use) {
  const LaserWalk& walk = LaserWalkOf(beams);
  std::size_t k = 0;
  for (auto _ : state) {
    const std::size_t i = k++ % walk.scans.size();
    use(walk.scans[i], walk.truth[i]);
  }
}

std::string AddPlainCells(int beams, int resolution_mm) {
  const std::string name = "plain cells of a scan @ " + SizeText(beams, resolution_mm);
  AddFloor(name, [=](benchmark::State& state) {
    SegmentBuilder builder;
    ForEachScan(beams, state, [&](const auto& scan, const Pose2& pose) {
      benchmark::DoNotOptimize(CellsOfScanPlain(builder.Build(*scan, pose, 1e-3 * resolution_mm)));
    });
  });
  return name;
}

void AddCellsCase(int beams, int resolution_mm) {
  AddCase({"insertion", "cells of a scan, " + SizeText(beams, resolution_mm),
           AddPlainCells(beams, resolution_mm), [=](benchmark::State& state) {
             ScanRasterizer rasterizer;
             ForEachScan(beams, state, [&](const auto& scan, const Pose2& pose) {
               benchmark::DoNotOptimize(rasterizer.Rasterize(*scan, pose, 1e-3 * resolution_mm));
             });
           }});
}

// The insertions of a frame in the paper's method: into both active submaps.
Loop SubmapLoop(int beams, bool plain) {
  return [=](benchmark::State& state) {
    SegmentBuilder builder;
    ScanRasterizer rasterizer;
    ActiveSubmaps submaps({}, {});
    ForEachScan(beams, state, [&](const auto& scan, const Pose2& pose) {
      submaps.Insert(plain ? CellsOfScanPlain(builder.Build(*scan, pose, 0.05))
                           : rasterizer.Rasterize(*scan, pose, 0.05),
                     *scan, pose);
      benchmark::DoNotOptimize(submaps.matching()->map().occupied_prob.data());
    });
  };
}

[[maybe_unused]] const bool added = [] {
  for (const auto& [beams, resolution_mm] :
       {std::pair{160, 50}, {320, 50}, {640, 50}, {640, 25}, {640, 100}}) {
    AddCellsCase(beams, resolution_mm);
  }
  for (const int beams : {160, 640}) {
    const std::string floor = "plain cells into two submaps @ " + SizeText(beams, 50);
    AddFloor(floor, SubmapLoop(beams, true));
    AddCase(
        {"insertion", "into two submaps, " + SizeText(beams, 50), floor, SubmapLoop(beams, false)});
  }
  AddCase({"insertion", "into the finished map, " + SizeText(640, 50), AddPlainCells(640, 50),
           [](benchmark::State& state) {
             MapDrawing drawing{GridOptions{}};
             ForEachScan(640, state,
                         [&](const auto& scan, const Pose2& pose) { drawing.Add(*scan, pose); });
           }});
  AddCase({"insertion", "into the surfel map, with cutting, 640 beams", AddPlainCells(640, 50),
           [](benchmark::State& state) {
             SurfelMap map({});
             ForEachScan(640, state, [&](const auto& scan, const Pose2& pose) {
               map.Insert(scan, pose, Eigen::Matrix3d::Zero());
             });
           }});
  return true;
}();

}  // namespace
}  // namespace depthgrid::bench
