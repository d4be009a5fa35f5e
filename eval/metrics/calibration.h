// Whether a cell said to be a wall with probability p is one in a share p of the cases.
#pragma once

#include <array>
#include <optional>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

constexpr int kReliabilityBins = 10;

struct ReliabilityBin {
  int cells = 0;
  double mean_prob = 0.0;       // what was said; 0 for no cells
  double occupied_share = 0.0;  // what was true; 0 for no cells
};

// Over the scored cells whose truth is free or occupied and of which the estimate says something.
struct Calibration {
  int cells = 0;
  double brier = 0.0;     // mean squared difference of probability and truth
  double log_loss = 0.0;  // mean of -ln of the probability given to the truth (cross-entropy)
  // Mean over cells of |occupied share - mean probability| of the cell's bin.
  double calibration_error = 0.0;
  std::array<ReliabilityBin, kReliabilityBins> bins;  // [0, 0.1), [0.1, 0.2) ... [0.9, 1]
};

// Probabilities are held inside this for the logarithm, so that one sure error is not infinite.
constexpr double kLeastProb = 1e-3;

// Empty when no cell counts. Truth and scored set share a geometry.
std::optional<Calibration> Calibrate(const StateMap& truth, const OccupancyMap& estimate,
                                     const CellSet& scored);

}  // namespace depthgrid
