#include "mapper/io/range_crowd.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/angle.h"
#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kNone = std::numeric_limits<double>::infinity();

// How a laser of 6 m that drives along a corridor of 2 x 40 m, whose ends are walls, writes a range
// beyond that.
using NoReturn = double (*)(int reading);
double Scattered(int reading) { return 6.0 + 0.0005 * (reading * 37 % 101); }
double AsNothing(int) { return kNone; }

std::vector<double> RangesAt(double x_m, NoReturn no_return, double reach_m = 6.0) {
  std::vector<double> range_m;
  for (int k = 0; k <= 180; ++k) {
    const double c = std::cos(RadFromDeg(k - 90.0));
    const double s = std::sin(RadFromDeg(k - 90.0));
    const double wall_m =
        std::min((40.0 - x_m) / std::max(c, 1e-9), 1.0 / std::max(std::abs(s), 1e-9));
    // The wall's roughness.
    const double range = wall_m * (1.0 + 0.002 * std::sin(12.9 * k + 78.2 * x_m));
    range_m.push_back(range < reach_m ? range : no_return(k + static_cast<int>(100.0 * x_m)));
  }
  return range_m;
}

std::optional<RangeCrowd> CrowdOf(NoReturn no_return, double step_m, double reach_m = 6.0) {
  RangeCrowdCheck check;
  for (int i = 0; i < 200; ++i) {
    const double x_m = 20.0 + step_m * i;
    check.Add({x_m, 0.0, 0.0}, RangesAt(x_m, no_return, reach_m), 0.1, 80.0);
  }
  return check.Found();
}

TEST(RangeCrowd, NoReturnsThatVaryALittleCrowd) {
  const auto crowd = CrowdOf(Scattered, 0.09);
  ASSERT_TRUE(crowd);
  EXPECT_NEAR(crowd->shortest_m, 6.0, 0.015);
  EXPECT_NEAR(crowd->longest_m, 6.05, 0.015);
  EXPECT_NEAR(static_cast<double>(crowd->count) / static_cast<double>(crowd->readings), 0.1, 0.02);
  EXPECT_GT(crowd->times_as_many, 10.0);
}

TEST(RangeCrowd, HitsDoNot) {
  EXPECT_FALSE(CrowdOf(AsNothing, 0.09));
  // The wall at the far end is seen all along.
  EXPECT_FALSE(CrowdOf(AsNothing, 0.09, kNone));
}

// It sees one wall at one distance, or does not say where it goes.
TEST(RangeCrowd, NothingIsSaidOfALaserThatStands) {
  EXPECT_FALSE(CrowdOf(AsNothing, 0.0, kNone));
  EXPECT_FALSE(CrowdOf(Scattered, 0.0));
}

std::string LogOf(NoReturn no_return) {
  std::string log;
  for (int i = 0; i < 60; ++i) {
    const double x_m = 20.0 + 0.25 * i;
    log += "FLASER 181";
    for (const double range_m : RangesAt(x_m, no_return)) log += fmt::format(" {:.3f}", range_m);
    log += fmt::format(" {0:.2f} 0 0 {0:.2f} 0 0 {1} host {1}\n", x_m, i);
  }
  return log;
}

TEST(RangeCrowd, IsSaidOfALogWithTheSettingThatSettlesIt) {
  EXPECT_THAT(
      WarningsOf(LogOf(Scattered)),
      AllOf(HasSubstr(" % of the readings are from 5.99 to 6.05 m, the log's longest, "),
            HasSubstr(" times as many as in as wide a band below, wherever the laser is: if "
                      "that is how it writes \"no return\", they are drawn as walls; --set "
                      "sequence.laser.max_range_m=5.99 takes them for none\n")));
  CarmenLogOptions options;
  options.max_range_m = 5.99;
  EXPECT_EQ(WarningsOf(LogOf(Scattered), options), "");
  EXPECT_EQ(WarningsOf(LogOf(AsNothing)), "");
}

}  // namespace
}  // namespace depthgrid
