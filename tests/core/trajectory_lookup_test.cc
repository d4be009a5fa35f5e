#include <gtest/gtest.h>

#include <limits>

#include "mapper/core/pose3.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {
namespace {

TEST(NearestStamp, IsTheFirstOnTiesAndWithinTheLimit) {
  const std::vector<double> stamps_s = {1.0, 2.0, 4.0};
  const auto nearest = [&](double stamp_s, double most_s) {
    const auto index = NearestStamp(stamps_s, stamp_s, most_s);
    return index ? static_cast<int>(*index) : -1;
  };
  EXPECT_EQ(nearest(2.0, 0.0), 1);
  EXPECT_EQ(nearest(3.0, 1.0), 1);
  EXPECT_EQ(nearest(3.25, 1.0), 2);
  EXPECT_EQ(nearest(3.25, 0.5), -1);
  EXPECT_EQ(nearest(-9.0, 10.0), 0);
  EXPECT_EQ(nearest(5.0, 1.0), 2);
  EXPECT_EQ(nearest(5.5, 1.0), -1);
  EXPECT_EQ(nearest(std::numeric_limits<double>::quiet_NaN(), 1.0), -1);
  EXPECT_FALSE(NearestStamp({}, 1.0, 1.0));
  EXPECT_EQ(StampsOf({{1.5, {}}, {2.5, {}}}), (std::vector<double>{1.5, 2.5}));
}

TEST(AngleOf, IsTheLengthOfTheRotationVector) {
  for (const double angle_rad : {0.0, 1e-12, 1e-8, 0.3, 3.0}) {
    const Eigen::Quaterniond rotation =
        ExpRotation(angle_rad * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0);
    EXPECT_NEAR(AngleOf(rotation), angle_rad, 1e-15 + 1e-15 * angle_rad);
    EXPECT_EQ(AngleOf(Eigen::Quaterniond(-rotation.coeffs())), AngleOf(rotation));
  }
}

}  // namespace
}  // namespace depthgrid
