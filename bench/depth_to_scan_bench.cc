// Depth image to scan at 640x480, full image, tilted; beside a copy of the image, which is the
// fastest anything can read and write it. Target: 0.2 ms at 4 GHz with 16-wide vectors.
#include <benchmark/benchmark.h>

#include <cstring>

#include "mapper/core/rng.h"
#include "mapper/scan/depth_to_scan.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

const PinholeCamera kCamera;

Pose3 Pose() { return TiltedCamera({-1.0, 0.0, 0.2}, 1.15, RadFromDeg(12.0), RadFromDeg(4.0)); }

DepthImage Image(double missing_share) {
  AnalyticRoom room;
  room.boxes.push_back({{1.0, -1.0, 0.0}, {1.5, -0.3, 0.5}});
  DepthImage image = room.Render(kCamera, Pose());
  RandomStream random(1, RandomStage::kTest);
  for (float& z_m : image.z_m) {
    if (random.Uniform() < missing_share) z_m = kInvalidDepth;
  }
  return image;
}

void CopyImage(benchmark::State& state) {
  const DepthImage image = Image(0.0);
  DepthImage copy = image;
  for (auto _ : state) {
    std::memcpy(copy.z_m.data(), image.z_m.data(), image.z_m.size() * sizeof(float));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(CopyImage)->Unit(benchmark::kMicrosecond);

// Argument: percent of pixels missing at random.
void ConvertFull(benchmark::State& state) {
  const DepthImage image = Image(static_cast<double>(state.range(0)) / 100.0);
  const DepthToScan converter(kCamera, {});
  const Pose3 pose = Pose();
  for (auto _ : state) benchmark::DoNotOptimize(converter.Convert(image, pose));
}
BENCHMARK(ConvertFull)->Arg(0)->Arg(1)->Arg(33)->Unit(benchmark::kMicrosecond);

void ConvertCentreRow(benchmark::State& state) {
  const DepthImage image = Image(0.0);
  ScanOptions options;
  options.mode = ScanMode::kCentreRow;
  const DepthToScan converter(kCamera, options);
  const Pose3 pose = Pose();
  for (auto _ : state) benchmark::DoNotOptimize(converter.Convert(image, pose));
}
BENCHMARK(ConvertCentreRow)->Unit(benchmark::kMicrosecond);

void FloorHeight(benchmark::State& state) {
  const DepthImage image = Image(0.0);
  ScanOptions options;
  options.floor = FloorSource::kImage;
  const DepthToScan converter(kCamera, options);
  const Pose3 pose = Pose();
  for (auto _ : state) benchmark::DoNotOptimize(converter.CameraHeightM(image, pose));
}
BENCHMARK(FloorHeight)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace depthgrid
