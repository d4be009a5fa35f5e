// The rendered depth camera and its noise. Floors: Embree's packets alone over the same rays, set
// up beforehand; the frame copied.
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "bench/bench_data.h"
#include "bench/bench_table.h"
#include "mapper/core/level.h"
#include "sim/depth/depth_noise.h"
#include "sim/depth/ray_scene_impl.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid::bench {
namespace {

constexpr int kPoses = 9;

const RayScene& Room(int triangles, RayIsa isa) {
  static std::map<std::pair<int, RayIsa>, RayScene> rooms;
  const auto room = rooms.find({triangles, isa});
  if (room != rooms.end()) return room->second;
  return rooms.try_emplace({triangles, isa}, test::ClutteredRoom(triangles), isa).first->second;
}

bool Runs(RayIsa isa, benchmark::State& state) {
  if (isa != RayIsa::kAvx512 || __builtin_cpu_supports("avx512vl") != 0) return true;
  state.SkipWithError("no AVX-512");
  return false;
}

Pose3 PoseOf(int k) { return CameraOf({2.0 + 0.05 * (k % 10), 2.0, 0.7 * (k % kPoses)}, 1.15); }

PinholeCamera CameraOfSize(int width_px) {
  SensorOptions sensor;
  sensor.width_px = width_px;
  sensor.height_px = width_px * 3 / 4;
  return SensorCamera(sensor);
}

// The rays of a frame as packets in 4-wide tiles.
template <int kWidth>
using Packets = std::vector<typename RayPacket<kWidth>::RayHits>;

template <int kWidth>
Packets<kWidth> PacketsOf(const PinholeCamera& camera, const Pose3& pose) {
  const Eigen::Matrix3f r = pose.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f origin = pose.translation.cast<float>();
  Packets<kWidth> packets;
  for (int v0 = 0; v0 < camera.height_px; v0 += kWidth / 4) {
    for (int u0 = 0; u0 < camera.width_px; u0 += 4) {
      auto& packet = packets.emplace_back();
      for (int i = 0; i < kWidth; ++i) {
        const Eigen::Vector3f d = r * Unproject(camera, u0 + i % 4, v0 + i / 4, 1.0).cast<float>();
        packet.ray.org_x[i] = origin.x();
        packet.ray.org_y[i] = origin.y();
        packet.ray.org_z[i] = origin.z();
        packet.ray.dir_x[i] = d.x();
        packet.ray.dir_y[i] = d.y();
        packet.ray.dir_z[i] = d.z();
        ResetLane(packet, i, std::numeric_limits<float>::infinity());
      }
    }
  }
  return packets;
}

// As RenderFrames, the frames of kPoses poses per iteration.
template <int kWidth>
void TracePackets(const PinholeCamera& camera, int triangles, RayIsa isa, benchmark::State& state) {
  if (!Runs(isa, state)) return;
  RTCScene scene = Room(triangles, isa).impl().scene;
  alignas(64) int valid[kWidth];
  std::fill_n(valid, kWidth, -1);
  RTCIntersectContext context = CoherentContext();
  for (auto _ : state) {
    for (int k = 0; k < kPoses; ++k) {
      state.PauseTiming();
      Packets<kWidth> packets = PacketsOf<kWidth>(camera, PoseOf(k));
      state.ResumeTiming();
      for (auto& packet : packets) {
        RayPacket<kWidth>::Intersect(valid, scene, &context, &packet);
      }
      benchmark::DoNotOptimize(packets.data());
    }
  }
}

void RenderFrames(const PinholeCamera& camera, int triangles, RayIsa isa, bool incidence,
                  benchmark::State& state) {
  if (!Runs(isa, state)) return;
  const DepthCamera depth_camera(Room(triangles, isa), camera);
  for (auto _ : state) {
    for (int k = 0; k < kPoses; ++k) {
      if (incidence) {
        benchmark::DoNotOptimize(depth_camera.RenderWithIncidence(PoseOf(k)));
      } else {
        benchmark::DoNotOptimize(depth_camera.Render(PoseOf(k)));
      }
    }
  }
}

void AddCameraCase(int width_px, int triangles, RayIsa isa, bool incidence, bool slow) {
  const PinholeCamera camera = CameraOfSize(width_px);
  const std::string lanes = isa == RayIsa::kAvx512 ? "16 wide" : "8 wide";
  const std::string size = std::to_string(camera.width_px) + "x" +
                           std::to_string(camera.height_px) + ", " + std::to_string(triangles) +
                           " triangles, " + lanes;
  const std::string floor = "Embree's packets alone @ " + std::to_string(width_px) + ", " +
                            std::to_string(triangles / 1000) + "k, " + lanes;
  AddFloor(floor, [=](benchmark::State& state) {
    if (isa == RayIsa::kAvx512) {
      TracePackets<16>(camera, triangles, isa, state);
    } else {
      TracePackets<8>(camera, triangles, isa, state);
    }
  });
  AddCase({"depth camera, 9 frames", size + (incidence ? ", angles" : ""), floor,
           [=](benchmark::State& state) { RenderFrames(camera, triangles, isa, incidence, state); },
           slow});
}

void AddNoiseCase(const std::string& name, const SensorOptions& options) {
  AddCase({"depth noise", name, AddCopyFloor(640), [=](benchmark::State& state) {
             const DepthNoise noise(options);
             const DepthWalk& walk = DepthWalkOf(640, 480);
             std::uint32_t frame = 0;
             for (auto _ : state) {
               benchmark::DoNotOptimize(
                   noise.Apply(walk.clean[frame % walk.clean.size()], 1, frame));
               ++frame;
             }
           }});
}

[[maybe_unused]] const bool added = [] {
  for (const RayIsa isa : {RayIsa::kAvx2, RayIsa::kAvx512}) {
    for (const int triangles : {10'000, 100'000, 1'000'000}) {
      AddCameraCase(640, triangles, isa, false, triangles == 1'000'000);
    }
    AddCameraCase(320, 100'000, isa, false, false);
    AddCameraCase(1280, 100'000, isa, false, true);
    AddCameraCase(640, 100'000, isa, true, false);
  }
  for (const auto& [model, name] : kDepthNoiseModels) {
    if (model == DepthNoiseModel::kNone) continue;
    SensorOptions options;
    options.noise = model;
    AddNoiseCase(std::string(name), options);
  }
  SensorOptions artifacts;
  artifacts.flying_pixels = 0.5;
  artifacts.shadow_baseline_m = 0.075;
  AddNoiseCase("flying pixels and shadow", artifacts);
  return true;
}();

}  // namespace
}  // namespace depthgrid::bench
