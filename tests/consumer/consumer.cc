// Thirty lines of a robot: one ready scan in, a map out.
#include <cstdio>
#include <memory>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"

int main() {
  using namespace depthgrid;
  Scan scan;
  scan.max_range_m = 6.0;
  for (int i = -30; i <= 30; ++i) {
    const float bearing_rad = 0.01F * static_cast<float>(i);
    const float range_m = 2.02F / std::cos(bearing_rad);  // a wall ahead, within a column of cells
    scan.beams.push_back({bearing_rad, range_m, 0.0F, range_m, true});
  }
  IncrementalMapper mapper(MapperOptions{}, std::nullopt);
  for (int i = 0; i < 10; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<const Scan>(scan);
    frame.slam_from_camera = CameraOf(Pose2{}, 1.0);
    mapper.AddFrame(frame);
  }
  const OccupancyMap map = mapper.Finish().map;
  const float wall_prob = map.At(CellOf({2.01, 0.02}, map.geometry.resolution_m));
  std::printf("wall %.3f\n", static_cast<double>(wall_prob));
  return wall_prob > 0.5F ? 0 : 1;
}
