#include "eval/doubts/floor_check.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// Ten depth images over a floor that was taken to lie at each of `used_z_m`.
MappingRun RunOver(const std::vector<double>& used_z_m) {
  MappingRun run;
  for (const double z_m : used_z_m) {
    for (int i = 0; i < 10; ++i) {
      FrameReport report;
      report.slam_from_camera = CameraOf({}, 1.8);
      report.stand = StandOf(*report.slam_from_camera, z_m);
      run.reports.push_back(report);
    }
  }
  return run;
}

TEST(MapsFloor, WhereItIsHigherThanTakenAndStaysSo) {
  const ScanOptions options;
  EXPECT_TRUE(MapsFloor(RunOver({0.0}), 0.6, options));
  EXPECT_TRUE(MapsFloor(RunOver({0.02, 0.1, 0.6}), 0.6, options));
  EXPECT_TRUE(MapsFloor(RunOver({0.0, 0.6, 0.6, 0.6}), 0.6, options));  // what was drawn stays
  EXPECT_FALSE(MapsFloor(RunOver({0.6}), 0.6, options));                // found at once
  EXPECT_FALSE(MapsFloor(RunOver({0.3}), 0.3, options));
  EXPECT_FALSE(MapsFloor(RunOver({0.0}), -1.2, options));       // of a cellar; the run is above
  EXPECT_FALSE(MapsFloor(RunOver({-3.0, 3.0}), 3.0, options));  // storeys below and above
}

TEST(MapsFloor, PosesThatAreBelievedMendNothing) {
  ScanOptions options;
  EXPECT_FALSE(MapsFloor(RunOver({0.0}), 0.2, options));
  options.floor = FloorSource::kPose;
  EXPECT_TRUE(MapsFloor(RunOver({0.0}), 0.2, options));
  options.floor_z_m = 0.2;
  EXPECT_FALSE(MapsFloor(RunOver({0.2}), 0.2, options));
}

TEST(MapsFloor, NothingIsSaidOfARunWithoutImages) {
  EXPECT_FALSE(MapsFloor(MappingRun(), 0.6, ScanOptions()));
}

}  // namespace
}  // namespace depthgrid
