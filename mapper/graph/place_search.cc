#include "mapper/graph/place_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "mapper/core/error.h"
#include "mapper/match/search_lattice.h"

namespace depthgrid {
namespace {

constexpr float kWallProb = 0.5F;
// The largest square is 32 cells, 1.6 m at 5 cm: larger ones contain a wall nearly everywhere.
constexpr int kMaxLevels = 6;
constexpr int kTopLevel = kMaxLevels - 1;
constexpr int kWithin = (1 << kTopLevel) - 1;

void RaiseTo(std::uint8_t score, const Cell& cell, const GridGeometry& geometry,
             std::vector<std::uint8_t>& scores) {
  std::uint8_t& there = scores[geometry.Index(cell)];
  there = std::max(there, score);
}

void RaiseRow(const std::uint8_t* scores, std::size_t count, std::uint8_t* into) {
  for (std::size_t i = 0; i < count; ++i) into[i] = std::max(into[i], scores[i]);
}

static_assert(std::endian::native == std::endian::little);  // byte k of a word is column k

// Cells of the points at one rotation.
std::vector<Cell> CellsOf(const std::vector<float>& x_m, const std::vector<float>& y_m,
                          const PointCells& at) {
  std::vector<Cell> cells(x_m.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {  // a loop that vectorises
    cells[i].x = at.whole_cells.x + static_cast<int>(at.X(x_m[i], y_m[i]));
    cells[i].y = at.whole_cells.y + static_cast<int>(at.Y(x_m[i], y_m[i]));
  }
  return cells;
}

// A square of translations at one rotation, with an upper bound of their scores.
struct Candidate {
  LatticeStep step;  // its lower-left corner
  int bound = -1;
};

bool Better(const Candidate& a, const Candidate& b) {
  return a.bound != b.bound ? a.bound > b.bound : PrecedesInLattice(a.step, b.step);
}

class Search {
 public:
  Search(const WallPyramid& walls, const std::vector<Eigen::Vector2d>& points,
         const PlaceWindow& window, double least_score, const std::optional<NotNear>& except)
      : walls_(walls), except_(except) {
    double farthest2 = 0.0;
    std::vector<float> x_m, y_m;
    for (const Eigen::Vector2d& point : points) {
      x_m.push_back(static_cast<float>(point.x()));
      y_m.push_back(static_cast<float>(point.y()));
      farthest2 = std::max(farthest2, point.squaredNorm());
    }
    lattice_ = MakeLattice(window.place_from_query, window.half_m, window.half_rad,
                           walls.resolution_m(), std::sqrt(farthest2));
    for (int yaw = -lattice_.half_yaw_steps; yaw <= lattice_.half_yaw_steps; ++yaw) {
      cells_.push_back(CellsOf(x_m, y_m, lattice_.CellsAt(yaw)));
    }
    best_score_ = static_cast<int>(std::ceil(least_score * kBestWallScore *
                                             static_cast<double>(points.size()))) -
                  1;
  }

  void Run() {
    const int level = walls_.levels() - 1;
    std::vector<Candidate> candidates;
    const int from = -lattice_.half_cells, count = (2 * lattice_.half_cells >> level) + 1;
    for (int yaw = -lattice_.half_yaw_steps; yaw <= lattice_.half_yaw_steps; ++yaw) {
      const std::vector<int> sums = walls_.SumsOfSquares(CellsAt(yaw), {from, from}, count);
      for (int i = 0; i < count * count; ++i) {
        const int bound = sums[static_cast<std::size_t>(i)];
        if (bound <= best_score_) continue;
        const LatticeStep step{from + ((i % count) << level), from + ((i / count) << level), yaw};
        candidates.push_back({step, bound});
      }
    }
    std::sort(candidates.begin(), candidates.end(), Better);
    for (const Candidate& candidate : candidates) Branch(candidate, level);
  }

  PlaceMatch Result(std::size_t points) const {
    PlaceMatch match;
    if (!best_) return match;
    match.found = true;
    match.place_from_query = lattice_.PoseOf(*best_);
    match.score = best_score_ / (static_cast<double>(kBestWallScore) * static_cast<double>(points));
    return match;
  }

 private:
  const std::vector<Cell>& CellsAt(int yaw_steps) const {
    return cells_[static_cast<std::size_t>(yaw_steps + lattice_.half_yaw_steps)];
  }

  Candidate CandidateAt(const LatticeStep& step, int level) const {
    return {step,
            walls_.Sum(CellsAt(step.yaw_steps), {step.x_cells, step.y_cells}, level, best_score_)};
  }

  bool IsExcepted(const LatticeStep& step) const {
    if (!except_) return false;
    const Pose2 off = Between(except_->place_from_query, lattice_.PoseOf(step));
    return off.translation().norm() < except_->within_m &&
           std::abs(off.yaw_rad) < except_->within_rad;
  }

  void Branch(const Candidate& candidate, int level) {
    if (candidate.bound <= best_score_) return;
    if (level == 0) {
      if (IsExcepted(candidate.step)) return;
      best_score_ = candidate.bound;
      best_ = candidate.step;
      return;
    }
    // Corners outside the window keep the bound -1.
    std::array<Candidate, 4> children{};
    for (int corner = 0; corner < 4; ++corner) {
      LatticeStep step = candidate.step;
      step.x_cells += (corner & 1) << (level - 1);
      step.y_cells += (corner >> 1) << (level - 1);
      if (step.x_cells > lattice_.half_cells || step.y_cells > lattice_.half_cells) continue;
      children[static_cast<std::size_t>(corner)] = CandidateAt(step, level - 1);
    }
    std::sort(children.begin(), children.end(), Better);
    for (const Candidate& child : children) Branch(child, level - 1);
  }

  const WallPyramid& walls_;
  std::optional<NotNear> except_;
  SearchLattice lattice_;
  std::vector<std::vector<Cell>> cells_;  // one entry a rotation
  int best_score_ = 0;                    // scores must exceed this
  std::optional<LatticeStep> best_;
};

}  // namespace

WallPyramid::WallPyramid(const OccupancyMap& map) : resolution_m_(map.geometry.resolution_m) {
  Level finest;
  finest.geometry = map.geometry;
  finest.geometry.min_cell = {map.geometry.min_cell.x - 1, map.geometry.min_cell.y - 1};
  finest.geometry.width_cells += 2;
  finest.geometry.height_cells += 2;
  finest.score.assign(finest.geometry.size() + 1, 0);
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    if (!(map.occupied_prob[i] > kWallProb)) continue;
    const Cell wall = map.geometry.CellAt(i);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const bool centre = dx == 0 && dy == 0;
        RaiseTo(centre ? kBestWallScore : 1, {wall.x + dx, wall.y + dy}, finest.geometry,
                finest.score);
      }
    }
  }
  levels_.push_back(std::move(finest));
  while (static_cast<int>(levels_.size()) < kMaxLevels) AddLevel();
  FindSquares();
}

// A square of this level is the maximum of four of the level below. Each score of the level below
// enters the squares that start at its cell and `half` cells to the left of and below it, hence the
// larger geometry.
void WallPyramid::AddLevel() {
  const int half = 1 << (levels() - 1);
  const Level& below = levels_.back();
  Level level;
  level.geometry = below.geometry;
  level.geometry.min_cell.x -= half;
  level.geometry.min_cell.y -= half;
  level.geometry.width_cells += half;
  level.geometry.height_cells += half;
  level.score.assign(level.geometry.size() + 1, 0);
  const auto width = static_cast<std::size_t>(below.geometry.width_cells);
  for (int row = 0; row < below.geometry.height_cells; ++row) {
    const std::uint8_t* scores = below.score.data() + static_cast<std::size_t>(row) * width;
    for (const int up : {0, half}) {
      std::uint8_t* into = level.score.data() + static_cast<std::size_t>(row + up) *
                                                    (width + static_cast<std::size_t>(half));
      RaiseRow(scores, width, into);
      RaiseRow(scores, width, into + half);
    }
  }
  levels_.push_back(std::move(level));
}

void WallPyramid::FindSquares() {
  const Level& level = levels_.back();
  squares_.width = ((level.geometry.width_cells - 1) >> kTopLevel) + 1 + 2 * kSideBySide;
  squares_.height = ((level.geometry.height_cells - 1) >> kTopLevel) + 1 + 2 * kSideBySide;
  const auto width = static_cast<std::size_t>(squares_.width);
  const std::size_t size = width * static_cast<std::size_t>(squares_.height);
  squares_.score.assign(size << (2 * kTopLevel), 0);
  for (int within = 0; within <= kWithin; ++within) {  // for locality of writes
    for (int y = within; y < level.geometry.height_cells; y += kWithin + 1) {
      const auto row = static_cast<std::size_t>((y >> kTopLevel) + kSideBySide) * width;
      const std::uint8_t* from =
          level.score.data() +
          static_cast<std::size_t>(y) * static_cast<std::size_t>(level.geometry.width_cells);
      for (int x = 0; x < level.geometry.width_cells; ++x) {
        const auto column = static_cast<std::size_t>((x >> kTopLevel) + kSideBySide);
        const auto grid = static_cast<std::size_t>((within << kTopLevel) + (x & kWithin));
        squares_.score[grid * size + row + column] = from[x];
      }
    }
  }
}

std::vector<int> WallPyramid::SumsOfSquares(const std::vector<Cell>& cells, const Cell& shift,
                                            int count) const {
  const Level& level = levels_.back();
  const Cell first{level.geometry.min_cell.x - shift.x, level.geometry.min_cell.y - shift.y};
  std::vector<int> sums(static_cast<std::size_t>(count * count));
  for (int y = 0; y < count; y += kSideBySide) {
    for (int x = 0; x < count; x += kSideBySide) {
      const FourByFour some =
          SumsOfFourByFour(cells, {first.x - (x << kTopLevel), first.y - (y << kTopLevel)});
      for (int dy = 0; dy < std::min(kSideBySide, count - y); ++dy) {
        for (int dx = 0; dx < std::min(kSideBySide, count - x); ++dx) {
          sums[static_cast<std::size_t>((y + dy) * count + x + dx)] =
              some[static_cast<std::size_t>(dy * kSideBySide + dx)];
        }
      }
    }
  }
  return sums;
}

// Sums four bytes per word, over as few points that no byte overflows.
WallPyramid::FourByFour WallPyramid::SumsOfFourByFour(const std::vector<Cell>& cells,
                                                      const Cell& first) const {
  constexpr std::size_t kTogether = 64;
  static_assert(kTogether * kBestWallScore < 256 && sizeof(std::uint32_t) == kSideBySide);
  const auto width = static_cast<std::size_t>(squares_.width);
  const int size = squares_.width * squares_.height;
  FourByFour sums{};
  std::array<int, kTogether> at;  // separate loop, so that it vectorises
  for (std::size_t begin = 0; begin < cells.size(); begin += kTogether) {
    const std::size_t end = std::min(begin + kTogether, cells.size());
    for (std::size_t i = begin; i < end; ++i) {
      const int x = cells[i].x - first.x, y = cells[i].y - first.y;
      // Clamped: farther outside all squares are empty as well.
      const int column =
          std::clamp((x >> kTopLevel) + kSideBySide, 0, squares_.width - kSideBySide);
      const int row = std::clamp((y >> kTopLevel) + kSideBySide, 0, squares_.height - kSideBySide);
      const int grid = ((y & kWithin) << kTopLevel) + (x & kWithin);
      at[i - begin] = grid * size + row * squares_.width + column;
    }
    std::array<std::uint32_t, kSideBySide> rows{};
    for (std::size_t i = 0; i < end - begin; ++i) {
      const std::uint8_t* from = squares_.score.data() + at[i];
      for (std::uint32_t& row : rows) {
        std::uint32_t four = 0;
        std::memcpy(&four, from, sizeof(four));
        row += four;
        from += width;
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += static_cast<int>(rows[i / kSideBySide] >> (8 * (i % kSideBySide)) & 0xFFU);
    }
  }
  return sums;
}

int WallPyramid::Best(const Cell& cell, int level) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  return l.geometry.Contains(cell) ? l.score[l.geometry.Index(cell)] : 0;
}

int WallPyramid::Sum(const std::vector<Cell>& cells, const Cell& shift, int level,
                     int of_interest) const {
  constexpr std::size_t kTogether = 64;
  const Level& l = levels_[static_cast<std::size_t>(level)];
  const Cell first{l.geometry.min_cell.x - shift.x, l.geometry.min_cell.y - shift.y};
  const auto width = static_cast<unsigned>(l.geometry.width_cells);
  const auto height = static_cast<unsigned>(l.geometry.height_cells);
  const auto outside = static_cast<unsigned>(l.geometry.size());
  std::array<unsigned, kTogether> at;  // separate loop, so that it vectorises
  int sum = 0;
  for (std::size_t begin = 0; begin < cells.size(); begin += kTogether) {
    const std::size_t end = std::min(begin + kTogether, cells.size());
    for (std::size_t i = begin; i < end; ++i) {
      // Negative differences become large unsigned numbers.
      const auto x = static_cast<unsigned>(cells[i].x - first.x);
      const auto y = static_cast<unsigned>(cells[i].y - first.y);
      at[i - begin] = x < width && y < height ? y * width + x : outside;
    }
    const std::uint8_t* const score = l.score.data();
    const std::size_t count = end - begin, fours = count / 4 * 4;
    std::array<int, 4> sums{};  // independent accumulators
    for (std::size_t i = 0; i < fours; i += 4) {
      for (std::size_t k = 0; k < 4; ++k) sums[k] += score[at[i + k]];
    }
    for (std::size_t i = fours; i < count; ++i) sum += score[at[i]];
    sum += sums[0] + sums[1] + sums[2] + sums[3];
    const int most = sum + kBestWallScore * static_cast<int>(cells.size() - end);
    if (most <= of_interest) return most;
  }
  return sum;
}

PlaceMatch SearchPlace(const WallPyramid& walls, const std::vector<Eigen::Vector2d>& points,
                       const PlaceWindow& window, double least_score,
                       const std::optional<NotNear>& except) {
  Require(least_score > 0.0, "a place is found by what fits");
  if (points.empty()) return {};
  Search search(walls, points, window, least_score, except);
  search.Run();
  return search.Result(points.size());
}

}  // namespace depthgrid
