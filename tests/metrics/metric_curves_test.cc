// The scores move the way they should when a map is wrong in a known way.
#include "tests/metrics/metric_curves.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// Up to a slack: cells are whole, so curves have small steps back.
void ExpectRising(const Curve& curve, const std::string& score, double slack) {
  const std::vector<double> values = curve.Of(score);
  ASSERT_EQ(values.size(), curve.amounts.size());
  for (std::size_t i = 1; i < values.size(); ++i) {
    EXPECT_GE(values[i], values[i - 1] - slack)
        << score << " against " << curve.disturbance << " " << curve.amounts[i];
  }
  EXPECT_GT(values.back(), values.front() + slack) << score << " against " << curve.disturbance;
}

void ExpectFalling(Curve curve, const std::string& score, double slack) {
  for (CurvePoint& point : curve.points) {
    for (auto& [name, value] : point) value = -value;
  }
  ExpectRising(curve, score, slack);
}

constexpr int kSteps = 6;

TEST(MetricCurves, APerfectMapIsPerfect) {
  for (const Curve& curve : SanityCurves(1)) {
    EXPECT_EQ(curve.Of("occupied IoU").front(), 1.0);
    EXPECT_EQ(curve.Of("chamfer m").front(), 0.0);
    EXPECT_NEAR(curve.Of("SSIM").front(), 1.0, 1e-12);
    EXPECT_EQ(curve.Of("plans: success").front(), 1.0);
    EXPECT_EQ(curve.Of("double wall rate").front(), 0.0);
  }
}

TEST(MetricCurves, Shift) {
  const Curve curve = CurveOf("shift m", Steps(0.3, kSteps), ShiftedRoom);
  ExpectFalling(curve, "occupied F1, 1 cell", 0.02);
  ExpectFalling(curve, "SSIM", 0.02);
  ExpectRising(curve, "chamfer m", 0.002);
  ExpectRising(curve, "registration shift m", 0.0);
  const std::vector<double> found = curve.Of("registration shift m");
  const std::vector<double> left = curve.Of("registered chamfer m");
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], curve.amounts[i], 0.006);
    // Two lattices know one wall at different points of it: up to this is left of nothing.
    EXPECT_LT(left[i], 0.035);
  }
}

// Within a cell as well, to the limit of what two drawings of one room know of it.
TEST(MetricCurves, ShiftOfPartsOfACell) {
  const Curve curve = CurveOf("shift m", Steps(0.075, kSteps), ShiftedRoom);
  const std::vector<double> found = curve.Of("registration shift m");
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], curve.amounts[i], 0.006);
}

TEST(MetricCurves, Rotation) {
  const Curve curve = CurveOf("rotation deg", Steps(6.0, kSteps),
                              [](double deg) { return TurnedRoom(RadFromDeg(deg)); });
  ExpectFalling(curve, "occupied F1, 1 cell", 0.02);
  ExpectRising(curve, "chamfer m", 0.002);
  for (const double left_m : curve.Of("registered chamfer m")) EXPECT_LT(left_m, 0.035);
}

TEST(MetricCurves, Blur) {
  const Curve curve = CurveOf("blur m", Steps(0.12, kSteps), BlurredRoom);
  ExpectRising(curve, "wall thickness m", 0.005);
  ExpectFalling(curve, "occupied IoU", 0.02);
  ExpectRising(curve, "Brier score", 0.001);
  for (const double shift_m : curve.Of("registration shift m")) EXPECT_LT(shift_m, 0.02);
}

TEST(MetricCurves, Dropout) {
  const Curve curve = CurveOf("dropout share", Steps(0.9, kSteps), ThinnedRoom);
  ExpectFalling(curve, "coverage", 0.0);
  ExpectFalling(curve, "plans: success", 0.0);
  ExpectRising(curve, "chamfer m", 0.001);
  const std::vector<double> coverage = curve.Of("coverage");
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    EXPECT_NEAR(coverage[i], 1.0 - curve.amounts[i], 0.02);
  }
}

}  // namespace
}  // namespace depthgrid
