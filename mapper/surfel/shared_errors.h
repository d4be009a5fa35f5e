// Errors that neighbouring sightings share, such as the steps of a depth camera (docs/math.md,
// "Errors that beams share").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapper/surfel/surfel.h"

namespace depthgrid {

// Surfels are divided, in the order first seen, into stretches of 16. Those of a stretch with
// similar normals are companions, whose errors may be correlated. Gives the number of companions of
// each surfel, itself included.
void CountCompanions(std::span<const Surfel> surfels, std::vector<int>& companies);

// Divisor for the information of a companion: n surfels of equal variance with correlation r are
// worth n / (1 + (n - 1) r) independent ones.
inline double CountedOver(int company, double correlation) {
  return 1.0 + (company - 1) * correlation;
}

// Correlation of companions' errors, estimated from the signs of their residuals, which is robust
// to wrong associations.
class SharedErrors {
 public:
  // Adds one group, with a residual for each surfel; 0 for none.
  void Add(std::span<const Surfel> surfels, std::span<const double> residuals);
  // Correlation of two companions' errors, at least 0; 0 while there are few pairs.
  double Correlation() const;

 private:
  std::int64_t pairs_ = 0;
  std::int64_t signs_ = 0;  // sum of the products of the pairs' signs
};

}  // namespace depthgrid
