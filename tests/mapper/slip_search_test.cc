// When a scan that the map explains little of is held to come after a slip.
#include "mapper/slip_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace depthgrid {
namespace {

FrameRecord FrameAt(double stamp_s, int epoch = 0) {
  FrameRecord frame;
  frame.index = static_cast<int>(stamp_s * 30.0);
  frame.stamp_s = stamp_s;
  frame.epoch = epoch;
  return frame;
}

MatchResult Explaining(double share, int surfels = 60) {
  MatchResult match;
  match.found = true;
  match.information = 1e6 * Eigen::Matrix3d::Identity();
  match.score = share;
  match.explained = surfels;
  return match;
}

// A map that explains all but a tenth, and the last scan at 1 s.
class SlipSearchTest : public ::testing::Test {
 protected:
  SlipSearchTest() {
    for (int i = 0; i < 30; ++i) relocation_.Explained(0.9);
    slips_.Placed(FrameAt(1.0), std::make_shared<const Scan>(), Explaining(0.9));
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
  slips_.Placed(FrameAt(1.05), std::make_shared<const Scan>(), Explaining(0.3));
  EXPECT_FALSE(IsSuspected(FrameAt(1.1), 0.1));
}

// Of depth images half is explained, and goes up and down.
TEST_F(SlipSearchTest, NorWhereLittleIsUsuallyExplained) {
  relocation_ = Relocation({}, {}, {});
  for (int i = 0; i < 30; ++i) relocation_.Explained(0.7);
  EXPECT_FALSE(IsSuspected(FrameAt(1.1), 0.3));
}

// A pillar alone in view: what comes after it is new, not moved.
TEST_F(SlipSearchTest, NorWhereLittleWasSeen) {
  slips_.Placed(FrameAt(1.05), std::make_shared<const Scan>(), Explaining(0.9, 14));
  EXPECT_FALSE(IsSuspected(FrameAt(1.1), 0.0));
  slips_.Placed(FrameAt(1.05), std::make_shared<const Scan>(), Explaining(0.9, 15));
  EXPECT_TRUE(IsSuspected(FrameAt(1.1), 0.0));
}

TEST_F(SlipSearchTest, NorBeforeTheFirstScan) {
  EXPECT_FALSE(SlipSearch(12.0).IsSuspected(FrameAt(1.1), 0.3, relocation_));
}

TEST_F(SlipSearchTest, NorWhereItIsSwitchedOff) {
  SlipSearch off(0.0);
  off.Placed(FrameAt(1.0), std::make_shared<const Scan>(), Explaining(0.9));
  EXPECT_FALSE(off.IsSuspected(FrameAt(1.1), 0.3, relocation_));
}

const Pose2 kLastPose{-0.02, 0.0, 0.0};
const SlipSearch::Last kLast{kLastPose, 1.0};

// Explains a scan at one pose, and says what of it has stood for long.
class FakeMap : public ReferenceMap {
 public:
  struct Lasting {
    double last = 0.0;       // of the last scan
    double predicted = 0.0;  // of this one at the prediction, the origin
    double elsewhere = 0.0;  // and where it is found
  };
  FakeMap(const Pose2& found, const Lasting& lasting) : match_(Explaining(0.9)), lasting_(lasting) {
    match_.map_from_base = found;
  }

  std::unique_ptr<ReferenceMap> Clone() const override { return std::make_unique<FakeMap>(*this); }
  MatchResult& match() { return match_; }
  MatchResult Match(const std::shared_ptr<const Scan>&, const Prediction&) override {
    return match_;
  }
  double ShareSeenBefore(const std::shared_ptr<const Scan>&, const Pose2& pose, int) override {
    if (pose == kLastPose) return lasting_.last;
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
  MatchResult match_;
  Lasting lasting_;
};

// How many headings were tried.
class CountingMap : public FakeMap {
 public:
  CountingMap() : FakeMap({}, {}) {}
  MatchResult Match(const std::shared_ptr<const Scan>&, const Prediction&) override {
    ++matches;
    return {};
  }
  int matches = 0;
};

TEST(SlipSearch, EveryDegreeToEitherSideIsTried) {
  for (const int slip_deg : {1, 12, 15, 30, 60, 122}) {
    SlipSearch slips(slip_deg);
    slips.Placed(FrameAt(1.0), std::make_shared<const Scan>(), Explaining(0.9));
    CountingMap map;
    slips.Find(std::make_shared<const Scan>(), {}, {}, 100, map);
    EXPECT_EQ(map.matches, 2 * slip_deg + 1);
  }
}

bool IsFoundIn(FakeMap map, const Eigen::Matrix3d& covariance = Eigen::Matrix3d::Zero(),
               const SlipSearch::Last& last = kLast) {
  SlipSearch slips(12.0);
  slips.Placed(FrameAt(1.0), std::make_shared<const Scan>(), Explaining(0.9));
  return slips.Find(std::make_shared<const Scan>(), {{}, covariance}, last, 100, map).has_value();
}

bool IsFound(const Pose2& slip, const FakeMap::Lasting& lasting) {
  return IsFoundIn(FakeMap(slip, lasting));
}

const FakeMap::Lasting kAllLasts{.last = 1.0, .predicted = 0.5, .elsewhere = 1.0};
const Pose2 kTurn{0.0, 0.0, RadFromDeg(5.0)};

// Few surfels fit at some heading whatever they are of.
TEST(SlipSearch, AHeadingExplainsAboutAsManySurfelsAsTheLastScan) {
  for (const int surfels : {29, 30}) {  // of 60
    FakeMap map(kTurn, kAllLasts);
    map.match().explained = surfels;
    EXPECT_EQ(IsFoundIn(map), surfels == 30);
  }
}

TEST(SlipSearch, AHeadingIsToldByWhatIsSeen) {
  for (const double sigma_deg : {0.9, 1.1}) {
    FakeMap map(kTurn, kAllLasts);
    map.match().information(2, 2) = 1.0 / (RadFromDeg(sigma_deg) * RadFromDeg(sigma_deg));
    EXPECT_EQ(IsFoundIn(map), sigma_deg < 1.0);
  }
  // Along a lone wall nothing is known but the heading.
  FakeMap wall(kTurn, kAllLasts);
  wall.match().information(1, 1) = 0.0;
  EXPECT_TRUE(IsFoundIn(wall));
}

TEST(SlipSearch, WhatSlamErrsByUsuallyIsNoSlip) {
  for (const double sigma_deg : {1.2, 1.3}) {  // of 5 degrees, four sigmas
    const Eigen::Vector3d sigma(0.01, 0.01, RadFromDeg(sigma_deg));
    const Eigen::Matrix3d covariance = sigma.cwiseProduct(sigma).asDiagonal();
    EXPECT_EQ(IsFoundIn(FakeMap(kTurn, kAllLasts), covariance), sigma_deg < 1.25);
  }
}

// Behind a corner the end of another wall looks like that of the one before it.
TEST(SlipSearch, NoCameraGoesFarBetweenTwoScans) {
  const Eigen::Matrix3d any = Eigen::Matrix3d::Zero();
  for (const double way_m : {0.055, 0.065}) {  // of 4 cm that are usual, and what the estimates err
    const FakeMap map(kLastPose * Pose2{way_m, 0.0, RadFromDeg(5.0)}, kAllLasts);
    EXPECT_EQ(IsFoundIn(map, any, {kLastPose, 0.04}), way_m < 0.06) << way_m;
  }
}

// Counts the hits that are asked for.
class HitCountingMap : public FakeMap {
 public:
  HitCountingMap() : FakeMap(kTurn, kAllLasts) {}
  double ShareSeenBefore(const std::shared_ptr<const Scan>& scan, const Pose2&, int) override {
    hits.push_back(std::count_if(scan->beams.begin(), scan->beams.end(),
                                 [](const Beam& beam) { return beam.hit; }));
    return 1.0;
  }
  std::vector<std::ptrdiff_t> hits;
};

// 60 degrees wide, a beam a degree with a hit 100 m away; the view turns by 5 degrees.
TEST(SlipSearch, WhatLeavesTheViewOrComesIntoItIsNoEvidence) {
  auto scan = std::make_shared<Scan>();
  for (int deg = -30; deg < 30; ++deg) {
    Beam beam;
    beam.bearing_rad = static_cast<float>(RadFromDeg(deg + 0.5));
    beam.range_m = 100.0F;
    beam.hit = true;
    scan->beams.push_back(beam);
  }
  SlipSearch slips(12.0);
  slips.Placed(FrameAt(1.0), scan, Explaining(0.9));
  HitCountingMap map;
  EXPECT_TRUE(slips.Find(scan, {}, {}, 100, map));
  ASSERT_EQ(map.hits.size(), 2U);
  for (const std::ptrdiff_t hits : map.hits) EXPECT_NEAR(static_cast<double>(hits), 55.0, 1.0);
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

// A wall that has just come into view explains any pose near those its first scans are drawn at.
TEST(SlipSearch, WhereHardlyAnythingHasStoodForLongOnlyATurnIsASlip) {
  const Pose2 turn{0.002, 0.001, RadFromDeg(5.0)}, aside{0.06, 0.0, RadFromDeg(1.0)};
  const FakeMap::Lasting nothing{}, two{.last = 0.03, .predicted = 0.03, .elsewhere = 0.03},
      four{.last = 0.07, .predicted = 0.07, .elsewhere = 0.07};  // of 60 surfels
  for (const FakeMap::Lasting& lasting : {nothing, two, four}) {
    EXPECT_TRUE(IsFound(turn, lasting));
    EXPECT_TRUE(IsFound(Pose2{0.06, 0.0, RadFromDeg(5.0)}, lasting));
  }
  EXPECT_FALSE(IsFound(aside, nothing));
  EXPECT_FALSE(IsFound(aside, two));
  EXPECT_TRUE(IsFound(aside, four));
}

}  // namespace
}  // namespace depthgrid
