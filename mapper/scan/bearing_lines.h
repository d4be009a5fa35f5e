// Inverse of Eq. 2: for each bearing of the level scan, the image line whose rays have that
// bearing. The vertical plane through the camera at a bearing cuts the image in a straight line,
// whatever the tilt, and along it range and height are z times a linear function of the row. So a
// tilted image is read bearing by bearing, and no beam inside the field of view stays empty.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "mapper/core/camera.h"

namespace depthgrid {

// At row v of the line: column u0 + u1 v; horizontal range z (h0 + h1 v); height above the camera
// z (g0 + g1 v), z the depth there.
struct BearingLine {
  float u0 = 0.0F, u1 = 0.0F;
  float h0 = 0.0F, h1 = 0.0F;
  float g0 = 0.0F, g1 = 0.0F;
  // Rows at which the line is inside the image and ahead of the camera; first > last if none.
  int first_row = 0;
  int last_row = -1;
};

// Lines are stored in blocks of this size, as a structure of arrays for SIMD.
constexpr std::size_t kBlockBearings = 64;
struct alignas(64) BlockLane : std::array<float, kBlockBearings> {};
struct BearingLineBlock {
  BlockLane u0, u1, h0, h1, g0, g1, first_row, last_row;
};

class BearingLineTable {
 public:
  std::size_t size() const { return size_; }
  // Unused lanes repeat the last line.
  std::vector<BearingLineBlock> blocks;

  BearingLine operator[](std::size_t k) const;
  void Resize(std::size_t size) {
    size_ = size;
    blocks.resize((size + kBlockBearings - 1) / kBlockBearings);
  }

 private:
  std::size_t size_ = 0;
};

// Whether lines run along image rows rather than columns (roll beyond 45 degrees): such an image is
// transposed first.
bool LinesRunAlongRows(const PinholeCamera& camera, const Eigen::Quaterniond& level_from_camera);

struct Bearing {
  double angle_rad = 0.0;
  double cosine = 1.0;
  double sine = 0.0;
};

// Bearings of equal steps, kept from frame to frame: they rarely change.
struct BearingFan {
  double right_rad = 0.0;  // where the first bin begins
  double step_rad = 0.0;
  std::vector<Bearing> bearings;
};

// Bearings of `beams` bins of equal angle over the field of view the camera would have if it were
// level (rolled to the nearest quarter turn), increasing (counter-clockwise). Cached in `fan`.
const std::vector<Bearing>& ScanBearings(const PinholeCamera& camera,
                                         const Eigen::Quaterniond& level_from_camera, int beams,
                                         BearingFan& fan);

// `transposed`: rows and columns of the image are exchanged; `camera` is still the original one.
BearingLineTable BearingLines(const PinholeCamera& camera,
                              const Eigen::Quaterniond& level_from_camera,
                              const std::vector<Bearing>& bearings, bool transposed,
                              BearingLineTable memory = {});

namespace internal {
// The camera of the (possibly transposed) image: rows of the matrix are forward, left and up of a
// ray (a, b, 1), a along the image's columns and b along its rows.
struct ImageAxes {
  Eigen::Matrix3d level_from_ray;
  double fx_px, fy_px, cx_px, cy_px;
  int width_px, height_px;
};
struct BlockDirections {
  alignas(64) std::array<double, kBlockBearings> cosine, sine;
};
// Computes the lines of a block, one bearing per lane.
void FindLines(const ImageAxes& axes, const BlockDirections& directions, BearingLineBlock& lines);
}  // namespace internal

}  // namespace depthgrid
