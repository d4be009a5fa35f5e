#include "sim/depth/depth_camera.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"
#include "sim/depth/parallel_calls.h"
#include "sim/depth/ray_scene_impl.h"

namespace depthgrid {
namespace {

// A packet is a tile of pixels rather than part of a row, so that its rays traverse the same nodes:
// 4x2 for packets of 8, 4x4 for packets of 16.
constexpr int kTileWidth = 4;
constexpr int kMaxTileHeight = 4;
// How far a tile may reach beyond the image's last column or row.
constexpr int kTileOverhangPx = std::max(kTileWidth, kMaxTileHeight) - 1;

struct View {
  const PinholeCamera& camera;
  const float* tangent_x;
  const float* tangent_y;
  Eigen::Matrix3f world_from_camera;
  Eigen::Vector3f origin;
};

struct Output {
  float* z_m;
  float* incidence_cos;  // null when not wanted
};

// Directions have z = 1 in camera axes, so the hit parameter is the z-depth.
template <int kWidth>
void SetTile(const View& view, int u0, int v0, typename RayPacket<kWidth>::RayHits& packet) {
  const Eigen::Matrix3f& r = view.world_from_camera;
  for (int i = 0; i < kWidth; ++i) {
    const float x = view.tangent_x[u0 + i % kTileWidth];
    const float y = view.tangent_y[v0 + i / kTileWidth];
    packet.ray.dir_x[i] = r(0, 0) * x + (r(0, 1) * y + r(0, 2));
    packet.ray.dir_y[i] = r(1, 0) * x + (r(1, 1) * y + r(1, 2));
    packet.ray.dir_z[i] = r(2, 0) * x + (r(2, 1) * y + r(2, 2));
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
}

template <int kWidth>
void CosinesOf(const typename RayPacket<kWidth>::RayHits& packet, float* cosines) {
  for (int i = 0; i < kWidth; ++i) {
    const float dx = packet.ray.dir_x[i], dy = packet.ray.dir_y[i], dz = packet.ray.dir_z[i];
    const float nx = packet.hit.Ng_x[i], ny = packet.hit.Ng_y[i], nz = packet.hit.Ng_z[i];
    const float dot = dx * nx + dy * ny + dz * nz;
    const float squares = (dx * dx + dy * dy + dz * dz) * (nx * nx + ny * ny + nz * nz);
    const float cosine = std::min(std::abs(dot) / std::sqrt(squares), 1.0F);
    cosines[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? 0.0F : cosine;
  }
}

template <int kWidth>
void RenderTileRow(RTCScene scene, const View& view, int v0, const Output& output) {
  constexpr int kTileHeight = kWidth / kTileWidth;
  RTCIntersectContext context = CoherentContext();
  typename RayPacket<kWidth>::RayHits packet;
  alignas(64) int valid[kWidth];
  alignas(64) float depths[kWidth];
  alignas(64) float cosines[kWidth];
  for (int i = 0; i < kWidth; ++i) {
    packet.ray.org_x[i] = view.origin.x();
    packet.ray.org_y[i] = view.origin.y();
    packet.ray.org_z[i] = view.origin.z();
    ResetLane(packet, i, 0.0F);
    packet.hit.Ng_x[i] = packet.hit.Ng_y[i] = packet.hit.Ng_z[i] = 0.0F;
  }
  const int rows = std::min(kTileHeight, view.camera.height_px - v0);
  for (int u0 = 0; u0 < view.camera.width_px; u0 += kTileWidth) {
    const int columns = std::min(kTileWidth, view.camera.width_px - u0);
    for (int i = 0; i < kWidth; ++i) {
      valid[i] = i % kTileWidth < columns && i / kTileWidth < rows ? -1 : 0;
    }
    SetTile<kWidth>(view, u0, v0, packet);
    RayPacket<kWidth>::Intersect(valid, scene, &context, &packet);
    for (int i = 0; i < kWidth; ++i) {
      depths[i] =
          packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? kInvalidDepth : packet.ray.tfar[i];
    }
    if (output.incidence_cos != nullptr) CosinesOf<kWidth>(packet, cosines);
    for (int row = 0; row < rows; ++row) {
      const std::ptrdiff_t at = std::ptrdiff_t{v0 + row} * view.camera.width_px + u0;
      std::copy_n(depths + row * kTileWidth, columns, output.z_m + at);
      if (output.incidence_cos != nullptr) {
        std::copy_n(cosines + row * kTileWidth, columns, output.incidence_cos + at);
      }
    }
  }
}

template <int kWidth>
void RenderImage(RTCScene scene, const View& view, int threads, const Output& output) {
  constexpr int kTileHeight = kWidth / kTileWidth;
  const int tile_rows = (view.camera.height_px + kTileHeight - 1) / kTileHeight;
  CallInParallel(static_cast<std::size_t>(tile_rows), threads, [&](std::size_t tile_row) {
    RenderTileRow<kWidth>(scene, view, static_cast<int>(tile_row) * kTileHeight, output);
  });
}

// (k - centre) / focal for k in [0, size), padded so that the last tile reads defined values.
std::vector<float> Tangents(int size_px, double centre_px, double focal_px) {
  std::vector<float> tangents(static_cast<std::size_t>(size_px + kTileOverhangPx));
  for (std::size_t k = 0; k < tangents.size(); ++k) {
    tangents[k] = static_cast<float>((static_cast<double>(k) - centre_px) / focal_px);
  }
  return tangents;
}

PinholeCamera Checked(const PinholeCamera& camera) {
  Validate(camera, "sensor");
  if (camera.HasDistortion()) {
    throw InputError("sensor", "the rendered camera has no lens distortion, set it to zero");
  }
  return camera;
}

}  // namespace

DepthCamera::DepthCamera(RayScene scene, const PinholeCamera& camera, int threads)
    : scene_(std::move(scene)),
      camera_(Checked(camera)),
      threads_(threads),
      tangent_x_(Tangents(camera.width_px, camera.cx_px, camera.fx_px)),
      tangent_y_(Tangents(camera.height_px, camera.cy_px, camera.fy_px)) {
  Require(threads >= 1, "at least one rendering thread");
}

DepthImage DepthCamera::Render(const Pose3& world_from_camera) const {
  DepthImage depth(camera_.width_px, camera_.height_px);
  RenderInto(world_from_camera, depth, nullptr);
  return depth;
}

DepthFrame DepthCamera::RenderWithIncidence(const Pose3& world_from_camera) const {
  DepthFrame frame{DepthImage(camera_.width_px, camera_.height_px), {}};
  frame.incidence_cos.resize(frame.depth.z_m.size());
  RenderInto(world_from_camera, frame.depth, frame.incidence_cos.data());
  return frame;
}

void DepthCamera::RenderInto(const Pose3& world_from_camera, DepthImage& depth,
                             float* incidence_cos) const {
  const View view{camera_, tangent_x_.data(), tangent_y_.data(),
                  world_from_camera.rotation.toRotationMatrix().cast<float>(),
                  world_from_camera.translation.cast<float>()};
  const Output output{depth.z_m.data(), incidence_cos};
  RTCScene scene = scene_.impl().scene;
  if (scene_.isa() == RayIsa::kAvx512) {
    RenderImage<16>(scene, view, threads_, output);
  } else {
    RenderImage<8>(scene, view, threads_, output);
  }
}

}  // namespace depthgrid
