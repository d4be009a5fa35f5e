// Whether who carries the camera stands on a surface: the camera has moved over where it was seen.
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstddef>

namespace depthgrid {

// Cells of a quarter of a metre; places 32 m apart share one, as it is only asked for the last
// metres of a path.
class TroddenCells {
 public:
  void See(const Eigen::Vector2d& place_m) { seen_.set(CellAt(place_m)); }
  void Pass(const Eigen::Vector2d& camera_m) {
    if (IsSeen(camera_m)) passed_.set(CellAt(camera_m));
  }
  bool IsSeen(const Eigen::Vector2d& place_m) const { return seen_.test(CellAt(place_m)); }
  // The number of cells that were seen and then passed over.
  std::size_t Count() const { return passed_.count(); }

 private:
  static constexpr double kCellM = 0.25;
  static constexpr int kCells = 128;  // along a side
  static std::size_t CellAt(const Eigen::Vector2d& place_m);

  std::bitset<kCells * kCells> seen_, passed_;
};

}  // namespace depthgrid
