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
constexpr Interval kLength = {1e-4, kMaxSceneExtentM};  // from 0.1 mm, the thickness of paper
constexpr Interval kFacets = {3, 512};                  // of a full circle

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

// The keys of an item and of its shape read together, so that unknown keys are detected.
template <typename Shape>
struct WithItem {
  ItemOptions item;
  Shape shape;
  void Visit(OptionsVisitor& v) {
    item.Visit(v);
    shape.Visit(v);
  }
};

// parent_from_item of each of the `count` copies of an item. Each copy is the one before turned
// about the parent's z axis by step_yaw_deg and then shifted by step.
std::vector<Eigen::Affine3d> PlacementsOf(const ItemOptions& item);

}  // namespace depthgrid
