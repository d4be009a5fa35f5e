#include "mapper/io/body_mask.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "mapper/core/median.h"
#include "mapper/io/body_rule.h"

namespace depthgrid {
namespace {

// Objects may appear in front of the body, but nothing behind it except bad measurements.
constexpr double kLastingShare = 0.5;
constexpr double kBeyondShare = 0.05;
constexpr double kMeasuredShare = 0.5;
constexpr double kMostOfImage = 0.5;
// Fewer lone pixels are noise.
constexpr double kLeastOfImage = 5e-4;
// Pixels at an edge mix both sides.
constexpr int kEdgePx = 3;

constexpr double kMostFloorM = 4.0;
// Number of columns sampled for it, and rows with the same spacing.
constexpr int kFloorColumns = 160;
constexpr std::size_t kLeastFloorPixels = 100;
constexpr double kOnFloorShare = 0.07;
// A plane is fitted again and again to what is this near to the one before, as a share of inverse
// depth, so that a part of the robot among the pixels does not tilt it.
constexpr std::array<double, 5> kFitShares = {1.0, 0.2, 0.12, kOnFloorShare, kOnFloorShare};
// What is known of a floor in front of a low camera: nothing lies beyond it where it would be this
// near, unless by so much in depth and in so few views as noise and wobble explain.
constexpr double kMostLowFloorM = 2.0;
constexpr double kBeyondFloor = 1.15;
// Of those samples, not taken for the body itself: 3 to 8 % with cameras .08 to .15 m high.
constexpr double kLeastOutsideShare = 0.01;

constexpr double kMmPerM = 1000.0;
constexpr double kFarMm = 65535.0;  // farther depths are clamped to this

// A pixel's position and inverse depth, which is linear in the position on a plane.
struct InversePixel {
  Eigen::Vector3d place;  // (column, row, 1)
  double inverse = 0.0;
};

// `plane` is inverse depth over (column, row, 1).
bool IsOn(const Eigen::Vector3d& plane, const Eigen::Vector3d& place, double inverse_depth,
          double share = kOnFloorShare) {
  return std::abs(plane.dot(place) - inverse_depth) < share * inverse_depth;
}

Eigen::Vector3d PlaceOf(int column, int row) {
  return {static_cast<double>(column), static_cast<double>(row), 1.0};
}

// Repeated least-squares fit, at first to all pixels; nothing with too few.
std::optional<Eigen::Vector3d> PlaneOf(const std::vector<InversePixel>& pixels) {
  std::optional<Eigen::Vector3d> plane;
  for (const double share : kFitShares) {  // the first has no plane before it
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    for (const InversePixel& pixel : pixels) {
      if (plane && !IsOn(*plane, pixel.place, pixel.inverse, share)) continue;
      h += pixel.place * pixel.place.transpose();
      g += pixel.inverse * pixel.place;
      ++count;
    }
    if (count < kLeastFloorPixels) return {};
    plane = h.ldlt().solve(g);
  }
  return plane;
}

// The pixels of the image's upper and of its lower half: the floor may be above in the image.
using Halves = std::array<std::vector<InversePixel>, 2>;

std::vector<Eigen::Vector3d> PlanesOf(const Halves& halves) {
  std::vector<Eigen::Vector3d> planes;
  for (const std::vector<InversePixel>& half : halves) {
    if (const auto plane = PlaneOf(half)) planes.push_back(*plane);
  }
  return planes;
}

}  // namespace

void BodyMask::Drop(DepthImage& image) const {
  if (image.width_px != width_px || image.height_px != height_px) return;
  for (std::size_t i = 0; i < is_body.size(); ++i) {
    if (is_body[i] != 0) image.z_m[i] = kInvalidDepth;
  }
}

void BodyFinder::Add(const DepthImage& view) {
  if (views_mm_.size() >= kMostViews) return;
  if (views_mm_.empty()) {
    width_px_ = view.width_px;
    height_px_ = view.height_px;
  }
  if (view.width_px != width_px_ || view.height_px != height_px_) return;
  std::vector<std::uint16_t>& depths = views_mm_.emplace_back(view.z_m.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double mm = std::round(kMmPerM * static_cast<double>(view.z_m[i]));
    if (mm > 0.0) depths[i] = static_cast<std::uint16_t>(std::min(mm, kFarMm));
  }
}

BodyFinder::Middle BodyFinder::MiddleOf(std::size_t pixel) const {
  std::array<std::uint16_t, kMostViews> depths;
  std::size_t count = 0;
  for (const std::vector<std::uint16_t>& view : views_mm_) {
    if (view[pixel] > 0) depths[count++] = view[pixel];
  }
  if (static_cast<double>(count) < kMeasuredShare * static_cast<double>(views_mm_.size())) {
    return {};
  }
  const std::span<std::uint16_t> measured(depths.data(), count);
  const double depth_m = UpperMedianAmong(measured) / kMmPerM;
  double near = 0.0, beyond = 0.0;
  for (const std::uint16_t mm : measured) {
    const double off_m = mm / kMmPerM - depth_m;
    near += std::abs(off_m) < BodyBandM(depth_m) ? 1.0 : 0.0;
    beyond += off_m >= BodyBandM(depth_m) ? 1.0 : 0.0;
  }
  const auto all = static_cast<double>(count);
  return {depth_m, near / all, beyond / all};
}

std::vector<Eigen::Vector3d> BodyFinder::LevelPlanes() const {
  Halves halves;
  const int step_px = std::max(1, width_px_ / kFloorColumns);
  for (int v = 0; v < height_px_; v += step_px) {
    for (int u = 0; u < width_px_; u += step_px) {
      const Middle middle = MiddleOf(PixelAt(u, v));
      if (middle.depth_m < kMostBodyM || middle.depth_m > kMostFloorM) continue;
      if (middle.near_share < kLastingShare) continue;
      halves[2 * v < height_px_ ? 0 : 1].push_back({PlaceOf(u, v), 1.0 / middle.depth_m});
    }
  }
  return PlanesOf(halves);
}

bool BodyFinder::IsFloor(const Eigen::Vector3d& plane, const std::vector<Seen>& seen) const {
  std::vector<bool> is_seen(views_mm_[0].size());
  for (const Seen& pixel : seen) is_seen[PixelAt(pixel.column, pixel.row)] = true;
  const int step_px = std::max(1, width_px_ / kFloorColumns);
  std::size_t all = 0, outside = 0, beyond = 0;
  for (int v = 0; v < height_px_; v += step_px) {
    for (int u = 0; u < width_px_; u += step_px) {
      const double inverse = plane.dot(PlaceOf(u, v));
      if (inverse * kMostLowFloorM < 1.0) continue;
      const std::size_t pixel = PixelAt(u, v);
      for (const std::vector<std::uint16_t>& view : views_mm_) {
        if (view[pixel] == 0) continue;
        ++all;
        outside += is_seen[pixel] ? 0 : 1;
        beyond += view[pixel] / kMmPerM * inverse > kBeyondFloor ? 1 : 0;
      }
    }
  }
  return static_cast<double>(outside) >= kLeastOutsideShare * static_cast<double>(all) &&
         static_cast<double>(beyond) <= kBeyondShare * static_cast<double>(outside);
}

std::vector<Eigen::Vector3d> BodyFinder::FloorsAmong(const std::vector<Seen>& seen) const {
  Halves halves;
  for (const Seen& pixel : seen) {
    halves[2 * pixel.row < height_px_ ? 0 : 1].push_back(
        {PlaceOf(pixel.column, pixel.row), 1.0 / pixel.depth_m});
  }
  std::vector<Eigen::Vector3d> planes = PlanesOf(halves);
  std::erase_if(planes, [&](const Eigen::Vector3d& plane) { return !IsFloor(plane, seen); });
  return planes;
}

std::optional<BodyMask> BodyFinder::Find() const {
  if (views_mm_.size() < kFewestBodyViews) return {};
  std::vector<Seen> seen;
  for (int v = 0; v < height_px_; ++v) {
    for (int u = 0; u < width_px_; ++u) {
      const Middle middle = MiddleOf(PixelAt(u, v));
      if (middle.depth_m <= 0.0 || middle.depth_m >= kMostBodyM) continue;
      if (middle.near_share < kLastingShare || middle.beyond_share > kBeyondShare) continue;
      seen.push_back({u, v, middle.depth_m});
    }
  }
  if (seen.empty()) return {};
  std::vector<Eigen::Vector3d> floors = LevelPlanes();
  for (const Eigen::Vector3d& plane : FloorsAmong(seen)) floors.push_back(plane);
  for (const Eigen::Vector3d& plane : floors) {
    std::erase_if(seen, [&](const Seen& pixel) {
      return IsOn(plane, PlaceOf(pixel.column, pixel.row), 1.0 / pixel.depth_m);
    });
  }
  const double pixels = static_cast<double>(width_px_) * height_px_;
  const double share = static_cast<double>(seen.size()) / pixels;
  if (share < kLeastOfImage || share >= kMostOfImage) return {};
  return MaskOf(std::move(seen));
}

BodyMask BodyFinder::MaskOf(std::vector<Seen> seen) const {
  BodyMask mask;
  mask.width_px = mask.first_column = width_px_;
  mask.height_px = mask.first_row = height_px_;
  mask.is_body.assign(views_mm_[0].size(), 0);
  for (const Seen& pixel : seen) {
    mask.first_column = std::min(mask.first_column, pixel.column);
    mask.last_column = std::max(mask.last_column, pixel.column);
    mask.first_row = std::min(mask.first_row, pixel.row);
    mask.last_row = std::max(mask.last_row, pixel.row);
    const int right = std::min(pixel.column + kEdgePx, width_px_ - 1);
    const int below = std::min(pixel.row + kEdgePx, height_px_ - 1);
    for (int v = std::max(pixel.row - kEdgePx, 0); v <= below; ++v) {
      for (int u = std::max(pixel.column - kEdgePx, 0); u <= right; ++u) {
        mask.is_body[PixelAt(u, v)] = 1;
      }
    }
  }
  const auto count = std::count(mask.is_body.begin(), mask.is_body.end(), std::uint8_t{1});
  mask.share = static_cast<double>(count) / static_cast<double>(mask.is_body.size());
  mask.depth_m = UpperMedianAmong(std::span(seen), [](const Seen& pixel) { return pixel.depth_m; });
  return mask;
}

}  // namespace depthgrid
