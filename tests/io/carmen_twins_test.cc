// Laser logs that hold each scan twice.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "mapper/io/carmen_log.h"
#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

// Three readings over 0.8 rad at that time.
std::string FlaserAt(int second, double middle_m) {
  return fmt::format("FLASER 3 1.00 {:.2f} 2.00 1 2 0.5 1 2 0.5 {} h 1\n", middle_m, second);
}
std::string RobotLaserAt(int second, double middle_m) {
  return fmt::format(
      "ROBOTLASER1 0 -0.4 0.8 0.4 6.0 0.01 0 3 1.000 {:.3f} 2.000 0 1 2 0.5 1 2 0.5 0 0 0 0 0 {} h "
      "1\n",
      middle_m, second);
}

TEST(CarmenTwins, LinesThatStateAnglesAreUsed) {
  for (const bool flaser_first : {false, true}) {
    std::string text;
    for (int i = 0; i < 12; ++i) {
      const double range_m = 1.501 + 0.1 * i;
      if (flaser_first) text += FlaserAt(i, range_m);
      text += RobotLaserAt(i, range_m);
      if (!flaser_first) text += FlaserAt(i, range_m);
    }
    const TextFile file(text);
    const auto source = OpenCarmenLog(file.path());
    ASSERT_EQ(source->Warnings().size(), 1U);
    EXPECT_THAT(source->Warnings()[0],
                HasSubstr(fmt::format(":{}: scans are written twice, as FLASER and as ROBOTLASER1",
                                      flaser_first ? 1 : 2)));
    const auto frames = ReadAll(*source);
    ASSERT_EQ(frames.size(), 12U);
    EXPECT_EQ(frames[11].stamp_s, 11.0);
    EXPECT_FLOAT_EQ(frames[11].scan->beams[0].bearing_rad, -0.4F);
    EXPECT_FLOAT_EQ(frames[11].scan->beams[1].range_m, 2.601F);
  }
}

// A laser ahead and one behind, at the same time: the first of the two is used, as ever.
TEST(CarmenTwins, TwoLasersAreNoTwins) {
  std::string text;
  for (int i = 0; i < 12; ++i) text += FlaserAt(i, 1.5) + RobotLaserAt(i, 3.0);
  const TextFile file(text);
  const auto source = OpenCarmenLog(file.path());
  EXPECT_FLOAT_EQ(ReadAll(*source)[0].scan->beams[1].range_m, 1.5F);
}

// Most of the log would be lost.
TEST(CarmenTwins, ManyScansThatAreWrittenOnceAreKept) {
  std::string text;
  for (int i = 0; i < 12; ++i) {
    text += FlaserAt(i, 1.5);
    if (i < 6) text += RobotLaserAt(i, 1.5);
  }
  const TextFile file(text);
  EXPECT_EQ(OpenCarmenLog(file.path())->FrameCount(), 12);
}

}  // namespace
}  // namespace depthgrid
