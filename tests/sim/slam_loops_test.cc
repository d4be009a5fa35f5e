#include "sim/slam/slam_loops.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/slam/loop_correction.h"
#include "sim/slam/slam_surrogate.h"
#include "tests/refusal.h"
#include "tests/sim/slam_paths.h"

namespace depthgrid {
namespace {

TEST(CorrectChain, ReachesTheTargetAndSpreadsTheChange) {
  const Trajectory truth = Circling(1.0);
  std::vector<Pose3> poses;
  for (const StampedPose& pose : truth) poses.push_back(pose.world_from_camera);
  const int second = 500;
  const Pose3 target = poses[500] * Pose3{ExpRotation({0.05, 0.2, -0.1}), {0.3, -0.2, 0.1}};
  const std::vector<Pose3> bent = CorrectChain(poses, 100, second, target);
  EXPECT_LT((bent[500].translation - target.translation).norm(), 1e-11);
  EXPECT_LT(bent[500].rotation.angularDistance(target.rotation), 1e-7);
  for (std::size_t i = 0; i <= 100; ++i) EXPECT_EQ(bent[i], poses[i]);
  double highest = 0.0;
  for (std::size_t i = 101; i <= 500; ++i) {
    const Pose3 change = Between(Between(poses[i - 1], poses[i]), Between(bent[i - 1], bent[i]));
    highest = std::max(highest, LogRotation(change.rotation).norm());
  }
  EXPECT_LT(highest, 3.0 * 0.23 / 400.0);  // no motion takes more than its share
  for (std::size_t i = 501; i < poses.size(); ++i) {
    const Pose3 change = Between(Between(poses[i - 1], poses[i]), Between(bent[i - 1], bent[i]));
    EXPECT_LT(change.translation.norm(), 1e-12);
  }
}

// With rotation held right, the least change of a chain spreads a shift evenly.
TEST(CorrectChain, AShiftOfAStraightShortChainIsSpreadEvenly) {
  std::vector<Pose3> poses(11, CameraOf({0, 0, 0}, 1.0));
  Pose3 target = poses[10];
  target.translation += Eigen::Vector3d(1, 2, 3);
  const std::vector<Pose3> bent = CorrectChain(poses, 0, 10, target);
  for (int i = 0; i <= 10; ++i) {
    const Eigen::Vector3d moved = bent[static_cast<std::size_t>(i)].translation -
                                  poses[static_cast<std::size_t>(i)].translation;
    EXPECT_LT((moved - 0.1 * i * Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  }
}

SlamOptions DriftingWithLoops(LoopScenario scenario) {
  SlamOptions options;
  options.drift_speed_mps = 0.02;
  options.drift_turn_dps = 0.2;
  options.loops = WithScenario({}, scenario);
  return options;
}

double ErrorAt(const Trajectory& truth, const SlamOutput& output, int frame) {
  const auto i = static_cast<std::size_t>(frame);
  return (output.live[i].slam_from_camera->translation - truth[i].world_from_camera.translation)
      .norm();
}

TEST(SlamLoops, ARevisitOfNoSizeIsRefused) {
  SlamLoopOptions options;
  options.max_distance_m = 0.0;
  EXPECT_EQ(RefusalOf([&] { RequireInRange(options, "slam.loops"); }),
            "slam.loops.max_distance_m: is 0, must be from 0.001 to 10");
  options = {};
  options.max_angle_deg = 0.0;
  EXPECT_EQ(RefusalOf([&] { RequireInRange(options, "slam.loops"); }),
            "slam.loops.max_angle_deg: is 0, must be from 0.01 to 180");
}

TEST(SlamSurrogate, ALoopCorrectsLiveAndFinalAndStartsAnEpoch) {
  const Trajectory truth = Circling(1.2);
  const SlamOutput output = DisturbTrajectory(truth, DriftingWithLoops(LoopScenario::kTrue), 1);
  ASSERT_EQ(output.loops.size(), 1U);
  const LoopClosure& loop = output.loops[0];
  const int at = loop.reported_at_frame;
  EXPECT_EQ(at, loop.second_frame);
  EXPECT_GT(ErrorAt(truth, output, at - 1), 0.1);
  EXPECT_LT(ErrorAt(truth, output, at), 0.06);
  EXPECT_EQ(output.live[static_cast<std::size_t>(at) - 1].epoch, 0);
  EXPECT_EQ(output.live[static_cast<std::size_t>(at)].epoch, 1);
  EXPECT_EQ(output.final[0].world_from_camera, truth[0].world_from_camera);
  EXPECT_EQ(output.final.back().world_from_camera, *output.live.back().slam_from_camera);
}

TEST(SlamSurrogate, TheCorrectedHistoryIsBetterThanTheLivePoses) {
  const Trajectory truth = Circling(1.2);
  double live_m = 0.0;
  double final_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SlamOutput output =
        DisturbTrajectory(truth, DriftingWithLoops(LoopScenario::kTrue), seed);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      live_m += ErrorAt(truth, output, static_cast<int>(i));
      final_m +=
          (output.final[i].world_from_camera.translation - truth[i].world_from_camera.translation)
              .norm();
    }
  }
  EXPECT_LT(final_m, 0.6 * live_m);
}

TEST(SlamSurrogate, ALaterLoopLeavesWhatAnEarlierOneCorrected) {
  const Trajectory truth = Circling(1.8);
  const SlamOutput all = DisturbTrajectory(truth, DriftingWithLoops(LoopScenario::kTrue), 1);
  ASSERT_EQ(all.loops.size(), 2U);
  const auto corrected = static_cast<std::size_t>(all.loops[0].second_frame);
  const auto later = static_cast<std::size_t>(all.loops[1].reported_at_frame);
  const Trajectory before_later(truth.begin(), truth.begin() + static_cast<std::ptrdiff_t>(later));
  const SlamOutput early =
      DisturbTrajectory(before_later, DriftingWithLoops(LoopScenario::kTrue), 1);
  for (std::size_t i = 0; i < later; ++i) {
    EXPECT_EQ(early.live[i], all.live[i]);
    if (i > corrected) continue;
    EXPECT_EQ(early.final[i], all.final[i]);
  }
  EXPECT_NE(early.final.back(), all.final[later - 1]);
}

TEST(SlamSurrogate, ALateLoopCorrectsLate) {
  const Trajectory truth = Circling(1.4);
  const SlamOutput now = DisturbTrajectory(truth, DriftingWithLoops(LoopScenario::kTrue), 1);
  const SlamOutput late = DisturbTrajectory(truth, DriftingWithLoops(LoopScenario::kLate), 1);
  ASSERT_EQ(now.loops.size(), 1U);
  ASSERT_EQ(late.loops.size(), 1U);
  EXPECT_EQ(late.loops[0].reported_at_frame, now.loops[0].reported_at_frame + 90);
  EXPECT_EQ(late.loops[0].first_from_second, now.loops[0].first_from_second);
  const auto between = static_cast<std::size_t>(now.loops[0].reported_at_frame) + 45;
  EXPECT_EQ(late.live[between].epoch, 0);
  EXPECT_EQ(now.live[between].epoch, 1);
}

TEST(SlamSurrogate, FalseLoopsMoveSlamOnlyWhenItFollowsThem) {
  const Trajectory truth = Circling(1.2);
  SlamOptions options = DriftingWithLoops(LoopScenario::kFalse);
  const SlamOutput ignored = DisturbTrajectory(truth, options, 3);
  EXPECT_EQ(ignored.loops.size(), 2U);  // one true, one false
  EXPECT_EQ(ignored.live.back().epoch, 1);
  options.loops.follow_false = true;
  const SlamOutput followed = DisturbTrajectory(truth, options, 3);
  EXPECT_EQ(followed.loops, ignored.loops);
  EXPECT_NE(followed.live, ignored.live);
}

TEST(FindRevisits, SeesALapOnceAndAStandingCameraNever) {
  const SlamLoopOptions options;
  const auto find = [&](const Trajectory& truth) {
    return FindRevisits(truth, std::vector<bool>(truth.size(), true), options);
  };
  EXPECT_TRUE(find(Standing(900)).empty());
  EXPECT_TRUE(find(Circling(0.9)).empty());
  const auto once = find(Circling(1.2));
  ASSERT_EQ(once.size(), 1U);
  EXPECT_EQ(once[0].first, 0);
  // Within 0.6 m of the start: 0.6 / (2 m * 2 pi) of a lap before it is complete.
  EXPECT_NEAR(once[0].second, 600 - 600 * 0.6 / (4.0 * kPi), 2.0);
  EXPECT_EQ(find(Circling(2.0)).size(), 3U);  // offered again every 10 s
}

// Along x, and twice across what was walked there. At the second place the camera goes out of reach
// of it for less than a second, which is no third.
TEST(FindRevisits, AreAsManyAsTheTimesThatItCameBack) {
  const std::vector<Eigen::Vector2d> corners = {{0, 0},  {6, 0},   {6, 4}, {3, 4},  {3, -4},
                                                {1, -4}, {1, 0.7}, {1, 0}, {1, 0.3}};
  Trajectory truth;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Eigen::Vector2d way_m = corners[k] - corners[k - 1];
    const int steps = static_cast<int>(way_m.norm() / 0.5 * 30.0);
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector2d at_m = corners[k - 1] + way_m * i / steps;
      truth.push_back(
          {static_cast<double>(truth.size()) / 30.0, CameraOf({at_m.x(), at_m.y(), 0.0}, 1.2)});
    }
  }
  SlamLoopOptions options;
  options.repeat_s = 1e3;
  const auto revisits = FindRevisits(truth, std::vector<bool>(truth.size(), true), options);
  ASSERT_EQ(revisits.size(), 2U);
  for (const auto& [revisit, x_m] : {std::pair(revisits[0], 3.0), {revisits[1], 1.0}}) {
    const auto second = static_cast<std::size_t>(revisit.second);
    EXPECT_NEAR(truth[second].world_from_camera.translation.x(), x_m, 1e-9);
    EXPECT_NEAR(std::abs(truth[second].world_from_camera.translation.y()), 0.6, 0.02);
  }
}

TEST(SimulateLoops, KeepPrecisionRecallAndSigma) {
  const Trajectory truth = Circling(6.0, 12.0);
  const std::vector<bool> tracked(truth.size(), true);
  SlamLoopOptions options;
  options.repeat_s = 2.0;
  options.recall = 0.7;
  options.precision = 0.8;
  options.sigma_translation_m = 0.05;
  options.sigma_rotation_deg = 0.5;
  const double revisits = static_cast<double>(FindRevisits(truth, tracked, options).size());
  double true_loops = 0.0;
  double all_loops = 0.0;
  double square = 0.0;
  double rotation_square = 0.0;
  constexpr int kRuns = 100;
  for (int seed = 0; seed < kRuns; ++seed) {
    for (const SimulatedLoop& loop :
         SimulateLoops(truth, tracked, options, static_cast<std::uint64_t>(seed))) {
      const LoopClosure& closure = loop.closure;
      const Pose3 error =
          Between(Between(truth[static_cast<std::size_t>(closure.first_frame)].world_from_camera,
                          truth[static_cast<std::size_t>(closure.second_frame)].world_from_camera),
                  closure.first_from_second);
      ++all_loops;
      EXPECT_EQ(closure.sigma_translation_m, 0.05);
      EXPECT_EQ(closure.sigma_rotation_rad, RadFromDeg(0.5));
      if (!loop.is_true) {
        EXPECT_GT(error.translation.norm() + LogRotation(error.rotation).norm(), 0.3);
        continue;
      }
      ++true_loops;
      square += error.translation.squaredNorm() / 3.0;
      rotation_square += LogRotation(error.rotation).squaredNorm() / 3.0;
    }
  }
  EXPECT_GT(revisits, 20.0);
  EXPECT_NEAR(true_loops / (revisits * kRuns), 0.7, 0.03);
  EXPECT_NEAR(true_loops / all_loops, 0.8, 0.03);
  EXPECT_NEAR(std::sqrt(square / true_loops), 0.05, 0.002);
  EXPECT_NEAR(DegFromRad(std::sqrt(rotation_square / true_loops)), 0.5, 0.02);
}

TEST(SimulateLoops, JoinTrackedFramesOnly) {
  const Trajectory truth = Circling(6.0, 12.0);
  std::vector<bool> tracked(truth.size());
  for (std::size_t i = 0; i < tracked.size(); ++i) tracked[i] = i % 100 < 50;
  SlamLoopOptions options = WithScenario({}, LoopScenario::kFalse);
  options.repeat_s = 2.0;
  int false_loops = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const SimulatedLoop& loop : SimulateLoops(truth, tracked, options, seed)) {
      EXPECT_TRUE(tracked[static_cast<std::size_t>(loop.closure.first_frame)]);
      EXPECT_TRUE(tracked[static_cast<std::size_t>(loop.closure.second_frame)]);
      false_loops += loop.is_true ? 0 : 1;
    }
  }
  EXPECT_GT(false_loops, 50);
}

TEST(SimulateLoops, WaitForTracking) {
  const Trajectory truth = Circling(1.4);
  std::vector<bool> tracked(truth.size(), true);
  SlamLoopOptions options = WithScenario({}, LoopScenario::kTrue);
  const auto plain = SimulateLoops(truth, tracked, options, 1);
  ASSERT_EQ(plain.size(), 1U);
  options.delay_frames = 20;
  const auto lost_from = static_cast<std::size_t>(plain[0].closure.second_frame) + 10;
  for (std::size_t i = lost_from; i < lost_from + 25; ++i) tracked[i] = false;
  const auto waited = SimulateLoops(truth, tracked, options, 1);
  ASSERT_EQ(waited.size(), 1U);
  EXPECT_EQ(waited[0].closure.second_frame, plain[0].closure.second_frame);
  EXPECT_EQ(waited[0].closure.reported_at_frame, static_cast<int>(lost_from) + 25);
}

}  // namespace
}  // namespace depthgrid
