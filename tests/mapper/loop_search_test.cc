#include "mapper/graph/loop_search.h"

#include <gtest/gtest.h>

#include "mapper/graph/place_search.h"
#include "mapper/match/search_lattice.h"
#include "mapper/surfel/surfel_map.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr PlanarLaser kSearchLaser{
    .beams = 320, .field_of_view_rad = RadFromDeg(90), .sigma_of_range = 0.01};

// Straight on for 1.5 m in x at each of the places, looking along the way; the estimate of the
// second place is off by `drift`.
std::vector<MappedFrame> TwoVisits(const PlanarWorld& world, const Pose2& first,
                                   const Pose2& second, const Pose2& drift) {
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 60; ++i) {
    const Pose2 truth = (i < 30 ? first : second) * Pose2{0.05 * (i % 30), 0.0, 0.0};
    frames.push_back(MappedFrameAt(world, kSearchLaser, truth, i < 30 ? truth : drift * truth, i));
  }
  return frames;
}

std::optional<PlanarLoop> LoopOf(const std::vector<MappedFrame>& frames) {
  const PlaceMatcher matcher({}, {});
  return matcher.LoopBetween(frames, 15, 45, 1.0, RadFromDeg(10));
}

TEST(PlaceMatcher, FindsARoomAgainAfterDrift) {
  const Pose2 start{0.5, 1.0, 0.2};
  const Pose2 drift{0.45, -0.3, 0.06};
  const std::vector<MappedFrame> frames =
      TwoVisits(FurnishedRoom(), start, start * Pose2{0.1, 0.1, 0.1}, drift);
  const std::optional<PlanarLoop> loop = LoopOf(frames);
  ASSERT_TRUE(loop);
  const Pose2 truth =
      Between(start * Pose2{0.75, 0, 0}, start * Pose2{0.1, 0.1, 0.1} * Pose2{0.75, 0, 0});
  const Pose2 error = Between(truth, loop->first_from_second);
  EXPECT_LT(error.translation().norm(), 0.02);
  EXPECT_LT(std::abs(error.yaw_rad), 0.01);
}

// Two long walls fit at any place along them.
TEST(PlaceMatcher, RefusesACorridor) {
  const PlanarWorld corridor = RectangleWorld(-30, -1, 30, 1);
  EXPECT_FALSE(LoopOf(TwoVisits(corridor, {0, 0, 0}, {0.2, 0, 0}, {0.4, 0, 0})));
  // Nor by its covariance, when the search alone does not see that it is ambiguous.
  LoopSearchOptions options;
  options.max_second_score = 1.0;
  const PlaceMatcher matcher(options, {});
  const auto frames = TwoVisits(corridor, {0, 0, 0}, {0.2, 0, 0}, {0.4, 0, 0});
  EXPECT_FALSE(matcher.LoopBetween(frames, 15, 45, 1.0, RadFromDeg(10)));
}

// One scan sees nothing at all along it, and what is left there is rounding.
TEST(PlaceMatcher, RefusesACorridorSeenByOneScan) {
  int tried = 0;
  for (int heading = 0; heading < 40; ++heading) {
    for (int k = 0; k < 3; ++k, ++tried) {
      const Pose2 map_from_corridor{0.0, 0.0, 0.17 * heading - 3.0};
      PlanarWorld corridor;
      for (const Wall& wall : StraightCorridor()) {
        corridor.push_back({map_from_corridor * wall.from, map_from_corridor * wall.to});
      }
      const Pose2 off{0.2 + 0.1 * k, 0.1 * k, 0.0};
      const auto frames = TwoVisits(corridor, map_from_corridor, map_from_corridor * off, {});
      PlanarLoop loop;
      loop.first = 15;
      loop.second = 45;
      loop.first_from_second = off * Pose2{-0.1, 0.0, 0.0};
      EXPECT_FALSE(PlaceMatcher({}, {}).Confirmed(frames, {0, 5, 10, 15, 20, 25}, {45}, loop, 0.9));
    }
  }
  EXPECT_EQ(tried, 120);
}

// A room of the same outline whose furniture stands elsewhere.
TEST(PlaceMatcher, RefusesARoomThatLooksAlike) {
  PlanarWorld rooms = RectangleWorld(0, 0, 5, 4);
  const auto add = [&](const PlanarWorld& part) {
    rooms.insert(rooms.end(), part.begin(), part.end());
  };
  add(RectangleWorld(3.0, 0.5, 3.8, 1.2));
  add(RectangleWorld(10, 0, 15, 4));
  add(RectangleWorld(13.6, 2.6, 14.4, 3.3));
  const std::vector<MappedFrame> same =
      TwoVisits(rooms, {0.5, 1.8, 0}, {0.6, 1.7, 0.1}, {0.3, 0.2, 0.05});
  EXPECT_TRUE(LoopOf(same));
  const std::vector<MappedFrame> other =
      TwoVisits(rooms, {0.5, 1.8, 0}, {10.6, 1.7, 0.1}, {-9.7, 0.2, 0.05});
  EXPECT_FALSE(LoopOf(other));
}

// Between the visits a box came into view.
TEST(PlaceMatcher, RefusesWhatExplainsTooLittleOfTheScans) {
  const Pose2 start{0.5, 1.0, 0.2};
  auto frames = TwoVisits(FurnishedRoom(), start, start, {0.3, -0.2, 0.04});
  PlanarWorld later = FurnishedRoom();
  AddRectangle(later, 4.4, 1.3, 4.7, 1.6);
  const auto changed = TwoVisits(later, start, start, {0.3, -0.2, 0.04});
  std::copy(changed.begin() + 30, changed.end(), frames.begin() + 30);
  LoopSearchOptions options;
  options.min_agreement = 0.8;
  const auto finds = [&](double min_explained) {
    options.min_explained = min_explained;
    return PlaceMatcher(options, {}).LoopBetween(frames, 15, 45, 1.0, RadFromDeg(10)).has_value();
  };
  EXPECT_TRUE(finds(0.8));
  EXPECT_FALSE(finds(0.95));
}

// On the spot, by 10 degrees a frame.
TEST(Place, EndsWhereTheCameraTurnedAway) {
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 40; ++i) {
    const Pose2 pose{3.0, 1.5, RadFromDeg(10.0 * i)};
    frames.push_back(MappedFrameAt(FurnishedRoom(), kSearchLaser, pose, pose, i));
  }
  PlaceOptions options;
  options.turn_deg = 55.0;
  options.max_scans = 100;
  const std::vector<int> members = FramesAround(frames, 20, options);
  EXPECT_EQ(members.front(), 15);
  EXPECT_EQ(members.back(), 25);
}

TEST(PlaceSearch, ScoresWhatTryingAllPosesScores) {
  const auto frames = TwoVisits(FurnishedRoom(), {0.5, 1, 0.2}, {0.6, 1.1, 0.3}, {0.2, -0.1, 0.03});
  const PlaceOptions options;
  const auto first = FramesAround(frames, 15, options);
  const auto second = FramesAround(frames, 45, options);
  const WallPyramid walls(DrawPlace(frames, first, 15, options.resolution_m));
  const auto points = PointsOfPlace(frames, second, 45, options.resolution_m);
  const PlaceWindow window{Between(frames[15].map_from_base, frames[45].map_from_base), 0.4, 0.1};
  const PlaceMatch match = SearchPlace(walls, points, window, 0.1);
  ASSERT_TRUE(match.found);
  double farthest_m = 0.0;
  for (const auto& p : points) farthest_m = std::max(farthest_m, p.norm());
  const SearchLattice lattice = MakeLattice(window.place_from_query, 0.4, 0.1, 0.05, farthest_m);
  int best = 0;
  for (int yaw = -lattice.half_yaw_steps; yaw <= lattice.half_yaw_steps; ++yaw) {
    const PointCells at = lattice.CellsAt(yaw);
    for (int y = -lattice.half_cells; y <= lattice.half_cells; ++y) {
      for (int x = -lattice.half_cells; x <= lattice.half_cells; ++x) {
        int sum = 0;
        for (const auto& p : points) {
          const auto px = static_cast<float>(p.x());
          const auto py = static_cast<float>(p.y());
          sum += walls.Best({at.whole_cells.x + x + static_cast<int>(at.X(px, py)),
                             at.whole_cells.y + y + static_cast<int>(at.Y(px, py))},
                            0);
        }
        best = std::max(best, sum);
      }
    }
  }
  EXPECT_DOUBLE_EQ(match.score, best / (2.0 * static_cast<double>(points.size())));
}

// Round a furnished room for 30 m with an estimate that slips 0.4 m half-way.
TEST(LoopSearch, FindsTheSlipWithinAFewMetresAndFourPlacesConsent) {
  std::vector<MappedFrame> frames;
  SurfelMap map(SurfelOptions{});
  LoopSearch search({}, {});
  const Pose2 slip{0.3, 0.25, 0.05};
  std::vector<PlanarLoop> found;
  for (int i = 0; i < 620 && found.empty(); ++i) {
    const double angle_rad = 2.0 * kPi * i / 100.0;
    const Pose2 truth{3.0 + 0.8 * std::cos(angle_rad), 1.5 + 0.8 * std::sin(angle_rad),
                      WrapAngle(angle_rad)};
    const bool slipped = i >= 450;
    frames.push_back(
        MappedFrameAt(FurnishedRoom(), kSearchLaser, truth, slipped ? slip * truth : truth, i));
    const auto scan = std::make_shared<const Scan>(*frames.back().scan);
    map.Insert(scan, frames.back().map_from_base, Eigen::Matrix3d::Zero());
    found = search.Find(frames, scan, {}, map);
    EXPECT_TRUE(slipped || found.empty()) << i;
  }
  ASSERT_EQ(found.size(), 4U);
  // The first place found again may reach back to before the slip.
  const PlanarLoop& loop = found.back();
  const Pose2& first = frames[static_cast<std::size_t>(loop.first)].map_from_base;
  const Pose2& second = frames[static_cast<std::size_t>(loop.second)].map_from_base;
  const Pose2 error = Between(Between(first, Inverse(slip) * second), loop.first_from_second);
  EXPECT_LT(error.translation().norm(), 0.03);
  EXPECT_LT(std::abs(error.yaw_rad), 0.01);
}

}  // namespace
}  // namespace depthgrid
