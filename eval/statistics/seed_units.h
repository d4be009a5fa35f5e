// The independent units among many runs: the seeds, however many runs each of them has.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace depthgrid {

// Runs with the same seed share the sensor noise and SLAM's errors whatever else differs, so they
// are averaged and count as one. With only one seed, or without seeds, each run is a unit.
//
// Where seeds are crossed (each slam_seed with each depth_seed), n x m runs contain only n
// independent draws of the one and m of the other. Then there are as many units as the axis with
// the fewest seeds has, and the seeds of the other axes are distributed among them. A unit's value
// is the sum over the axes of the mean of its runs there, shifted so that the units' mean is that
// of all runs. So the spread of the units includes the effect of every axis, and tests and
// intervals are conservative.
class SeedUnits {
 public:
  // `seeds`: for each run the values of all seed axes.
  explicit SeedUnits(const std::vector<std::vector<std::string>>& seeds);

  std::size_t count() const { return count_; }
  // Axes that are crossed with each other; empty where one determines the others.
  const std::vector<std::size_t>& crossed() const { return crossed_; }
  // One value per unit, from the finite ones of `values` (one per run); NaN for a unit without any.
  std::vector<double> Figures(const std::vector<double>& values) const;

 private:
  std::size_t count_ = 0;
  std::vector<std::vector<std::size_t>> unit_of_run_;  // [axis that counts][run]
  std::vector<std::size_t> crossed_;
};

}  // namespace depthgrid
