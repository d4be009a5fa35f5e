#include "mapper/core/median.h"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <utility>

namespace depthgrid {
namespace {

TEST(UpperMedian, IsAValueThatIsThere) {
  EXPECT_EQ(UpperMedian({3.0}), 3.0);
  EXPECT_EQ(UpperMedian({5.0, -1.0, 2.0}), 2.0);
  EXPECT_EQ(UpperMedian({4.0, 1.0, 3.0, 2.0}), 3.0);  // of two, the upper
  EXPECT_ANY_THROW(UpperMedian({}));
}

TEST(UpperMedianAmong, IsOfWhatCountsOfTheItems) {
  std::array<std::pair<double, double>, 3> items = {{{1.0, 30.0}, {2.0, 10.0}, {3.0, 20.0}}};
  const std::span among(items.data(), items.size());
  EXPECT_EQ(UpperMedianAmong(among, [](const auto& item) { return item.first; }), 2.0);
  EXPECT_EQ(UpperMedianAmong(among, [](const auto& item) { return item.second; }), 20.0);
}

}  // namespace
}  // namespace depthgrid
