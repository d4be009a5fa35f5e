// Feeds the mapper frame by frame, as a live SLAM system would, while another thread draws the map.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"
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

// The map so far. Draws on, so that it takes no longer the longer the run.
class LiveMap {
 public:
  explicit LiveMap(const GridOptions& options) : options_(options), drawing_(options) {}

  // `mapped`: CurrentMapped(), a copy that the mapper's thread no longer touches. `corrected`:
  // whether any report since the last call had map_corrected.
  void Draw(const std::vector<MappedFrame>& mapped, bool corrected) {
    if (corrected) {
      drawing_ = MapDrawing(options_);
      drawn_ = 0;
    }
    for (; drawn_ < mapped.size(); ++drawn_) {
      const MappedFrame& frame = mapped[drawn_];
      drawing_.Add(frame.frame, *frame.obstacles, frame.map_from_base);
    }
    const OccupancyMap before = std::exchange(map_, drawing_.Map());
    changed_ = ChangedBetween(before, map_);
  }
  void Show() const {  // a real node would publish it, or what changed of it
    std::printf("%d x %d cells, %d x %d of them may have changed\n", map_.geometry.width_cells,
                map_.geometry.height_cells, changed_.width_cells, changed_.height_cells);
  }
  const OccupancyMap& map() const { return map_; }

 private:
  GridOptions options_;
  MapDrawing drawing_;
  std::size_t drawn_ = 0;  // of the mapped frames
  OccupancyMap map_;
  GridGeometry changed_;
};

bool IsReady(const std::future<void>& task) {
  return !task.valid() || task.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--help" || first == "-h") {
    std::printf("usage: live_mapper\n");
    return 0;
  }
  const MapperOptions options;  // the most accurate; mapper_options.h has them all
  IncrementalMapper mapper(options, std::nullopt);  // used by this thread only
  LiveMap live(options.grid);                       // by `drawing` while that runs
  std::future<void> drawing;
  bool corrected = false;
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
      corrected = corrected || report.map_corrected;
      if (!report.map_from_camera) continue;  // SLAM is lost
      const Pose2 map_from_base = BaseOf(*report.map_from_camera);
      if (i % 90 == 89) std::printf("at %.2f, %.2f m\n", map_from_base.x_m, map_from_base.y_m);
    } catch (const InputError& error) {  // what no mapper can use; the next frame may be sound
      std::fprintf(stderr, "left out: %s\n", error.what());
      continue;
    }
    // Once in a while, and not before the last drawing is done.
    if (i % 30 == 29 && IsReady(drawing)) {
      if (drawing.valid()) live.Show();
      drawing = std::async(std::launch::async, [&live, corrected, mapped = mapper.CurrentMapped()] {
        live.Draw(mapped, corrected);
      });
      corrected = false;
    }
  }
  if (drawing.valid()) drawing.get();
  live.Draw(mapper.CurrentMapped(), corrected);
  // The same as mapper.CurrentMap(), which draws all of it on the mapper's thread.
  const bool same = ChangedBetween(live.map(), mapper.CurrentMap()).size() == 0;
  const MapperResult result = mapper.Finish();  // everything adjusted once more
  const StateMap states = StatesOf(result.map);
  const auto walls = std::count(states.states.begin(), states.states.end(), CellState::kOccupied);
  std::printf("%d x %d cells, %d of them wall\n", states.geometry.width_cells,
              states.geometry.height_cells, static_cast<int>(walls));
  return same && walls > 300 ? 0 : 1;
}
