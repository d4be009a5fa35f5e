#include "eval/way_check.h"

#include <gtest/gtest.h>

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
