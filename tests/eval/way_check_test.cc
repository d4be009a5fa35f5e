#include "eval/doubts/way_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// SLAM goes along x in steps of 0.1 m, the map's poses `scale` as far.
MappingRun Straight(int frames, double scale) {
  MappingRun run;
  for (int i = 0; i < frames; ++i) {
    FrameReport report;
    report.slam_from_camera = Pose3{};
    report.slam_from_camera->translation.x() = 0.1 * i;
    run.reports.push_back(report);
    Pose3 map = *report.slam_from_camera;
    map.translation.x() *= scale;
    map.translation.z() = 0.3 * i;  // heights are SLAM's, whatever it is worth
    run.result.map_from_camera.emplace_back(map);
  }
  return run;
}

// The map says that a laser drives along a circle of 1 m radius for `turn_rad`; SLAM's poses are
// what `slam_of` makes of that.
template <typename SlamOf>
MappingRun Circle(double turn_rad, SlamOf slam_of) {
  MappingRun run;
  constexpr int kFrames = 120;
  for (int i = 0; i <= kFrames; ++i) {
    const double at_rad = turn_rad * i / kFrames;
    const Pose2 map = {std::sin(at_rad), 1.0 - std::cos(at_rad), WrapAngle(at_rad)};
    FrameReport report;
    report.slam_from_camera = CameraOf(slam_of(map), 0.0);
    run.reports.push_back(report);
    run.result.map_from_camera.emplace_back(CameraOf(map, 0.0));
  }
  return run;
}

constexpr double kRoundRad = 2.0 * kPi;

TEST(WayCheck, TellsWhatMakesTwoWaysDiffer) {
  const auto same = [](const Pose2& p) { return p; };
  const auto elsewhere = [](const Pose2& p) { return Pose2{-3.0, 5.0, 2.0} * p; };
  const auto drifts = [](const Pose2& p) { return Pose2{1.2 * p.x_m, p.y_m, 0.9 * p.yaw_rad}; };
  EXPECT_FALSE(WayDoubt(Circle(kRoundRad, same)));
  EXPECT_FALSE(WayDoubt(Circle(kRoundRad, elsewhere)));
  EXPECT_FALSE(WayDoubt(Circle(kPi, drifts)));
  const auto mirrored = [](const Pose2& p) { return Pose2{p.x_m, -p.y_m, -p.yaw_rad}; };
  EXPECT_EQ(WayDoubt(Circle(kRoundRad, mirrored)), WayFault::kMirroredScans);
  const auto turned_back = [](const Pose2& p) { return Pose2{p.x_m, p.y_m, -p.yaw_rad}; };
  EXPECT_EQ(WayDoubt(Circle(kRoundRad, turned_back)), WayFault::kTurns);
  const auto swapped = [](const Pose2& p) { return Pose2{p.y_m, p.x_m, p.yaw_rad}; };
  EXPECT_EQ(WayDoubt(Circle(kRoundRad, swapped)), WayFault::kDirections);
  const auto from_y = [](const Pose2& p) { return Pose2{p.x_m, p.y_m, p.yaw_rad - 0.5 * kPi}; };
  EXPECT_EQ(WayDoubt(Circle(kRoundRad, from_y)), WayFault::kDirections);
}

// On the spot, SLAM by 0.1 rad a frame.
MappingRun OnTheSpot(int frames, double scale) {
  MappingRun run;
  for (int i = 0; i < frames; ++i) {
    FrameReport report;
    report.slam_from_camera = CameraOf({0.0, 0.0, 0.1 * i}, 0.0);
    run.reports.push_back(report);
    run.result.map_from_camera.emplace_back(CameraOf({0.0, 0.0, 0.1 * scale * i}, 0.0));
  }
  return run;
}

TEST(WayCheck, TellsTheScaleOfTurns) {
  for (const double scale : {0.9, 1.0, 1.1}) EXPECT_FALSE(TurnScaleDoubt(OnTheSpot(100, scale)));
  for (const double scale : {0.5, 0.8, 1.25, 2.0}) {
    const auto told = TurnScaleDoubt(OnTheSpot(100, scale));
    ASSERT_TRUE(told) << scale;
    EXPECT_NEAR(*told, scale, 1e-9);
    EXPECT_FALSE(TurnScaleDoubt(OnTheSpot(15, scale))) << scale;  // less than half a turn
  }
  EXPECT_FALSE(TurnScaleDoubt(MappingRun{}));
}

// Noise in the odometry's headings flattens the slope over them to 0.85, of a right scale too.
TEST(WayCheck, NoiseOfHeadingsIsNoOtherScale) {
  const auto noisy = [](double scale) {
    MappingRun run = OnTheSpot(400, scale);
    RandomStream random(1, RandomStage::kTest);
    for (FrameReport& report : run.reports) {
      const double yaw_rad = BaseOf(*report.slam_from_camera).yaw_rad + 0.12 * random.Normal();
      report.slam_from_camera = CameraOf({0.0, 0.0, yaw_rad}, 0.0);
    }
    return run;
  };
  EXPECT_FALSE(TurnScaleDoubt(noisy(1.0)));
  for (const double scale : {0.5, 2.0}) {
    const auto told = TurnScaleDoubt(noisy(scale));
    ASSERT_TRUE(told) << scale;
    EXPECT_NEAR(*told, scale, 0.2 * scale);
  }
}

TEST(WayCheck, TellsNothingOfAShortWay) {
  const auto mirrored = [](const Pose2& p) { return Pose2{p.x_m, -p.y_m, -p.yaw_rad}; };
  EXPECT_FALSE(WayDoubt(Circle(0.2 * kPi, mirrored)));
  EXPECT_FALSE(WayDoubt(MappingRun{}));
}

TEST(WayCheck, TurnsAloneTellOfMirroredScans) {
  EXPECT_EQ(WayDoubt(OnTheSpot(100, -1.0)), WayFault::kMirroredScans);
}

TEST(WayCheck, AddsUpStretches) {
  const Ways ways = WaysOf(Straight(41, 0.5));
  EXPECT_NEAR(ways.slam_m, 4.0, 0.11);
  EXPECT_NEAR(ways.map_m, 0.5 * ways.slam_m, 1e-12);
}

TEST(WayCheck, TakesNoStretchAcrossACorrectionOrALoss) {
  MappingRun run = Straight(41, 1.0);
  for (std::size_t i = 20; i < 41; ++i) {
    run.reports[i].slam_epoch = 1;
    run.reports[i].slam_from_camera->translation.x() += 10.0;
  }
  run.reports[32].slam_from_camera.reset();
  run.result.map_from_camera[35].reset();
  const Ways ways = WaysOf(run);
  EXPECT_NEAR(ways.slam_m, ways.map_m, 1e-9);
  EXPECT_GT(ways.slam_m, 2.0);
  EXPECT_LT(ways.slam_m, 4.0);
}

// Wheels that are counted from zero again, without a word: none drove back in one step.
TEST(WayCheck, TakesNoStretchAcrossPosesThatBeginAnew) {
  MappingRun run = Straight(81, 1.0);
  for (std::size_t i = 0; i < 81; ++i) {
    run.reports[i].stamp_s = 0.1 * static_cast<double>(i);
    if (i >= 50) run.reports[i].slam_from_camera->translation.x() -= 5.0;
  }
  const Ways ways = WaysOf(run);
  EXPECT_NEAR(ways.slam_m, ways.map_m, 1e-9);
  EXPECT_GT(ways.slam_m, 6.0);
  EXPECT_FALSE(ScaleDoubt(run));
  EXPECT_FALSE(WayDoubt(run));
}

// After a pause of the log SLAM's step does not hold, and the mapper guesses.
TEST(WayCheck, TakesNoStretchToAPlaceThatWasGuessed) {
  MappingRun run = Straight(60, 1.0);
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    FrameReport& report = run.reports[i];
    report.stamp_s = 0.1 * static_cast<double>(i) + (i >= 30 ? 10.0 : 0.0);
    report.guessed = i >= 30 && i < 45;
    if (i >= 30) report.slam_from_camera->translation.y() = 25.0;
  }
  EXPECT_NEAR(WaysOf(run).slam_m, WaysOf(run).map_m, 1e-9);
  EXPECT_FALSE(ScaleDoubt(run));
  EXPECT_FALSE(WayDoubt(run));
}

TEST(WayCheck, DoubtsEitherScale) {
  EXPECT_FALSE(ScaleDoubt(Straight(60, 1.0)));
  EXPECT_FALSE(ScaleDoubt(Straight(60, 1.25)));
  EXPECT_FALSE(ScaleDoubt(Straight(60, 0.8)));
  EXPECT_TRUE(ScaleDoubt(Straight(60, 1.35)));
  EXPECT_TRUE(ScaleDoubt(Straight(60, 0.7)));
  EXPECT_TRUE(ScaleDoubt(Straight(60, 0.0)));
  EXPECT_FALSE(ScaleDoubt(Straight(15, 0.2)));  // too short to tell
  EXPECT_FALSE(ScaleDoubt(MappingRun{}));
}

}  // namespace
}  // namespace depthgrid
