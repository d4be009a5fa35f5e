#include "sim/depth/ray_scene.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>

#include "mapper/core/error.h"
#include "mapper/core/usable_threads.h"
#include "sim/depth/ray_scene_impl.h"

namespace depthgrid {
namespace {

// Eight branches per node and whole triangles in the leaves: the same depths bit for bit as
// Embree's choice with ROBUST (four branches), but coherent packets take 0.83 of the time
// (docs/tried.md, "Depth camera"). Precomputed triangles are faster still, but not robust.
constexpr const char* kTriangleTree = "bvh8.triangle4v";

std::string DeviceConfig(RayIsa isa) {
  const char* const name = isa == RayIsa::kAvx512 ? "avx512" : "avx2";
  return fmt::format("isa={},threads={},tri_accel={}", name, UsableThreads(), kTriangleTree);
}

void CheckMachine(RayIsa isa) {
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  if (isa == RayIsa::kAvx512 && !has_avx512) {
    throw InputError("isa", "avx512 is not supported by this machine, choose avx2");
  }
  if (isa == RayIsa::kAvx2 && !__builtin_cpu_supports("avx2")) {
    throw InputError("isa", "avx2 is not supported by this machine");
  }
}

void CheckMesh(const TriangleMesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  Require(std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                      [&](const auto& t) { return t[0] < count && t[1] < count && t[2] < count; }),
          "a triangle's indices lie within the mesh's vertices");
  // Embree silently drops triangles with invalid vertices.
  Require(std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                      [](const Eigen::Vector3f& v) { return v.allFinite(); }),
          "a mesh's vertices are finite");
}

void CheckDevice(RTCDevice device) {
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree could not build the ray scene (out of memory?)");
  }
}

template <typename RayHits>
void SetLane(RayHits& packet, int i, const Ray& ray) {
  packet.ray.org_x[i] = ray.origin.x();
  packet.ray.org_y[i] = ray.origin.y();
  packet.ray.org_z[i] = ray.origin.z();
  packet.ray.dir_x[i] = ray.direction.x();
  packet.ray.dir_y[i] = ray.direction.y();
  packet.ray.dir_z[i] = ray.direction.z();
  ResetLane(packet, i, ray.reach);
}

template <int kWidth>
void TracePackets(RTCScene scene, std::span<const Ray> rays, std::span<float> distances) {
  RTCIntersectContext context = CoherentContext();
  typename RayPacket<kWidth>::RayHits packet;
  alignas(64) int valid[kWidth];
  for (std::size_t first = 0; first < rays.size(); first += kWidth) {
    const std::size_t last = rays.size() - 1;
    for (int i = 0; i < kWidth; ++i) {
      const std::size_t index = first + static_cast<std::size_t>(i);
      const Ray& ray = rays[std::min(index, last)];
      valid[i] = index <= last ? -1 : 0;
      SetLane(packet, i, ray);
    }
    RayPacket<kWidth>::Intersect(valid, scene, &context, &packet);
    for (int i = 0; i < kWidth && first + static_cast<std::size_t>(i) <= last; ++i) {
      distances[first + static_cast<std::size_t>(i)] =
          packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity()
                                                          : packet.ray.tfar[i];
    }
  }
}

// The point of triangle abc nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3f ClosestPoint(const Eigen::Vector3f& p, const Eigen::Vector3f& a,
                             const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a, ac = c - a;
  const float d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const float d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const float d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const float denominator = va + vb + vc;
  return a + vb / denominator * ab + vc / denominator * ac;
}

// Embree callback: reduces the query's radius to the distance of a triangle; returns whether it
// changed.
bool ShrinkToTriangle(RTCPointQueryFunctionArguments* arguments) {
  const auto& scene = *static_cast<const RayScene::Impl*>(arguments->userPtr);
  const std::uint32_t* corners = scene.triangles + 3 * std::size_t{arguments->primID};
  const auto vertex = [&](int k) {
    return Eigen::Vector3f(scene.vertices + 3 * std::size_t{corners[k]});
  };
  RTCPointQuery& query = *arguments->query;
  const Eigen::Vector3f point(query.x, query.y, query.z);
  const float distance = (ClosestPoint(point, vertex(0), vertex(1), vertex(2)) - point).norm();
  if (!(distance < query.radius)) return false;
  query.radius = distance;
  return true;
}

}  // namespace

RayScene::Impl::Impl(const TriangleMesh& mesh, RayIsa chosen_isa, int build_threads)
    : isa(chosen_isa) {
  CheckMachine(isa);
  CheckMesh(mesh);
  device = rtcNewDevice(DeviceConfig(isa).c_str());
  if (device == nullptr) throw std::runtime_error("Embree could not start");
  scene = rtcNewScene(device);
  // Without ROBUST about one ray in a million passes through the edge between two triangles. With
  // it, HIGH quality would silently be built as MEDIUM.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  if (!mesh.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex_copy = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    auto* triangle_copy = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    CheckDevice(device);
    for (const auto& v : mesh.vertices) vertex_copy = std::copy_n(v.data(), 3, vertex_copy);
    for (const auto& t : mesh.triangles) triangle_copy = std::copy_n(t.data(), 3, triangle_copy);
    vertices = vertex_copy - 3 * mesh.vertices.size();
    triangles = triangle_copy - 3 * mesh.triangles.size();
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  tbb::task_arena(UsableThreads(build_threads)).execute([&] { rtcJoinCommitScene(scene); });
  CheckDevice(device);
}

RayScene::Impl::~Impl() {
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

RayScene::RayScene(const TriangleMesh& mesh, RayIsa isa, int build_threads)
    : impl_(std::make_shared<const Impl>(mesh, isa, build_threads)) {}

RayIsa RayScene::isa() const { return impl_->isa; }

std::optional<RayHit> RayScene::NearestHit(const Ray& ray) const {
  // A packet with one active ray, as Embree's single-ray kernels round differently.
  RTCIntersectContext context = CoherentContext();
  RayPacket<8>::RayHits packet;
  alignas(32) int valid[8] = {-1, 0, 0, 0, 0, 0, 0, 0};
  for (int i = 0; i < 8; ++i) SetLane(packet, i, ray);
  RayPacket<8>::Intersect(valid, impl_->scene, &context, &packet);
  if (packet.hit.geomID[0] == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return RayHit{packet.ray.tfar[0], packet.hit.primID[0]};
}

void RayScene::NearestHits(std::span<const Ray> rays, std::span<float> distances) const {
  Require(rays.size() == distances.size(), "one distance a ray");
  if (impl_->isa == RayIsa::kAvx512) {
    TracePackets<16>(impl_->scene, rays, distances);
  } else {
    TracePackets<8>(impl_->scene, rays, distances);
  }
}

bool RayScene::Occluded(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const Eigen::Vector3f way = to - from;
  RTCRay ray{};
  ray.org_x = from.x(), ray.org_y = from.y(), ray.org_z = from.z();
  ray.dir_x = way.x(), ray.dir_y = way.y(), ray.dir_z = way.z();
  ray.tfar = 1.0F;
  ray.mask = ~0U;
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0.0F;  // Embree's sign for "blocked"
}

float RayScene::DistanceToSurface(const Eigen::Vector3f& point_m, float limit_m) const {
  if (impl_->vertices == nullptr) return limit_m;
  RTCPointQuery query{point_m.x(), point_m.y(), point_m.z(), 0.0F, limit_m};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, ShrinkToTriangle, const_cast<Impl*>(impl_.get()));
  return query.radius;
}

}  // namespace depthgrid
