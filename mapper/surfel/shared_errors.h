// Errors that neighbouring sightings share, such as the steps of a depth camera (docs/math.md,
// "Errors that beams share").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapper/surfel/surfel.h"

namespace depthgrid {

// Surfels in the order they were first seen are taken in stretches of 16. Those of a stretch whose
// walls face the same way are companions: they may err alike. By surfel, how many they are, itself
// included.
void CountCompanions(std::span<const Surfel> surfels, std::vector<int>& companies);

// A companion's information counts over this, so that all of them have the information of their
// mean: n of equal variance and correlation r tell as much as n / (1 + (n - 1) r) that err
// independently.
inline double CountedOver(int company, double correlation) {
  return 1.0 + (company - 1) * correlation;
}

// How much companions share of their errors, told by the signs of their residuals, which wrong
// associations hardly move.
class SharedErrors {
 public:
  // Of one group, a residual a surfel; 0 where there is none.
  void Add(std::span<const Surfel> surfels, std::span<const double> residuals);
  // Of two companions' errors. At least 0; of few pairs nothing is told.
  double Correlation() const;

 private:
  std::int64_t pairs_ = 0;
  std::int64_t signs_ = 0;  // sum of the products of the pairs' signs
};

}  // namespace depthgrid
