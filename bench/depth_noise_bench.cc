// Speed of depth noise on a rendered 640x480 frame of a 100,000-triangle room; it should cost less
// than rendering that frame (depth_camera_bench.cc). Floor: the frame copied.
#include <benchmark/benchmark.h>

#include "mapper/core/level.h"
#include "sim/depth_noise.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

const DepthFrame& CleanFrame() {
  static const DepthFrame frame =
      DepthCamera(RayScene(test::ClutteredRoom(100'000)), PinholeCamera{})
          .RenderWithIncidence(CameraOf({2.0, 2.0, 0.7}, 1.15));
  return frame;
}

void AddDepthNoise(benchmark::State& state, DepthNoiseModel model) {
  SensorOptions options;
  options.noise = model;
  const DepthNoise noise(options);
  const DepthFrame& clean = CleanFrame();
  std::uint32_t frame = 0;
  for (auto _ : state) benchmark::DoNotOptimize(noise.Apply(clean, 1, frame++));
}

void AddArtifacts(benchmark::State& state) {
  SensorOptions options;
  options.flying_pixels = 0.5;
  options.shadow_baseline_m = 0.075;
  const DepthNoise noise(options);
  const DepthFrame& clean = CleanFrame();
  std::uint32_t frame = 0;
  for (auto _ : state) benchmark::DoNotOptimize(noise.Apply(clean, 1, frame++));
}

void CopyDepth(benchmark::State& state) {
  for (auto _ : state) {
    DepthImage copy = CleanFrame().depth;
    benchmark::DoNotOptimize(copy);
  }
}

BENCHMARK_CAPTURE(AddDepthNoise, nguyen, DepthNoiseModel::kNguyen)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AddDepthNoise, handa, DepthNoiseModel::kHanda)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AddDepthNoise, d435, DepthNoiseModel::kD435)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AddDepthNoise, kinect_v2, DepthNoiseModel::kKinectV2)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AddDepthNoise, azure, DepthNoiseModel::kAzure)->Unit(benchmark::kMillisecond);
BENCHMARK(AddArtifacts)->Unit(benchmark::kMillisecond);
BENCHMARK(CopyDepth)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace depthgrid
