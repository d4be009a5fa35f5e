// Implementation of RayScene, included only by sim's .cc files to keep Embree out of public
// headers.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

#include "sim/depth/ray_scene.h"

namespace depthgrid {

struct RayScene::Impl {
  Impl(const TriangleMesh& mesh, RayIsa isa, int build_threads);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  RayIsa isa;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const float* vertices = nullptr;           // Embree's copy, x y z per vertex
  const std::uint32_t* triangles = nullptr;  // Embree's copy, three indices per triangle
};

// Embree's packets of 8 and 16 rays under one name.
template <int kWidth>
struct RayPacket;

template <>
struct RayPacket<8> {
  using RayHits = RTCRayHit8;
  static void Intersect(const int* valid, RTCScene scene, RTCIntersectContext* context,
                        RayHits* packet) {
    rtcIntersect8(valid, scene, context, packet);
  }
};

template <>
struct RayPacket<16> {
  using RayHits = RTCRayHit16;
  static void Intersect(const int* valid, RTCScene scene, RTCIntersectContext* context,
                        RayHits* packet) {
    rtcIntersect16(valid, scene, context, packet);
  }
};

inline RTCIntersectContext CoherentContext() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

// Resets lane `i` to a ray without a hit; the caller sets origin and direction.
template <typename RayHits>
void ResetLane(RayHits& packet, int i, float reach) {
  packet.ray.tnear[i] = 0.0F;
  packet.ray.time[i] = 0.0F;
  packet.ray.tfar[i] = reach;
  packet.ray.mask[i] = ~0U;
  packet.ray.id[i] = 0;
  packet.ray.flags[i] = 0;
  packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

}  // namespace depthgrid
