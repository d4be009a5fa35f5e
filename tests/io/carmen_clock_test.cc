// Stamps of a log that do not rise (docs/formats.md, "Laser logs").
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;

// 30 scans a second apart; what `stamp_of` makes of the stamp of each; the last ten lie so far
// ahead.
template <typename StampOf>
std::string LogWith(StampOf stamp_of, double x_behind_m = 0.0) {
  std::string log;
  for (int i = 0; i < 30; ++i) log += ScanAt(i < 20 ? 0.0 : x_behind_m, 0, stamp_of(i));
  return log;
}

std::vector<double> StampsOf(const std::string& log) {
  const TextFile file(log);
  std::vector<double> stamps_s;
  for (const Frame& frame : ReadAll(*OpenCarmenLog(file.path()))) stamps_s.push_back(frame.stamp_s);
  return stamps_s;
}

TEST(CarmenClock, AStampThatAllLaterOnesContradictIsLeftOut) {
  const std::string log = LogWith([](int i) { return i == 12 ? 1000000 : 100 + i; });
  const std::vector<double> stamps_s = StampsOf(log);
  ASSERT_EQ(stamps_s.size(), 29U);
  EXPECT_EQ(stamps_s[12], 113.0);
  EXPECT_THAT(WarningsOf(log),
              HasSubstr("log:13: a scan whose stamp is later than all after it: stamp 1000000.0"));
  const TextFile file(log);
  EXPECT_EQ(CarmenFrames(file.path()).numbers[12], 13);  // it keeps its number
}

TEST(CarmenClock, AClockThatWasSetBackGoesOn) {
  const std::string log = LogWith([](int i) { return 5000 + i - (i < 20 ? 0 : 3600); });
  const std::vector<double> stamps_s = StampsOf(log);
  ASSERT_EQ(stamps_s.size(), 30U);
  for (std::size_t i = 0; i < 30; ++i)
    EXPECT_NEAR(stamps_s[i], 5000.0 + static_cast<double>(i), 2e-3);
  EXPECT_THAT(WarningsOf(log),
              HasSubstr("log:21: the clock was set back, by about 3600.000 s: so much is added to "
                        "the stamps of this scan and all after it"));
}

// How long it took is not known.
TEST(CarmenClock, AJumpWhereTheClockWasSetBackIsNoMotion) {
  for (const double x_m : {0.2, 3.0}) {
    const TextFile file(LogWith([](int i) { return 100 + i - (i < 20 ? 0 : 10); }, x_m));
    const auto source = OpenCarmenLog(file.path());
    EXPECT_EQ(ReadAll(*source).back().slam_epoch, x_m > 1.0 ? 1 : 0);
    EXPECT_EQ(testing::Matches(testing::Contains(HasSubstr("jumps where the clock was set back")))(
                  source->Warnings()),
              x_m > 1.0);
  }
}

}  // namespace
}  // namespace depthgrid
