// SLAM whose motion is far off in a few frames, as odometry's where wheels slip, and right in all
// others: what is seen before and after tells how far each frame turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/fuse/drift_filter.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr PlanarLaser kOddLaser{
    .beams = 360, .field_of_view_rad = RadFromDeg(270), .sigma_of_range = 0.003};

// How the camera moves to a frame, and how SLAM errs.
struct OddStep {
  Pose2 motion;
  Pose2 error;
};

// Largest errors of the final headings, rad.
double WorstHeading(const std::vector<OddStep>& steps, std::uint64_t seed,
                    const MapperOptions& options = {}) {
  IncrementalMapper mapper(options, std::nullopt);
  std::vector<Pose2> truths{{2.4, 1.5, 0.3}};
  Pose2 slam = truths.front();
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    if (i > 0) {
      truths.push_back(truths.back() * steps[i - 1].motion);
      slam = slam * steps[i - 1].motion * steps[i - 1].error;
    }
    Frame frame;
    frame.index = static_cast<int>(i);
    frame.stamp_s = 0.2 * static_cast<double>(i);
    frame.slam_from_camera = CameraOf(slam, 0.0);
    frame.scan = std::make_shared<Scan>(
        ScanOf(FurnishedRoom(), truths.back(), kOddLaser, seed, static_cast<std::uint32_t>(i)));
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  double worst = 0.0;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[i]);
    worst = std::max(worst, std::abs(Between(truths[i], pose).yaw_rad));
  }
  return worst;
}

// 15 straight steps, then a turn of 80 degrees of which odometry misses a third, again and again.
// Groups begin within the turns, and their first frames were seen as well as those that follow.
TEST(OddMotion, OfATurnMovesNothingThatWasSeenBefore) {
  std::vector<OddStep> steps;
  for (int side = 0; side < 8; ++side) {
    for (int i = 0; i < 15; ++i) steps.push_back({{0.04, 0.0, 0.0}, {}});
    for (int i = 0; i < 10; ++i) {
      const double turn = RadFromDeg(i < 2 ? 4.0 : 9.0);
      steps.push_back({{0.01, 0.0, turn}, {0.0, 0.0, -turn / 3.0}});
    }
  }
  for (const std::uint64_t seed : {1, 2}) {
    EXPECT_LT(WorstHeading(steps, seed), RadFromDeg(0.2)) << seed;
  }
}

// Odometry that is late by part of a frame misses some of the turn with which the run begins.
TEST(OddMotion, OfTheFirstFramesDoesNotTurnAllThatFollows) {
  std::vector<OddStep> steps;
  for (int i = 0; i < 240; ++i) {
    steps.push_back({{i / 60 % 2 == 0 ? 0.03 : -0.03, 0.0, 0.0},
                     {3e-4 * std::cos(i / 5.0), 0.0, 1e-4 * std::sin(i / 7.0)}});
  }
  for (std::size_t i = 0; i < 2; ++i) {
    steps[i].motion = {0.0, 0.0, RadFromDeg(-0.44)};
    steps[i].error.yaw_rad = RadFromDeg(0.22);
  }
  MapperOptions believing;
  believing.surfel.joint.judge_stretches = false;
  for (const std::uint64_t seed : {1, 2}) {
    EXPECT_LT(WorstHeading(steps, seed), RadFromDeg(0.08)) << seed;
    EXPECT_GT(WorstHeading(steps, seed, believing), RadFromDeg(0.12)) << seed;
  }
}

// What a match tells of the pose before the motion, against the least squares of both states.
TEST(DriftFilter, TellsOfThePoseBeforeWhatLeastSquaresTell) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  const Pose2 motion{0.3, -0.1, 0.4};
  MotionNoise noise;
  noise.walk = {0.02, 0.01, 0.03};
  noise.bias = {0.01, 0.02, 0.01};
  DriftState before;
  Matrix6 root;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      root(row, column) = 0.01 * std::sin(1.0 + 7.0 * row + 3.0 * column) + (row == column) * 0.02;
    }
  }
  before.covariance = root * root.transpose();
  MatchResult match;
  match.found = true;
  match.information = Eigen::Vector3d(1e4, 400.0, 1e3).asDiagonal();
  const DriftState predicted = Predicted(before, motion, 1, noise);
  match.map_from_base = predicted.map_from_base * Pose2{0.03, -0.02, 0.05};
  const DriftUpdate update = Updated(predicted, match, noise);

  const MotionErrors errors = ErrorsOver(1, noise);
  Eigen::Matrix<double, 6, 12> moved = Eigen::Matrix<double, 6, 12>::Zero();
  moved.topLeftCorner<3, 3>() = -AdjointOf(Inverse(motion));
  moved.block<3, 3>(0, 3).setIdentity();
  moved.block<3, 3>(0, 3) *= -1.0;
  moved.block<3, 3>(3, 3) = -Eigen::Matrix3d(errors.bias_kept.asDiagonal());
  moved.rightCols<6>().setIdentity();
  Eigen::Matrix<double, 6, 1> renewed;
  renewed << errors.walk, errors.bias_renewed;
  Matrix12 h = moved.transpose() * renewed.cwiseAbs2().cwiseInverse().asDiagonal() * moved;
  h.topLeftCorner<6, 6>() += before.covariance.inverse();
  h.block<3, 3>(6, 6) += match.information;
  Eigen::Matrix<double, 12, 1> g = Eigen::Matrix<double, 12, 1>::Zero();
  g.segment<3>(6) = match.information * update.fused.innovation;
  const Eigen::Matrix<double, 12, 1> step = h.ldlt().solve(g);
  const Eigen::Vector3d told = update.previous_gain * update.fused.innovation;
  EXPECT_LT((told - step.head<3>()).norm(), 1e-9);
  EXPECT_GT(told.norm(), 1e-3);
}

}  // namespace
}  // namespace depthgrid
