// A mesh prepared for ray queries (Embree 3). Immutable and cheap to copy (copies share the tree);
// queries are thread-safe.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "sim/depth/ray_isa.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

struct RayHit {
  float distance = 0.0F;       // in lengths of the ray's direction
  std::uint32_t triangle = 0;  // index into the mesh's triangles
};

// From `origin` along `direction` (any length) up to `direction * reach`.
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();
  float reach = std::numeric_limits<float>::infinity();
};

class RayScene {
 public:
  explicit RayScene(const TriangleMesh& mesh, RayIsa isa = RayIsa::kAvx2, int build_threads = 1);

  // The nearest surface along the ray; both sides of a triangle count.
  std::optional<RayHit> NearestHit(const Ray& ray) const;
  // The same for many rays: distance of each, infinity where nothing is hit. Neighbouring rays
  // should be alike (they are traced in packets); the result does not depend on it.
  void NearestHits(std::span<const Ray> rays, std::span<float> distances) const;
  // Whether a surface lies between the two points.
  bool Occluded(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;
  // Distance from a point to the nearest surface, or `limit_m` when none is nearer.
  float DistanceToSurface(const Eigen::Vector3f& point_m, float limit_m) const;

  RayIsa isa() const;

  struct Impl;  // sim/depth/ray_scene_impl.h
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace depthgrid
