#include "eval/sweep/sweep_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "eval/experiment/experiment_options.h"
#include "eval/experiment/seed_range.h"
#include "eval/sweep/sweep_results.h"
#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// The range of an axis that does not list its values.
struct RangeOptions {
  double from = 0.0;
  double to = 0.0;
  int count = 0;
  RangeScale scale = RangeScale::kLinear;

  void Visit(OptionsVisitor& v) {
    v.Number("from", from, {}, "first value");
    v.Number("to", to, {}, "last value");
    v.Number("count", count, {1, kMostSweepRuns}, "how many values");
    v.Choice("scale", scale, {{RangeScale::kLinear, "linear"}, {RangeScale::kLog, "log"}},
             "equal differences or equal ratios");
  }
};

struct SeedOptions {
  int seeds = 0;
  std::uint64_t first = 1;

  void Visit(OptionsVisitor& v) {
    v.Number("seeds", seeds, {1, kMostSweepRuns}, "how many seeds");
    v.Seed("first", first, "the first of them");
  }
};

std::vector<std::string> KeysOf(const std::string& names) {
  std::vector<std::string> keys;
  for (const TextRow& row : SplitRows(names)) {
    for (const auto& field : row.fields) keys.emplace_back(field);
  }
  return keys;
}

void ReadSeeds(const Config& map, SweepAxis& axis) {
  SeedOptions seeds;
  map.Read(seeds);
  RequireSeeds(axis.place, seeds.first, seeds.seeds);
  for (int i = 0; i < seeds.seeds; ++i) {
    axis.values.push_back({fmt::format("{}", seeds.first + static_cast<std::uint64_t>(i))});
  }
}

// 0 for -0, which is the same value and would have another text.
double WithOneZero(double value) { return value + 0.0; }

constexpr double kRoundings = 4.0 * std::numeric_limits<double>::epsilon();

// Removes rounding errors: 10 instead of 9.999999999999998, which nobody wants and no `--where`
// would find.
double WithoutRounding(double value) {
  const double plain = *ParseNumber(fmt::format("{:.12g}", value));
  return std::abs(plain - value) <= kRoundings * std::abs(value) ? plain : value;
}

// The value at `share` of the range, as it is listed. Between ends of both signs, rounding leaves a
// value near zero.
double ListedAt(const AxisRange& range, double share) {
  const double value = range.At(share);
  const double rounding = kRoundings * std::max(std::abs(range.from), std::abs(range.to));
  const bool crosses_zero = (range.from < 0.0) != (range.to < 0.0);
  const bool is_zero = crosses_zero && share > 0.0 && share < 1.0 && std::abs(value) <= rounding;
  return is_zero ? 0.0 : WithoutRounding(value);
}

void ReadRange(const Config& map, SweepAxis& axis) {
  RangeOptions read;
  map.Read(read);
  for (const char* key : {"from", "to"}) {
    if (!map.Has(key)) throw InputError(axis.place, fmt::format("a range needs '{}'", key));
  }
  if (read.scale == RangeScale::kLog && (read.from <= 0.0 || read.to <= 0.0)) {
    throw InputError(axis.place,
                     fmt::format("a log range from {} to {} must lie above 0", read.from, read.to));
  }
  const AxisRange range{WithOneZero(read.from), WithOneZero(read.to), read.scale,
                        IsWholeNumber(ExperimentOptions{}, axis.keys.front())};
  if (read.count == 0) {
    axis.range = range;
    return;
  }
  if (read.count == 1 && read.from != read.to) {
    throw InputError(axis.place,
                     fmt::format("count 1 from {} to {} must be 2 or more", read.from, read.to));
  }
  for (int i = 0; i < read.count; ++i) {
    const double share = read.count == 1 ? 0.0 : static_cast<double>(i) / (read.count - 1);
    axis.values.push_back({fmt::format("{}", ListedAt(range, share))});
  }
}

void ReadList(const std::vector<std::string>& items, SweepAxis& axis) {
  for (const std::string& item : items) {
    std::vector<std::string> value = {ShortestYaml(item)};
    if (axis.keys.size() > 1) {
      value = Config::FromText("value: " + item, axis.place).List("value");
      std::transform(value.begin(), value.end(), value.begin(), ShortestYaml);
    }
    if (value.size() != axis.keys.size()) {
      throw InputError(axis.place, fmt::format("value {} must be a list of {}, one a key", item,
                                               axis.keys.size()));
    }
    axis.values.push_back(std::move(value));
  }
}

SweepAxis ReadAxis(const ConfigEntry& entry) {
  SweepAxis axis;
  axis.place = entry.place;
  axis.is_lone = !entry.map && !entry.items;
  axis.keys = KeysOf(entry.key);
  if (axis.keys.empty()) throw InputError(entry.place, "an axis needs the name of a key");
  if (entry.map && axis.keys.size() > 1) {
    throw InputError(entry.place, "keys that change together need a list of lists");
  }
  if (entry.map && entry.map->Has("seeds")) {
    ReadSeeds(*entry.map, axis);
  } else if (entry.map) {
    ReadRange(*entry.map, axis);
  } else {
    ReadList(entry.items.value_or(std::vector{entry.text}), axis);
  }
  const bool nothing = entry.text.empty() || entry.text == "~" || entry.text == "null";
  if ((axis.values.empty() && !axis.range) || nothing) {
    throw InputError(entry.place, fmt::format("axis '{}' has no values", entry.key));
  }
  std::set<std::vector<std::string>> seen;
  for (const auto& value : axis.values) {
    if (seen.insert(value).second) continue;
    // In a range of whole numbers, steps are rounded to the nearest one.
    throw InputError(entry.place, fmt::format("axis '{}' has the value {} twice{}", entry.key,
                                              fmt::join(value, ", "),
                                              entry.map ? ": give a smaller count" : ""));
  }
  return axis;
}

}  // namespace

double AxisRange::At(double share) const {
  if (share <= 0.0) return from;
  if (share >= 1.0) return to;
  const double value =
      scale == RangeScale::kLog ? from * std::pow(to / from, share) : from + (to - from) * share;
  return WithOneZero(whole ? std::round(value) : value);
}

double AxisRange::Drawn(double share) const {
  const double least = std::ceil(std::min(from, to)), most = std::floor(std::max(from, to));
  if (!whole || least > most) return At(share);
  const AxisRange around{least - 0.5, most + 0.5, scale};
  return WithOneZero(std::clamp(std::round(around.At(share)), least, most));
}

bool SweepAxis::IsSeed() const { return std::all_of(keys.begin(), keys.end(), IsSeedKey); }

std::vector<SweepAxis> ReadAxes(const Config& axes) {
  std::vector<SweepAxis> read;
  std::vector<std::string> seen;
  for (const ConfigEntry& entry : axes.Entries()) {
    read.push_back(ReadAxis(entry));
    for (const std::string& key : read.back().keys) {
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
        throw InputError(entry.place, fmt::format("key '{}' is on two axes", key));
      }
      seen.push_back(key);
    }
  }
  return read;
}

std::string ShortestYaml(const std::string& text) {
  constexpr double kExactIntegers = 9007199254740992.0;  // 2^53: larger seeds are kept as text
  const auto number = ParseNumber(text);
  const bool is_exact = number && std::isfinite(*number) && std::abs(*number) < kExactIntegers;
  if (!is_exact || HasLeadingZero(text)) return text;
  return fmt::format("{}", WithOneZero(*number));
}

}  // namespace depthgrid
