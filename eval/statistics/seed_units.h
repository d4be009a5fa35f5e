// What of many runs varies on its own: the seeds, however many runs each of them has.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace depthgrid {

// Runs of one seed share its noise and its SLAM's errors whatever else they differ in, so they are
// averaged and count as one. Of one seed alone, or without seeds, each run is a unit.
//
// Where seeds are crossed (each slam_seed with each depth_seed) n x m runs hold n draws of the one
// and m of the other, no more. Then there are as many units as the axis with fewest seeds has, the
// seeds of the others being shared out among them; a unit's figure is the sum over the axes of the
// mean of its runs there, less what makes their mean that of all runs. So the spread of the units
// holds what every axis does, and tests and intervals over them err on the safe side.
class SeedUnits {
 public:
  // `seeds`: for each run the values of all seed axes.
  explicit SeedUnits(const std::vector<std::vector<std::string>>& seeds);

  std::size_t count() const { return count_; }
  // Axes that are crossed with each other; empty where one decides the others.
  const std::vector<std::size_t>& crossed() const { return crossed_; }
  // A figure a unit, of the finite ones among `values` (one a run); NaN for a unit without any.
  std::vector<double> Figures(const std::vector<double>& values) const;

 private:
  std::size_t count_ = 0;
  std::vector<std::vector<std::size_t>> unit_of_run_;  // [axis that counts][run]
  std::vector<std::size_t> crossed_;
};

}  // namespace depthgrid
