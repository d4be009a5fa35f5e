#include "eval/run/saturation_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

Pose3 Turned(double angle_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY())),
          Eigen::Vector3d::Zero()};
}

// A slope from 1 m to 5 m, cut at `cut_m`.
DepthImage Slope(float cut_m, float shift_m) {
  DepthImage image(100, 20);
  for (std::size_t i = 0; i < image.z_m.size(); ++i) {
    image.z_m[i] =
        std::min(cut_m, 1.0F + shift_m + 4.0F * static_cast<float>(i) / static_cast<float>(2000));
  }
  return image;
}

TEST(SaturationCheck, FindsTheDepthThatEverythingFartherIsCutTo) {
  SaturationCheck cut, whole, still;
  for (int i = 0; i < 20; ++i) {
    const float shift_m = 0.02F * static_cast<float>(i);
    cut.Add(Slope(3.0F, shift_m), Turned(0.02 * i));
    whole.Add(Slope(100.0F, shift_m), Turned(0.02 * i));
    // A camera that looks at one wall squarely.
    still.Add(Slope(3.0F, shift_m), Turned(0.0));
  }
  ASSERT_TRUE(cut.Found());
  EXPECT_EQ(cut.Found()->z_m, 3.0F);
  EXPECT_EQ(cut.Found()->frames, 20);
  EXPECT_FALSE(whole.Found());
  EXPECT_FALSE(still.Found());
  // Once something lies beyond, it was a wall.
  cut.Add(Slope(4.0F, 0.0F), Turned(0.5));
  EXPECT_FALSE(cut.Found());
}

// Steps of disparity, and no depth at all beyond 3.5 m: the last step is as full as those below.
TEST(SaturationCheck, TheLastStepOfDisparityIsNotACut) {
  constexpr float kStepsM = 350.0F;  // depth times disparity
  const auto stepped = [](float cut_m, float shift_m) {
    DepthImage image = Slope(100.0F, shift_m);
    for (float& z_m : image.z_m) {
      z_m = kStepsM / std::round(kStepsM / z_m);
      if (z_m > 3.5F) z_m = kInvalidDepth;
      z_m = std::min(cut_m, z_m);
    }
    return image;
  };
  SaturationCheck whole, cut;
  for (int i = 0; i < 20; ++i) {
    const float shift_m = 0.02F * static_cast<float>(i);
    whole.Add(stepped(100.0F, shift_m), Turned(0.02 * i));
    cut.Add(stepped(2.5F, shift_m), Turned(0.02 * i));
  }
  EXPECT_FALSE(whole.Found());
  ASSERT_TRUE(cut.Found());
  EXPECT_EQ(cut.Found()->z_m, 2.5F);
}

// Wherever in the image it stands, and whatever else is no depth.
TEST(SaturationCheck, TheLargestDepthIsFoundAtEveryPixel) {
  constexpr float kNone[] = {std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::quiet_NaN(), kInvalidDepth, -1.0F};
  for (const float none : kNone) {
    for (std::size_t at = 0; at < 11; ++at) {
      SaturationCheck check;
      for (int i = 0; i < 20; ++i) {
        DepthImage image(11, 1);
        for (std::size_t k = 0; k < 11; ++k) image.z_m[k] = 1.0F + 0.1F * static_cast<float>(k);
        image.z_m[(at + 3) % 11] = none;
        image.z_m[at] = 4.5F;
        check.Add(image, Turned(0.02 * i));
      }
      ASSERT_TRUE(check.Found()) << none << " " << at;
      EXPECT_EQ(check.Found()->z_m, 4.5F) << none << " " << at;
    }
  }
}

}  // namespace
}  // namespace depthgrid
