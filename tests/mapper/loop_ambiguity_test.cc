// Places that look alike: what the loop search makes of them.
#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/graph/loop_search.h"
#include "mapper/surfel/surfel_map.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr PlanarLaser kWideLaser{
    .beams = 160, .field_of_view_rad = RadFromDeg(90), .sigma_of_range = 0.01};
constexpr double kOtherCorridorM = 100.0;  // to the left of the first

void AddCupboard(PlanarWorld& world, double x_m, double y_m, bool left) {
  if (left) {
    AddRectangle(world, x_m, y_m + 0.9, x_m + 0.7, y_m + 1.5);
  } else {
    AddRectangle(world, x_m, y_m - 1.5, x_m + 0.5, y_m - 0.9);
  }
}

// Two corridors 30 m long whose cupboards stand at the same places but for some, which stand
// opposite.
PlanarWorld TwoCorridors(double differing_from_m, double differing_to_m) {
  PlanarWorld world = RectangleWorld(-5, -1.5, 30, 1.5);
  AddRectangle(world, -5, kOtherCorridorM - 1.5, 30, kOtherCorridorM + 1.5);
  bool left = true;
  for (double x_m :
       {-2.0, 1.1, 2.9, 4.4, 7.0, 8.2, 10.5, 13.1, 14.2, 16.7, 19.0, 20.3, 23.0, 25.4}) {
    AddCupboard(world, x_m, 0.0, left);
    const bool differs = x_m >= differing_from_m && x_m < differing_to_m;
    AddCupboard(world, x_m, kOtherCorridorM, left != differs);
    left = !left;
  }
  return world;
}

// Along the first corridor for 22 m, 18 m around in the open, and along a corridor again: poses as
// estimated, the second corridor's (true: `second`) off from those of the first by `slip`.
class CorridorWalk {
 public:
  CorridorWalk(const PlanarWorld& world, const Pose2& second, const Pose2& slip) {
    for (int i = 0; i < kSteps; ++i) Add(world, Along(i), Along(i));
    for (int i = 0; i < kAround; ++i) {
      Add({}, {0.0, -50.0, 0.0}, {22.0 - 22.0 * i / kAround, -3.0 + 0.01 * i, kPi});
    }
    for (int i = 0; i < kSteps; ++i) Add(world, second * Along(i), slip * Along(i));
  }

  static constexpr int kSteps = 220;
  static constexpr int kAround = 60;

  // The first loops that the search comes to believe. It is told of each of `known` once both its
  // frames are there.
  std::vector<PlanarLoop> Found(const LoopSearchOptions& options,
                                const std::vector<PlanarLoop>& known = {}) const {
    SurfelMap map(SurfelOptions{});
    LoopSearch search(options, {});
    std::vector<MappedFrame> so_far;
    for (const MappedFrame& frame : frames_) {
      so_far.push_back(frame);
      const auto scan = std::make_shared<const Scan>(*frame.scan);
      map.Insert(scan, frame.map_from_base, Eigen::Matrix3d::Zero());
      std::vector<PlanarLoop> told;
      for (const PlanarLoop& loop : known) {
        if (std::max(loop.first, loop.second) <= frame.frame) told.push_back(loop);
      }
      std::vector<PlanarLoop> found = search.Find(so_far, scan, told, map);
      if (!found.empty()) return found;
    }
    return {};
  }

 private:
  static Pose2 Along(int i) { return {0.1 * i, 0.1, 0.0}; }
  void Add(const PlanarWorld& world, const Pose2& truth, const Pose2& estimate) {
    frames_.push_back(
        MappedFrameAt(world, kWideLaser, truth, estimate, static_cast<int>(frames_.size())));
  }

  std::vector<MappedFrame> frames_;
};

// 44 m of way may be off by 1.8 m.
LoopSearchOptions SearchOptions() {
  LoopSearchOptions options;
  options.drift_share = 0.04;
  return options;
}

const Pose2 kOther{0.0, kOtherCorridorM, 0.0};
const Pose2 kSlip{1.4, 0.2, 0.02};

// Searches that were put off while none waited are made up for.
TEST(LookAlikes, TheSamePlacesAreFoundWhenFewAreLookedFor) {
  const CorridorWalk walk(TwoCorridors(100.0, 100.0), {}, kSlip);
  std::vector<std::vector<PlanarLoop>> found;
  for (const int idle_searches : {1, 2, 3}) {
    LoopSearchOptions options = SearchOptions();
    options.idle_searches = idle_searches;
    found.push_back(walk.Found(options));
  }
  ASSERT_FALSE(found[0].empty());
  for (const std::vector<PlanarLoop>& other : found) {
    ASSERT_EQ(other.size(), found[0].size());
    for (std::size_t i = 0; i < other.size(); ++i) {
      EXPECT_EQ(other[i].first, found[0][i].first);
      EXPECT_EQ(other[i].second, found[0][i].second);
      EXPECT_TRUE(other[i].first_from_second == found[0][i].first_from_second);
    }
  }
}

TEST(LookAlikes, ACorridorThatIsAlikeForAFewMetresIsNotTakenForTheOther) {
  const CorridorWalk walk(TwoCorridors(14.0, 30.0), kOther, kSlip);
  EXPECT_TRUE(walk.Found(SearchOptions()).empty());
  // It would be, were a few places in a row enough.
  LoopSearchOptions few = SearchOptions();
  few.consent_ways = 0.0;
  EXPECT_FALSE(walk.Found(few).empty());
}

TEST(LookAlikes, OrIsAlikeAgainFartherOn) {
  const CorridorWalk walk(TwoCorridors(14.0, 15.0), kOther, kSlip);
  EXPECT_TRUE(walk.Found(SearchOptions()).empty());
  LoopSearchOptions lenient = SearchOptions();
  lenient.most_unanswered = 100;
  EXPECT_FALSE(walk.Found(lenient).empty());
}

TEST(LookAlikes, TheSameCorridorIsFoundAgain) {
  const CorridorWalk walk(TwoCorridors(0.0, 30.0), {}, kSlip);
  const std::vector<PlanarLoop> found = walk.Found(SearchOptions());
  ASSERT_GE(found.size(), 5U);
  for (const PlanarLoop& loop : found) {
    const double way_m =
        0.1 * (loop.second - CorridorWalk::kAround - CorridorWalk::kSteps - loop.first);
    EXPECT_NEAR(loop.first_from_second.x_m, way_m, 0.03);
    EXPECT_NEAR(loop.first_from_second.y_m, 0.0, 0.03);
    EXPECT_NEAR(loop.first_from_second.yaw_rad, 0.0, 0.01);
  }
}

// After a loop the estimate is known to within the way since.
TEST(LookAlikes, AKnownLoopLeavesLittleToSearch) {
  const CorridorWalk walk(TwoCorridors(0.0, 30.0), {}, kSlip);
  std::vector<PlanarLoop> known;
  for (int i = 0; i < CorridorWalk::kSteps; i += 20) {
    PlanarLoop loop;
    loop.first = i;
    loop.second = i + CorridorWalk::kSteps + CorridorWalk::kAround;
    known.push_back(loop);
  }
  EXPECT_TRUE(walk.Found(SearchOptions(), known).empty());
}

}  // namespace
}  // namespace depthgrid
