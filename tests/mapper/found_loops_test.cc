// Loops that the mapper finds itself, in the mapper.
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/loop_closing.h"
#include "mapper/surfel/surfel_map.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr PlanarLaser kSideLaser{
    .beams = 160, .field_of_view_rad = RadFromDeg(90), .sigma_of_range = 0.01};
constexpr int kWalkSteps = 220;
constexpr int kOpenSteps = 60;

// 35 m with cupboards on both sides.
PlanarWorld LongCorridor() {
  PlanarWorld world = RectangleWorld(-5, -1.5, 30, 1.5);
  bool left = true;
  for (const double x_m :
       {-2.0, 1.1, 2.9, 4.4, 7.0, 8.2, 10.5, 13.1, 14.2, 16.7, 19.0, 20.3, 23.0, 25.4}) {
    if (left) {
      AddRectangle(world, x_m, 0.9, x_m + 0.7, 1.5);
    } else {
      AddRectangle(world, x_m, -1.5, x_m + 0.5, -0.9);
    }
    left = !left;
  }
  return world;
}

Pose2 Along(int i) { return {0.1 * i, 0.1, 0.0}; }

// Along the corridor, around in the open, where nothing is seen, and along it again with poses that
// are off by what SLAM drifted meanwhile.
struct CorridorFrame {
  Pose2 truth;
  Pose2 slam_from_base;
  bool in_the_open = false;
};

std::vector<CorridorFrame> TwiceAlong(const Pose2& drift) {
  std::vector<CorridorFrame> frames;
  for (int i = 0; i < kWalkSteps; ++i) frames.push_back({Along(i), Along(i)});
  for (int i = 0; i < kOpenSteps; ++i) {
    const Pose2 pose{22.0 - 22.0 * i / kOpenSteps, -3.0 + 0.01 * i, 0.0};
    frames.push_back({pose, pose, true});
  }
  for (int i = 0; i < kWalkSteps; ++i) frames.push_back({Along(i), drift * Along(i)});
  return frames;
}

TEST(FoundLoops, BringTheMapTogether) {
  const PlanarWorld world = LongCorridor();
  const auto final_error_m = [&](LoopSearchUse use, int& accepted) {
    MapperOptions options;
    options.loops.search.use = use;
    options.loops.search.drift_share = 0.04;
    IncrementalMapper mapper(options, std::nullopt);
    const std::vector<CorridorFrame> frames = TwiceAlong({1.4, 0.2, 0.02});
    accepted = 0;
    for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
      const CorridorFrame& at = frames[static_cast<std::size_t>(i)];
      Frame frame;
      frame.index = i;
      frame.stamp_s = i / 10.0;
      frame.slam_from_camera = CameraOf(at.slam_from_base, 1.0);
      frame.scan =
          std::make_shared<const Scan>(ScanOf(at.in_the_open ? PlanarWorld() : world, at.truth,
                                              kSideLaser, 1, static_cast<std::uint32_t>(i)));
      const FrameReport report = mapper.AddFrame(frame);
      accepted += report.loops_accepted;
      EXPECT_EQ(report.loops_rejected, 0);
    }
    const MapperResult result = mapper.Finish();
    EXPECT_EQ(result.loops.empty(), accepted == 0);
    const Pose2 last = BaseOf(*result.map_from_camera.back());
    return Between(frames.back().truth, last).translation().norm();
  };
  int accepted = 0;
  EXPECT_GT(final_error_m(LoopSearchUse::kOff, accepted), 0.5);
  EXPECT_EQ(accepted, 0);
  EXPECT_LT(final_error_m(LoopSearchUse::kAuto, accepted), 0.1);
  EXPECT_GT(accepted, 0);
}

struct TwoWalks {
  std::vector<MappedFrame> frames;
  SurfelMap map{SurfelOptions()};
};

TwoWalks WalksOf(const PlanarWorld& world) {
  TwoWalks walks;
  for (int i = 0; i < 80; ++i) {
    const Pose2 pose = Along(i % 40);
    walks.frames.push_back(MappedFrameAt(world, kSideLaser, pose, pose, i));
    MappedFrame& frame = walks.frames.back();
    if (i > 0 && i != 40) frame.slam_motion = Pose2{0.1, 0.0, 0.0};
    walks.map.Insert(std::make_shared<const Scan>(*frame.scan), pose, Eigen::Matrix3d::Zero());
    if (i == 39) walks.map.BeginPart(PartPlace::kKnown);
  }
  return walks;
}

PlanarLoop LoopOff(const TwoWalks& walks, int first, const Pose2& off) {
  PlanarLoop loop;
  loop.first = first;
  loop.second = first + 40;
  const auto at = [&](int i) { return walks.frames[static_cast<std::size_t>(i)].map_from_base; };
  loop.first_from_second = Between(at(loop.first), at(loop.second)) * off;
  return loop;
}

// All of them or none: the search found them together. Those known before stay.
TEST(FoundLoops, AreKeptWhenTheMapHoldsTogetherWithThem) {
  TwoWalks walks = WalksOf(LongCorridor());
  LoopCloser closer{LoopOptions()};
  const LoopCloser::Outcome right =
      closer.Add({LoopOff(walks, 10, {}), LoopOff(walks, 20, {})}, walks.frames,
                 AdjustEffort::kCloseLoops, walks.map, {});
  EXPECT_TRUE(right.adjusted);
  EXPECT_EQ(right.accepted, 2);
  EXPECT_EQ(right.rejected, 0);
  ASSERT_EQ(closer.loops().size(), 2U);
  for (const PlanarLoop& loop : closer.loops()) EXPECT_FALSE(loop.on_trial);
  const LoopCloser::Outcome wrong =
      closer.Add({LoopOff(walks, 15, {}), LoopOff(walks, 25, {0.0, 0.6, 0.3})}, walks.frames,
                 AdjustEffort::kCloseLoops, walks.map, {});
  EXPECT_FALSE(wrong.adjusted);
  EXPECT_EQ(wrong.accepted, 0);
  EXPECT_EQ(wrong.rejected, 2);
  ASSERT_EQ(closer.loops().size(), 2U);
  EXPECT_EQ(closer.loops()[1].first, 20);
}

}  // namespace
}  // namespace depthgrid
