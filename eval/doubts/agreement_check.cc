#include "eval/doubts/agreement_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapper/core/occupancy_map.h"

namespace depthgrid {
namespace {

// Enough for shares to a tenth of a percent, and 30 ms at most.
constexpr std::size_t kMostScans = 600;
constexpr std::size_t kMostBeams = 160;  // per scan
constexpr double kToleranceCells = 2.0;
constexpr double kToleranceSigmas = 3.0;
// Warned of from this share on (docs/results.md, "Scans against their map").
constexpr double kManyCrossing = 0.02;

// The scans that are examined: evenly spread over the run.
std::vector<const MappedFrame*> SampleOf(const std::vector<MappedFrame>& mapped) {
  std::vector<const MappedFrame*> kept;
  for (const MappedFrame& frame : mapped) {
    if (frame.kept() && !frame.of_prior_map() && frame.obstacles) kept.push_back(&frame);
  }
  const std::size_t step = (kept.size() + kMostScans - 1) / kMostScans;
  std::vector<const MappedFrame*> sample;
  for (std::size_t i = 0; i < kept.size(); i += step) sample.push_back(kept[i]);
  return sample;
}

// Standard deviation of a beam's range as a share of the range. On a flat wall the second
// difference of three neighbouring ranges is noise alone, of variance (1 + 4 + 1) sigma^2; edges
// are few, so the median passes over them.
double NoiseShare(const std::vector<Scan>& scans) {
  std::vector<double> shares;
  for (const Scan& scan : scans) {
    for (std::size_t i = 1; i + 1 < scan.beams.size(); ++i) {
      const Beam &before = scan.beams[i - 1], &here = scan.beams[i], &after = scan.beams[i + 1];
      if (!before.hit || !here.hit || !after.hit) continue;
      const double bend_m = before.range_m - 2.0 * here.range_m + after.range_m;
      shares.push_back(std::abs(bend_m) / here.range_m);
    }
  }
  if (shares.empty()) return 0.0;
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  constexpr double kMedianOfNormal = 0.6745;
  return *middle / (kMedianOfNormal * std::sqrt(6.0));
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
                  double noise_share) {
  const double cell_m = walls.resolution_m();
  const double yaw_rad = map_from_base.yaw_rad + beam.bearing_rad;
  const double tolerance_m =
      std::max(kToleranceCells * cell_m, kToleranceSigmas * noise_share * beam.range_m);
  return beam.hit && walls.Bar({map_from_base.x_m, map_from_base.y_m},
                               {std::cos(yaw_rad), std::sin(yaw_rad)}, beam.clear_from_m + cell_m,
                               std::min(beam.clear_to_m - cell_m, beam.range_m - tolerance_m));
}

struct Counts {
  int beams = 0, crossing = 0;
};

Counts CountIn(const Walls& walls, const Scan& scan, const Pose2& map_from_base,
               double noise_share) {
  const std::size_t step = (scan.beams.size() + kMostBeams - 1) / kMostBeams;
  Counts counts;
  for (std::size_t i = 0; i + 1 < scan.beams.size(); i += step) {
    if (!scan.beams[i].hit) continue;
    ++counts.beams;
    // A single beam may be a wrong reading; its neighbour then is not.
    const auto leads_through = [&](std::size_t k) {
      return LeadsThrough(scan.beams[k], walls, map_from_base, noise_share);
    };
    if (leads_through(i) && leads_through(i + 1)) ++counts.crossing;
  }
  return counts;
}

}  // namespace

std::optional<Agreement> AgreementOf(const MapperResult& result) {
  const std::vector<const MappedFrame*> sample = SampleOf(result.mapped);
  std::vector<Scan> scans;
  for (const MappedFrame* frame : sample) scans.push_back(*frame->obstacles);
  const double noise_share = NoiseShare(scans);
  const Walls walls(result.map);
  Agreement agreement;
  int crossing = 0, worst = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const Counts counts = CountIn(walls, scans[i], sample[i]->map_from_base, noise_share);
    agreement.beams += counts.beams;
    crossing += counts.crossing;
    if (counts.crossing <= worst) continue;
    worst = counts.crossing;
    agreement.worst_frame = sample[i]->frame;
  }
  if (agreement.beams == 0) return {};
  agreement.crossing_share = static_cast<double>(crossing) / agreement.beams;
  return agreement;
}

std::optional<std::string> DoubtOfAgreement(const Agreement& agreement) {
  if (agreement.crossing_share < kManyCrossing) return {};
  return fmt::format(
      "the map contradicts its own scans: {:.1f} % of the beams lead through its walls (most "
      "around "
      "frame {}), so walls are drawn twice or askew, as where poses are wrong",
      100.0 * agreement.crossing_share, *agreement.worst_frame);
}

std::optional<std::string> DoubtOfAgreement(const MapperResult& result) {
  const auto agreement = AgreementOf(result);
  return agreement ? DoubtOfAgreement(*agreement) : std::nullopt;
}

}  // namespace depthgrid
