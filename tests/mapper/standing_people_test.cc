// A robot that stands in a hall of which it sees one wall, and people who come up to it and leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/localised_run.h"

namespace depthgrid {
namespace {

constexpr double kRateHz = 30.0;
constexpr int kStopsAt = 240;
constexpr double kStaysS = 10.0;

struct Visitor {
  double bearing_rad = 0.0;
  double nearest_m = 0.0;
  double comes_s = 0.0;
  double speed_mps = 0.0;

  // Metres before the robot, which stopped so long ago.
  double Distance(double standing_s) const {
    const double leaves_s = comes_s + kStaysS;
    if (standing_s > leaves_s) return nearest_m + speed_mps * (standing_s - leaves_s);
    return std::max(3.0 - speed_mps * (standing_s - comes_s), nearest_m);
  }
};

PlanarWorld HallWith(const std::vector<Visitor>& visitors, const Pose2& robot, double standing_s) {
  PlanarWorld world = RectangleWorld(-6.0, 0.0, 10.0, 9.0);
  AddRectangle(world, 2.0, 4.5, 2.4, 4.9);
  AddRectangle(world, 5.5, 1.0, 6.0, 1.6);
  for (const Visitor& visitor : visitors) {
    if (standing_s < visitor.comes_s) continue;
    const double distance_m = visitor.Distance(standing_s);
    const Eigen::Vector2d at = robot * Eigen::Vector2d(distance_m * std::cos(visitor.bearing_rad),
                                                       distance_m * std::sin(visitor.bearing_rad));
    AddRectangle(world, at.x() - 0.2, at.y() - 0.15, at.x() + 0.2, at.y() + 0.15);
  }
  return world;
}

// The worst error while the robot, whose odometry jitters in its last digits, stands for 30 s.
double WorstErrorAmong(const std::vector<Visitor>& visitors, std::uint32_t seed) {
  const PlanarLaser laser{
      .beams = 320, .field_of_view_rad = kPi, .max_range_m = 3.5, .sigma_of_range = 0.01};
  RandomStream random(seed, RandomStage::kTest);
  IncrementalMapper mapper({}, std::nullopt);
  double worst_m = 0.0;
  for (int i = 0; i < kStopsAt + static_cast<int>(30.0 * kRateHz); ++i) {
    const Pose2 truth = TourAt(60 + std::min(i, kStopsAt));
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / kRateHz;
    frame.slam_from_camera =
        CameraOf({truth.x_m + 1e-5 * random.Uniform(), truth.y_m, truth.yaw_rad}, 1.0);
    const PlanarWorld world = HallWith(visitors, truth, (i - kStopsAt) / kRateHz);
    frame.scan = std::make_shared<const Scan>(
        ScanOf(world, truth, laser, 4, static_cast<std::uint32_t>(i) + 1000 * seed));
    const FrameReport report = mapper.AddFrame(frame);
    const Pose2 off = Between(truth, BaseOf(report.map_from_camera.value()));
    worst_m = std::max(worst_m, off.translation().norm());
  }
  return worst_m;
}

// Both leave towards the side that the one wall in view does not hold.
TEST(StandingAmongPeople, IsNotLedAwayWhenTheyLeave) {
  const std::vector<Visitor> visitors = {
      {.bearing_rad = -0.94, .nearest_m = 0.92, .comes_s = 2.73, .speed_mps = 1.57},
      {.bearing_rad = -0.14, .nearest_m = 0.51, .comes_s = 2.24, .speed_mps = 1.25}};
  for (const std::uint32_t seed : {1U, 5U, 8U, 9U}) {
    EXPECT_LT(WorstErrorAmong(visitors, seed), 0.05) << seed;
  }
}

}  // namespace
}  // namespace depthgrid
