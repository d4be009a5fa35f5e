// A whole storey by a 180-beam laser through the program: a ROBOTLASER1 log whose odometry drifts,
// scored against the truth.
#include <gmock/gmock.h>

#include "mapper/io/carmen_line.h"
#include "mapper/io/trajectory_file.h"
#include "sim/laser/laser_world.h"
#include "sim/laser/odometry_noise.h"
#include "tests/eval/program.h"
#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

void AddBox(const Eigen::Vector2d& low, const Eigen::Vector2d& high, LaserWorld& world) {
  const Eigen::Vector2d corners[] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  for (int i = 0; i < 4; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 4]});
}

// A ring corridor 3 m wide round a block, with cupboards that no two places share.
LaserWorld Storey() {
  LaserWorld world;
  AddBox({0.0, 0.0}, {16.0, 11.0}, world);
  AddBox({3.0, 3.0}, {13.0, 8.0}, world);
  AddBox({5.0, 0.0}, {6.0, 0.6}, world);
  AddBox({15.2, 4.0}, {16.0, 6.5}, world);
  AddBox({8.5, 10.3}, {9.0, 11.0}, world);
  AddBox({0.0, 6.0}, {0.5, 7.0}, world);
  return world;
}

// Once round and on into the second lap, turning on the spot at the corners.
std::vector<Pose2> Tour() {
  const Eigen::Vector2d corners[] = {{1.5, 1.5}, {14.5, 1.5}, {14.5, 9.5}, {1.5, 9.5}};
  std::vector<Pose2> poses;
  for (int side = 0; side < 5; ++side) {
    const Eigen::Vector2d& from = corners[side % 4];
    const Eigen::Vector2d along = corners[(side + 1) % 4] - from;
    const double yaw_rad = 0.5 * kPi * side;
    for (int k = 0; k < 9; ++k) {
      poses.push_back({from.x(), from.y(), WrapAngle(yaw_rad - 0.5 * kPi * (8 - k) / 9.0)});
    }
    for (double way_m = 0.1; way_m < along.norm(); way_m += 0.1) {
      const Eigen::Vector2d at = from + way_m * along.normalized();
      poses.push_back({at.x(), at.y(), WrapAngle(yaw_rad)});
    }
  }
  return poses;
}

double MeanErrorM(const std::vector<Pose2>& truth, const Trajectory& estimate) {
  EXPECT_EQ(truth.size(), estimate.size());
  double sum_m = 0.0;
  for (std::size_t i = 0; i < std::min(truth.size(), estimate.size()); ++i) {
    sum_m += (estimate[i].world_from_camera.translation.head<2>() - truth[i].translation()).norm();
  }
  return sum_m / static_cast<double>(truth.size());
}

class LaserBuilding : public ProgramTest {};

TEST_F(LaserBuilding, IsMappedFarBetterThanItsOdometry) {
  LaserOptions laser;
  laser.beams = 180;
  laser.field_of_view_deg = 180.0;
  laser.min_range_m = 0.1;
  laser.max_range_m = 30.0;
  laser.noise_relative = 0.003;
  OdometryOptions drift;
  drift.mean_error_m = 0.6;
  const LaserWorld world = Storey();
  const std::vector<Pose2> truth = Tour();
  const std::vector<Pose2> odometry = DisturbOdometry(truth, drift, 3);
  std::string log;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    CarmenScan scan;
    scan.stamp_s = 0.1 * static_cast<double>(k);
    scan.first_bearing_rad = laser.FirstBearingRad();
    scan.bearing_step_rad = laser.BearingStepRad();
    scan.max_range_m = 81.83;
    scan.range_m = DisturbScan(CastScan(world, truth[k], laser), laser, 3, static_cast<int>(k));
    scan.odom_from_laser = odometry[k];
    log += RobotLaserLine(scan) + "\n";
  }
  Write("storey.log", log);
  const Outcome outcome = Program("map storey.log -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("storey.log: CARMEN laser log, "));
  const auto error_m = [&](const char* file) {
    return MeanErrorM(truth, ReadTrajectory(Path(std::string("out/") + file)));
  };
  EXPECT_NEAR(error_m("trajectory_slam.txt"), 0.6, 1e-3);
  EXPECT_LT(error_m("trajectory_online.txt"), 0.05);
  EXPECT_LT(error_m("trajectory_est.txt"), 0.02);
}

}  // namespace
}  // namespace depthgrid
