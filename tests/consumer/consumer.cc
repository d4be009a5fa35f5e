// Some lines of a robot: it turns in a square room and drives a little, ready scans in, a map out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"

using namespace depthgrid;

namespace {

constexpr double kHalfRoomM = 2.02;  // within a column of cells

double ToWalls(const Pose2& room_from_laser, double bearing_rad) {
  const double x = std::cos(room_from_laser.yaw_rad + bearing_rad);
  const double y = std::sin(room_from_laser.yaw_rad + bearing_rad);
  const double to_x = (kHalfRoomM - std::copysign(1.0, x) * room_from_laser.x_m) / std::abs(x);
  const double to_y = (kHalfRoomM - std::copysign(1.0, y) * room_from_laser.y_m) / std::abs(y);
  return std::min(to_x, to_y);
}

Scan ScanAt(const Pose2& room_from_laser) {
  Scan scan;
  scan.max_range_m = 6.0;
  for (int i = -60; i <= 60; ++i) {
    const double bearing_rad = 0.01 * i;
    const auto range_m = static_cast<float>(ToWalls(room_from_laser, bearing_rad));
    scan.beams.push_back({static_cast<float>(bearing_rad), range_m, 0.0F, range_m, true});
  }
  return scan;
}

}  // namespace

// Prints the wall's probability and, to the last bit, the poses: compiled otherwise, they are the
// same.
int main() {
  IncrementalMapper mapper(MapperOptions{}, std::nullopt);
  Pose2 room_from_laser;
  Pose2 odom_from_laser;
  for (int i = 0; i < 60; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<const Scan>(ScanAt(room_from_laser));
    frame.slam_from_camera = CameraOf(odom_from_laser, 1.0);
    mapper.AddFrame(frame);
    room_from_laser = room_from_laser * Pose2{0.01, 0.001, 0.03};
    odom_from_laser = odom_from_laser * Pose2{0.0102, 0.001, 0.0301};
  }
  const MapperResult result = mapper.Finish();
  const float wall_prob = result.map.At(CellOf({2.01, 0.02}, result.map.geometry.resolution_m));
  std::printf("wall %.3f\n", static_cast<double>(wall_prob));
  for (const auto& map_from_camera : result.map_from_camera) {
    const Pose2 pose = BaseOf(*map_from_camera);
    std::printf("%a %a %a\n", pose.x_m, pose.y_m, pose.yaw_rad);
  }
  return wall_prob > 0.5F ? 0 : 1;
}
