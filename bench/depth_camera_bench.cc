// Speed of the rendered depth camera: 640x480, ICL-NUIM's camera, a cluttered room of so many
// triangles. Floor: Embree's packets alone over the same rays, set up beforehand.
#include <benchmark/benchmark.h>

#include <map>
#include <vector>

#include "mapper/core/level.h"
#include "sim/depth_camera.h"
#include "sim/ray_scene_impl.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

const RayScene& Room(int triangles, RayIsa isa) {
  static std::map<std::pair<int, RayIsa>, RayScene> rooms;
  const auto [room, is_new] =
      rooms.try_emplace({triangles, isa}, test::ClutteredRoom(triangles), isa);
  return room->second;
}

bool HasAvx512() { return __builtin_cpu_supports("avx512vl") != 0; }

Pose3 PoseOf(int k) { return CameraOf({2.0 + 0.05 * (k % 10), 2.0, 0.7 * (k % 9)}, 1.15); }

void Counters(benchmark::State& state, double pixels_per_frame) {
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["Mray/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * pixels_per_frame * 1e-6,
                         benchmark::Counter::kIsRate);
}

// Arguments: triangles, instruction set, threads.
void RenderDepth(benchmark::State& state) {
  const auto isa = static_cast<RayIsa>(state.range(1));
  if (isa == RayIsa::kAvx512 && !HasAvx512()) return state.SkipWithError("no AVX-512");
  const DepthCamera camera(Room(static_cast<int>(state.range(0)), isa), PinholeCamera{},
                           static_cast<int>(state.range(2)));
  int k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(camera.Render(PoseOf(k++)));
  Counters(state, 640.0 * 480.0);
}

void RenderDepthAndIncidence(benchmark::State& state) {
  const auto isa = static_cast<RayIsa>(state.range(1));
  if (isa == RayIsa::kAvx512 && !HasAvx512()) return state.SkipWithError("no AVX-512");
  const DepthCamera camera(Room(static_cast<int>(state.range(0)), isa), PinholeCamera{},
                           static_cast<int>(state.range(2)));
  int k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(camera.RenderWithIncidence(PoseOf(k++)));
  Counters(state, 640.0 * 480.0);
}

// The rays of one frame as packets in 4-wide tiles.
template <int kWidth>
std::vector<typename RayPacket<kWidth>::RayHits> FramePackets(const Pose3& pose) {
  const PinholeCamera camera;
  const Eigen::Matrix3f r = pose.rotation.toRotationMatrix().cast<float>();
  std::vector<typename RayPacket<kWidth>::RayHits> packets;
  for (int v0 = 0; v0 < camera.height_px; v0 += kWidth / 4) {
    for (int u0 = 0; u0 < camera.width_px; u0 += 4) {
      auto& packet = packets.emplace_back();
      for (int i = 0; i < kWidth; ++i) {
        const Eigen::Vector3f d = r * Unproject(camera, u0 + i % 4, v0 + i / 4, 1.0).cast<float>();
        packet.ray.org_x[i] = static_cast<float>(pose.translation.x());
        packet.ray.org_y[i] = static_cast<float>(pose.translation.y());
        packet.ray.org_z[i] = static_cast<float>(pose.translation.z());
        packet.ray.dir_x[i] = d.x();
        packet.ray.dir_y[i] = d.y();
        packet.ray.dir_z[i] = d.z();
        ResetLane(packet, i, std::numeric_limits<float>::infinity());
      }
    }
  }
  return packets;
}

template <int kWidth>
void EmbreeAlone(benchmark::State& state) {
  const auto isa = static_cast<RayIsa>(state.range(1));
  if (isa == RayIsa::kAvx512 && !HasAvx512()) return state.SkipWithError("no AVX-512");
  RTCScene scene = Room(static_cast<int>(state.range(0)), isa).impl().scene;
  alignas(64) int valid[kWidth];
  std::fill_n(valid, kWidth, -1);
  RTCIntersectContext context = CoherentContext();
  for (auto _ : state) {
    for (int k = 0; k < 9; ++k) {
      state.PauseTiming();
      auto packets = FramePackets<kWidth>(PoseOf(k));
      state.ResumeTiming();
      for (auto& packet : packets) {
        RayPacket<kWidth>::Intersect(valid, scene, &context, &packet);
      }
      benchmark::DoNotOptimize(packets.data());
    }
  }
  Counters(state, 9.0 * 640.0 * 480.0);
  state.counters["frames/s"] = benchmark::Counter(9.0 * static_cast<double>(state.iterations()),
                                                  benchmark::Counter::kIsRate);
}

constexpr auto kAvx2 = static_cast<int64_t>(RayIsa::kAvx2);
constexpr auto kAvx512 = static_cast<int64_t>(RayIsa::kAvx512);

BENCHMARK(RenderDepth)
    ->ArgNames({"triangles", "isa", "threads"})
    ->ArgsProduct({{12, 10'000, 100'000, 1'000'000}, {kAvx2, kAvx512}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK(RenderDepthAndIncidence)
    ->ArgNames({"triangles", "isa", "threads"})
    ->ArgsProduct({{100'000}, {kAvx2, kAvx512}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK(EmbreeAlone<8>)
    ->ArgNames({"triangles", "isa"})
    ->Args({100'000, kAvx2})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(EmbreeAlone<16>)
    ->ArgNames({"triangles", "isa"})
    ->Args({100'000, kAvx512})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace depthgrid
