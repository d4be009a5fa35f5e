#include "mapper/core/median.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

TEST(UpperMedian, IsAValueThatIsThere) {
  EXPECT_EQ(UpperMedian({3.0}), 3.0);
  EXPECT_EQ(UpperMedian({5.0, -1.0, 2.0}), 2.0);
  EXPECT_EQ(UpperMedian({4.0, 1.0, 3.0, 2.0}), 3.0);  // of two, the upper
  EXPECT_ANY_THROW(UpperMedian({}));
}

}  // namespace
}  // namespace depthgrid
