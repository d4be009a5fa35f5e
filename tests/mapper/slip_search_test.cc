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

// Explains all of a scan at one pose, and says what of it has stood for long.
class FakeMap : public ReferenceMap {
 public:
  struct Lasting {
    double last = 0.0;       // of the last scan
    double predicted = 0.0;  // of this one at the prediction, the origin
    double elsewhere = 0.0;  // and where it is found
  };
  FakeMap(const Pose2& found, const Lasting& lasting, std::shared_ptr<const Scan> last)
      : found_(found), lasting_(lasting), last_(std::move(last)) {}

  MatchResult Match(const std::shared_ptr<const Scan>&, const Prediction&) override {
    MatchResult match;
    match.found = true;
    match.score = 0.9;
    match.map_from_base = found_;
    return match;
  }
  double ShareSeenBefore(const std::shared_ptr<const Scan>& scan, const Pose2& pose, int) override {
    if (scan == last_) return lasting_.last;
    return pose == Pose2{} ? lasting_.predicted : lasting_.elsewhere;
  }
  std::span<const MapPart> MatchedParts() const override { return {}; }
  void Insert(const std::shared_ptr<const Scan>&, const Pose2&, const Eigen::Matrix3d&) override {}
  void InsertTied(const std::shared_ptr<const Scan>&, const Pose2&, int) override {}
  Adjustment Adjust(const std::vector<MappedFrame>&, const std::vector<PlanarLoop>&, AdjustEffort,
                    std::span<const int>) override {
    return {};
  }
  void Rebuild(const std::vector<MappedFrame>&) override {}

 private:
  Pose2 found_;
  Lasting lasting_;
  std::shared_ptr<const Scan> last_;
};

// How many headings were tried.
class CountingMap : public FakeMap {
 public:
  CountingMap() : FakeMap({}, {}, nullptr) {}
  MatchResult Match(const std::shared_ptr<const Scan>&, const Prediction&) override {
    ++matches;
    return {};
  }
  int matches = 0;
};

TEST(SlipSearch, EveryDegreeToEitherSideIsTried) {
  for (const int slip_deg : {1, 12, 15, 30, 60, 122}) {
    SlipSearch slips(slip_deg);
    slips.Placed(FrameAt(1.0), std::make_shared<const Scan>(), 0.9);
    CountingMap map;
    slips.Find(std::make_shared<const Scan>(), {}, {}, 100, map);
    EXPECT_EQ(map.matches, 2 * slip_deg + 1);
  }
}

bool IsFound(const Pose2& slip, const FakeMap::Lasting& lasting) {
  const auto last = std::make_shared<const Scan>();
  SlipSearch slips(12.0);
  slips.Placed(FrameAt(1.0), last, 0.9);
  FakeMap map(slip, lasting, last);
  return slips.Find(std::make_shared<const Scan>(), {}, {}, 100, map).has_value();
}

TEST(SlipSearch, WhatHasStoodForLongMustWantTheHeading) {
  const Pose2 turn{0.002, 0.001, RadFromDeg(5.0)}, aside{0.06, 0.0, RadFromDeg(5.0)};
  for (const Pose2& slip : {turn, aside}) {
    EXPECT_TRUE(IsFound(slip, {.last = 0.5, .predicted = 0.45, .elsewhere = 0.4}));
    EXPECT_FALSE(IsFound(slip, {.last = 0.5, .predicted = 0.1, .elsewhere = 0.2}));
    EXPECT_FALSE(IsFound(slip, {.last = 0.5, .predicted = 0.3, .elsewhere = 0.3}));
  }
  // Less is enough for what turned in place.
  const FakeMap::Lasting less{.last = 0.5, .predicted = 0.1, .elsewhere = 0.3};
  EXPECT_TRUE(IsFound(turn, less));
  EXPECT_FALSE(IsFound(aside, less));
}

}  // namespace
}  // namespace depthgrid
