// Calibration of a map's probabilities: of the cells said to be occupied with probability p, a
// share p should be occupied.
#pragma once

#include <array>
#include <optional>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

constexpr int kReliabilityBins = 10;

struct ReliabilityBin {
  int cells = 0;
  double mean_prob = 0.0;       // of the estimate; 0 for no cells
  double occupied_share = 0.0;  // in truth; 0 for no cells
};

// Over the scored cells that are known both in the truth and in the estimate.
struct Calibration {
  int cells = 0;
  double brier = 0.0;     // mean squared difference of probability and truth
  double log_loss = 0.0;  // mean of -ln of the probability given to the truth (cross-entropy)
  // Mean over cells of |occupied share - mean probability| of the cell's bin.
  double calibration_error = 0.0;
  std::array<ReliabilityBin, kReliabilityBins> bins;  // [0, 0.1), [0.1, 0.2) ... [0.9, 1]
};

// For the logarithm, probabilities are clamped to [this, 1 - this], so that one wrong cell with
// probability 0 or 1 does not make the loss infinite.
constexpr double kLeastProb = 1e-3;

// Empty when no cell counts. Truth and scored set have the same geometry.
std::optional<Calibration> Calibrate(const StateMap& truth, const OccupancyMap& estimate,
                                     const CellSet& scored);

}  // namespace depthgrid
