// The keys that every item of a scene file has, whatever its shape: material and place.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "mapper/core/options.h"
#include "sim/mesh/scene_limits.h"

namespace depthgrid {

constexpr Interval kCoordinate = {-kMaxSceneExtentM, kMaxSceneExtentM};
constexpr Interval kLength = {1e-4, kMaxSceneExtentM};  // a tenth of a millimetre: paper
constexpr Interval kFacets = {3, 512};                  // around something round

struct ItemOptions {
  std::string shape;
  std::string material;
  std::array<double, 3> at = {0, 0, 0};
  std::array<double, 3> rpy_deg = {0, 0, 0};
  double yaw_deg = 0.0;  // added to the third of rpy_deg
  double scale = 1.0;
  int count = 1;
  std::array<double, 3> step = {0, 0, 0};
  double step_yaw_deg = 0.0;

  void Visit(OptionsVisitor& v);
};

// An item's keys and its shape's in one reading, so that an unknown key is found among both.
template <typename Shape>
struct WithItem {
  ItemOptions item;
  Shape shape;
  void Visit(OptionsVisitor& v) {
    item.Visit(v);
    shape.Visit(v);
  }
};

// Where the copies of an item stand: parent_from_item for each of its `count` repetitions. Each
// further one is the one before, turned about the parent's z axis by step_yaw_deg and shifted by
// step.
std::vector<Eigen::Affine3d> PlacementsOf(const ItemOptions& item);

}  // namespace depthgrid
