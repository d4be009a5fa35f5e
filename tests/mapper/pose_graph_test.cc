#include "mapper/graph/pose_graph.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "mapper/graph/scan_submap_graph.h"
#include "tests/mapper/poses.h"

namespace depthgrid {
namespace {

TEST(ConstraintError, IsZeroAtTheMeasuredPoseAndByHandElsewhere) {
  ExpectNear(Pose2::FromVector(ConstraintError({1, 2, kPi / 2}, {1, 3, kPi}, {1, 0, kPi / 2})), {},
             1e-15);
  const Eigen::Vector3d error = ConstraintError({1, 2, kPi / 2}, {0.9, 3.3, -3.1}, {1, 0, 1.6});
  EXPECT_NEAR(error.x(), 1.0 - 1.3, 1e-12);
  EXPECT_NEAR(error.y(), 0.0 - 0.1, 1e-12);
  EXPECT_NEAR(error.z(), 1.6 - WrapAngle(-3.1 - kPi / 2), 1e-12);
}

TEST(ConstraintError, JacobiansAgreeWithDifferences) {
  RandomStream random(1, RandomStage::kTest);
  int cases = 0;
  for (int i = 0; i < 200; ++i, ++cases) {
    const Pose2 from = RandomPose(random);
    const Pose2 to = RandomPose(random);
    const Pose2 measured = Between(from, to) * Pose2{0.1, 0.2, 0.3};  // far from the angle's jump
    const ConstraintJacobians jacobians = JacobiansOf(from, to);
    constexpr double kStep = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d step = Eigen::Vector3d::Zero();
      step[axis] = kStep;
      const auto moved = [&](const Pose2& pose, double sign) {
        return Pose2::FromVector(pose.vector() + sign * step);
      };
      const Eigen::Vector3d by_from = (ConstraintError(moved(from, 1), to, measured) -
                                       ConstraintError(moved(from, -1), to, measured)) /
                                      (2 * kStep);
      const Eigen::Vector3d by_to = (ConstraintError(from, moved(to, 1), measured) -
                                     ConstraintError(from, moved(to, -1), measured)) /
                                    (2 * kStep);
      EXPECT_TRUE(jacobians.by_from.col(axis).isApprox(by_from, 1e-7));
      EXPECT_TRUE(jacobians.by_to.col(axis).isApprox(by_to, 1e-7));
    }
  }
  EXPECT_EQ(cases, 200);
}

// Three steps of 1 m along x and a loop that says 3.4 m: four equal springs share the 0.4 m.
TEST(SolvePoseGraph, SharesAnErrorBetweenEqualConstraints) {
  std::vector<Pose2> poses = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  std::vector<PoseConstraint> constraints;
  for (int i = 0; i < 3; ++i) constraints.push_back({i, i + 1, {1, 0, 0}, {0.1, 0.1, 0.1}});
  constraints.push_back({0, 3, {3.4, 0, 0}, {0.1, 0.1, 0.1}});
  const PoseGraphSolution solution = SolvePoseGraph(poses, constraints, {});
  EXPECT_TRUE(solution.converged);
  for (int i = 0; i < 4; ++i) {
    ExpectNear(solution.poses[static_cast<std::size_t>(i)], {1.1 * i, 0, 0}, 1e-6);
  }
}

TEST(SolvePoseGraph, RecoversPosesFromConsistentConstraintsWhereverItStarts) {
  RandomStream random(2, RandomStage::kTest);
  std::vector<Pose2> truth;
  for (int i = 0; i < 12; ++i)
    truth.push_back({2 * std::cos(i), 2 * std::sin(i), WrapAngle(1.1 * i)});
  std::vector<PoseConstraint> constraints;
  for (int i = 0; i < 12; ++i) {
    for (const int j : {(i + 1) % 12, (i + 5) % 12}) {
      constraints.push_back(
          {i,
           j,
           Between(truth[static_cast<std::size_t>(i)], truth[static_cast<std::size_t>(j)]),
           {0.02, 0.02, 0.01},
           true});
    }
  }
  std::vector<Pose2> start = truth;
  for (std::size_t i = 1; i < start.size(); ++i) {
    start[i] =
        start[i] * Pose2{0.2 * random.Normal(), 0.2 * random.Normal(), 0.2 * random.Normal()};
  }
  const PoseGraphSolution solution = SolvePoseGraph(start, constraints, {});
  EXPECT_EQ(solution.poses[0], truth[0]);
  for (std::size_t i = 0; i < truth.size(); ++i) ExpectNear(solution.poses[i], truth[i], 1e-6);
}

TEST(SolvePoseGraph, HuberKeepsOneWildLoopFromBendingTheRest) {
  std::vector<Pose2> poses;
  std::vector<PoseConstraint> constraints;
  for (int i = 0; i < 20; ++i) {
    poses.push_back({0.5 * i, 0, 0});
    if (i > 0) constraints.push_back({i - 1, i, {0.5, 0, 0}, {0.01, 0.01, 0.001}});
  }
  const auto bend = [&](bool robust) {
    std::vector<PoseConstraint> all = constraints;
    all.push_back({2, 18, {2.0, 3.0, 1.0}, {0.02, 0.02, 0.01}, robust});
    double worst = 0.0;
    const PoseGraphSolution solution = SolvePoseGraph(poses, all, {});
    for (std::size_t i = 0; i < poses.size(); ++i) {
      worst = std::max(worst, (solution.poses[i].translation() - poses[i].translation()).norm());
    }
    return worst;
  };
  EXPECT_LT(bend(true), 0.6);
  EXPECT_GT(bend(false), 3.0 * bend(true));
}

TEST(SolvePoseGraph, RefusesConstraintsOfNoPose) {
  EXPECT_THROW(SolvePoseGraph({{}, {}}, {{0, 2, {}}}, {}), std::logic_error);
  EXPECT_THROW(SolvePoseGraph({{}, {}}, {{1, 1, {}}}, {}), std::logic_error);
}

// Scans once round a square, whose heading drifts; submaps of 10.
class ScanSubmapGraphTest : public ::testing::Test {
 protected:
  static constexpr int kScans = 80;
  static constexpr int kScansPerSubmap = 10;

  ScanSubmapGraphTest() {
    Pose2 drifted;
    Pose2 pose;
    std::vector<Pose2> estimates;
    for (int i = 0; i < kScans; ++i) {
      truth_.push_back(pose);
      MappedFrame frame;
      frame.frame = i;
      frame.map_from_base = drifted;
      frame.slam_motion = Pose2{};
      frames_.push_back(frame);
      estimates.push_back(drifted);
      measurements_.push_back(MeasurementOf(estimates, i, kScansPerSubmap));
      const Pose2 step{0.1, 0.0, i % 20 == 19 ? kPi / 2 : 0.0};
      pose = pose * step;
      drifted = drifted * step * Pose2{0.0, 0.001, 0.001};
    }
  }

  PlanarLoop LoopOf(int first, int second, const Pose2& error = {}) const {
    return {.first = first,
            .second = second,
            .first_from_second = Between(truth_[static_cast<std::size_t>(first)],
                                         truth_[static_cast<std::size_t>(second)]) *
                                 error};
  }
  Adjustment Adjusted(const std::vector<PlanarLoop>& loops) const {
    return AdjustScansAndSubmaps(frames_, measurements_, loops, kScansPerSubmap, {});
  }
  double MeanError(const std::vector<Pose2>& poses) const {
    double sum_m = 0.0;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      sum_m += (poses[i].translation() - truth_[i].translation()).norm();
    }
    return sum_m / static_cast<double>(truth_.size());
  }
  std::vector<Pose2> Estimates() const {
    std::vector<Pose2> poses;
    for (const MappedFrame& frame : frames_) poses.push_back(frame.map_from_base);
    return poses;
  }

  std::vector<Pose2> truth_;
  std::vector<MappedFrame> frames_;
  std::vector<ScanMeasurement> measurements_;
};

TEST_F(ScanSubmapGraphTest, NothingMovesWithoutLoops) {
  EXPECT_EQ(Adjusted({}).map_from_base, Estimates());
}

TEST_F(ScanSubmapGraphTest, ATrueLoopHalvesTheErrorAndTearsNothing) {
  const Adjustment adjustment = Adjusted({LoopOf(0, kScans - 1)});
  EXPECT_TRUE(adjustment.loop_accepted[0]);
  EXPECT_LT(MeanError(adjustment.map_from_base), 0.5 * MeanError(Estimates()));
  EXPECT_LT((adjustment.map_from_base.back().translation() - truth_.back().translation()).norm(),
            0.02);
  for (std::size_t i = 1; i < truth_.size(); ++i) {
    const Pose2 before = Between(frames_[i - 1].map_from_base, frames_[i].map_from_base);
    const Pose2 after = Between(adjustment.map_from_base[i - 1], adjustment.map_from_base[i]);
    EXPECT_LT((after.translation() - before.translation()).norm(), 0.01);
  }
}

TEST_F(ScanSubmapGraphTest, SolvingAgainFromTheAnswerGivesTheAnswer) {
  const std::vector<PlanarLoop> loops = {LoopOf(0, kScans - 1), LoopOf(5, 75)};
  const Adjustment first = Adjusted(loops);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    frames_[i].map_from_base = first.map_from_base[i];
  }
  const Adjustment second = Adjusted(loops);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    ExpectNear(second.map_from_base[i], first.map_from_base[i], 1e-4);
  }
}

TEST_F(ScanSubmapGraphTest, ALoopThatContradictsTheOthersIsTakenOut) {
  const std::vector<PlanarLoop> loops = {LoopOf(0, 79), LoopOf(2, 77), LoopOf(4, 76),
                                         LoopOf(1, 78, {1.0, -0.8, 0.4})};
  const Adjustment adjustment = Adjusted(loops);
  EXPECT_EQ(adjustment.loop_accepted, (std::vector<bool>{true, true, true, false}));
  const Adjustment without = Adjusted({loops[0], loops[1], loops[2]});
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    ExpectNear(adjustment.map_from_base[i], without.map_from_base[i], 1e-6);
  }
}

}  // namespace
}  // namespace depthgrid
