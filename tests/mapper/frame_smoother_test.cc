#include "mapper/surfel/frame_smoother.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

// Along a bare wall: both ends are seen whole, between them only what lies across. SLAM goes 2 mm a
// frame too far, and 2 mm too short in the second half.
std::vector<SmootherFrame> AlongAWall(int frames, int seen) {
  std::vector<SmootherFrame> run;
  for (int k = 0; k < frames; ++k) {
    SmootherFrame frame;
    frame.map_from_base = {0.02 * k, 0.0, 0.0};
    frame.match.found = true;
    frame.match.map_from_base = frame.map_from_base;
    frame.match.information = Eigen::Vector3d(0.0, 1e6, 1e7).asDiagonal();
    if (k < seen || k >= frames - seen) frame.match.information(0, 0) = 1e6;
    const double too_far_m = k < frames / 2 ? 0.002 : -0.002;
    if (k > 0) frame.motion = Pose2{0.02 + too_far_m, 0.0, 0.0};
    run.push_back(frame);
  }
  return run;
}

MotionNoise LastingBias() {
  MotionNoise noise;
  noise.jitter.setZero();
  noise.walk.setConstant(1e-4);
  noise.bias.setConstant(0.002);
  noise.bias_kept.setConstant(0.99);
  return noise;
}

double FarthestOff(const std::vector<SmootherFrame>& run, const std::vector<Pose2>& smoothed) {
  double farthest_m = 0.0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const Pose2 off = Between(run[k].map_from_base, smoothed[k]);
    farthest_m = std::max(farthest_m, off.translation().norm());
  }
  return farthest_m;
}

TEST(Smoothed, StaysNearTheGuessWhereNothingIsSeen) {
  const std::vector<SmootherFrame> run = AlongAWall(601, 20);
  const double anywhere_m = FarthestOff(run, Smoothed(run, LastingBias(), 0.0));
  EXPECT_GT(anywhere_m, 0.3);
  EXPECT_LT(FarthestOff(run, Smoothed(run, LastingBias(), 0.3)), 0.3 * anywhere_m);
}

TEST(Smoothed, GoesWhereMatchesSay) {
  std::vector<SmootherFrame> run = AlongAWall(200, 200);
  for (SmootherFrame& frame : run) frame.match.map_from_base.y_m += 0.05;
  for (const double stay_m : {0.0, 0.3}) {
    const std::vector<Pose2> smoothed = Smoothed(run, LastingBias(), stay_m);
    for (const Pose2& pose : smoothed) EXPECT_NEAR(pose.y_m, 0.05, 1e-4);
  }
}

// SLAM's pose jitters by 5 cm and 0.1 rad in one frame before a wall. Its match says nothing of the
// way along the wall, although its base axes are turned against those of all other poses.
TEST(Smoothed, JitterBeforeAWallMovesNothingAlongIt) {
  constexpr std::size_t kJitters = 20;
  MatchResult match;
  match.found = true;
  match.information = Eigen::Vector3d(1e6, 0.0, 1e7).asDiagonal();
  std::vector<SmootherFrame> run(2 * kJitters + 1);
  for (SmootherFrame& frame : run) {
    frame.match = match;
    frame.motion = Pose2{};
  }
  const Pose2 jitter{0.05, 0.0, 0.1};
  run[kJitters].match.information = InformationIn(jitter, match);
  run[kJitters].match.map_from_base = jitter;
  MotionNoise noise;
  noise.jitter = {0.05, 0.05, 0.1};
  noise.walk.setConstant(1e-5);
  const Pose2 jittering = Smoothed(run, noise, 0.3)[kJitters];
  EXPECT_NEAR(jittering.x_m, 0.05, 1e-3);
  EXPECT_NEAR(jittering.y_m, 0.0, 1e-4);
  EXPECT_NEAR(jittering.yaw_rad, 0.1, 1e-3);
}

// SLAM's bias after a stand is the one before: what is known of it does not fade meanwhile, so that
// a frame after it goes where the motion less that bias leads.
TEST(Smoothed, ABiasOutlastsAStand) {
  constexpr int kMoving = 40, kStanding = 400;
  constexpr double kTooFarM = 0.002;
  std::vector<SmootherFrame> run;
  for (int k = 0; k < kMoving + kStanding + 20; ++k) {
    SmootherFrame frame;
    frame.stands = k >= kMoving && k < kMoving + kStanding;
    const double x_m = 0.02 * std::min(k, kMoving) + 0.02 * std::max(k - kMoving - kStanding, 0);
    frame.map_from_base = {x_m, 0.0, 0.0};
    frame.match.found = true;
    frame.match.map_from_base = frame.map_from_base;
    const double forward = k < kMoving + kStanding ? 1e6 : 0.0;
    frame.match.information = Eigen::Vector3d(forward, 1e6, 1e7).asDiagonal();
    if (k > 0) {
      frame.motion = Pose2{x_m - run.back().map_from_base.x_m, 0.0, 0.0};
      if (!frame.stands) frame.motion->x_m += kTooFarM;
    }
    run.push_back(frame);
  }
  const std::vector<Pose2> smoothed = Smoothed(run, LastingBias(), 0.0);
  EXPECT_NEAR(smoothed.back().x_m, run.back().map_from_base.x_m, 0.2 * 20 * kTooFarM);
}

// SLAM that was perfect and then goes 2 mm a frame too far. Believed as before, it is followed by
// more than a centimetre although each match knows the way to one.
TEST(Smoothed, SlamIsBelievedLessWhereItsErrorsGrew) {
  constexpr int kUndisturbed = 200;
  MotionNoise noise;
  noise.walk.setConstant(1e-5);
  noise.bias.setConstant(1e-5);
  std::vector<SmootherFrame> run;
  for (int k = 0; k < 2 * kUndisturbed; ++k) {
    SmootherFrame frame;
    frame.map_from_base = {0.02 * k, 0.0, 0.0};
    frame.match.found = true;
    frame.match.map_from_base = frame.map_from_base;
    frame.match.information = Eigen::Vector3d(1e4, 1e6, 1e7).asDiagonal();
    if (k > 0) frame.motion = Pose2{k < kUndisturbed ? 0.02 : 0.022, 0.0, 0.0};
    run.push_back(frame);
  }
  EXPECT_GT(FarthestOff(run, Smoothed(run, noise, 0.3)), 0.01);
  for (int k = kUndisturbed; k < 2 * kUndisturbed; ++k) {
    run[static_cast<std::size_t>(k)].growth.setConstant(200.0);
  }
  EXPECT_LT(FarthestOff(run, Smoothed(run, noise, 0.3)), 0.003);
}

}  // namespace
}  // namespace depthgrid
