// What a frame's report tells of corrections of what was mapped before it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kCorrectedFrames = 330;  // a round of 300, and a little more
constexpr int kCorrectingLoop = 310;

// Round a furnished room with SLAM that drifts, and a loop.
Frame DriftingFrame(int i) {
  static const PlanarWorld room = FurnishedRoom();
  const auto truth = [](int frame) {
    const double angle_rad = 2.0 * kPi * frame / 300;
    return Pose2{3.0 + 0.7 * std::cos(angle_rad), 1.6 + 0.7 * std::sin(angle_rad),
                 WrapAngle(angle_rad + 0.5 * kPi)};
  };
  Frame frame;
  frame.index = i;
  frame.stamp_s = i / 30.0;
  frame.slam_from_camera = CameraOf(Pose2{0.0008 * i, 0.0004 * i, 0.0003 * i} * truth(i), 1.0);
  frame.scan = std::make_shared<const Scan>(ScanOf(
      room, truth(i), {.beams = 160, .sigma_of_range = 0.005}, 3, static_cast<std::uint32_t>(i)));
  if (i == kCorrectingLoop) {
    LoopClosure loop;
    loop.reported_at_frame = loop.second_frame = i;
    loop.first_frame = 5;
    loop.first_from_second = Between(CameraOf(truth(5), 1.0), CameraOf(truth(i), 1.0));
    frame.loops.push_back(loop);
  }
  return frame;
}

// A map that is drawn on with every frame, and again only where the report says so; what that says
// is compared with the poses of the frames mapped before.
class LiveDrawing {
 public:
  explicit LiveDrawing(const MapperOptions& options)
      : options_(options), mapper_(options, std::nullopt), drawing_(options.grid) {}

  void Add(const Frame& frame) {
    const FrameReport report = mapper_.AddFrame(frame);
    if (report.map_corrected) corrected_at.insert(frame.index);
    const std::vector<MappedFrame> now = mapper_.CurrentMapped();
    double moved_m = 0.0, turned_rad = 0.0;
    for (std::size_t i = 0; i < before_.size(); ++i) {
      ASSERT_EQ(now[i].frame, before_[i].frame);
      const Pose2& was = before_[i].map_from_base;
      const Pose2& is = now[i].map_from_base;
      moved_m = std::max(moved_m, (is.translation() - was.translation()).norm());
      turned_rad = std::max(turned_rad, std::abs(WrapAngle(is.yaw_rad - was.yaw_rad)));
    }
    most_moved_m = std::max(most_moved_m, moved_m);
    const bool moved = moved_m > 0.0 || turned_rad > 0.0;
    EXPECT_TRUE(!moved || report.map_corrected) << frame.index;
    EXPECT_EQ(moved, report.map_moved_m > 0.0 || report.map_turned_rad > 0.0) << frame.index;
    // A bound where a frame moves them more than once.
    EXPECT_GE(report.map_moved_m, moved_m - 1e-12) << frame.index;
    EXPECT_LE(report.map_moved_m, 2.5 * moved_m) << frame.index;
    EXPECT_GE(report.map_turned_rad, turned_rad - 1e-12) << frame.index;
    Draw(now, report.map_corrected);
    before_ = now;
    if (report.map_from_camera) {
      const Pose2 carried = report.map_from_slam * BaseOf(*report.slam_from_camera);
      const Pose2 current = BaseOf(*mapper_.CurrentPoses().back());
      EXPECT_LT(Separation(carried, current), 1e-9) << frame.index;
    }
  }
  void ExpectIsTheMap() const {
    const OccupancyMap drawn = drawing_.Map(), whole = mapper_.CurrentMap();
    EXPECT_EQ(drawn.geometry, whole.geometry);
    EXPECT_EQ(ChangedBetween(drawn, whole).size(), 0U);
  }

  std::set<int> corrected_at;
  double most_moved_m = 0.0;

 private:
  void Draw(const std::vector<MappedFrame>& mapped, bool again) {
    if (again) {
      drawing_ = MapDrawing(options_.grid);
      drawn_ = 0;
    }
    for (; drawn_ < mapped.size(); ++drawn_) {
      const MappedFrame& frame = mapped[drawn_];
      drawing_.Add(frame.frame, *frame.obstacles, frame.map_from_base);
    }
  }

  MapperOptions options_;
  IncrementalMapper mapper_;
  MapDrawing drawing_;
  std::size_t drawn_ = 0;
  std::vector<MappedFrame> before_;
};

TEST(MapCorrected, TellsWhatMovedWithEveryMethod) {
  for (const MapperMethod method : {MapperMethod::kSurfel, MapperMethod::kPaper}) {
    MapperOptions options;
    options.method = method;
    options.fusion.mode = FusionMode::kLearned;
    if (method == MapperMethod::kPaper) options.fusion.mode = FusionMode::kKalman;
    options.keep.first_frames = 200;  // the later ones are tied, but where something is new
    LiveDrawing live(options);
    for (int i = 0; i < kCorrectedFrames; ++i) {
      live.Add(DriftingFrame(i));
      if (i % 30 == 29) live.ExpectIsTheMap();
    }
    live.ExpectIsTheMap();
    const bool surfel = method == MapperMethod::kSurfel;
    EXPECT_EQ(live.corrected_at.count(kCorrectingLoop), 1U);
    EXPECT_EQ(live.corrected_at.count(60), surfel ? 1U : 0U);  // a round
    EXPECT_GT(live.most_moved_m, 1e-4);
    EXPECT_LE(live.corrected_at.size(), 4U);
  }
}

TEST(MapCorrected, SlamTrustedAloneIsNeverCorrectedOnTheWay) {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  options.fusion.gain = {0.0, 0.0, 0.0};
  LiveDrawing live(options);
  for (int i = 0; i < 100; ++i) live.Add(DriftingFrame(i));
  live.ExpectIsTheMap();
  EXPECT_TRUE(live.corrected_at.empty());
}

// Somebody walks on ahead from the first frame on: they are drawn, then taken out.
TEST(MapCorrected, WhatIsTakenOutIsTold) {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  LiveDrawing live(options);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose{0.02 * i, 0.0, 0.0};
    PlanarWorld world = RectangleWorld(-1.0, -2.5, 5.0, 2.5);
    AddRectangle(world, pose.x_m + 1.0, 0.4, pose.x_m + 1.4, 1.0);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<const Scan>(ScanOf(
        world, pose, {.beams = 320, .sigma_of_range = 0.01}, 3, static_cast<std::uint32_t>(i)));
    frame.slam_from_camera = CameraOf(Pose2{1.05 * pose.x_m, 0.0, 0.0}, 1.0);
    live.Add(frame);
    live.ExpectIsTheMap();
  }
  // Before the round after 60 frames.
  EXPECT_LT(*live.corrected_at.begin(), 60);
}

TEST(ChangedCells, AreWithinTheSmallestRectangle) {
  OccupancyMap before(GridGeometry{0.1, {-2, 3}, 4, 3});
  OccupancyMap after(GridGeometry{0.1, {-3, 3}, 6, 3});
  EXPECT_EQ(ChangedBetween(before, after).size(), 0U);  // none is known in either
  EXPECT_EQ(ChangedBetween({}, {}).size(), 0U);
  const auto set = [](OccupancyMap& map, const Cell& cell, float prob) {
    map.occupied_prob[map.geometry.Index(cell)] = prob;
  };
  set(before, {-1, 4}, 0.5F);
  set(after, {-1, 4}, 0.5F);
  EXPECT_EQ(ChangedBetween(before, after).size(), 0U);
  set(after, {2, 5}, 0.9F);   // outside of the first one
  set(before, {0, 4}, 0.1F);  // unknown in the second one
  const GridGeometry changed{0.1, {0, 4}, 3, 2};
  EXPECT_EQ(ChangedBetween(before, after), changed);
  EXPECT_EQ(ChangedBetween(after, before), changed);
  EXPECT_EQ(ChangedBetween({}, after), (GridGeometry{0.1, {-1, 4}, 4, 2}));
}

}  // namespace
}  // namespace depthgrid
