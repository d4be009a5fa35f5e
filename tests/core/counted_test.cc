#include "mapper/core/counted.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

TEST(Counted, OneThingTakesNoS) {
  EXPECT_EQ(Counted(0, "frame"), "0 frames");
  EXPECT_EQ(Counted(1, "frame"), "1 frame");
  EXPECT_EQ(Counted(std::size_t{2}, "loop closure"), "2 loop closures");
}

}  // namespace
}  // namespace depthgrid
