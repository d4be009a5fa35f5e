// Feeds the mapper frame by frame, as a live SLAM system would, and keeps the map.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"

using namespace depthgrid;

// What a level camera at `base` sees of a square room of 5 x 5 m around the origin. A real system
// gives frame.depth instead, and its camera to the mapper.
Scan Look(const Pose2& base) {
  Scan scan{.beams = {}, .max_range_m = 6.0};
  for (int i = -160; i < 160; ++i) {
    const double bearing = i * RadFromDeg(0.2);
    const double x = std::cos(base.yaw_rad + bearing), y = std::sin(base.yaw_rad + bearing);
    const double to_x = (std::copysign(2.5, x) - base.x_m) / x;
    const double to_y = (std::copysign(2.5, y) - base.y_m) / y;
    const auto range = static_cast<float>(std::min(to_x, to_y));
    scan.beams.push_back({static_cast<float>(bearing), range, 0.4F, range, true});
  }
  return scan;
}

void Show(const OccupancyMap& map) {  // a real node would publish it
  const StateMap states = StatesOf(map);
  const auto walls = std::count(states.states.begin(), states.states.end(), CellState::kOccupied);
  std::printf("%d x %d cells, %d of them wall\n", map.geometry.width_cells,
              map.geometry.height_cells, static_cast<int>(walls));
}

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--help" || first == "-h") {
    std::printf("usage: live_mapper\n");
    return 0;
  }
  const MapperOptions options;  // the most accurate; mapper_options.h has them all
  IncrementalMapper mapper(options, std::nullopt);
  for (int i = 0; i < 300; ++i) {  // a turn on the spot, 30 frames a second
    const Pose2 base{0.3, -0.2, WrapAngle(RadFromDeg(1.2) * i)};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    // SLAM's pose; empty while it is lost. A camera's goes in as it is; CameraOf() makes one of a
    // planar pose, BaseOf() a planar one of the report's.
    frame.slam_from_camera = CameraOf(base);
    frame.slam_epoch = 0;  // counts SLAM's corrections of itself
    frame.scan = std::make_shared<Scan>(Look(base));
    try {
      const FrameReport report = mapper.AddFrame(frame);  // the pose to navigate by, at once
      if (!report.map_from_camera) continue;              // SLAM is lost
      const Pose2 map_from_base = BaseOf(*report.map_from_camera);
      if (i % 90 == 89) std::printf("at %.2f, %.2f m: ", map_from_base.x_m, map_from_base.y_m);
    } catch (const InputError& error) {  // what no mapper can use; the next frame may be sound
      std::fprintf(stderr, "left out: %s\n", error.what());
      continue;
    }
    // All of the map is drawn for it: once in a while, not after each frame.
    if (i % 90 == 89) Show(mapper.CurrentMap());
  }
  const MapperResult result = mapper.Finish();  // everything adjusted once more
  Show(result.map);
  const StateMap states = StatesOf(result.map);
  return std::count(states.states.begin(), states.states.end(), CellState::kOccupied) > 300 ? 0 : 1;
}
