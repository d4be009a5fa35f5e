// The first frames gone through again, once the first adjustment tells how SLAM errs.
#include "mapper/beginning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

TEST(Beginning, HoldsFramesAndScansWithoutWhatTheSensorGave) {
  Beginning beginning(true);
  Frame frame;
  frame.index = 7;
  frame.depth = std::make_shared<DepthImage>();
  frame.scan = frame.matched_scan = std::make_shared<Scan>();
  const auto scan = std::make_shared<const Scan>();
  beginning.Add(frame, {.obstacles = scan, .matched = scan});
  ASSERT_EQ(beginning.frames().size(), 1U);
  const Beginning::Seen& seen = beginning.frames()[0];
  EXPECT_EQ(seen.frame.index, 7);
  EXPECT_EQ(seen.frame.depth, nullptr);
  EXPECT_EQ(seen.frame.scan, nullptr);
  EXPECT_EQ(seen.frame.matched_scan, nullptr);
  EXPECT_EQ(seen.scans.matched, scan);
}

TEST(Beginning, IsOverAfter300Frames) {
  Beginning beginning(true);
  for (int i = 0; i < 300; ++i) beginning.Add({}, {});
  EXPECT_TRUE(beginning.lasts());
  EXPECT_EQ(beginning.frames().size(), 300U);
  beginning.Add({}, {});
  EXPECT_FALSE(beginning.lasts());
  EXPECT_TRUE(beginning.frames().empty());
  beginning.Add({}, {});
  EXPECT_TRUE(beginning.frames().empty());
}

TEST(Beginning, NothingIsHeldThatNobodyWants) {
  Beginning beginning(false);
  beginning.Add({}, {});
  EXPECT_FALSE(beginning.lasts());
  EXPECT_TRUE(beginning.frames().empty());
}

// From 0 to 1 rad.
std::shared_ptr<const Scan> EvenScan(int beams) {
  Scan scan;
  for (int i = 0; i < beams; ++i) {
    const float bearing_rad = static_cast<float>(i) / static_cast<float>(beams - 1);
    scan.beams.push_back({.bearing_rad = bearing_rad, .range_m = 2.0F, .hit = true});
  }
  return std::make_shared<const Scan>(scan);
}

std::size_t SilentBeams(const std::shared_ptr<const Scan>& scan) {
  const auto is_silent = [](const Beam& beam) { return beam == Silent(beam); };
  return static_cast<std::size_t>(std::count_if(scan->beams.begin(), scan->beams.end(), is_silent));
}

TEST(Beginning, WhatMovedIsTakenOutByItsBearings) {
  Beginning beginning(true);
  const std::vector<int> beams = {11, 0, 21, 6, 11};  // 0: no scan
  for (const int count : beams) {
    const auto scan = count > 0 ? EvenScan(count) : nullptr;
    // Numbers of frames need not go upwards.
    Frame frame;
    frame.index = 90 - count;
    beginning.Add(frame, {.obstacles = scan, .matched = scan});
  }
  EXPECT_TRUE(beginning.TakeOut({{.frame = 0, .first_rad = 0.36F, .last_rad = 0.55F},
                                 {.frame = 3, .first_rad = 0.55F, .last_rad = 0.86F}}));
  const auto& frames = beginning.frames();
  EXPECT_EQ(SilentBeams(frames[0].scans.matched), 2U);  // .4 and .5
  EXPECT_EQ(frames[1].scans.matched, nullptr);
  EXPECT_EQ(SilentBeams(frames[2].scans.matched), 10U);  // .4 to .85: in between it went along
  EXPECT_EQ(SilentBeams(frames[3].scans.matched), 2U);   // .6 and .8
  EXPECT_EQ(SilentBeams(frames[4].scans.matched), 0U);
  EXPECT_EQ(SilentBeams(frames[0].scans.obstacles), 0U);  // the map of cells is drawn from all
}

TEST(Beginning, WhatIsNotInItChangesNothing) {
  Beginning beginning(true);
  beginning.Add({}, {.obstacles = EvenScan(11), .matched = EvenScan(11)});
  EXPECT_FALSE(beginning.TakeOut({{.frame = 7, .first_rad = 0.0F, .last_rad = 1.0F}}));
  EXPECT_EQ(SilentBeams(beginning.frames()[0].scans.matched), 0U);
  beginning.End();
  EXPECT_FALSE(beginning.TakeOut({{.frame = 0, .first_rad = 0.0F, .last_rad = 1.0F}}));
}

constexpr int kFrameCount = 150;

// A round through a furnished room, with a view of 67 degrees.
Pose2 TruthAt(int i) {
  const double phase_rad = 4.0 * kPi * i / kFrameCount;
  return {0.8 * std::sin(phase_rad), 0.5 - 0.5 * std::cos(phase_rad), 0.6 * std::sin(phase_rad)};
}

PlanarWorld Room() {
  PlanarWorld world = RectangleWorld(-3, -2.5, 3, 2.5);
  for (const Wall& wall : RectangleWorld(2.0, -0.4, 2.8, 0.5)) world.push_back(wall);
  for (const Wall& wall : RectangleWorld(1.6, 1.5, 2.4, 2.1)) world.push_back(wall);
  return world;
}

struct Way {
  std::vector<std::optional<Pose3>> online;
  MapperResult result;
};

// SLAM errs by `drift_m` a frame, this way and that. Frames `lost` have no pose.
Way Drive(const MapperOptions& options, std::uint64_t seed, double drift_m,
          const std::vector<int>& lost = {}) {
  const PlanarWorld world = Room();
  const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
  RandomStream random(seed, RandomStage::kTest);
  IncrementalMapper mapper(options, std::nullopt);
  Way way;
  Pose2 slam;
  Eigen::Vector3d bias(drift_m, -drift_m, 0.3 * drift_m);
  for (int i = 0; i < kFrameCount; ++i) {
    if (i > 0) {
      const Pose2 motion = Between(TruthAt(i - 1), TruthAt(i));
      const Eigen::Vector3d noise(random.Normal(), random.Normal(), 0.3 * random.Normal());
      bias = 0.98 * bias + 0.2 * drift_m * noise;
      slam = slam * motion * Pose2::FromVector(bias);
    }
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<Scan>(
        ScanOf(world, TruthAt(i), laser, seed, static_cast<std::uint32_t>(i)));
    if (std::find(lost.begin(), lost.end(), i) == lost.end()) {
      frame.slam_from_camera = CameraOf(TruthAt(0) * slam, 1.0);
    }
    way.online.push_back(mapper.AddFrame(frame).map_from_camera);
  }
  way.result = mapper.Finish();
  return way;
}

double MeanErrorM(const std::vector<std::optional<Pose3>>& map_from_camera, int from) {
  double sum_m = 0.0;
  for (int i = from; i < kFrameCount; ++i) {
    const Pose2 base = BaseOf(*map_from_camera[static_cast<std::size_t>(i)]);
    sum_m += (base.translation() - TruthAt(i).translation()).norm();
  }
  return sum_m / (kFrameCount - from);
}

MapperOptions Options(bool again) {
  MapperOptions options;
  options.rounds.again = again;
  options.surfel.moving_m = 0.0;  // all is matched from the start, before it is seen to stand
  return options;
}

constexpr int kFirstRound = 60;

// Of four seeds the ratio is anything from .68 to .71 as details change; of twelve it is .76.
TEST(GoingThroughAgain, PutsRightWhatWasDrawnWhileSlamWasBelieved) {
  constexpr int kSeeds = 12;
  double once_m = 0.0, again_m = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Way once = Drive(Options(false), seed, 0.02);
    const Way again = Drive(Options(true), seed, 0.02);
    once_m += MeanErrorM(once.online, kFirstRound) / kSeeds;
    again_m += MeanErrorM(again.online, kFirstRound) / kSeeds;
    // What was told of the first frames stays told.
    for (std::size_t i = 0; i < kFirstRound; ++i) {
      EXPECT_EQ(BaseOf(*once.online[i]), BaseOf(*again.online[i])) << i;
    }
  }
  EXPECT_LT(again_m, 0.8 * once_m) << again_m << " m in place of " << once_m;
}

TEST(GoingThroughAgain, KeepsEachFrameAlsoThoseWithoutAPose) {
  const std::vector<int> lost = {20, 21, 22};
  const Way way = Drive(Options(true), 3, 0.01, lost);
  ASSERT_EQ(way.result.map_from_camera.size(), static_cast<std::size_t>(kFrameCount));
  for (int i = 0; i < kFrameCount; ++i) {
    const bool posed = std::find(lost.begin(), lost.end(), i) == lost.end();
    EXPECT_EQ(way.result.map_from_camera[static_cast<std::size_t>(i)].has_value(), posed) << i;
  }
  EXPECT_EQ(way.result.mapped.size(), static_cast<std::size_t>(kFrameCount) - lost.size());
}

TEST(GoingThroughAgain, IsTheSameEachTime) {
  const Way a = Drive(Options(true), 5, 0.02);
  const Way b = Drive(Options(true), 5, 0.02);
  for (std::size_t i = 0; i < kFrameCount; ++i) {
    EXPECT_EQ(BaseOf(*a.online[i]), BaseOf(*b.online[i]));
    EXPECT_EQ(BaseOf(*a.result.map_from_camera[i]), BaseOf(*b.result.map_from_camera[i]));
  }
}

// A chosen gain knows nothing that could be known better the second time.
TEST(GoingThroughAgain, IsOfAGainThatIsLearntAlone) {
  MapperOptions once = Options(false), again = Options(true);
  once.fusion.mode = again.fusion.mode = FusionMode::kFixed;
  const Way a = Drive(once, 2, 0.01);
  const Way b = Drive(again, 2, 0.01);
  for (std::size_t i = 0; i < kFrameCount; ++i) {
    EXPECT_EQ(BaseOf(*a.online[i]), BaseOf(*b.online[i]));
  }
}

}  // namespace
}  // namespace depthgrid
