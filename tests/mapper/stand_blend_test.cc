#include "mapper/scan/stand_blend.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

constexpr double kFloorZM = 0.3;
constexpr int kStandFrames = 200;

// How a frame truly is, and what is said of it.
struct Said {
  Pose3 truth;
  Pose3 slam;
  CameraStand floor;
};

// The floor errs by a few millimetres and hundredths of a degree, SLAM's height by up to `rise_m`
// and its tilt by up to `lean_rad`, more and more.
std::vector<Said> WalkOf(double rise_m, double lean_rad) {
  RandomStream random(6, RandomStage::kTest);
  std::vector<Said> frames;
  for (int i = 0; i < kStandFrames; ++i) {
    const double share = static_cast<double>(i) / (kStandFrames - 1);
    Said said;
    said.truth = TiltedCamera({share, -share, 3.0 * share}, kFloorZM + 1.2, 0.2 + 0.1 * share, 0.1);
    said.slam = said.truth;
    said.slam.translation.z() += share * rise_m;
    said.slam.rotation = ExpRotation({share * lean_rad, 0.0, 0.0}) * said.slam.rotation;
    said.floor = {ExpRotation({0.001 * random.Normal(), 0.001 * random.Normal(), 0.0}) *
                      LevelFromCamera(said.truth),
                  1.2 + 0.003 * random.Normal()};
    frames.push_back(said);
  }
  return frames;
}

// Largest errors over the walk, once all of it is known.
struct StandErrors {
  double height_m = 0.0;
  double tilt_rad = 0.0;
  double slams_own = 0.0;  // share of the poses that are SLAM's, bit for bit
};

StandErrors ErrorsOf(const std::vector<Said>& frames) {
  StandBlend blend(kFloorZM);
  for (const Said& said : frames) blend.Add(said.slam, said.floor);
  StandErrors errors;
  for (const Said& said : frames) {
    const Pose3 placed = blend.Placed(said.slam, said.floor);
    const Pose2 base = BaseOf(placed), slam_base = BaseOf(said.slam);
    EXPECT_EQ(base.translation(), slam_base.translation());
    EXPECT_NEAR(WrapAngle(base.yaw_rad - slam_base.yaw_rad), 0.0, 1e-12);
    const Eigen::Vector3d up = LevelFromCamera(placed) *
                               (LevelFromCamera(said.truth).conjugate() * Eigen::Vector3d::UnitZ());
    errors.tilt_rad = std::max(errors.tilt_rad, up.head<2>().norm());
    errors.height_m =
        std::max(errors.height_m, std::abs(placed.translation.z() - said.truth.translation.z()));
    errors.slams_own += (placed == said.slam ? 1.0 : 0.0) / kStandFrames;
  }
  return errors;
}

TEST(StandBlend, TheFloorOutweighsDrift) {
  const StandErrors errors = ErrorsOf(WalkOf(0.5, 0.06));
  EXPECT_LT(errors.height_m, 0.02);
  EXPECT_LT(errors.tilt_rad, 0.006);
  EXPECT_EQ(errors.slams_own, 0.0);
}

TEST(StandBlend, PosesAsGoodAsTheFloorStayAsTheyAre) {
  const StandErrors errors = ErrorsOf(WalkOf(0.02, 0.005));
  EXPECT_NEAR(errors.slams_own, 1.0, 1e-9);
}

TEST(StandBlend, HeightAndTiltAreJudgedApart) {
  const StandErrors rises = ErrorsOf(WalkOf(0.5, 0.0));
  EXPECT_LT(rises.height_m, 0.02);
  EXPECT_LT(rises.tilt_rad, 1e-9);
  const StandErrors leans = ErrorsOf(WalkOf(0.0, 0.06));
  EXPECT_EQ(leans.height_m, 0.0);
  EXPECT_LT(leans.tilt_rad, 0.006);
}

// A frame that says otherwise is not enough against the three seconds before, in which the floor's
// own errors add up to 0.19 m; so many that say so are.
TEST(StandBlend, SlamIsRightAtFirst) {
  Said said = WalkOf(0.0, 0.0).back();
  said.slam.translation.z() += 0.1;
  StandBlend blend(kFloorZM);
  for (int i = 0; i < 3; ++i) blend.Add(said.slam, said.floor);
  EXPECT_EQ(blend.Placed(said.slam, said.floor).translation.z(), said.slam.translation.z());
  for (int i = 0; i < 30; ++i) blend.Add(said.slam, said.floor);
  EXPECT_LT(blend.Placed(said.slam, said.floor).translation.z(), said.slam.translation.z() - 0.05);
}

TEST(StandBlend, BeforeAnythingIsKnownThePoseCounts) {
  const Said said = WalkOf(0.5, 0.06).back();
  EXPECT_EQ(StandBlend(kFloorZM).Placed(said.slam, said.floor), said.slam);
}

}  // namespace
}  // namespace depthgrid
