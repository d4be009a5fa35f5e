#include "mapper/io/frozen_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace depthgrid {
namespace {

std::shared_ptr<const DepthImage> ImageOf(float z_m) {
  auto image = std::make_shared<DepthImage>(4, 3);
  std::fill(image->z_m.begin(), image->z_m.end(), z_m);
  return image;
}

Pose3 TurnedBy(double degrees) { return {ExpRotation({0.0, RadFromDeg(degrees), 0.0}), {0, 0, 0}}; }
Pose3 MovedBy(double x_m, double z_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, z_m}}; }

TEST(FrozenImages, AreThoseThatStayWhileTheCameraMoves) {
  FrozenImages images;
  EXPECT_FALSE(images.IsFrozen(ImageOf(2.0F), TurnedBy(0.0), 0.0, 0));
  EXPECT_FALSE(images.IsFrozen(ImageOf(2.0F), TurnedBy(0.4), 0.03, 0));
  EXPECT_TRUE(images.IsFrozen(ImageOf(2.0F), TurnedBy(0.6), 0.06, 0));
  EXPECT_FALSE(images.IsFrozen(ImageOf(2.0F), MovedBy(0.0, 0.01), 0.09, 0));
  EXPECT_TRUE(images.IsFrozen(ImageOf(2.0F), MovedBy(0.0, 0.016), 0.09, 0));
  EXPECT_TRUE(images.IsFrozen(ImageOf(2.0F), MovedBy(0.0, -0.017), 0.12, 0));
  EXPECT_FALSE(images.IsFrozen(ImageOf(2.001F), TurnedBy(9.0), 0.15, 0));
}

TEST(FrozenImages, AreNotThoseOfACameraThatStandsOrMovesAlongAWall) {
  FrozenImages images;
  for (int i = 0; i < 300; ++i) {  // SLAM wanders by 3 cm and a degree in a second
    const Pose3 wandering = MovedBy(0.0, 0.001 * i) * TurnedBy(i / 30.0);
    EXPECT_FALSE(images.IsFrozen(ImageOf(2.0F), wandering, i / 30.0, 0)) << i;
  }
  EXPECT_FALSE(images.IsFrozen(ImageOf(3.0F), MovedBy(0.0, 0.0), 11.0, 0));
  EXPECT_FALSE(images.IsFrozen(ImageOf(3.0F), MovedBy(0.5, 0.0), 11.1, 0));
  EXPECT_FALSE(images.IsFrozen(ImageOf(3.0F), MovedBy(0.5, 1.0), 11.2, 1));  // SLAM moved, not it
  EXPECT_FALSE(images.IsFrozen(ImageOf(kInvalidDepth), MovedBy(0.0, 0.0), 12.0, 1));
  EXPECT_FALSE(images.IsFrozen(ImageOf(kInvalidDepth), MovedBy(0.0, 1.0), 12.1, 1));
}

// Some drivers write NaN for a pixel without depth, and a NaN is not equal to itself.
TEST(FrozenImages, AreFoundByTheirBitsThoughPixelsAreNoNumbers) {
  const auto with_nan = [](float z_m) {
    auto image = std::make_shared<DepthImage>(*ImageOf(z_m));
    image->z_m[5] = std::numeric_limits<float>::quiet_NaN();
    return image;
  };
  FrozenImages images;
  EXPECT_FALSE(images.IsFrozen(with_nan(2.0F), TurnedBy(0.0), 0.0, 0));
  EXPECT_TRUE(images.IsFrozen(with_nan(2.0F), TurnedBy(2.5), 0.06, 0));
  EXPECT_FALSE(images.IsFrozen(with_nan(2.1F), TurnedBy(5.0), 0.09, 0));
  // One without any depth shows nothing that could stand still.
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(images.IsFrozen(ImageOf(kNan), MovedBy(0.0, 0.0), 1.0, 0));
  EXPECT_FALSE(images.IsFrozen(ImageOf(kNan), MovedBy(0.0, 1.0), 1.1, 0));
}

}  // namespace
}  // namespace depthgrid
