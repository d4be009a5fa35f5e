#include "sim/shapes/item_options.h"

#include "mapper/core/angle.h"

namespace depthgrid {

void ItemOptions::Visit(OptionsVisitor& v) {
  v.Text("shape", shape, "kind of shape");
  v.Text("material", material, "name of a material of this file");
  v.Tuple("at", at, kCoordinate, "where the shape's origin goes, metres");
  v.Tuple("rpy_deg", rpy_deg, {-360, 360}, "turn about x, then y, then z");
  v.Number("yaw_deg", yaw_deg, {-360, 360}, "turn about z, added to rpy_deg");
  v.Number("scale", scale, {1e-4, 1e4}, "size factor");
  v.Number("count", count, {1, 10000}, "how many, each a step further");
  v.Tuple("step", step, kCoordinate, "shift from one to the next, metres");
  v.Number("step_yaw_deg", step_yaw_deg, {-360, 360}, "turn from one to the next");
}

std::vector<Eigen::Affine3d> PlacementsOf(const ItemOptions& item) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();
  placement.translate(Vector3d(item.at[0], item.at[1], item.at[2]));
  placement.rotate(AngleAxisd(RadFromDeg(item.rpy_deg[2] + item.yaw_deg), Vector3d::UnitZ()) *
                   AngleAxisd(RadFromDeg(item.rpy_deg[1]), Vector3d::UnitY()) *
                   AngleAxisd(RadFromDeg(item.rpy_deg[0]), Vector3d::UnitX()));
  placement.scale(item.scale);
  Eigen::Affine3d step = Eigen::Affine3d::Identity();
  step.translate(Vector3d(item.step[0], item.step[1], item.step[2]));
  step.rotate(AngleAxisd(RadFromDeg(item.step_yaw_deg), Vector3d::UnitZ()));
  std::vector<Eigen::Affine3d> placements;
  for (int i = 0; i < item.count; ++i) {
    placements.push_back(placement);
    placement = step * placement;
  }
  return placements;
}

}  // namespace depthgrid
