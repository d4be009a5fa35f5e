// Pairs the runs of the two sides of a comparison, and selects those that count.
#pragma once

#include <cstddef>
#include <vector>

#include "eval/compare/comparison.h"
#include "eval/statistics/seed_units.h"

namespace depthgrid {

// Rows of the two tables: a[i] and b[i] are a pair.
struct RunPairs {
  std::vector<std::size_t> a;
  std::vector<std::size_t> b;
  SeedUnits units{{}};
  Pairing pairing;
};

// Pairs runs that meet the conditions and have equal values on all axes of both sides, without
// seeds that only repeat another. Throws InputError as Compare() does.
RunPairs PairsOf(const SweepResults& a, const SweepResults& b, const CompareOptions& options);

}  // namespace depthgrid
