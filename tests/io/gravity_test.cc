#include "mapper/io/gravity.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "mapper/io/find_up.h"
#include "mapper/io/world_up.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

constexpr double kHeightM = 1.3;

AnalyticRoom FurnishedRoom() {
  AnalyticRoom room;
  room.boxes = {{{1.2, -1.0, 0.0}, {2.4, 0.6, 0.45}}, {{-2.6, 0.8, 0.0}, {-1.4, 2.2, 0.75}}};
  return room;
}

// A dozen views turning round in a room, whose poses are told in a world turned by `turned_by` and
// rise by `drift_up_m` and tilt by `drift_tilt_rad` from the first to the last; before them
// `first_views` of the recording's first, which do not drift.
GravityFinder Views(const AnalyticRoom& room, const Eigen::Quaterniond& turned_by, double pitch_rad,
                    double noise, double drift_up_m = 0.0, double drift_tilt_rad = 0.0,
                    int first_views = 0) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  RandomStream random(8, RandomStage::kTest);
  GravityFinder finder;
  for (int i = -first_views; i < 12; ++i) {
    const Pose3 pose = TiltedCamera({0.3 * std::cos(i), 0.3 * std::sin(i), kPi * i / 6.0}, kHeightM,
                                    pitch_rad + 0.1 * std::sin(2.0 * i), 0.15 * std::cos(3.0 * i));
    DepthImage image = room.Render(camera, pose);
    for (float& z_m : image.z_m) z_m *= static_cast<float>(1.0 + noise * random.Normal());
    const double drifted = std::max(i, 0) / 11.0;
    const Eigen::Vector3d tilt(drift_tilt_rad * drifted, 0.0, 0.0);
    const Pose3 drift{ExpRotation(tilt), {0.0, 0.0, drift_up_m * drifted}};
    const Pose3 told = Pose3{turned_by, Eigen::Vector3d(4, 5, 6)} * drift * pose;
    i < 0 ? finder.AddFirst(image, camera, told) : finder.Add(image, camera, told);
  }
  return finder;
}

double AngleDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return DegFromRad(std::acos(std::min(1.0, a.dot(b))));
}

// Poses are not read beyond 10,000 km; bins over all of the height between would take gigabytes.
TEST(Gravity, PosesFarApartTakeNoMemory) {
  const auto identity = Eigen::Quaterniond::Identity();
  EXPECT_NO_THROW(Views(FurnishedRoom(), identity, 0.3, 0.0, 1e13).Find());
}

TEST(Gravity, FindsUpInAnyTurnedWorld) {
  RandomStream random(3, RandomStage::kTest);
  int cases = 0;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Quaterniond turned =
        i == 0 ? Eigen::Quaterniond::Identity()
        : i == 1
            ? Eigen::Quaterniond(Eigen::AngleAxisd(RadFromDeg(26.0), Eigen::Vector3d::UnitX()))
            : Eigen::Quaterniond(random.Normal(), random.Normal(), random.Normal(), random.Normal())
                  .normalized();
    const Eigen::Vector3d up = turned * Eigen::Vector3d::UnitZ();
    const auto gravity = Views(FurnishedRoom(), turned, 0.3, i % 2 == 0 ? 0.0 : 0.01).Find();
    ASSERT_TRUE(gravity) << i;
    EXPECT_LT(AngleDeg(gravity->up_in_world, up), 0.3) << i;
    EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.02) << i;
    EXPECT_FALSE(gravity->floor_is_late) << i;  // nothing drifts
    EXPECT_NEAR(gravity->floor_m, up.dot(Eigen::Vector3d(4, 5, 6)), 0.02) << i;
    ++cases;
  }
  EXPECT_EQ(cases, 12);
}

// A wall that stands beside the images' upper edge in some of them is no floor.
TEST(Gravity, PortraitImagesAreTakenAsTheWorldsZSays) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  const AnalyticRoom room = FurnishedRoom();
  for (const double roll_rad : {0.5 * kPi, -0.5 * kPi}) {
    GravityFinder finder;
    for (int i = 0; i < 12; ++i) {
      const Pose3 pose = TiltedCamera({0.3 * std::cos(i), 0.3 * std::sin(i), kPi * i / 6.0},
                                      kHeightM, 0.4, roll_rad);
      finder.Add(room.Render(camera, pose), camera, pose);
    }
    const auto gravity = finder.Find();
    ASSERT_TRUE(gravity);
    EXPECT_LT(AngleDeg(gravity->up_in_world, Eigen::Vector3d::UnitZ()), 0.3);
    EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.02);
  }
}

// Half a round, told in the axes of its first camera.
struct HalfRound {
  Pose3 told_from_true;
  GravityFinder finder;
};
HalfRound TurnedHalfRound(double pitch_rad, double roll_rad) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  HalfRound round;
  for (int i = 0; i < 12; ++i) {
    const Pose3 pose = TiltedCamera({0.3 * std::cos(i), 0.3 * std::sin(i), kPi * i / 12.0},
                                    kHeightM, pitch_rad, roll_rad);
    if (i == 0) round.told_from_true = Inverse(pose);
    round.finder.Add(FurnishedRoom().Render(camera, pose), camera, round.told_from_true * pose);
  }
  return round;
}

// Also in a world whose z lies level.
TEST(Gravity, PortraitImagesAreTakenAsTheCameraTurns) {
  for (const double roll_rad : {0.5 * kPi, -0.5 * kPi}) {
    const HalfRound round = TurnedHalfRound(0.2, roll_rad);
    const auto gravity = round.finder.Find();
    ASSERT_TRUE(gravity);
    const Eigen::Vector3d up = round.told_from_true.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT(AngleDeg(gravity->up_in_world, up), 0.3);
    EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.02);
  }
}

// The floor's normal is 72 degrees from the images' own up.
TEST(Gravity, ACameraThatLooksDownSteeplySeesTheFloor) {
  const HalfRound round = TurnedHalfRound(RadFromDeg(72.0), 0.0);
  const auto gravity = round.finder.Find();
  ASSERT_TRUE(gravity);
  const Eigen::Vector3d up = round.told_from_true.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT(AngleDeg(gravity->up_in_world, up), 0.3);
  EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.02);
}

// As if the camera were mounted upside down: it turns about its optical axis.
GravityFinder UpsideDownViews(const AnalyticRoom& room, double pitch_rad) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  GravityFinder finder;
  for (int i = 0; i < 12; ++i) {
    const Pose3 pose = TiltedCamera({0.3 * std::cos(i), 0.3 * std::sin(i), kPi * i / 6.0}, kHeightM,
                                    pitch_rad, kPi);
    finder.Add(room.Render(camera, pose), camera, pose);
  }
  return finder;
}

TEST(Gravity, UpsideDownCamerasSeeTheFloorBeyondTheLowerEdge) {
  const GravityFinder finder = UpsideDownViews(FurnishedRoom(), 0.3);
  EXPECT_FALSE(finder.Find());
  const auto gravity = finder.Find(true);
  ASSERT_TRUE(gravity);
  EXPECT_LT(AngleDeg(gravity->up_in_world, Eigen::Vector3d::UnitZ()), 0.3);
  EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.02);
}

// A level camera sees as much of the ceiling, on which nothing stands.
TEST(Gravity, FurnitureOnTheCeilingIsTold) {
  const GravityFinder finder = UpsideDownViews(FurnishedRoom(), 0.0);
  const auto ceiling = finder.Find();
  ASSERT_TRUE(ceiling);
  EXPECT_LT(AngleDeg(ceiling->up_in_world, -Eigen::Vector3d::UnitZ()), 0.3);
  EXPECT_TRUE(ceiling->crowded_above);
  const auto floor = finder.Find(true);
  ASSERT_TRUE(floor);
  EXPECT_LT(AngleDeg(floor->up_in_world, Eigen::Vector3d::UnitZ()), 0.3);
  EXPECT_FALSE(floor->crowded_above);
}

// Each image is off on its own, as with wrong stamps: not by drift, and their mean is right.
TEST(Gravity, ImagesThatScatterAreNoDrift) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  RandomStream random(5, RandomStage::kTest);
  GravityFinder finder;
  for (int i = 0; i < 24; ++i) {
    const Pose3 pose = TiltedCamera({0.1, 0.0, kPi * i / 6.0}, kHeightM, 0.3, 0.0);
    const Eigen::Vector3d off(RadFromDeg(3.0) * random.Normal(), RadFromDeg(3.0) * random.Normal(),
                              0.0);
    const Pose3 told{ExpRotation(off) * pose.rotation, pose.translation};
    finder.Add(AnalyticRoom{}.Render(camera, pose), camera, told);
  }
  const auto gravity = finder.Find();
  ASSERT_TRUE(gravity);
  EXPECT_FALSE(gravity->drifts);
  EXPECT_GT(gravity->wander_rad, RadFromDeg(3.0));
  EXPECT_LT(gravity->error_rad, RadFromDeg(2.0));
  EXPECT_LT(AngleDeg(gravity->up_in_world, Eigen::Vector3d::UnitZ()), 2.0);
}

// One plane through all views was 3 degrees off.
TEST(Gravity, DriftInHeightTiltsNothing) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(RadFromDeg(26.0), Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d up = turned * Eigen::Vector3d::UnitZ();
  const auto gravity = Views(FurnishedRoom(), turned, 0.3, 0.01, -0.8).Find();
  ASSERT_TRUE(gravity);
  EXPECT_LT(AngleDeg(gravity->up_in_world, up), 0.3);
  EXPECT_LT(gravity->wander_rad, RadFromDeg(2.0));
  EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.03);
  // Where the second to fourth of them have it: the first sees a table in its place.
  EXPECT_NEAR(gravity->floor_m, up.dot(Eigen::Vector3d(4, 5, 6)) - 2.0 * 0.8 / 11.0, 0.03);
  EXPECT_TRUE(gravity->floor_is_late);
}

// Up is where SLAM's world has it at its beginning; all views' mean was 3.1 degrees off.
// Half of the images are within 10 cm of the lowest floor.
TEST(Gravity, DriftInHeightOfAFewSecondsLeavesTheFirstFloor) {
  for (const double drift_m : {-0.2, 0.2}) {
    const auto gravity =
        Views(FurnishedRoom(), Eigen::Quaterniond::Identity(), 0.3, 0.01, drift_m, 0.0, 5).Find();
    ASSERT_TRUE(gravity);
    EXPECT_NEAR(gravity->floor_m, 6.0, 0.02) << drift_m;
    EXPECT_FALSE(gravity->floor_is_late);
    EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.03) << drift_m;
  }
}

TEST(Gravity, ATableThatTheFirstImagesSeeIsNoFloor) {
  GravityFinder finder = Views(FurnishedRoom(), Eigen::Quaterniond::Identity(), 0.3, 0.01);
  AnalyticRoom table = FurnishedRoom();
  table.boxes.push_back({{-3.0, -3.0, 0.0}, {3.0, 3.0, 0.45}});
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  for (int i = 0; i < 5; ++i) {
    const Pose3 pose = TiltedCamera({0.1 * i, 0.0, 0.1 * i}, kHeightM, 0.5, 0.0);
    const Pose3 told = Pose3{Eigen::Quaterniond::Identity(), Eigen::Vector3d(4, 5, 6)} * pose;
    finder.AddFirst(table.Render(camera, pose), camera, told);
  }
  const auto gravity = finder.Find();
  ASSERT_TRUE(gravity);
  EXPECT_NEAR(gravity->floor_m, 6.0, 0.02);
}

// SLAM's height drifts from the fifth spread view on, so that the images agree on no floor.
TEST(Gravity, ATableThatTheFirstImagesSeeIsNoFloorWhereHeightDrifts) {
  AnalyticRoom table = FurnishedRoom();
  table.boxes.push_back({{-3.0, -3.0, 0.0}, {3.0, 3.0, 0.7}});
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  const auto told = [](Pose3 pose, double drift_m) {
    pose.translation += Eigen::Vector3d(4.0, 5.0, 6.0 - drift_m);
    return pose;
  };
  for (const bool first_sees_floor : {true, false}) {
    GravityFinder finder;
    for (int i = 0; i < 12; ++i) {
      const Pose3 pose = TiltedCamera({0.1 * i, 0.0, kPi * i / 6.0}, kHeightM, 0.4, 0.0);
      const DepthImage image = AnalyticRoom{}.Render(camera, pose);
      finder.Add(image, camera, told(pose, 0.1 * std::max(0, i - 3)));
    }
    for (int i = 0; i < 5; ++i) {
      const Pose3 pose = TiltedCamera({0.1 * i, 0.0, 0.1 * i}, kHeightM, 0.4, 0.0);
      const AnalyticRoom seen = i == 0 && first_sees_floor ? AnalyticRoom{} : table;
      finder.AddFirst(seen.Render(camera, pose), camera, told(pose, 0.0));
    }
    const auto gravity = finder.Find();
    ASSERT_TRUE(gravity);
    EXPECT_NEAR(gravity->camera_height_m, kHeightM, 0.02);
    EXPECT_NEAR(gravity->floor_m, 6.0, 0.02);
    EXPECT_EQ(gravity->floor_is_late, !first_sees_floor);
  }
}

TEST(Gravity, DriftInTiltLeavesTheFirstUp) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(RadFromDeg(26.0), Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d up = turned * Eigen::Vector3d::UnitZ();
  const auto gravity = Views(FurnishedRoom(), turned, 0.3, 0.01, 0.0, RadFromDeg(6.0)).Find();
  ASSERT_TRUE(gravity);
  EXPECT_LT(AngleDeg(gravity->up_in_world, up), 0.9);  // the second view is 0.55 degrees off
  EXPECT_GT(gravity->wander_rad, RadFromDeg(2.0));
}

// More than any surface's normal may differ from up.
TEST(Gravity, DriftInTiltLeavesTheUpOfTheFirstImages) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(RadFromDeg(26.0), Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d up = turned * Eigen::Vector3d::UnitZ();
  const double drift_rad = RadFromDeg(40.0);
  const auto gravity = Views(FurnishedRoom(), turned, 0.3, 0.01, 0.5, drift_rad, 5).Find();
  ASSERT_TRUE(gravity);
  EXPECT_TRUE(gravity->drifts);
  EXPECT_LT(AngleDeg(gravity->up_in_world, up), 0.6);
  EXPECT_NEAR(gravity->floor_m, up.dot(Eigen::Vector3d(4, 5, 6)), 0.03);
  // Spread ones alone see what SLAM has become.
  const auto blind = Views(FurnishedRoom(), turned, 0.3, 0.01, 0.5, drift_rad).Find();
  ASSERT_TRUE(blind);
  EXPECT_GT(AngleDeg(blind->up_in_world, up), 5.0);
}

// SLAM's tilt drifts by 4 degrees in the first seconds and then no more.
TEST(Gravity, DriftInTiltAtFirstLeavesTheUpOfTheFirstImages) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  GravityFinder finder = Views(FurnishedRoom(), Eigen::Quaterniond::Identity(), 0.3, 0.01);
  const Pose3 before{
      Eigen::Quaterniond(Eigen::AngleAxisd(RadFromDeg(4.0), Eigen::Vector3d::UnitX())),
      Eigen::Vector3d(4, 5, 6)};
  for (int i = 0; i < 8; ++i) {
    const Pose3 pose = TiltedCamera({0.05 * i, 0.0, 0.05 * i}, kHeightM, 0.3, 0.0);
    finder.AddFirst(FurnishedRoom().Render(camera, pose), camera, before * pose);
  }
  const auto gravity = finder.Find();
  ASSERT_TRUE(gravity);
  EXPECT_TRUE(gravity->drifts);
  EXPECT_LT(AngleDeg(gravity->up_in_world, before.rotation * Eigen::Vector3d::UnitZ()), 0.5);
}

// A recording that begins in front of a sofa whose seat slopes by 12 degrees; its world is level.
TEST(Gravity, ASeatThatTheFirstImagesSeeDoesNotTurnTheWorld) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  GravityFinder finder = Views(FurnishedRoom(), Eigen::Quaterniond::Identity(), 0.3, 0.01);
  const Eigen::Quaterniond sloped(Eigen::AngleAxisd(RadFromDeg(12.0), Eigen::Vector3d::UnitX()));
  AnalyticRoom seat;
  seat.walls.low.z() = 0.55;
  for (int i = 0; i < 8; ++i) {
    const Pose3 pose = TiltedCamera({0.0, 0.0, 0.02 * i}, kHeightM, 0.5, 0.0);
    // The seat as an image shows it that turns with the camera, told where the camera is.
    const Pose3 slope{sloped, Eigen::Vector3d::Zero()};
    const Pose3 told{slope.rotation * pose.rotation, pose.translation + Eigen::Vector3d(4, 5, 6)};
    finder.AddFirst(seat.Render(camera, pose), camera, told);
  }
  const auto gravity = finder.Find();
  ASSERT_TRUE(gravity);
  EXPECT_FALSE(gravity->drifts);
  EXPECT_LT(AngleDeg(gravity->up_in_world, Eigen::Vector3d::UnitZ()), 0.5);
}

TEST(Gravity, SaysNothingWithoutAFloor) {
  // Looking up at walls and ceiling.
  EXPECT_FALSE(Views(FurnishedRoom(), Eigen::Quaterniond::Identity(), -0.7, 0.0).Find());
  EXPECT_FALSE(GravityFinder().Find());
}

TEST(SnappedUp, OnlyTheUsualAxisIsTakenForScatter) {
  const auto snapped = [](const Eigen::Vector3d& axis, double deg, double error_deg, bool drifts) {
    Gravity gravity;
    gravity.up_in_world = Eigen::AngleAxisd(RadFromDeg(deg), Eigen::Vector3d::UnitX()) * axis;
    gravity.wander_rad = RadFromDeg(8.0);
    gravity.error_rad = RadFromDeg(error_deg);
    gravity.drifts = drifts;
    return SnappedUp(gravity, WorldUp::kZ) == axis;
  };
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), minus_y = -Eigen::Vector3d::UnitY();
  EXPECT_TRUE(snapped(z, 2.9, 1.6, false));
  EXPECT_FALSE(snapped(z, 3.1, 1.6, false));
  EXPECT_FALSE(snapped(minus_y, 1.7, 1.6, false));
  EXPECT_TRUE(snapped(minus_y, 1.5, 1.6, false));
  EXPECT_TRUE(snapped(minus_y, 0.9, 0.0, false));
  EXPECT_TRUE(snapped(minus_y, 2.9, 1.6, true));
}

TEST(WorldUp, RotationsMakeTheAxisZ) {
  int axes = 0;
  for (const WorldUp up : {WorldUp::kX, WorldUp::kMinusX, WorldUp::kY, WorldUp::kMinusY,
                           WorldUp::kZ, WorldUp::kMinusZ}) {
    const Eigen::Quaterniond level = LevelFromWorld(AxisOf(up));
    EXPECT_TRUE((level * AxisOf(up)).isApprox(Eigen::Vector3d::UnitZ(), 1e-12)) << NameOf(up);
    EXPECT_EQ(NearestAxis(AxisOf(up)), up);
    ++axes;
  }
  EXPECT_EQ(axes, 6);
  const auto tilted = [](double deg) {
    return Eigen::Vector3d(std::sin(RadFromDeg(deg)), 0.0, std::cos(RadFromDeg(deg)));
  };
  EXPECT_EQ(NearestAxis(tilted(0.9)), WorldUp::kZ);
  EXPECT_EQ(NearestAxis(tilted(1.1)), WorldUp::kAuto);
  EXPECT_EQ(NearestAxis(tilted(1.9), RadFromDeg(2.0)), WorldUp::kZ);
  EXPECT_EQ(NearestAxis(tilted(0.9), RadFromDeg(0.5)), WorldUp::kZ);
}

TEST(WorldUp, TheIdentityReturnsPosesBitForBit) {
  SlamOutput slam;
  const Pose3 pose{Eigen::Quaterniond(0.6, 0.0, 0.8, 1e-9), {1, 2, 3}};  // not quite a unit
  slam.live = {{0.0, pose, 0}, {1.0, {}, 0}};
  slam.final = {{0.0, pose}};
  EXPECT_EQ(Rotated(slam, LevelFromWorld(Eigen::Vector3d::UnitZ())).live, slam.live);
  const SlamOutput turned = Rotated(slam, LevelFromWorld(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(turned.live[0].slam_from_camera->translation.isApprox(Eigen::Vector3d(1, 3, -2)));
  EXPECT_FALSE(turned.live[1].slam_from_camera);
  EXPECT_EQ(turned.final[0].world_from_camera, *turned.live[0].slam_from_camera);
}

}  // namespace
}  // namespace depthgrid
