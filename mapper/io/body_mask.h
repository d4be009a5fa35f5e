// Parts of the robot that its depth camera sees: a gripper, a mast, the rim of a shield. They go
// with it wherever it goes, would be matched as what stands still, and drawn along its way.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/io/body_rule.h"

namespace depthgrid {

// Which pixels of a camera's images show the robot, and how it looks to say so.
struct BodyMask {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> is_body;  // by pixel, as of DepthImage
  double share = 0.0;                 // of all pixels
  double depth_m = 0.0;               // the median of what it shows there
  int first_column = 0;               // the box around it
  int last_column = 0;
  int first_row = 0;
  int last_row = 0;

  // Makes "no measurement" of its pixels. Images of another size stay as they are.
  void Drop(DepthImage& image) const;
};

class BodyFinder {
 public:
  static constexpr std::size_t kMostViews = 24;

  // An image since whose forerunner the camera had turned by kBodyViewTurnDeg. Those of another
  // size than the first are not looked at.
  void Add(const DepthImage& view);

  // Pixels nearer than 1 m behind which hardly anything (5 % of what was measured) was seen, while
  // half of it is within 3 cm or 5 % of one depth, in half of the views at least; and three pixels
  // around. Nothing that stands in a room, walks ahead or is carried past stays like that; what
  // does is the floor before a camera that is always as high and as steep, so what lies in one
  // plane with such pixels beyond 1 m is none of it. Nothing of fewer than kFewestBodyViews, nor of
  // half the image or more.
  std::optional<BodyMask> Find() const;

 private:
  // Of a pixel's depths, and the shares of those measured that are near it or beyond.
  struct Middle {
    double depth_m = 0.0;  // 0: hardly ever measured
    double near_share = 0.0;
    double beyond_share = 0.0;
  };
  Middle MiddleOf(std::size_t pixel) const;
  struct Seen {
    int column = 0;
    int row = 0;
    double depth_m = 0.0;
  };
  // Inverse depth over (column, row, 1) of what stays beyond the body's reach.
  std::vector<Eigen::Vector3d> LevelPlanes() const;
  BodyMask MaskOf(std::vector<Seen> seen) const;
  std::size_t PixelAt(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px_) +
           static_cast<std::size_t>(column);
  }

  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::vector<std::uint16_t>> views_mm_;  // 0: not measured
};

}  // namespace depthgrid
