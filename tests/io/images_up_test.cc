#include "mapper/io/images_up.h"

#include <gtest/gtest.h>

#include <functional>

#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

struct HeldCamera {
  double heading_deg = 0.0;
  double pitch_down_deg = 0.0;
  double roll_deg = 0.0;
};

// Angle between true up and the one of 24 images that are held so, a few degrees more or less, in
// a world whose z is up or in that of their first camera.
double OffDeg(const std::function<HeldCamera(int)>& held, bool in_first_camera) {
  RandomStream random(7, RandomStage::kTest);
  const auto some_rad = [&](double deg) { return RadFromDeg(deg + 4.0 * random.Normal()); };
  ImagesUp images;
  Pose3 world_from_true;
  for (int i = 0; i < 24; ++i) {
    const HeldCamera camera = held(i);
    const Pose3 pose = TiltedCamera({0.0, 0.0, some_rad(camera.heading_deg)}, 1.3,
                                    some_rad(camera.pitch_down_deg), some_rad(camera.roll_deg));
    if (i == 0 && in_first_camera) world_from_true = Inverse(pose);
    images.Add(world_from_true * pose);
  }
  const Eigen::Vector3d up = world_from_true.rotation * Eigen::Vector3d::UnitZ();
  return DegFromRad(std::acos(std::min(1.0, up.dot(images.Mean().normalized()))));
}

// The y axes lie in an upright plane then.
TEST(ImagesUp, BackAndForthIsNoPortrait) {
  for (const double pitch_deg : {38.0, 45.0, 55.0}) {
    for (const int back : {2, 3}) {
      const auto held = [&](int i) { return HeldCamera{i % back == 0 ? 180.0 : 0.0, pitch_deg}; };
      EXPECT_LT(OffDeg(held, false), 35.0) << pitch_deg << ' ' << back;
      EXPECT_LT(OffDeg(held, true), 35.0) << pitch_deg << ' ' << back;
    }
  }
}

// z of the world of a first camera that looks to the side lies left of the images on the way out
// and right of them on the way back.
TEST(ImagesUp, AFirstCameraThatLooksAcrossTheWayIsNoPortrait) {
  const auto held = [](int i) {
    return i == 0 ? HeldCamera{} : HeldCamera{i % 3 == 0 ? -90.0 : 90.0, 45.0};
  };
  EXPECT_LT(OffDeg(held, true), 35.0);
}

TEST(ImagesUp, ACameraMayLookStraightDown) {
  for (const double pitch_deg : {88.0, 90.0, 92.0}) {
    const auto held = [&](int i) { return HeldCamera{15.0 * i, pitch_deg}; };
    EXPECT_LT(OffDeg(held, false), 3.0) << pitch_deg;
    EXPECT_LT(OffDeg(held, true), 3.0) << pitch_deg;
  }
}

TEST(ImagesUp, PortraitIsToldByTurning) {
  for (const double roll_deg : {-90.0, 90.0}) {
    for (const double pitch_deg : {15.0, 45.0, 70.0}) {
      const auto held = [&](int i) { return HeldCamera{15.0 * i, pitch_deg, roll_deg}; };
      EXPECT_LT(OffDeg(held, false), 5.0) << pitch_deg;
      EXPECT_LT(OffDeg(held, true), 5.0) << pitch_deg;
    }
  }
}

}  // namespace
}  // namespace depthgrid
