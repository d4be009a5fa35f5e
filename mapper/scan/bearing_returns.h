// Reads the image along the lines of the bearings: the nearest surface in the obstacle band, and
// which rays have usable depth.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/few_columns.h"
#include "mapper/scan/noise_window.h"

namespace depthgrid {

struct ReturnLimits {
  float min_depth_m = 0.0F;
  float max_range_m = 0.0F;
  float low_m = 0.0F;  // the obstacle band, relative to the camera
  float high_m = 0.0F;
  int min_returns = 1;
  int first_row = 0;  // rows used
  int last_row = 0;
};

// A second, thin band, usually around the camera's height.
struct SliceBand {
  float low_m = 0.0F;  // relative to the camera
  float high_m = 0.0F;
  // Limit of SteadyRange(); 0: treat the band as one surface.
  float agree_sigmas = 0.0F;
  // Limit of LeaningRange(); 0: none leans.
  float lean_sigmas = 0.0F;

  float MiddleM() const { return 0.5F * (low_m + high_m); }
  // The core, the inner half of its heights.
  float CoreLowM() const { return MiddleM() - 0.25F * (high_m - low_m); }
  float CoreHighM() const { return MiddleM() + 0.25F * (high_m - low_m); }
};

// Image rows; empty if first > last.
struct RowRange {
  int first = 0;
  int last = -1;
  bool operator==(const RowRange&) const = default;
};

struct BearingReturns {
  bool hit = false;
  float range_m = 0.0F;  // of the nearest surface; meaningful only when `hit`
  RowRange seen;         // first and last row with a usable depth
  RowRange gap_below;    // rows around the largest run of unusable depth below the horizon ...
  RowRange gap_above;    // ... and above: both rows are usable, those between them are not
  bool operator==(const BearingReturns&) const = default;
};

// A sample of a line is a range if it lies in the band, else one of these.
constexpr float kPassing = 1e9F;   // usable, but no obstacle: floor, ceiling, too far
constexpr float kUnusable = 2e9F;  // invalid or too near

// Neighbouring pixels belong to one surface when their depths differ by less than this share: 3 %
// is a wall at an incidence of 86 degrees.
constexpr float kSameSurfaceShare = 0.03F;

// Depth between the pixel centres of a row. z is interpolated linearly within a surface (1/z would
// be exact; the difference is 20 um at 5 m and 60 degrees); across an edge the pixel whose centre
// is nearer to the line counts.
inline float DepthBetween(float z0, float z1, float share_of_1) {
  const float difference = z1 - z0;
  if (std::abs(difference) <= kSameSurfaceShare * std::min(z0, z1)) {
    return z0 + share_of_1 * difference;
  }
  const float nearer = share_of_1 < 0.5F ? z0 : z1;
  return nearer > 0.0F ? nearer : std::max(z0, z1);
}

// Two pixels of a plane differ in 1/z by as much as their neighbours; by this share more or less
// they still count as one surface.
constexpr float kSlopeShare = 0.5F;

// The same with few columns, from the four pixels around the line (the outer two repeat the inner
// ones at the image's edges): if 1/z goes on as to one of the neighbours, it is interpolated.
inline float DepthBetweenFew(float before, float z0, float z1, float after, float share_of_1) {
  const float nearer = std::min(z0, z1);
  if (!(nearer > 0.0F) || std::abs(z1 - z0) <= kSameSurfaceShare * nearer) {
    return DepthBetween(z0, z1, share_of_1);
  }
  const float w0 = 1.0F / z0, w1 = 1.0F / z1;
  const float slope = w1 - w0;
  const float tolerance = kSlopeShare * std::abs(slope);
  const bool goes_on = std::abs(w0 - 1.0F / before - slope) <= tolerance ||
                       std::abs(1.0F / after - w1 - slope) <= tolerance;
  return goes_on ? 1.0F / (w0 + share_of_1 * slope) : DepthBetween(z0, z1, share_of_1);
}

// Largest column, such that there is a pixel to the right.
inline float LastColumn(int width_px) { return static_cast<float>(width_px - 1) - 0.001F; }

// The interpolated depth on a line at row v.
float DepthOn(const DepthImage& image, const BearingLine& line, int v);

// The sample of a line at row v.
float SampleAt(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits, int v);

// The rows of a line that are used.
RowRange RowsOf(const BearingLine& line, const ReturnLimits& limits);

// The smallest sample with enough samples in the noise window above it; kPassing if there is none.
// `sorted` is memory and afterwards begins with all smaller samples.
float SmallestSupported(std::span<const float> samples, const ReturnLimits& limits,
                        const NoiseWindow& window, std::vector<float>& sorted);

// Sets the hit to the surface whose smallest sample is given: the mean over the noise window above
// it, then over the window centred on that mean (repeated NoiseWindow::MeansOf times). Returns the
// range beyond which samples have no effect.
float RangeFrom(std::span<const float> samples, float smallest_m, const NoiseWindow& window,
                BearingReturns& returns);

// RangeFrom() of the smallest supported sample. Returns the range beyond which samples have no
// effect.
float FindNearest(std::span<const float> samples, const ReturnLimits& limits,
                  const NoiseWindow& window, std::vector<float>& sorted, BearingReturns& returns);

// What stands a little farther back above or below the camera's height (the lid of a printer, the
// upper edge of a desk) lies within the noise window far away and not nearby: the mean of both
// would move towards the camera as it comes near. So samples above and below the core, the inner
// half of the slice's heights, count only if both their means are within `agree_sigmas` of the
// core's; else the range is the core's mean. `samples`: the line's in the slice, one per row from
// `first_row` on; `range_m`: from FindNearest().
float SteadyRange(std::span<const float> samples, int first_row, const BearingLine& line,
                  const SliceBand& slice, const ReturnLimits& limits, const NoiseWindow& window,
                  float range_m);

// Where a surface leans or is round, the noise window holds its nearest part nearby and all of it
// far away, so the height that is met would change with the distance. The surface that lies at the
// slice's middle height is followed up and down from there, and where a line through its ranges
// over their heights leans by more than `lean_sigmas` of its slope's sigma, the range is the line's
// at the middle height. Not so where the core leans by less (a step) or what was found stands
// before that surface. `range_m`: from SteadyRange(); returned where nothing leans.
float LeaningRange(std::span<const float> samples, int first_row, const BearingLine& line,
                   const SliceBand& slice, const ReturnLimits& limits, const NoiseWindow& window,
                   float range_m);

// The limits by which LeaningRange() follows a surface: chosen; what others do, as far as tried, is
// in docs/tried.md, "The slice that is matched".
struct LeaningLimits {
  // The next sample may be off by this many sigmas, and by 1.2 (50 degrees) times its way up.
  static constexpr float kNextSigmas = 3.5F;
  static constexpr float kSteepest = 1.2F;
  // More samples than this, one after the other, that are off end the surface.
  static constexpr float kMostMisses = 2.0F;
  // Needed in all, and above and below the middle each.
  static constexpr float kLeastSamples = 5.0F;
  static constexpr float kLeastOfHalf = 2.0F;
  // A line that leans by less (6 degrees) is taken for upright.
  static constexpr float kLeastLean = 0.1F;
  // A surface whose core leans by less than this share of that is stepped.
  static constexpr float kLeastOfCore = 0.5F;
  // What is nearer than the surface by more sigmas stands before it.
  static constexpr float kBeforeSigmas = 3.0F;
};

// Usable rows of a block of lines, and the rows around their longest gaps below and above the
// horizon.
struct BlockViews {
  BlockLane first, last;  // first > last if none
  // No gap if they are at most one apart.
  BlockLane below_from, below_to, above_from, above_to;
  bool has_gaps = false;
};
struct BlockHits {
  BlockLane is_hit;  // 1 or 0
  BlockLane range_m;
};

// The returns of every line of an image. The views are common to the obstacle band and the slice;
// only the hits differ.
struct ImageReturns {
  std::size_t size = 0;  // number of lines; further lanes are padding
  std::vector<BlockViews> views;
  std::vector<BlockHits> obstacles, slice;  // `slice` is empty when not asked for

  BearingReturns At(std::size_t k, const std::vector<BlockHits>& hits) const;
};

// Memory for FindReturns, kept from frame to frame.
struct ReturnsMemory {
  struct alignas(64) Lanes {
    float lane[16];
  };
  std::vector<Lanes> samples;
  std::vector<float> survey;
  std::vector<float> column, sorted;
  ImageReturns returns;
};

// All of the above for every line at once, vectorised; the same values bit for bit. The result is
// valid until the memory is reused.
ImageReturns& FindReturns(const DepthImage& image, const BearingLineTable& lines,
                          const ReturnLimits& limits, const std::optional<SliceBand>& slice,
                          const NoiseWindow& window, ReturnsMemory& memory);

}  // namespace depthgrid
