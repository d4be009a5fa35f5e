// A robot that sees one wall alone for a while, along which its odometry slides.
#include "mapper/graph/slide_search.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr int kSlideLookRound = 120;  // frames in which all of the room is seen
constexpr int kSlideAlongWall = 60;   // then only the wall ahead
constexpr int kSlideTurnAway = 40;    // then a corner comes into view
constexpr int kSlideFrames = kSlideLookRound + kSlideAlongWall + kSlideTurnAway;
constexpr double kSidewaysM = 0.01;  // a frame, along the wall

Pose2 SlideTruthAt(int i) {
  constexpr double kTurnRad = 2.0 * kPi / kSlideLookRound;
  if (i <= kSlideLookRound) return {4.2, 2.8, WrapAngle(kTurnRad * i)};
  const int along = std::min(i - kSlideLookRound, kSlideAlongWall);
  const int turned = std::max(i - kSlideLookRound - kSlideAlongWall, 0);
  return {4.2, 2.8 - kSidewaysM * along, -kTurnRad * turned};
}

struct SlideOutcome {
  int loops = 0;
  double slid_m = 0.0;    // the estimate's error where the wall alone was seen last
  double at_end_m = 0.0;  // and of the last frame
  double variance = 0.0;  // of all motions forward, as the mapper tells it, summed
};

// SLAM errs by `slide_m` a frame along the wall while it is seen alone, and knows that it errs.
SlideOutcome SlideOutcomeOf(double slide_m, bool search,
                            const SlideSearchOptions& slide = SlideSearchOptions()) {
  const PlanarWorld room = RectangleWorld(0.0, 0.0, 6.0, 5.0);
  const PlanarLaser laser{
      .beams = 160, .field_of_view_rad = RadFromDeg(45), .sigma_of_range = 0.01};
  MapperOptions options;
  options.fusion.mode = FusionMode::kKalman;
  options.fusion.slam_noise = {.jitter_m = 0.001,
                               .jitter_rad = 0.001,
                               .walk_m_per_sqrt_s = 0.08,
                               .walk_rad_per_sqrt_s = 0.005};
  options.rounds.first_frames = 0;
  options.loops.search.use = LoopSearchUse::kOff;
  options.loops.slide = slide;
  options.loops.slide.use = search;
  IncrementalMapper mapper(options, std::nullopt);
  SlideOutcome outcome;
  for (int i = 0; i < kSlideFrames; ++i) {
    const Pose2 truth = SlideTruthAt(i);
    const int along = std::clamp(i - kSlideLookRound, 0, kSlideAlongWall);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan =
        std::make_shared<Scan>(ScanOf(room, truth, laser, 5, static_cast<std::uint32_t>(i)));
    frame.slam_from_camera = CameraOf({truth.x_m, truth.y_m - slide_m * along, truth.yaw_rad}, 0.5);
    const FrameReport report = mapper.AddFrame(frame);
    outcome.loops += report.loops_accepted;
    outcome.variance += report.motion_covariance(0, 0);
    const Pose2 estimate = BaseOf(*report.map_from_camera);
    const double error_m = (estimate.translation() - truth.translation()).norm();
    if (i == kSlideLookRound + kSlideAlongWall) outcome.slid_m = error_m;
    outcome.at_end_m = error_m;
  }
  return outcome;
}

TEST(SlideSearch, WhatWasMappedBeforeSaysHowFarTheEstimateSlid) {
  const SlideOutcome without = SlideOutcomeOf(0.005, false);
  EXPECT_GT(without.slid_m, 0.25);
  EXPECT_GT(without.at_end_m, 0.25);  // the corner is drawn a second time
  EXPECT_EQ(without.loops, 0);
  const SlideOutcome with = SlideOutcomeOf(0.005, true);
  EXPECT_GT(with.slid_m, 0.25);
  EXPECT_LT(with.at_end_m, 0.03);  // a loop is believed to 2 cm
  EXPECT_EQ(with.loops, 1);
}

// The search leaves no trace where it finds nothing.
TEST(SlideSearch, NothingChangesWhereNothingSlidFar) {
  const SlideOutcome with = SlideOutcomeOf(0.0, true);
  const SlideOutcome without = SlideOutcomeOf(0.0, false);
  EXPECT_EQ(with.loops, 0);
  EXPECT_EQ(with.slid_m, without.slid_m);
  EXPECT_EQ(with.at_end_m, without.at_end_m);
}

// Of a slide out of its reach the scan is tried in vain: nothing else may come of that.
TEST(SlideSearch, WhatItTriesInVainLeavesNoTrace) {
  SlideSearchOptions narrow;
  narrow.window_sigmas = 0.5;
  const SlideOutcome with = SlideOutcomeOf(0.005, true, narrow);
  const SlideOutcome without = SlideOutcomeOf(0.005, false);
  EXPECT_EQ(with.loops, 0);
  EXPECT_EQ(with.at_end_m, without.at_end_m);
  EXPECT_GT(with.variance, 0.0);
  EXPECT_EQ(with.variance, without.variance);
}

}  // namespace
}  // namespace depthgrid
