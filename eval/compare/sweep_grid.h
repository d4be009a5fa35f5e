// A sweep's table as a grid: what was varied, which points there are, which runs repeat each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/statistics/best_setting.h"
#include "eval/statistics/seed_units.h"
#include "eval/sweep/sweep_results.h"

namespace depthgrid {

// An axis that is no seed.
struct GridAxis {
  std::string key;
  bool numeric = false;
  std::vector<std::string> texts;  // its values: ascending if numeric, else as they first appear
  std::vector<double> numbers;     // the same, if numeric
};

struct GridPoint {
  std::vector<std::size_t> values;  // of each axis, index into its texts
  std::vector<std::size_t> rows;    // the sweep's finished runs of it that did not fail
};

struct SweepGrid {
  std::vector<GridAxis> axes;
  std::vector<GridPoint> points;  // in the sweep's order
  std::size_t seed_axes = 0;
  std::vector<std::string> seeds_of_row;  // the texts of all seed axes together
  // The first row of its point that gave the same in every score, as where nothing is random: one
  // measurement, however many seeds it was made with. Mostly the row itself.
  std::vector<std::size_t> measurement_of_row;
};

SweepGrid GridOf(const SweepResults& results);

// What varies on its own among runs with these texts of all seed axes.
SeedUnits UnitsOf(const std::vector<std::string>& seeds);

// One line of the grid along a numeric axis, all other axes held.
struct GridLine {
  std::vector<std::size_t> points;    // by rising value of the axis
  std::vector<std::size_t> left_out;  // those of the line without a value: all their runs failed
  // Over the seeds that all `points` have; empty if there are none, or fewer than two points.
  std::optional<BestSetting> best;
  std::size_t seeds = 0;  // on which that rests: of crossed ones as many as one of them has
  std::vector<double> mean_regret_of_seed;  // by point: what is lost to the oracle of each seed
  // The oracle is the run of the same seed and other settings with `mapper.fusion.mode: oracle`;
  // else, where a point has none of one of the seeds, the best point of the seed.
  bool to_oracle_runs = false;
};

// Lines of at least two points, those left out among them. They differ in nothing but the axis.
std::vector<GridLine> LinesAlong(const SweepGrid& grid, std::size_t axis,
                                 const std::vector<double>& metric, Better better,
                                 const BootstrapOptions& bootstrap);

}  // namespace depthgrid
