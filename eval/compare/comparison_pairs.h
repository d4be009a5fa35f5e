// Which runs of two sides of a comparison belong together, and which of them count.
#pragma once

#include <cstddef>
#include <vector>

#include "eval/compare/comparison.h"
#include "eval/statistics/seed_units.h"

namespace depthgrid {

// Rows of the two tables: a[i] and b[i] make a pair.
struct RunPairs {
  std::vector<std::size_t> a;
  std::vector<std::size_t> b;
  SeedUnits units{{}};
};

// Runs that meet the conditions and have one value of each axis that both sides have, but for seeds
// that only repeat another; `comparison` gets what they are paired by, and how many there are and
// are left out. Throws InputError as Compare() does.
RunPairs PairsOf(const SweepResults& a, const SweepResults& b, const CompareOptions& options,
                 Comparison& comparison);

}  // namespace depthgrid
