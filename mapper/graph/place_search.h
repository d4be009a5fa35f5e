// Finds the pose of points in a place's map by branch and bound over a window (Hess et al. 2016;
// Olson 2009 for the pyramid). Exact: the same pose as an exhaustive search.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Scores of a place's cells, 2 in a wall, 1 beside one, and for each level the largest score in the
// square of 2^level cells up and to the right.
class WallPyramid {
 public:
  explicit WallPyramid(const OccupancyMap& map);

  int levels() const { return static_cast<int>(levels_.size()); }
  double resolution_m() const { return resolution_m_; }
  // The largest score of cells x..x+2^level-1, y..y+2^level-1; 0 outside.
  int Best(const Cell& cell, int level) const;
  // The sum over these cells, shifted. If it is at most `of_interest`, any number from the sum to
  // `of_interest` may be returned.
  int Sum(const std::vector<Cell>& cells, const Cell& shift, int level, int of_interest) const;

  // The sums for count x count adjacent squares of the highest level, from `shift` on: square (x,
  // y) is at y * count + x.
  std::vector<int> SumsOfSquares(const std::vector<Cell>& cells, const Cell& shift,
                                 int count) const;

 private:
  // The highest level's scores reordered: cells that are multiples of a square apart are adjacent,
  // so that four by four squares are four short rows.
  struct Squares {
    int width = 0, height = 0;        // of one such grid, including a border
    std::vector<std::uint8_t> score;  // [y within a square][x within a square][y][x]
  };
  struct Level {
    GridGeometry geometry;
    std::vector<std::uint8_t> score;  // and one more, for cells outside
  };
  static constexpr int kSideBySide = 4;  // squares summed together in each direction
  using FourByFour = std::array<int, kSideBySide * kSideBySide>;

  void AddLevel();
  void FindSquares();
  // `first`: the highest level's first cell, less the shift.
  FourByFour SumsOfFourByFour(const std::vector<Cell>& cells, const Cell& first) const;

  double resolution_m_;
  std::vector<Level> levels_;
  Squares squares_;
};

constexpr int kBestWallScore = 2;

struct PlaceWindow {
  Pose2 place_from_query;  // centre
  double half_m = 1.0;
  double half_rad = 0.2;
};

// Poses near this one are excluded.
struct NotNear {
  Pose2 place_from_query;
  double within_m = 0.5;
  double within_rad = 0.2;
};

struct PlaceMatch {
  bool found = false;  // whether any pose reaches `least_score`
  Pose2 place_from_query;
  double score = 0.0;  // mean over the points, 0..1
};

PlaceMatch SearchPlace(const WallPyramid& walls, const std::vector<Eigen::Vector2d>& points,
                       const PlaceWindow& window, double least_score,
                       const std::optional<NotNear>& except = std::nullopt);

}  // namespace depthgrid
