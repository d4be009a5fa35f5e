// The axes of a sweep's file (docs/sweeps.md, "The file").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/io/config.h"

namespace depthgrid {

// Of one sweep, and so of one axis: more is a slip of the pen, or several sweeps. Reading the plan
// of so many takes seconds.
constexpr int kMostSweepRuns = 100'000;

enum class RangeScale { kLinear, kLog };

// A range without a count, from which a random sweep draws.
struct AxisRange {
  double from = 0.0;
  double to = 0.0;
  RangeScale scale = RangeScale::kLinear;
  bool whole = false;  // the key takes whole numbers alone

  // At `share` of the way, 0 to 1, to the nearest whole number if need be; the ends are exact.
  double At(double share) const;
  // The same for random shares: of whole numbers on a linear scale each is drawn as often as its
  // neighbours, the ends too.
  double Drawn(double share) const;
};

struct SweepAxis {
  std::vector<std::string> keys;                 // several: their values change together
  std::vector<std::vector<std::string>> values;  // [value][key], YAML in its shortest form
  std::optional<AxisRange> range;                // of a random sweep, instead of values
  bool is_lone = false;                          // one value that is no list
  std::string place;

  // Seeds repeat each grid point instead of making others.
  bool IsSeed() const;
};

// `axes` is the map of that name. Throws InputError for an axis without values, a range that is
// none, or an axis twice.
std::vector<SweepAxis> ReadAxes(const Config& axes);

// Numbers in their shortest form, anything else as it stands.
std::string ShortestYaml(const std::string& text);

}  // namespace depthgrid
