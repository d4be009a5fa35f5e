// Which of stamps that fall are wrong.
#include "mapper/io/stamp_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

using MaybeStamps = std::vector<std::optional<double>>;

std::vector<double> StampsEvery(double step_s, int count) {
  std::vector<double> stamps_s;
  for (int i = 0; i < count; ++i) stamps_s.push_back(step_s * i);
  return stamps_s;
}

void ExpectAsTheyAre(const std::vector<double>& stamps_s) {
  const StampOrder order = OrderOf(stamps_s);
  EXPECT_EQ(order.stamps_s, MaybeStamps(stamps_s.begin(), stamps_s.end()));
  EXPECT_THAT(order.set_back, IsEmpty());
}

TEST(StampOrder, RisingStampsStay) {
  ExpectAsTheyAre({});
  ExpectAsTheyAre({7.0});
  ExpectAsTheyAre({1.0, 2.0, 2.0, 5000.0, 5001.0});
}

// Two messages of one scan, a driver that delivers late, a log that was written backwards: those
// that are not later than the one before are left out as ever.
TEST(StampOrder, AFewThatComeLateAreLateThemselves) {
  ExpectAsTheyAre({1.0, 0.9, 2.0, 1.9, 3.0, 2.9, 4.0, 3.9});
  ExpectAsTheyAre({1.0, 2.0, 3.0, 4.0, 0.0, 5.0, 6.0, 7.0, 8.0});
  ExpectAsTheyAre({9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0});
}

TEST(StampOrder, AFewThatAreAheadOfAllAfterThemAreWrong) {
  for (const std::size_t first : {0U, 5U}) {
    for (const std::size_t count : {1U, 3U}) {
      std::vector<double> stamps_s = StampsEvery(0.1, 20);
      for (std::size_t i = first; i < first + count; ++i) stamps_s[i] += 1e6;
      const StampOrder order = OrderOf(stamps_s);
      EXPECT_THAT(order.set_back, IsEmpty());
      for (std::size_t i = 0; i < stamps_s.size(); ++i) {
        EXPECT_EQ(order.stamps_s[i].has_value(), i < first || i >= first + count);
      }
    }
  }
}

TEST(StampOrder, AClockThatWasSetBackIsPutForward) {
  for (const double back_s : {1.0, 3600.0}) {  // overlapping, and not
    std::vector<double> stamps_s = StampsEvery(0.1, 60);
    for (std::size_t i = 20; i < 60; ++i) stamps_s[i] -= back_s;
    for (std::size_t i = 40; i < 60; ++i) stamps_s[i] -= back_s;
    const StampOrder order = OrderOf(stamps_s);
    ASSERT_EQ(order.set_back.size(), 2U);
    EXPECT_EQ(order.set_back[0].at, 20U);
    EXPECT_EQ(order.set_back[1].at, 40U);
    for (const auto& set_back : order.set_back) EXPECT_NEAR(set_back.by_s, back_s, 1.5e-3);
    for (std::size_t i = 0; i < 60; ++i) {
      ASSERT_TRUE(order.stamps_s[i]);
      EXPECT_NEAR(*order.stamps_s[i], 0.1 * static_cast<double>(i), 3e-3);
    }
  }
}

// Images and poses find each other by their stamps, so these stay; but it is said.
TEST(StampOrder, FilesThatAreSortedSayThatTheClockWasSetBack) {
  std::string list, poses;
  for (int i = 0; i < 20; ++i) {
    const std::string stamp = std::to_string(100 + i - (i < 10 ? 0 : 50));
    list += stamp + " depth/" + std::to_string(i) + ".png\n";
    poses += stamp + " 0 0 0 0 0 0 1\n";
  }
  const auto said = HasSubstr(":11: the clock was set back here, by about 50.000 s");
  EXPECT_THAT(
      ParseFileList(list, "depth.txt").warnings,
      Contains(HasSubstr("; split the file before this line and use the parts one by one")));
  EXPECT_THAT(ParseFileList(list, "depth.txt").warnings, Contains(said));
  EXPECT_THAT(ParseTrajectory(poses, "poses.txt").Warnings("poses.txt"), Contains(said));
  const std::string late = "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n";
  EXPECT_THAT(ParseTrajectory(late, "poses.txt").Warnings("poses.txt"),
              ElementsAre(Not(HasSubstr("clock"))));
}

}  // namespace
}  // namespace depthgrid
