// Odometry that is not read when the scan is taken.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr double kStepS = 0.25;
constexpr double kSpeedMps = 1.2;

void AddRoundPillar(const Eigen::Vector2d& at_m, double radius_m, PlanarWorld& world) {
  constexpr int kSides = 12;
  const auto corner = [&](int i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kSides;
    return Eigen::Vector2d(at_m +
                           radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  };
  for (int i = 0; i < kSides; ++i) world.push_back({corner(i), corner(i + 1)});
}

PlanarWorld HallOfPillars() {
  PlanarWorld world = RectangleWorld(-11.0, -8.0, 11.0, 8.0);
  for (int i = -2; i <= 2; ++i) {
    AddRoundPillar({4.0 * i, 5.5}, 0.3, world);
    AddRoundPillar({4.0 * i + 0.5, -5.5}, 0.25, world);
  }
  for (const Wall& wall : RectangleWorld(-5.0, -1.0, 5.0, 1.0)) world.push_back(wall);
  return world;
}

// Round the block in the middle of the hall.
Pose2 RoundTheBlockAt(double t_s) {
  const double a = kSpeedMps * t_s / 5.5;
  const double x = 7.0 * std::cos(a), y = 3.5 * std::sin(a);
  return {x, y, std::atan2(3.5 * std::cos(a), -7.0 * std::sin(a))};
}

struct LateErrors {
  double online_m = 0.0, final_m = 0.0;
};

// By a laser all round the front, with a beam a degree.
LateErrors MapLate(double late_s, std::uint64_t seed) {
  constexpr int kFrames = 240;
  const PlanarLaser laser{.beams = 180,
                          .field_of_view_rad = RadFromDeg(180.0),
                          .min_range_m = 0.1,
                          .max_range_m = 30.0,
                          .sigma_of_range = 0.003};
  const PlanarWorld world = HallOfPillars();
  const Pose2 first = RoundTheBlockAt(0.0);
  const auto true_at = [&](double t_s) { return Between(first, RoundTheBlockAt(t_s)); };
  IncrementalMapper mapper({}, std::nullopt);
  RandomStream random(seed, RandomStage::kTest);
  LateErrors errors;
  for (int k = 0; k < kFrames; ++k) {
    Frame frame;
    frame.index = k;
    frame.stamp_s = k * kStepS;
    frame.scan = std::make_shared<const Scan>(
        ScanOf(world, RoundTheBlockAt(frame.stamp_s), laser, seed, static_cast<std::uint32_t>(k)));
    const double read_at_s = k == 0 ? 0.0 : frame.stamp_s + late_s * random.Normal();
    frame.slam_from_camera = CameraOf(true_at(read_at_s), 0.0);
    const FrameReport report = mapper.AddFrame(frame);
    const Pose2 off = Between(true_at(frame.stamp_s), BaseOf(*report.map_from_camera));
    errors.online_m += off.translation().norm() / kFrames;
  }
  const MapperResult result = mapper.Finish();
  for (int k = 0; k < kFrames; ++k) {
    const Pose3& found = *result.map_from_camera[static_cast<std::size_t>(k)];
    errors.final_m += Between(true_at(k * kStepS), BaseOf(found)).translation().norm() / kFrames;
  }
  return errors;
}

// Read .15 s early or late, poses are up to half a metre and 20 degrees off, each by itself.
// Without a match where the motion went on the third run ended .7 m off.
TEST(LatePoses, AreMatchedWhereTheMotionWentOn) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const LateErrors errors = MapLate(0.15, seed);
    EXPECT_LT(errors.online_m, 0.25) << seed;
    EXPECT_LT(errors.final_m, 0.03) << seed;
  }
}

}  // namespace
}  // namespace depthgrid
