// The shapes of a scene file: one struct a kind, with the keys it has there (docs/scenes.md).
#pragma once

#include <string>
#include <vector>

#include "mapper/io/config.h"
#include "sim/triangle_mesh.h"

namespace depthgrid {

// The keys every item has.
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

// Names for `shape:`, without "use" and "mesh", which need the file around them.
std::vector<std::string> ShapeNames();

// The shape in its own axes, all triangles of material 0, and the common keys as read. Throws
// InputError for anything wrong with the item.
struct BuiltItem {
  ItemOptions item;
  TriangleMesh mesh;
};
BuiltItem BuildShape(const std::string& shape, const Config& config);

// Where the copies of an item stand: parent_from_item for each of its `count` repetitions. Each
// further one is the one before, turned about the parent's z axis by step_yaw_deg and shifted by
// step.
std::vector<Eigen::Affine3d> PlacementsOf(const ItemOptions& item);

}  // namespace depthgrid
