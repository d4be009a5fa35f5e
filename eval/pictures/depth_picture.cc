#include "eval/pictures/depth_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "eval/pictures/canvas.h"
#include "mapper/scan/depth_to_scan.h"

namespace depthgrid {
namespace {

constexpr Colour kInvalidPixel = {60, 60, 60};
constexpr Colour kHit = {255, 80, 60};
constexpr Colour kFree = {90, 230, 160};

// Stops of matplotlib's viridis (CC0), even in brightness; 0 is far.
constexpr std::array<Colour, 6> kDepthScale = {
    {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};

Colour DepthColour(double nearness) {
  const double position = std::clamp(nearness, 0.0, 1.0) * (kDepthScale.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kDepthScale.size() - 2);
  const double t = position - static_cast<double>(below);
  const auto mix = [t](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + t * (b - a)));
  };
  const Colour& a = kDepthScale[below];
  const Colour& b = kDepthScale[below + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

// Projects points given as forward, left and up from the camera, in level axes; empty for points
// behind it.
class LevelProjection {
 public:
  LevelProjection(const PinholeCamera& camera, const CameraStand& stand)
      : camera_(camera), camera_from_level_(stand.level_from_camera.conjugate()) {}

  std::optional<Eigen::Vector2d> PixelOf(const Eigen::Vector3d& point_in_level) const {
    constexpr double kNearestDepthM = 0.05;
    const Eigen::Vector3d point_in_camera = camera_from_level_ * point_in_level;
    if (point_in_camera.z() < kNearestDepthM) return std::nullopt;
    return Project(camera_, point_in_camera);
  }

 private:
  PinholeCamera camera_;
  Eigen::Quaterniond camera_from_level_;
};

// Drawn in short pieces, because part of the stretch may be behind the camera.
void DrawClearStretch(Canvas& canvas, const LevelProjection& projection, const Beam& beam,
                      double floor_below_camera_m) {
  constexpr int kPieces = 24;
  std::optional<Eigen::Vector2d> last;
  for (int i = 0; i <= kPieces; ++i) {
    const double range_m =
        beam.clear_from_m + (beam.clear_to_m - beam.clear_from_m) * (1.0 * i / kPieces);
    const auto pixel =
        projection.PixelOf({range_m * std::cos(beam.bearing_rad),
                            range_m * std::sin(beam.bearing_rad), -floor_below_camera_m});
    if (last && pixel) canvas.Line(*last, *pixel, 1.0, kFree);
    last = pixel;
  }
}

}  // namespace

RgbImage DepthPicture(const DepthImage& depth, double max_depth_m) {
  RgbImage picture(depth.width_px, depth.height_px);
  for (int v = 0; v < depth.height_px; ++v) {
    for (int u = 0; u < depth.width_px; ++u) {
      const float z_m = depth.At(u, v);
      const Colour colour =
          z_m > 0.0F ? DepthColour(1.0 - static_cast<double>(z_m) / max_depth_m) : kInvalidPixel;
      SetPixel(picture, u, v, colour);
    }
  }
  return picture;
}

RgbImage DepthPictureWithBeams(const DepthImage& depth, const PinholeCamera& camera,
                               const CameraStand& stand, const Scan& scan,
                               const ScanOptions& options) {
  constexpr std::size_t kClearStretchEvery = 16;  // beams; all of them would hide the picture
  Canvas canvas(DepthPicture(depth, options.max_range_m));
  const DepthToScan converter(camera, options);
  const LevelProjection projection(camera, stand);
  for (std::size_t i = kClearStretchEvery / 2; i < scan.beams.size(); i += kClearStretchEvery) {
    const Beam& beam = scan.beams[i];
    if (beam.clear_to_m > beam.clear_from_m) {
      DrawClearStretch(canvas, projection, beam, stand.height_m);
    }
  }
  const double dot_px = std::max(1.0, camera.width_px / 320.0);
  for (const Eigen::Vector2d& pixel : converter.HitPixels(depth, stand, scan)) {
    if (pixel.x() >= 0.0) canvas.Disc(pixel, dot_px, kHit);
  }
  return canvas.image();
}

}  // namespace depthgrid
