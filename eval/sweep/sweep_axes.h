// The axes of a sweep's file (docs/sweeps.md, "The file").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/io/config.h"

namespace depthgrid {

// Limit for a sweep and thus for an axis: more is probably a typing error. Reading the plan of so
// many takes seconds.
constexpr int kMostSweepRuns = 100'000;

enum class RangeScale { kLinear, kLog };

// A range without a count, from which a random sweep draws.
struct AxisRange {
  double from = 0.0;
  double to = 0.0;
  RangeScale scale = RangeScale::kLinear;
  bool whole = false;  // the key takes only whole numbers

  // The value at `share` (0 to 1) of the range, rounded if `whole`; the ends are exact.
  double At(double share) const;
  // The same for uniform random shares: on a linear scale all whole numbers, ends included, are
  // equally likely.
  double Drawn(double share) const;
};

struct SweepAxis {
  std::vector<std::string> keys;                 // if several, their values change together
  std::vector<std::vector<std::string>> values;  // [value][key], YAML in its shortest form
  std::optional<AxisRange> range;                // in a random sweep, instead of values
  bool is_lone = false;                          // a single value, not given as a list
  std::string place;

  // A seed axis repeats each grid point instead of adding points.
  bool IsSeed() const;
};

// `axes` is the map of that name. Throws InputError for an axis without values, an invalid range,
// or an axis that occurs twice.
std::vector<SweepAxis> ReadAxes(const Config& axes);

// Numbers in their shortest form, -0 as 0; other text unchanged.
std::string ShortestYaml(const std::string& text);

}  // namespace depthgrid
