// When a scan that the map explains little of is held to come after a slip.
#include "mapper/slip_search.h"

#include <gtest/gtest.h>

#include <memory>

namespace depthgrid {
namespace {

FrameRecord FrameAt(double stamp_s, int epoch = 0) {
  FrameRecord frame;
  frame.index = static_cast<int>(stamp_s * 30.0);
  frame.stamp_s = stamp_s;
  frame.epoch = epoch;
  return frame;
}

// A map that explains all but a tenth, and the last scan at 1 s.
class SlipSearchTest : public ::testing::Test {
 protected:
  SlipSearchTest() {
    for (int i = 0; i < 30; ++i) relocation_.Explained(0.9);
    slips_.Placed(FrameAt(1.0), std::make_shared<const Scan>(), 0.9);
  }
  bool IsSuspected(const FrameRecord& frame, double share) const {
    return slips_.IsSuspected(frame, share, relocation_);
  }

  Relocation relocation_{{}, {}, {}};
  SlipSearch slips_{12.0};
};

TEST_F(SlipSearchTest, LittleOfAScanIsExplainedAllAtOnce) {
  EXPECT_TRUE(IsSuspected(FrameAt(1.1), 0.3));
  EXPECT_FALSE(IsSuspected(FrameAt(1.1), 0.6));
}

// Poses that come without scans meanwhile do not make it sudden.
TEST_F(SlipSearchTest, ButNotLongAfterTheLastScan) {
  EXPECT_FALSE(IsSuspected(FrameAt(11.0), 0.3));
}

TEST_F(SlipSearchTest, NorWhereAnEpochBeganAnyway) {
  EXPECT_FALSE(IsSuspected(FrameAt(1.1, 1), 0.3));
}

TEST_F(SlipSearchTest, NorWhereTheLastScanWasNotExplainedEither) {
  slips_.Placed(FrameAt(1.05), std::make_shared<const Scan>(), 0.3);
  EXPECT_FALSE(IsSuspected(FrameAt(1.1), 0.1));
}

TEST_F(SlipSearchTest, NorBeforeTheFirstScan) {
  EXPECT_FALSE(SlipSearch(12.0).IsSuspected(FrameAt(1.1), 0.3, relocation_));
}

TEST_F(SlipSearchTest, NorWhereItIsSwitchedOff) {
  SlipSearch off(0.0);
  off.Placed(FrameAt(1.0), std::make_shared<const Scan>(), 0.9);
  EXPECT_FALSE(off.IsSuspected(FrameAt(1.1), 0.3, relocation_));
}

}  // namespace
}  // namespace depthgrid
