#include "mapper/graph/place_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr float kWallProb = 0.5F;
// The widest square is 32 cells, 1.6 m of a 5 cm grid: wider ones hold a wall nearly everywhere.
constexpr int kMaxLevels = 6;

void RaiseTo(std::uint8_t score, const Cell& cell, const GridGeometry& geometry,
             std::vector<std::uint8_t>& scores) {
  std::uint8_t& there = scores[geometry.Index(cell)];
  there = std::max(there, score);
}

void RaiseRow(const std::uint8_t* scores, std::size_t count, std::uint8_t* into) {
  for (std::size_t i = 0; i < count; ++i) into[i] = std::max(into[i], scores[i]);
}

// The points' cells at one rotation.
std::vector<Cell> CellsOf(const std::vector<Eigen::Vector2d>& points, const PointCells& at) {
  std::vector<Cell> cells;
  cells.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    const auto x = static_cast<float>(point.x());
    const auto y = static_cast<float>(point.y());
    cells.push_back({at.whole_cells.x + static_cast<int>(at.X(x, y)),
                     at.whole_cells.y + static_cast<int>(at.Y(x, y))});
  }
  return cells;
}

// A square of translations of one rotation, and more than what any of them can score.
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
    for (const Eigen::Vector2d& point : points) {
      farthest2 = std::max(farthest2, point.squaredNorm());
    }
    lattice_ = MakeLattice(window.place_from_query, window.half_m, window.half_rad,
                           walls.resolution_m(), std::sqrt(farthest2));
    for (int yaw = -lattice_.half_yaw_steps; yaw <= lattice_.half_yaw_steps; ++yaw) {
      cells_.push_back(CellsOf(points, lattice_.CellsAt(yaw)));
    }
    best_score_ = static_cast<int>(std::ceil(least_score * kBestWallScore *
                                             static_cast<double>(points.size()))) -
                  1;
  }

  void Run() {
    const int level = walls_.levels() - 1;
    std::vector<Candidate> candidates;
    for (int yaw = -lattice_.half_yaw_steps; yaw <= lattice_.half_yaw_steps; ++yaw) {
      for (int y = -lattice_.half_cells; y <= lattice_.half_cells; y += 1 << level) {
        for (int x = -lattice_.half_cells; x <= lattice_.half_cells; x += 1 << level) {
          candidates.push_back(CandidateAt({x, y, yaw}, level));
        }
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
  Candidate CandidateAt(const LatticeStep& step, int level) const {
    const std::vector<Cell>& cells =
        cells_[static_cast<std::size_t>(step.yaw_steps + lattice_.half_yaw_steps)];
    return {step, walls_.Sum(cells, {step.x_cells, step.y_cells}, level, best_score_)};
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
    // Corners outside the window stay below any score.
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
  int best_score_ = 0;                    // only more than this is of interest
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
}

// The squares of a level are made of four of the level below: the larger of two side by side, then
// of two such rows. A cell's lower-left square lies `half` cells to the left and below in the level
// below, whose geometry begins that much later.
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
  std::array<unsigned, kTogether> at;  // found apart, as that vectorises
  int sum = 0;
  for (std::size_t begin = 0; begin < cells.size(); begin += kTogether) {
    const std::size_t end = std::min(begin + kTogether, cells.size());
    for (std::size_t i = begin; i < end; ++i) {
      // Cells before the first are large without a sign.
      const auto x = static_cast<unsigned>(cells[i].x - first.x);
      const auto y = static_cast<unsigned>(cells[i].y - first.y);
      at[i - begin] = x < width && y < height ? y * width + x : outside;
    }
    for (std::size_t i = 0; i < end - begin; ++i) sum += l.score[at[i]];
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
