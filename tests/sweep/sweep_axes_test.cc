// The values of a sweep's axes.
#include "eval/sweep/sweep_axes.h"

#include <gmock/gmock.h>

#include <cmath>

#include "mapper/io/config.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

SweepAxis AxisOf(const std::string& given) {
  return ReadAxes(Config::FromText("mapper.scan.floor_z_m: " + given, "s.yaml")).at(0);
}

std::vector<std::string> TextsOf(const std::string& given) {
  std::vector<std::string> texts;
  for (const auto& value : AxisOf(given).values) texts.push_back(value.at(0));
  return texts;
}

TEST(SweepAxes, HaveOneZeroOnly) {
  EXPECT_THAT(TextsOf("[-1, -0, 1]"), ElementsAre("-1", "0", "1"));
  EXPECT_THAT(TextsOf("[-0.0, 1]"), ElementsAre("0", "1"));
  EXPECT_THAT(TextsOf("{from: -0.0, to: 1, count: 2}"), ElementsAre("0", "1"));
  EXPECT_THAT(TextsOf("{from: -1, to: -0.0, count: 2}"), ElementsAre("-1", "0"));
  EXPECT_EQ(RefusalOf([] { AxisOf("[0, 1, -0]"); }),
            "s.yaml:1: axis 'mapper.scan.floor_z_m' has the value 0 twice");
  const AxisRange whole{-1.0, 1.0, RangeScale::kLinear, true};
  for (const double share : {0.4, 0.5, 0.6}) EXPECT_FALSE(std::signbit(whole.At(share))) << share;
  EXPECT_FALSE(std::signbit(whole.Drawn(0.4)));
  EXPECT_FALSE(std::signbit(AxisOf("{from: -0.0, to: 1}").range->from));
}

// Not -5.551115123125783e-17.
TEST(SweepAxes, BetweenEndsOfBothSignsLiesZero) {
  EXPECT_THAT(TextsOf("{from: -0.3, to: 0.6, count: 4}"), ElementsAre("-0.3", "0", "0.3", "0.6"));
  EXPECT_THAT(TextsOf("{from: -1, to: 1, count: 3}"), ElementsAre("-1", "0", "1"));
  EXPECT_THAT(TextsOf("{from: 1e-17, to: 1, count: 2}"), ElementsAre("1e-17", "1"));
  EXPECT_THAT(TextsOf("{from: 1e-20, to: 3e-20, count: 3}"),
              ElementsAre("1e-20", "2e-20", "3e-20"));
}

}  // namespace
}  // namespace depthgrid
