// A sweep's table as a grid: its axes, its points, and the runs of each point.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/statistics/best_setting.h"
#include "eval/statistics/seed_units.h"
#include "eval/sweep/sweep_results.h"

namespace depthgrid {

// An axis other than a seed.
struct GridAxis {
  std::string key;
  bool numeric = false;
  std::vector<std::string> texts;  // its values: ascending if numeric, else in order of appearance
  std::vector<double> numbers;     // the same, if numeric
};

struct GridPoint {
  std::vector<std::size_t> values;  // for each axis, index into its texts
  std::vector<std::size_t> rows;    // its finished runs that did not fail
};

struct SweepGrid {
  std::vector<GridAxis> axes;
  std::vector<GridPoint> points;  // in the sweep's order
  std::size_t seed_axes = 0;
  std::vector<std::string> seeds_of_row;  // the texts of all seed axes together
  // The first row of the same point with equal values of every score, as where nothing is random;
  // all these rows are one measurement. Usually the row itself.
  std::vector<std::size_t> measurement_of_row;
};

SweepGrid GridOf(const SweepResults& results);

// The independent units among runs with these texts of all seed axes.
SeedUnits UnitsOf(const std::vector<std::string>& seeds);

// One line of the grid along a numeric axis, all other axes held.
struct GridLine {
  std::vector<std::size_t> points;  // by ascending value of the axis
  // Points of the line without a value, because all their runs failed.
  std::vector<std::size_t> left_out;
  // Over the seeds that all `points` have; empty if there are none, or fewer than two points.
  std::optional<BestSetting> best;
  // Number of seeds for `best`; of crossed seeds, the number of the smallest axis.
  std::size_t seeds = 0;
  std::vector<double> mean_regret_of_seed;  // by point: mean loss against the oracle of each seed
  // The oracle is the run of the same seed and other settings with `mapper.fusion.mode: oracle`;
  // else, where a point has none of one of the seeds, the best point of the seed.
  bool to_oracle_runs = false;
};

// Lines of at least two points, including those left out. The points of a line differ only in the
// axis.
std::vector<GridLine> LinesAlong(const SweepGrid& grid, std::size_t axis,
                                 const std::vector<double>& metric, Better better,
                                 const BootstrapOptions& bootstrap);

}  // namespace depthgrid
