#include "mapper/grid/crossed_walls.h"

#include <algorithm>
#include <cmath>

#include "mapper/grid/beam_noise.h"

namespace depthgrid {
namespace {

constexpr double kToleranceCells = 2.0;
constexpr double kToleranceSigmas = 3.0;

// The frames whose scans are examined.
std::vector<int> SampleOf(const std::vector<MappedFrame>& frames, std::size_t most) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MappedFrame& frame = frames[i];
    if (frame.kept() && !frame.of_prior_map() && frame.obstacles) {
      kept.push_back(static_cast<int>(i));
    }
  }
  const std::size_t step = (kept.size() + most - 1) / most;
  std::vector<int> sample;
  for (std::size_t i = 0; i < kept.size(); i += step) sample.push_back(kept[i]);
  return sample;
}

class Walls {
 public:
  explicit Walls(const OccupancyMap& map) : map_(map) {}

  double resolution_m() const { return map_.geometry.resolution_m; }

  // Whether a beam in this direction must cross a wall here: the wall goes on to both sides of it,
  // so the beam does not just graze a corner. Walls that it meets at less than 45 degrees bar none.
  bool Bars(const Cell& cell, const Eigen::Vector2d& direction) const {
    if (!IsWall(cell)) return false;
    const bool along_x = std::abs(direction.x()) > std::abs(direction.y());
    const auto goes_on = [&](int side) {
      for (const int off : {0, -1, 1}) {
        if (IsWall(along_x ? Cell{cell.x + off, cell.y + side}
                           : Cell{cell.x + side, cell.y + off})) {
          return true;
        }
      }
      return false;
    };
    return goes_on(-1) && goes_on(1);
  }

  // Whether one bars the ray from `from_m` to `to_m` along it: at two steps of half a cell in a
  // row.
  bool Bar(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction, double from_m,
           double to_m) const {
    const double step_m = 0.5 * resolution_m();
    const int steps = static_cast<int>((to_m - from_m) / step_m);
    bool barred_before = false;
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d place_m = origin_m + (from_m + i * step_m) * direction;
      const bool barred = Bars(CellOf(place_m, resolution_m()), direction);
      if (barred && barred_before) return true;
      barred_before = barred;
    }
    return false;
  }

 private:
  bool IsWall(const Cell& cell) const { return StateOf(map_.At(cell)) == CellState::kOccupied; }

  const OccupancyMap& map_;
};

// Whether the beam leads through a wall where it says that the way is free.
bool LeadsThrough(const Beam& beam, const Walls& walls, const Pose2& map_from_base,
                  const BeamNoise& noise) {
  const double cell_m = walls.resolution_m();
  const double yaw_rad = map_from_base.yaw_rad + beam.bearing_rad;
  const double tolerance_m = std::max(kToleranceCells * cell_m,
                                      kToleranceSigmas * noise.Share(beam.range_m) * beam.range_m);
  return beam.hit && walls.Bar({map_from_base.x_m, map_from_base.y_m},
                               {std::cos(yaw_rad), std::sin(yaw_rad)}, beam.clear_from_m + cell_m,
                               std::min(beam.clear_to_m - cell_m, beam.range_m - tolerance_m));
}

}  // namespace

std::vector<CrossedWalls> WallsCrossed(const std::vector<MappedFrame>& frames,
                                       const OccupancyMap& map, const CrossedWallsSample& sample) {
  const std::vector<int> examined = SampleOf(frames, sample.scans);
  std::vector<Scan> scans;
  for (const int i : examined) scans.push_back(*FrameAt(frames, i).obstacles);
  const BeamNoise noise(scans);
  const Walls walls(map);
  std::vector<CrossedWalls> found;
  for (std::size_t k = 0; k < examined.size(); ++k) {
    const std::vector<Beam>& beams = scans[k].beams;
    const Pose2& map_from_base = FrameAt(frames, examined[k]).map_from_base;
    const auto leads_through = [&](std::size_t i) {
      return LeadsThrough(beams[i], walls, map_from_base, noise);
    };
    CrossedWalls& counts = found.emplace_back();
    counts.mapped = examined[k];
    const std::size_t step = (beams.size() + sample.beams - 1) / sample.beams;
    for (std::size_t i = 0; i + 1 < beams.size(); i += step) {
      if (!beams[i].hit) continue;
      ++counts.beams;
      if (leads_through(i) && leads_through(i + 1)) ++counts.crossing;
    }
  }
  return found;
}

double CrossingShare(const std::vector<CrossedWalls>& scans) {
  CrossedWalls all;
  for (const CrossedWalls& scan : scans) {
    all.beams += scan.beams;
    all.crossing += scan.crossing;
  }
  return all.share();
}

}  // namespace depthgrid
