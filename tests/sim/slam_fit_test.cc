#include "sim/slam/slam_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "sim/slam/error_growth.h"
#include "sim/slam/slam_calibration.h"
#include "sim/slam/slam_events.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid {
namespace {

// Once round a desk in 50 s, 1.5 m away and looking down at it, as TUM fr2/desk was recorded.
Trajectory RoundADesk(double seconds) {
  Trajectory truth;
  for (int i = 0; i <= static_cast<int>(seconds * 30.0); ++i) {
    const double angle_rad = 2.0 * kPi * i / 1500.0;
    const Pose3 level = CameraOf(
        {1.5 * std::cos(angle_rad), 1.5 * std::sin(angle_rad), WrapAngle(angle_rad + kPi)}, 1.2);
    truth.push_back({i / 30.0, level * Pose3{ExpRotation({-0.5, 0.0, 0.0}), {0, 0, 0}}});
  }
  return truth;
}

SlamRun Disturbed(const Trajectory& truth, const SlamOptions& options, std::uint64_t seed) {
  SlamRun run;
  const SlamOutput output = DisturbTrajectory(truth, options, seed);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!output.live[i].slam_from_camera) continue;
    run.truth.push_back(truth[i]);
    run.estimate.push_back({truth[i].stamp_s, *output.live[i].slam_from_camera});
  }
  return run;
}

std::vector<SlamRun> Runs(const SlamOptions& options, int count, double seconds) {
  std::vector<SlamRun> runs;
  const Trajectory truth = RoundADesk(seconds);
  for (int seed = 0; seed < count; ++seed) {
    runs.push_back(Disturbed(truth, options, static_cast<std::uint64_t>(seed)));
  }
  return runs;
}

// Straight ahead without a turn: rotations are exact, bit for bit.
Trajectory AheadAt(const std::vector<double>& stamps_s) {
  Trajectory truth;
  for (const double stamp_s : stamps_s) {
    truth.push_back({stamp_s, {Eigen::Quaterniond::Identity(), {0.1 * stamp_s, 0.0, 1.0}}});
  }
  return truth;
}

std::vector<double> StampsS(int count) {
  std::vector<double> stamps_s;
  for (int i = 0; i < count; ++i) stamps_s.push_back(i / 30.0);
  return stamps_s;
}

std::vector<SlamRun> RunsOf(const Trajectory& truth, const SlamOptions& options) {
  std::vector<SlamRun> runs;
  for (std::uint64_t seed = 0; seed < 10; ++seed) runs.push_back(Disturbed(truth, options, seed));
  return runs;
}

// How far a walk, per axis, is off after a time.
double WalkedM(const SlamOptions& options, double lag_s) {
  const GrowthTerms terms = {options.jitter_translation_m, options.bias_translation_m,
                             options.walk_translation_m, options.drift_speed_mps, 0.0};
  return std::sqrt(GrowthOf(terms, {options.bias_time_s, options.drift_time_s}, lag_s));
}

double TurnedDeg(const SlamOptions& options, double lag_s) {
  const GrowthTerms terms = {options.jitter_rotation_deg, options.bias_rotation_deg,
                             options.walk_rotation_deg, options.drift_turn_dps, 0.0};
  return std::sqrt(GrowthOf(terms, {options.bias_time_s, options.drift_time_s}, lag_s));
}

// Walk, bias and drift can stand in for one another: what counts is how errors grow.
void ExpectWalk(const SlamOptions& fitted, double walk_m) {
  for (const double lag_s : {0.1, 1.0, 5.0}) {
    EXPECT_NEAR(WalkedM(fitted, lag_s) / (walk_m * std::sqrt(lag_s)), 1.0, 0.15) << lag_s;
  }
}

TEST(ErrorOverLag, IsThatOfAConstantRateByHand) {
  SlamRun run;
  for (int i = 0; i <= 90; ++i) {
    const Pose3 still = CameraOf({0, 0, 0}, 1.0);
    run.truth.push_back({i / 30.0, still});
    run.estimate.push_back(
        {i / 30.0, still * Pose3{Eigen::Quaterniond::Identity(), {0.001 * i, 0, 0}}});
  }
  const auto errors = ErrorOverLag({run}, {1.0 / 30.0, 1.0, 3.0, 10.0});
  ASSERT_EQ(errors.size(), 3U);  // the run is shorter than 10 s
  EXPECT_NEAR(errors[0].translation_m, 0.001, 1e-12);
  EXPECT_EQ(errors[0].pairs, 90);
  EXPECT_NEAR(errors[1].translation_m, 0.030, 1e-12);
  EXPECT_EQ(errors[1].pairs, 61);
  EXPECT_NEAR(errors[2].translation_m, 0.090, 1e-12);
}

// ORB-SLAM2 on TUM fr2/desk: root mean square error over time lags.
TEST(SlamProfiles, TheDeskProfileErrsOverLagsAsMeasured) {
  const std::vector<double> lags_s = {1.0 / 30.0, 0.1, 1.0 / 3.0, 1.0, 3.0, 10.0, 30.0, 60.0};
  const std::array<double, 8> measured_mm = {3.4, 4.6, 5.6, 7.2, 10, 16, 42, 58};
  const std::array<double, 8> measured_deg = {.28, .33, .38, .46, .56, .82, 1.5, 1.5};
  const auto desk =
      ErrorOverLag(Runs(ProfileOptions(SlamProfile::kOrbSlam2Desk), 30, 99.0), lags_s);
  SlamOptions scale_one = ProfileOptions(SlamProfile::kOrbSlam2);
  scale_one.drift_scale = 1.0;
  scale_one.loops = {};
  const auto calibrated = ErrorOverLag(Runs(scale_one, 30, 99.0), lags_s);
  ASSERT_EQ(desk.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(std::log(desk[i].translation_m * 1e3 / measured_mm[i]), 0.0, std::log(1.25)) << i;
    EXPECT_NEAR(std::log(desk[i].rotation_deg / measured_deg[i]), 0.0, std::log(1.25)) << i;
    EXPECT_NEAR(std::log(calibrated[i].translation_m * 1e3 / measured_mm[i]), 0.0, std::log(1.3))
        << i;
  }
}

TEST(FitGrowth, FindsTheTermsOfAnExactGrowth) {
  const CorrelationTimes times = {0.5, 10.0};
  const GrowthTerms declared = {0.003, 0.01, 0.002, 0.001, 0.0};
  std::vector<Growth> growth;
  for (double lag_s = 1.0 / 30.0; lag_s < 60.0; lag_s *= 1.6) {
    growth.push_back({lag_s, GrowthOf(declared, times, lag_s), 1.0});
  }
  const GrowthTerms fitted = FitGrowth(growth, times, 0.0);
  EXPECT_NEAR(fitted.jitter, declared.jitter, 1e-6);
  EXPECT_NEAR(fitted.bias, declared.bias, 1e-6);
  EXPECT_NEAR(fitted.walk, declared.walk, 1e-6);
  EXPECT_NEAR(fitted.drift, declared.drift, 1e-6);
  const GrowthTerms less = FitGrowth(growth, times, 0.001 * 0.001);
  EXPECT_NEAR(less.walk, 0.001 * std::sqrt(3.0), 1e-6);
}

// A file's quaternions are rounded: what is left of turns without an error explains no shift.
TEST(FitSlamErrors, RoundedTurnsAreNoPivot) {
  SlamOptions given;
  given.walk_translation_m = 0.02;
  std::vector<SlamRun> runs = Runs(given, 2, 100.0);
  RandomStream random(5, RandomStage::kTest, 0);
  for (SlamRun& run : runs) {
    for (auto& posed : run.estimate) {
      const Eigen::Vector3d rounding(random.Normal(), random.Normal(), random.Normal());
      posed.world_from_camera.rotation =
          posed.world_from_camera.rotation * ExpRotation(1e-15 * rounding);
    }
  }
  const SlamFit fit = FitSlamErrors(runs);
  EXPECT_EQ(fit.options.pivot_m, 0.0);
  ExpectWalk(fit.options, 0.02);
}

TEST(FitSlamErrors, OfExactRotationFindsTranslation) {
  SlamOptions given;
  given.walk_translation_m = 0.02;
  const std::vector<SlamRun> runs = RunsOf(AheadAt(StampsS(3000)), given);
  for (const auto& posed : runs[0].estimate) {
    ASSERT_EQ(posed.world_from_camera.rotation.vec().norm(), 0.0);
  }
  const SlamOptions fitted = FitSlamErrors(runs).options;
  ExpectWalk(fitted, 0.02);
  EXPECT_EQ(TurnedDeg(fitted, 1.0), 0.0);
  EXPECT_EQ(fitted.tilt_share, 1.0);  // nothing is known of it
}

// The camera stands still and upright, so that its turns about z are the world's.
TEST(FitSlamErrors, OfYawAloneFindsNoTilt) {
  std::vector<SlamRun> runs;
  for (int seed = 0; seed < 10; ++seed) {
    SlamRun run;
    RandomStream random(5, RandomStage::kTest, static_cast<std::uint64_t>(seed));
    double yaw_rad = 0.0;
    for (const double stamp_s : StampsS(3000)) {
      const Eigen::Quaterniond turn(std::cos(yaw_rad / 2.0), 0.0, 0.0, std::sin(yaw_rad / 2.0));
      run.truth.push_back({stamp_s, {}});
      run.estimate.push_back({stamp_s, {turn, Eigen::Vector3d::Zero()}});
      yaw_rad += RadFromDeg(0.5) * std::sqrt(1.0 / 30.0) * random.Normal();
    }
    runs.push_back(run);
  }
  const SlamOptions fitted = FitSlamErrors(runs).options;
  EXPECT_EQ(fitted.tilt_share, 0.0);
  EXPECT_EQ(WalkedM(fitted, 1.0), 0.0);
  for (const double lag_s : {0.1, 1.0, 5.0}) {
    EXPECT_NEAR(TurnedDeg(fitted, lag_s) / (0.5 * std::sqrt(lag_s)), 1.0, 0.15) << lag_s;
  }
}

TEST(FitSlamErrors, ErrorsGrowWithTimeWhateverTheStampsAre) {
  SlamOptions given;
  given.walk_translation_m = 0.02;
  std::vector<double> jittered_s = StampsS(3000);
  RandomStream random(5, RandomStage::kTest, 0);
  for (double& stamp_s : jittered_s) stamp_s += 0.012 * (random.Uniform() - 0.5);
  ExpectWalk(FitSlamErrors(RunsOf(AheadAt(jittered_s), given)).options, 0.02);
  std::vector<double> one_odd_s = StampsS(3000);
  one_odd_s.insert(one_odd_s.begin() + 1001, one_odd_s[1000] + 0.002);
  ExpectWalk(FitSlamErrors(RunsOf(AheadAt(one_odd_s), given)).options, 0.02);
  std::vector<double> gaps_s = StampsS(3000);
  std::erase_if(gaps_s, [](double stamp_s) { return std::fmod(stamp_s, 20.0) > 19.0; });
  ExpectWalk(FitSlamErrors(RunsOf(AheadAt(gaps_s), given)).options, 0.02);
}

// A recorder that skips every other frame for a while, at most 1.5 usual steps being no gap.
TEST(MeasureGrowth, LagsLastTheMeanTimeOfTheirPairs) {
  ErrorTrack track;
  for (const double stamp_s : {0.0, 1.0, 1.5, 2.5, 3.0, 4.0, 4.5}) {
    track.push_back({stamp_s, {2.0 * stamp_s, 0.0, 0.0}});
  }
  const std::vector<Growth> growth = MeasureGrowth({track}, 1);
  ASSERT_EQ(growth.size(), 2U);
  EXPECT_DOUBLE_EQ(growth[0].lag_s, 0.75);
  EXPECT_DOUBLE_EQ(growth[0].mean_square, 4.0 * (1.0 + 0.25) / 2.0);
  EXPECT_DOUBLE_EQ(growth[0].weight, 6.0);
  EXPECT_DOUBLE_EQ(growth[1].lag_s, 1.5);
  EXPECT_DOUBLE_EQ(growth[1].mean_square, 9.0);
}

TEST(FitSlamErrors, FindsWhatTheSurrogateWasGiven) {
  SlamOptions given;
  given.pivot_m = 1.9;
  given.tilt_share = 0.4;
  given.jitter_translation_m = 0.0006;
  given.jitter_rotation_deg = 0.05;
  given.walk_translation_m = 0.004;
  given.walk_rotation_deg = 0.1;
  given.jump_rate_hz = 0.2;
  given.jump_translation_m = 0.02;
  given.jump_rotation_deg = 0.8;
  given.lost_rate_hz = 0.05;
  given.lost_mean_s = 1.5;
  given.relocalisation_translation_m = 0.05;
  given.relocalisation_rotation_deg = 2.0;
  const SlamFit fit = FitSlamErrors(Runs(given, 12, 100.0));
  EXPECT_NEAR(fit.options.pivot_m, 1.9, 0.1);
  EXPECT_GT(fit.pivot_explains, 0.8);
  EXPECT_NEAR(fit.options.tilt_share, 0.4, 0.08);
  EXPECT_NEAR(fit.options.jitter_translation_m / given.jitter_translation_m, 1.0, 0.15);
  // Single motions too small to be told from jitter are missed, large jitter is taken for a jump.
  EXPECT_NEAR(fit.options.jump_rate_hz / given.jump_rate_hz, 1.0, 0.25);
  EXPECT_NEAR(fit.options.jump_translation_m / given.jump_translation_m, 1.0, 0.25);
  EXPECT_NEAR(fit.options.jump_rotation_deg / given.jump_rotation_deg, 1.0, 0.25);
  EXPECT_NEAR(fit.options.lost_rate_hz / given.lost_rate_hz, 1.0, 0.3);
  EXPECT_NEAR(fit.options.lost_mean_s / given.lost_mean_s, 1.0, 0.3);
  // Walk, bias and drift can stand in for one another: what counts is how errors grow.
  const std::vector<double> lags_s = {1.0 / 30.0, 0.1, 1.0, 10.0, 30.0};
  const auto before = ErrorOverLag(Runs(given, 12, 100.0), lags_s);
  const auto after = ErrorOverLag(Runs(fit.options, 12, 100.0), lags_s);
  for (std::size_t i = 0; i < lags_s.size(); ++i) {
    EXPECT_NEAR(std::log(after[i].translation_m / before[i].translation_m), 0.0, std::log(1.3));
    EXPECT_NEAR(std::log(after[i].rotation_deg / before[i].rotation_deg), 0.0, std::log(1.3));
  }
}

TEST(FitSlamErrors, LeavesCorrectionsOut) {
  SlamOptions given = ProfileOptions(SlamProfile::kOrbSlam2);
  given.drift_scale = 10.0;
  const SlamRun run = Disturbed(RoundADesk(54.0), given, 3);
  const auto events = FindEvents(run);
  int corrections = 0;
  for (const RunEvent& event : events) corrections += event.correction ? 1 : 0;
  EXPECT_EQ(corrections, 1);
  EXPECT_EQ(FitSlamErrors({run}).corrections, 1);
  // The motion that brings the estimate back is in neither stretch.
  const std::vector<SlamRun> stretches = BetweenCorrections(run);
  ASSERT_EQ(stretches.size(), 2U);
  const SlamRun& before = stretches[0];
  const SlamRun& after = stretches[1];
  EXPECT_EQ(before.truth.size() + after.truth.size(), run.truth.size());
  EXPECT_EQ(before.estimate.back().stamp_s, before.truth.back().stamp_s);
  const std::size_t to = before.truth.size();
  EXPECT_EQ(after.truth.front().stamp_s, run.truth[to].stamp_s);
  const std::vector<double> frame_s = {1.0 / 30.0};
  const double step_m = MotionError(run, to - 1, to).translation.norm();
  const double whole_m = ErrorOverLag({run}, frame_s)[0].translation_m;
  const LagError apart = ErrorOverLag(stretches, frame_s)[0];
  EXPECT_NEAR(whole_m * whole_m * (apart.pairs + 1),
              apart.translation_m * apart.translation_m * apart.pairs + step_m * step_m, 1e-9);
}

// With a median error of nothing, five times as much is nothing too.
TEST(FindEvents, WhatAFileRoundsIsNoJump) {
  SlamRun run{RoundADesk(10.0), RoundADesk(10.0)};
  for (std::size_t i = 0; i < run.estimate.size(); i += 5) {  // the last decimal of a TUM file
    run.estimate[i].world_from_camera.translation.x() += 1e-4;
  }
  EXPECT_TRUE(FindEvents(run).empty());
  // A centimetre is one, however well all else is known.
  for (std::size_t i = 100; i < run.estimate.size(); ++i) {
    run.estimate[i].world_from_camera.translation.y() += 0.01;
  }
  const auto events = FindEvents(run);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].from, 99U);
  EXPECT_EQ(events[0].to, 100U);
}

TEST(BetweenCorrections, AreAllOfARunWithoutAny) {
  const Trajectory truth = RoundADesk(2.0);
  const std::vector<SlamRun> stretches = BetweenCorrections({truth, truth});
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_EQ(stretches[0].truth.size(), truth.size());
}

// Every two seconds the estimate is 4 cm beside itself for three frames: nothing of it is left when
// the jump is over, and it is most of the error from frame to frame.
TEST(FitSlamErrors, SwingsOfAJumpAreNoise) {
  SlamOptions calm;
  calm.jitter_translation_m = 0.0006;
  calm.jitter_rotation_deg = 0.02;
  SlamRun run = Disturbed(RoundADesk(60.0), calm, 1);
  for (std::size_t i = 30; i < run.estimate.size(); ++i) {
    if (i % 60 >= 3) continue;
    Pose3& pose = run.estimate[i].world_from_camera;
    pose.translation += pose.rotation * Eigen::Vector3d(0.04, 0.0, 0.0);
  }
  const SlamFit fit = FitSlamErrors({run});
  EXPECT_EQ(fit.jumps, 30);
  const std::vector<double> lags_s = {1.0 / 30.0, 0.1, 1.0};
  const auto of_run = ErrorOverLag({run}, lags_s);
  const auto of_fit = ErrorOverLag(Runs(fit.options, 5, 60.0), lags_s);
  for (std::size_t i = 0; i < lags_s.size(); ++i) {
    EXPECT_NEAR(std::log(of_fit[i].translation_m / of_run[i].translation_m), 0.0, std::log(1.3))
        << lags_s[i];
  }
}

TEST(FitSlamErrors, RefusesTooLittle) {
  const Trajectory truth = RoundADesk(1.0);
  EXPECT_THROW(FitSlamErrors({{truth, truth}}), InputError);
}

TEST(FitSlamErrors, OfAPerfectRunIsZero) {
  const Trajectory truth = RoundADesk(20.0);
  const SlamFit fit = FitSlamErrors({{truth, truth}});
  EXPECT_EQ(fit.jumps, 0);
  EXPECT_LT(WalkedM(fit.options, 1.0), 1e-12);
  EXPECT_LT(TurnedDeg(fit.options, 1.0), 1e-10);
  // Beside a run of some error, which is found: its square is the mean of both.
  SlamOptions given;
  given.jitter_translation_m = 0.001;
  const SlamFit halved = FitSlamErrors({{truth, truth}, Disturbed(truth, given, 1)});
  EXPECT_NEAR(halved.options.jitter_translation_m, 0.001 / std::sqrt(2.0), 0.00005);
}

TEST(CalibrateDrift, ReachesItsTargetOnOtherSeedsToo) {
  const Trajectory truth = RoundADesk(20.0);
  for (const SlamProfile profile : {SlamProfile::kOrbSlam2, SlamProfile::kPlanarSlamMh}) {
    SlamOptions options = ProfileOptions(profile);
    const DriftCalibration found = CalibrateDrift(truth, options, 0.3, {1, 60});
    EXPECT_TRUE(found.reached);
    EXPECT_NEAR(found.mean_error_m, 0.3, 0.0003);
    options.drift_scale = found.drift_scale;
    EXPECT_EQ(MeanLiveErrorM(truth, options, {1, 60}), found.mean_error_m);
    // Two means of 60 seeds, each with a spread of about 0.5 of the mean: 3 standard errors.
    EXPECT_NEAR(MeanLiveErrorM(truth, options, {1001, 60}), 0.3,
                0.3 * 3 * 0.5 * std::sqrt(2.0 / 60.0));
  }
}

TEST(CalibrateDrift, FramesWithoutAPoseHaveNoError) {
  const Trajectory truth = RoundADesk(20.0);
  SlamOptions options;
  options.drift_speed_mps = 0.01;
  options.lost_rate_hz = 0.2;
  const SlamOutput output = DisturbTrajectory(truth, options, 4);
  double sum_m = 0.0;
  int posed = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& pose = output.live[i].slam_from_camera;
    if (!pose) continue;
    sum_m += (pose->translation - truth[i].world_from_camera.translation).head<2>().norm();
    ++posed;
  }
  ASSERT_LT(posed, static_cast<int>(truth.size()) - 20);
  EXPECT_NEAR(MeanLiveErrorM(truth, options, {4, 1}), sum_m / posed, 1e-12);
}

TEST(CalibrateDrift, SaysWhenItCannot) {
  SlamOptions options = ProfileOptions(SlamProfile::kOrbSlam2);
  options.bias_translation_m = 0.5;
  EXPECT_FALSE(CalibrateDrift(RoundADesk(5.0), options, 0.01, {1, 5}).reached);
  EXPECT_FALSE(CalibrateDrift(RoundADesk(5.0), {}, 0.01, {1, 2}).reached);
}

}  // namespace
}  // namespace depthgrid
