#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapper/scan/bearing_returns.h"

namespace depthgrid {
namespace {

struct Sum {
  float sum = 0.0F;
  float count = 0.0F;

  void Add(float sample) {
    sum += sample;
    count += 1.0F;
  }
  float Mean() const { return sum / count; }
};

float MeanWithin(std::span<const float> samples, float low, float high, float otherwise) {
  Sum within;
  for (const float sample : samples) {
    if (sample >= low && sample <= high) within.Add(sample);
  }
  return within.count > 0.0F ? within.Mean() : otherwise;
}

// The row whose rays have this slope (height over range).
float RowAtSlope(const BearingLine& line, float slope) {
  return (slope * line.h0 - line.g0) / (line.g1 - slope * line.h1);
}

// The rows of a line that are in the slice's core.
struct CoreRows {
  float first = 0.0F, last = 0.0F;

  bool Contains(float row) const { return row >= first && row <= last; }
};

CoreRows CoreRowsAt(const BearingLine& line, const SliceBand& slice, float range_m) {
  const float a = RowAtSlope(line, slice.CoreHighM() / range_m);
  const float b = RowAtSlope(line, slice.CoreLowM() / range_m);
  return a < b ? CoreRows{a, b} : CoreRows{b, a};
}

// Sums over samples, for a line through their ranges over their heights.
struct LineSums {
  float n = 0.0F, h = 0.0F, r = 0.0F, hh = 0.0F, hr = 0.0F;

  void Add(float behind_m, float height_m) {
    n += 1.0F;
    h += height_m;
    r += behind_m;
    hh += height_m * height_m;
    hr += height_m * behind_m;
  }
  float Det() const { return n * hh - h * h; }
  float Lean() const { return (n * hr - h * r) / Det(); }
  float AtZero() const { return (hh * r - h * hr) / Det(); }
};

// A surface followed through a slice: its samples as heights above the middle and ranges behind the
// first one.
class Leaning {
 public:
  Leaning(float from_m, float height_m, float sigma_m, float core_m)
      : from_m_(from_m), sigma_m_(sigma_m), core_m_(core_m) {
    Take(0.0F, height_m);
    Restart(height_m);
  }
  // Follow() goes on from the first sample.
  void Restart(float height_m) {
    last_m_ = 0.0F;
    last_height_m_ = height_m;
    misses_ = 0.0F;
  }
  void Follow(float range_m, float height_m) {
    if (misses_ > LeaningLimits::kMostMisses) return;
    const float behind_m = range_m - from_m_;
    const float most_m = LeaningLimits::kNextSigmas * sigma_m_ +
                         LeaningLimits::kSteepest * std::abs(height_m - last_height_m_);
    if (std::abs(behind_m - last_m_) > most_m) {
      misses_ += 1.0F;
      return;
    }
    misses_ = 0.0F;
    last_m_ = 0.5F * (last_m_ + behind_m);
    last_height_m_ = height_m;
    Take(behind_m, height_m);
  }
  float RangeOr(float range_m, float lean_sigmas) const {
    if (below_ < LeaningLimits::kLeastOfHalf || above_ < LeaningLimits::kLeastOfHalf) {
      return range_m;
    }
    const float det = all_.Det();
    if (all_.n < LeaningLimits::kLeastSamples || !(det > 0.0F)) return range_m;
    const float lean = all_.Lean();
    const float sigma = sigma_m_ * std::sqrt(all_.n / det);
    if (!(std::abs(lean) >= std::max(lean_sigmas * sigma, LeaningLimits::kLeastLean))) {
      return range_m;
    }
    if (!(core_.Lean() * lean >= LeaningLimits::kLeastOfCore * (lean * lean))) return range_m;
    if (range_m < from_m_ + nearest_m_ - LeaningLimits::kBeforeSigmas * sigma_m_) return range_m;
    return from_m_ + all_.AtZero();
  }

 private:
  void Take(float behind_m, float height_m) {
    all_.Add(behind_m, height_m);
    if (std::abs(height_m) <= core_m_) core_.Add(behind_m, height_m);
    (height_m < 0.0F ? below_ : above_) += 1.0F;
    nearest_m_ = std::min(nearest_m_, behind_m);
  }

  float from_m_, sigma_m_, core_m_;
  float last_m_ = 0.0F, last_height_m_ = 0.0F, misses_ = 0.0F;
  LineSums all_, core_;
  float below_ = 0.0F, above_ = 0.0F, nearest_m_ = 0.0F;
};

bool Agree(const Sum& part, const Sum& core, float limit_m) {
  if (part.count == 0.0F) return true;
  const float difference_m = part.Mean() - core.Mean();
  return difference_m * difference_m * (part.count * core.count) <=
         limit_m * limit_m * (part.count + core.count);
}

// Non-negative floats have the order of their bits, and integers vectorise easily. Differences for
// samples below `from` wrap round and are larger than all others.
std::uint32_t SmallestFrom(std::span<const float> samples, std::uint32_t from) {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max() - from;
  for (const float sample : samples) {
    least = std::min(least, std::bit_cast<std::uint32_t>(sample) - from);
  }
  return from + least;
}

std::size_t CountOf(std::span<const float> samples, float wanted) {
  std::uint32_t count = 0;
  for (const float sample : samples) count += sample == wanted ? 1 : 0;
  return count;
}

}  // namespace

RowRange RowsOf(const BearingLine& line, const ReturnLimits& limits) {
  return {std::max(line.first_row, limits.first_row), std::min(line.last_row, limits.last_row)};
}

float DepthOn(const DepthImage& image, const BearingLine& line, int v) {
  const auto row = static_cast<float>(v);
  const float u = std::min(std::max(line.u0 + line.u1 * row, 0.0F), LastColumn(image.width_px));
  const int column = static_cast<int>(u);
  const float* pixel = image.Row(v) + column;
  const float share = u - static_cast<float>(column);
  if (image.width_px > kFewColumns) return DepthBetween(pixel[0], pixel[1], share);
  const float before = pixel[column > 0 ? -1 : 0];
  const float after = pixel[column + 2 < image.width_px ? 2 : 1];
  return DepthBetweenFew(before, pixel[0], pixel[1], after, share);
}

float SampleAt(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits,
               int v) {
  const auto row = static_cast<float>(v);
  const float z_m = DepthOn(image, line, v);
  if (!(z_m >= limits.min_depth_m)) return kUnusable;
  const float range_m = z_m * (line.h0 + line.h1 * row);
  const float height_m = z_m * (line.g0 + line.g1 * row);
  const bool marks =
      range_m <= limits.max_range_m && height_m >= limits.low_m && height_m <= limits.high_m;
  return marks ? range_m : kPassing;
}

float RangeFrom(std::span<const float> samples, float smallest_m, const NoiseWindow& window,
                BearingReturns& returns) {
  const float width_m = window.At(smallest_m);
  const float half_m = 0.5F * width_m;
  float mattered_m = smallest_m + width_m;
  returns.hit = true;
  returns.range_m = MeanWithin(samples, smallest_m, mattered_m, smallest_m);
  for (int mean = 0; mean < NoiseWindow::MeansOf(width_m); ++mean) {
    const float centre_m = returns.range_m;
    mattered_m = std::max(mattered_m, centre_m + half_m);
    returns.range_m = MeanWithin(samples, centre_m - half_m, centre_m + half_m, centre_m);
  }
  return mattered_m;
}

float SmallestSupported(std::span<const float> samples, const ReturnLimits& limits,
                        const NoiseWindow& window, std::vector<float>& sorted) {
  sorted.clear();
  const auto needed = static_cast<std::size_t>(limits.min_returns);
  std::size_t last = needed - 1;
  for (std::uint32_t from = 0;;) {
    const std::uint32_t next = SmallestFrom(samples, from);
    if (next >= std::bit_cast<std::uint32_t>(kPassing)) return kPassing;
    const auto sample = std::bit_cast<float>(next);
    sorted.insert(sorted.end(), CountOf(samples, sample), sample);
    from = next + 1;
    for (; last < sorted.size(); ++last) {
      const float smallest = sorted[last + 1 - needed];
      if (sorted[last] <= smallest + window.At(smallest)) return smallest;
    }
  }
}

float FindNearest(std::span<const float> samples, const ReturnLimits& limits,
                  const NoiseWindow& window, std::vector<float>& sorted, BearingReturns& returns) {
  const float smallest_m = SmallestSupported(samples, limits, window, sorted);
  if (smallest_m >= kPassing) return kPassing;
  return RangeFrom(samples, smallest_m, window, returns);
}

float SteadyRange(std::span<const float> samples, int first_row, const BearingLine& line,
                  const SliceBand& slice, const ReturnLimits& limits, const NoiseWindow& window,
                  float range_m) {
  if (slice.agree_sigmas <= 0.0F) return range_m;
  const CoreRows rows = CoreRowsAt(line, slice, range_m);
  const float width_m = window.At(range_m);
  const float half_m = 0.5F * width_m;
  const auto up_to = [&](float centre_m) {
    return std::min(centre_m + half_m, limits.max_range_m);
  };
  Sum before, core, after;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(samples[i] >= range_m - half_m && samples[i] <= up_to(range_m))) continue;
    const auto row = static_cast<float>(first_row + static_cast<int>(i));
    if (row < rows.first) before.Add(samples[i]);
    if (rows.Contains(row)) core.Add(samples[i]);
    if (row > rows.last) after.Add(samples[i]);
  }
  const auto needed = static_cast<float>(limits.min_returns);
  if (core.count < needed) return range_m;
  const float limit_m = slice.agree_sigmas * NoiseWindow::kSigmaShare * width_m;
  if (Agree(before, core, limit_m) && Agree(after, core, limit_m)) return range_m;
  const float centre_m = core.Mean();
  Sum steady;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<float>(first_row + static_cast<int>(i));
    if (!rows.Contains(row)) continue;
    if (samples[i] >= centre_m - half_m && samples[i] <= up_to(centre_m)) steady.Add(samples[i]);
  }
  return steady.count < needed ? range_m : steady.Mean();
}

float LeaningRange(std::span<const float> samples, int first_row, const BearingLine& line,
                   const SliceBand& slice, const ReturnLimits& limits, const NoiseWindow& window,
                   float range_m) {
  if (slice.lean_sigmas <= 0.0F) return range_m;
  const float width_m = window.At(range_m);
  const float half_m = 0.5F * width_m;
  const auto height_at = [&](std::size_t i) {
    const auto row = static_cast<float>(first_row + static_cast<int>(i));
    const float slope = (line.g0 + line.g1 * row) / (line.h0 + line.h1 * row);
    return samples[i] * slope - slice.MiddleM();
  };
  bool is_wide = false;  // some of it is outside the noise window
  float least_m = std::numeric_limits<float>::infinity();
  std::size_t middle = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(samples[i] <= limits.max_range_m)) continue;
    is_wide = is_wide || samples[i] < range_m - half_m || samples[i] > range_m + half_m;
    const float off_m = std::abs(height_at(i));
    if (!(off_m < least_m)) continue;
    least_m = off_m;
    middle = i;
  }
  if (!is_wide) return range_m;
  Leaning surface(samples[middle], height_at(middle), NoiseWindow::kSigmaShare * width_m,
                  slice.CoreHighM() - slice.MiddleM());
  for (std::size_t i = middle; i-- > 0;) {
    if (samples[i] <= limits.max_range_m) surface.Follow(samples[i], height_at(i));
  }
  surface.Restart(height_at(middle));
  for (std::size_t i = middle + 1; i < samples.size(); ++i) {
    if (samples[i] <= limits.max_range_m) surface.Follow(samples[i], height_at(i));
  }
  return surface.RangeOr(range_m, slice.lean_sigmas);
}

}  // namespace depthgrid
