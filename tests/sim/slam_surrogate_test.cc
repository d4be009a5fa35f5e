#include "sim/slam_surrogate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/level.h"
#include "mapper/io/config.h"
#include "sim/loop_correction.h"
#include "sim/slam_error.h"
#include "sim/slam_loops.h"

namespace depthgrid {
namespace {

constexpr int kSeeds = 300;

// A camera that stays where it is: what moves is the error.
Trajectory Standing(int frames, double step_s = 1.0 / 30.0) {
  Trajectory truth;
  for (int i = 0; i < frames; ++i) {
    truth.push_back({i * step_s, CameraOf({1.0, 2.0, 0.3}, 1.2)});
  }
  return truth;
}

// `laps` times round a circle of 2 m radius, looking outwards, 20 s a lap.
Trajectory Circling(double laps, double seconds_per_lap = 20.0) {
  Trajectory truth;
  const int frames = static_cast<int>(laps * seconds_per_lap * 30.0) + 1;
  for (int i = 0; i < frames; ++i) {
    const double angle_rad = 2.0 * kPi * i / (seconds_per_lap * 30.0);
    truth.push_back({i / 30.0, CameraOf({2.0 * std::cos(angle_rad), 2.0 * std::sin(angle_rad),
                                         WrapAngle(angle_rad)},
                                        1.2)});
  }
  return truth;
}

// Mean square per axis of the error of the live pose at a frame, over many seeds.
struct Spread {
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};
Spread SpreadAt(const Trajectory& truth, const SlamOptions& options, int frame) {
  double translation = 0.0;
  double rotation = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const SlamOutput output = DisturbTrajectory(truth, options, static_cast<std::uint64_t>(seed));
    const auto i = static_cast<std::size_t>(frame);
    const Pose3 error = Between(truth[i].world_from_camera, *output.live[i].slam_from_camera);
    translation += error.translation.squaredNorm() / (3.0 * kSeeds);
    rotation += LogRotation(error.rotation).squaredNorm() / (3.0 * kSeeds);
  }
  return {std::sqrt(translation), DegFromRad(std::sqrt(rotation))};
}

// Three standard errors of a standard deviation estimated from 3 axes x kSeeds draws.
const double kTolerance = 3.0 / std::sqrt(2.0 * 3.0 * kSeeds);

void ExpectRelative(double measured, double declared) {
  EXPECT_NEAR(measured / declared, 1.0, kTolerance) << measured << " against " << declared;
}

TEST(SlamSurrogate, WithoutErrorGivesTheTruthBitForBit) {
  const Trajectory truth = Circling(1.2);
  const SlamOutput output = DisturbTrajectory(truth, ProfileOptions(SlamProfile::kGroundTruth), 7);
  ASSERT_EQ(output.live.size(), truth.size());
  EXPECT_EQ(output.final, truth);
  EXPECT_TRUE(output.loops.empty());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(*output.live[i].slam_from_camera, truth[i].world_from_camera);
    EXPECT_EQ(output.live[i].epoch, 0);
  }
}

TEST(SlamSurrogate, JitterHasItsSigmaAndNoMemory) {
  SlamOptions options;
  options.jitter_translation_m = 0.003;
  options.jitter_rotation_deg = 0.1;
  const Trajectory truth = Standing(1000);
  const SlamOutput output = DisturbTrajectory(truth, options, 3);
  double square = 0.0;
  double lagged = 0.0;
  double rotation = 0.0;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose3 error = Between(truth[i].world_from_camera, *output.live[i].slam_from_camera);
    square += error.translation.squaredNorm();
    lagged += error.translation.dot(before);
    rotation += LogRotation(error.rotation).squaredNorm();
    before = error.translation;
  }
  EXPECT_NEAR(std::sqrt(square / 2997.0), 0.003, 0.003 * 0.04);
  EXPECT_NEAR(DegFromRad(std::sqrt(rotation / 2997.0)), 0.1, 0.1 * 0.04);
  EXPECT_NEAR(lagged / square, 0.0, 3.0 / std::sqrt(2997.0));
  EXPECT_EQ(output.live[0].slam_from_camera, truth[0].world_from_camera);
}

TEST(SlamSurrogate, WalkGrowsWithTheRootOfTime) {
  SlamOptions options;
  options.walk_translation_m = 0.01;
  options.walk_rotation_deg = 0.1;
  options.drift_scale = 2.0;
  const Trajectory truth = Standing(481);
  for (const int frame : {30, 120, 480}) {
    const Spread spread = SpreadAt(truth, options, frame);
    ExpectRelative(spread.translation_m, 0.02 * std::sqrt(frame / 30.0));
    ExpectRelative(spread.rotation_deg, 0.2 * std::sqrt(frame / 30.0));
  }
}

// The walk is that of the time that passed, not of the frames.
TEST(SlamSurrogate, WalkDoesNotDependOnTheFrameRate) {
  SlamOptions options;
  options.walk_translation_m = 0.01;
  ExpectRelative(SpreadAt(Standing(33, 0.25), options, 32).translation_m, 0.01 * std::sqrt(8.0));
}

// A pose bias that starts at 0 has variance s^2 (1 - exp(-2 t / tau)).
TEST(SlamSurrogate, BiasOfThePoseIsBounded) {
  SlamOptions options;
  options.bias_translation_m = 0.02;
  options.bias_rotation_deg = 0.3;
  options.bias_time_s = 2.0;
  const Trajectory truth = Standing(601);
  for (const int frame : {15, 60, 600}) {
    const double settled = std::sqrt(-std::expm1(-2.0 * frame / 30.0 / options.bias_time_s));
    const Spread spread = SpreadAt(truth, options, frame);
    ExpectRelative(spread.translation_m, 0.02 * settled);
    ExpectRelative(spread.rotation_deg, 0.3 * settled);
  }
}

TEST(SlamSurrogate, BiasForgetsWithItsCorrelationTime) {
  SlamOptions options;
  options.bias_translation_m = 0.02;
  options.bias_time_s = 0.5;
  const auto errors = DrawFrameErrors(Standing(6001), options, 5);
  double square = 0.0;
  double lagged = 0.0;
  constexpr std::size_t kLag = 15;  // 0.5 s
  for (std::size_t i = 1; i + kLag < errors.size(); ++i) {
    square += errors[i].offset.translation.squaredNorm();
    lagged += errors[i].offset.translation.dot(errors[i + kLag].offset.translation);
  }
  EXPECT_NEAR(std::sqrt(square / (3.0 * 6000)), 0.02, 0.002);
  EXPECT_NEAR(lagged / square, std::exp(-1.0), 0.08);
}

// Var of the integral of an Ornstein-Uhlenbeck process: 2 s^2 tau^2 (t/tau - 1 + exp(-t/tau)).
TEST(SlamSurrogate, DriftIntegratesAStationaryBiasOfTheRate) {
  SlamOptions options;
  options.drift_speed_mps = 0.02;
  options.drift_turn_dps = 0.0;
  options.drift_time_s = 2.0;
  const Trajectory truth = Standing(601);
  for (const int frame : {3, 60, 600}) {
    const double x = frame / 30.0 / options.drift_time_s;
    const double variance = 2.0 * std::pow(0.02 * 2.0, 2) * (x - 1.0 + std::exp(-x));
    ExpectRelative(SpreadAt(truth, options, frame).translation_m, std::sqrt(variance));
  }
}

TEST(SlamSurrogate, JumpsAndLossesComeAtTheirRates) {
  SlamOptions options;
  options.jump_rate_hz = 0.5;
  options.jump_translation_m = 0.05;
  options.lost_rate_hz = 0.2;
  options.lost_mean_s = 0.8;
  options.relocalisation_translation_m = 0.1;
  const Trajectory truth = Standing(3001);
  double jumps = 0.0;
  double jump_square = 0.0;
  double bursts = 0.0;
  double lost_frames = 0.0;
  double landing_square = 0.0;
  constexpr int kRuns = 40;
  for (int seed = 0; seed < kRuns; ++seed) {
    for (const FrameErrors& error :
         DrawFrameErrors(truth, options, static_cast<std::uint64_t>(seed))) {
      lost_frames += error.lost ? 1 : 0;
      if (error.relocalised) {
        ++bursts;
        landing_square += error.motion.translation.squaredNorm() / 3.0;
      } else if (!error.motion.translation.isZero(0.0)) {
        ++jumps;
        jump_square += error.motion.translation.squaredNorm() / 3.0;
      }
    }
  }
  const double seconds = kRuns * 100.0;
  const double tracked_s = seconds - lost_frames / 30.0;
  EXPECT_NEAR(jumps / seconds, 0.5, 0.05);
  EXPECT_NEAR(std::sqrt(jump_square / jumps), 0.05, 0.002);
  EXPECT_NEAR(bursts / tracked_s, 0.2, 0.025);
  // A burst lasts to the first frame after its time is over: half a frame more in the mean.
  EXPECT_NEAR(lost_frames / 30.0 / bursts, 0.8 + 0.5 / 30.0, 0.1);
  EXPECT_NEAR(std::sqrt(landing_square / bursts), 0.1, 0.006);
}

TEST(SlamSurrogate, LostFramesHaveNoPoseAndRelocalisationStartsAnEpoch) {
  SlamOptions options;
  options.lost_rate_hz = 0.3;
  const Trajectory truth = Standing(1500);
  const SlamOutput output = DisturbTrajectory(truth, options, 2);
  std::size_t tracked = 0;
  int epochs = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(output.live[i].stamp_s, truth[i].stamp_s);
    tracked += output.live[i].slam_from_camera ? 1 : 0;
    if (i == 0) continue;
    const bool found = output.live[i].slam_from_camera && !output.live[i - 1].slam_from_camera;
    EXPECT_EQ(output.live[i].epoch - output.live[i - 1].epoch, found ? 1 : 0);
    epochs += found ? 1 : 0;
  }
  EXPECT_GT(epochs, 3);
  EXPECT_EQ(output.final.size(), tracked);
  EXPECT_LT(tracked, truth.size());
}

TEST(SlamSurrogate, RotationErrorsTurnAboutThePivot) {
  const Pose3 error = PivotedMotion({0.01, -0.02, 0.005}, Eigen::Vector3d::Zero(), 1.9);
  const Eigen::Vector3d pivot(0, 0, 1.9);
  EXPECT_LT((error * pivot - pivot).norm(), 1e-15);
  EXPECT_GT(error.translation.norm(), 0.03);
}

TEST(SlamSurrogate, EffectsDoNotDisturbEachOther) {
  const Trajectory truth = Circling(1.2);
  SlamOptions options = ProfileOptions(SlamProfile::kOrbSlam2);
  const auto all = DrawFrameErrors(truth, options, 4);
  options.walk_translation_m = 0.0;
  options.walk_rotation_deg = 0.0;
  options.drift_speed_mps = 0.0;
  options.drift_turn_dps = 0.0;
  options.loops = {};
  const auto jitter_only = DrawFrameErrors(truth, options, 4);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_EQ(all[i].offset, jitter_only[i].offset);
  EXPECT_EQ(DisturbTrajectory(truth, options, 4).live, DisturbTrajectory(truth, options, 4).live);
  EXPECT_NE(DisturbTrajectory(truth, options, 4).live, DisturbTrajectory(truth, options, 5).live);
}

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
    if (i <= corrected) EXPECT_EQ(early.final[i], all.final[i]);
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

TEST(SlamOptions, AProfileIsOverriddenByKeysBesideIt) {
  SlamOptions options;
  Config::FromText(
      "jitter_translation_m: 0.5\nloops: {scenario: late, recall: 0.25}\n"
      "profile: orb_slam2_measured",
      "x")
      .Read(options);
  SlamOptions expected = ProfileOptions(SlamProfile::kOrbSlam2Measured);
  expected.jitter_translation_m = 0.5;
  expected.loops = WithScenario(expected.loops, LoopScenario::kLate);
  expected.loops.recall = 0.25;
  EXPECT_EQ(ToYaml(options), ToYaml(expected));
  SlamOptions again;
  Config::FromText(ToYaml(options), "x").Read(again);
  EXPECT_EQ(ToYaml(again), ToYaml(expected));
}

}  // namespace
}  // namespace depthgrid
