// Parts of the robot in the view of its depth camera: a gripper, a mast, the rim of a shield. They
// move with the robot, so they must neither be matched as static surfaces nor drawn along its path.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/io/body_rule.h"

namespace depthgrid {

// The pixels of a camera's images that show the robot, with what a warning says of them.
struct BodyMask {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> is_body;  // per pixel, in the order of DepthImage
  double share = 0.0;                 // of all pixels
  double depth_m = 0.0;               // median depth of the body
  int first_column = 0;               // bounding box
  int last_column = 0;
  int first_row = 0;
  int last_row = 0;

  // Sets the body's pixels to invalid. Images of another size are left unchanged.
  void Drop(DepthImage& image) const;
};

class BodyFinder {
 public:
  static constexpr std::size_t kMostViews = 24;

  // Adds an image; the camera must have turned by kBodyViewTurnDeg since the one before. Images of
  // another size than the first are ignored.
  void Add(const DepthImage& view);

  // A body pixel is nearer than 1 m, measured in at least half of the views, with half of its
  // depths within 3 cm or 5 % of one depth and hardly any (5 %) beyond it. Three pixels around are
  // added. Nothing static or moving in a room looks like this, except the floor in front of a
  // camera of constant height and tilt; so pixels are excluded that lie in one plane with such
  // constant pixels beyond 1 m or, for a camera near the floor, in a plane beyond which nothing
  // lies where it goes on (a robot's deck ends, and the floor is seen beyond it). Nothing is
  // returned with fewer than kFewestBodyViews views or for half the image or more.
  std::optional<BodyMask> Find() const;

 private:
  // The median of a pixel's depths and the shares of its depths that are near it or beyond it.
  struct Middle {
    double depth_m = 0.0;  // 0: rarely measured
    double near_share = 0.0;
    double beyond_share = 0.0;
  };
  Middle MiddleOf(std::size_t pixel) const;
  struct Seen {
    int column = 0;
    int row = 0;
    double depth_m = 0.0;
  };
  // Planes, as coefficients of inverse depth over (column, row, 1), of constant pixels beyond the
  // body's reach.
  std::vector<Eigen::Vector3d> LevelPlanes() const;
  // The planes of constant near pixels that can be a floor.
  std::vector<Eigen::Vector3d> FloorsAmong(const std::vector<Seen>& seen) const;
  bool IsFloor(const Eigen::Vector3d& plane, const std::vector<Seen>& seen) const;
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
