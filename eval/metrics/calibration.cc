#include "eval/metrics/calibration.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {

std::optional<Calibration> Calibrate(const StateMap& truth, const OccupancyMap& estimate,
                                     const CellSet& scored) {
  Calibration sum;
  for (std::size_t i = 0; i < truth.states.size(); ++i) {
    if (scored.members[i] == 0 || truth.states[i] == CellState::kUnknown) continue;
    const double prob = estimate.At(truth.geometry.CellAt(i));
    if (std::isnan(prob)) continue;
    const double is_wall = truth.states[i] == CellState::kOccupied ? 1.0 : 0.0;
    const double held = std::clamp(prob, kLeastProb, 1.0 - kLeastProb);
    ++sum.cells;
    sum.brier += (prob - is_wall) * (prob - is_wall);
    sum.log_loss -= std::log(is_wall > 0.0 ? held : 1.0 - held);
    const int bin = std::min(static_cast<int>(prob * kReliabilityBins), kReliabilityBins - 1);
    ReliabilityBin& b = sum.bins[static_cast<std::size_t>(bin)];
    ++b.cells;
    b.mean_prob += prob;
    b.occupied_share += is_wall;
  }
  if (sum.cells == 0) return std::nullopt;
  sum.brier /= sum.cells;
  sum.log_loss /= sum.cells;
  for (ReliabilityBin& b : sum.bins) {
    if (b.cells == 0) continue;
    sum.calibration_error += std::abs(b.occupied_share - b.mean_prob) / sum.cells;
    b.mean_prob /= b.cells;
    b.occupied_share /= b.cells;
  }
  return sum;
}

}  // namespace depthgrid
