// What the image says along the lines of the bearings: the nearest surface in the obstacle band and
// which rays were seen at all.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/noise_window.h"

namespace depthgrid {

struct ReturnLimits {
  float min_depth_m = 0.0F;
  float max_range_m = 0.0F;
  float low_m = 0.0F;  // the obstacle band, relative to the camera
  float high_m = 0.0F;
  int min_returns = 1;
  int first_row = 0;  // rows that take part
  int last_row = 0;
};

// A second band around the camera's own height, thin against the obstacle band.
struct SliceBand {
  float low_m = 0.0F;   // relative to the camera, not positive
  float high_m = 0.0F;  // not negative
  // As SteadyRange(); 0 takes the whole band for one surface.
  float agree_sigmas = 0.0F;
};

// Rows are counted as in the image; first > last stands for none.
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

// A sample of a line is a range when it lies in the band, or one of these.
constexpr float kPassing = 1e9F;   // usable, but marks nothing: floor, ceiling, too far
constexpr float kUnusable = 2e9F;  // invalid or too near

// Neighbouring pixels belong to one surface when their depths differ by less than this share: 3 %
// is a wall at an incidence of 86 degrees.
constexpr float kSameSurfaceShare = 0.03F;

// Depth between the pixel centres of a row. z is interpolated linearly within a surface (1/z would
// be exact; the difference is 20 um at 5 m and 60 degrees); across an edge the nearer pixel counts.
inline float DepthBetween(float z0, float z1, float share_of_1) {
  const float difference = z1 - z0;
  if (std::abs(difference) <= kSameSurfaceShare * std::min(z0, z1)) {
    return z0 + share_of_1 * difference;
  }
  const float nearer = share_of_1 < 0.5F ? z0 : z1;
  return nearer > 0.0F ? nearer : std::max(z0, z1);
}

// Columns are kept between 0 and this, so that there always is a pixel to the right.
inline float LastColumn(int width_px) { return static_cast<float>(width_px - 1) - 0.001F; }

// The depth on a line at row v, between the pixels' own.
float DepthOn(const DepthImage& image, const BearingLine& line, int v);

// The sample of a line at row v.
float SampleAt(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits, int v);

// The rows of a line that take part.
RowRange RowsOf(const BearingLine& line, const ReturnLimits& limits);

// The smallest sample that enough others support, within the noise window above it; kPassing when
// there is none. `sorted` is memory, and afterwards begins with all samples that are smaller.
float SmallestSupported(std::span<const float> samples, const ReturnLimits& limits,
                        const NoiseWindow& window, std::vector<float>& sorted);

// Makes the surface whose smallest sample this is the hit, at the mean over the noise window above
// it, once more centred on itself (more often where NoiseWindow::MeansOf says so). Returns up to
// where samples mattered: more of them beyond would change nothing.
float RangeFrom(std::span<const float> samples, float smallest_m, const NoiseWindow& window,
                BearingReturns& returns);

// The nearest range that enough samples agree on: that from the smallest supported sample. Returns
// up to where samples mattered.
float FindNearest(std::span<const float> samples, const ReturnLimits& limits,
                  const NoiseWindow& window, std::vector<float>& sorted, BearingReturns& returns);

// What stands a little farther back above or below the camera's height (the lid of a printer, the
// upper edge of a desk) lies within the noise window far away and not nearby: the mean of both
// would move towards the camera as it comes near. So what is seen above and below the core, the
// inner half of the slice's heights, counts only if neither mean is farther from the core's than
// `agree_sigmas` of their noise; else the range is the core's mean alone. Both or none, so that a
// slanted surface is met at the camera's height. `samples` are the line's of the slice, one a row
// from `first_row` on; `range_m` is FindNearest's.
float SteadyRange(std::span<const float> samples, int first_row, const BearingLine& line,
                  const SliceBand& slice, const ReturnLimits& limits, const NoiseWindow& window,
                  float range_m);

// Of a block of lines: which rows are usable, and the rows around the longest gaps between them
// below and above the horizon.
struct BlockViews {
  BlockLane first, last;  // first > last when none
  // No gap where they are no more than one apart.
  BlockLane below_from, below_to, above_from, above_to;
  bool has_gaps = false;
};
struct BlockHits {
  BlockLane is_hit;  // 1 or 0
  BlockLane range_m;
};

// What an image says of every line. The slice's lines are seen as the others are: only the nearest
// surface differs.
struct ImageReturns {
  std::size_t size = 0;  // lines; lanes after them do not count
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
// good until the memory is used again.
ImageReturns& FindReturns(const DepthImage& image, const BearingLineTable& lines,
                          const ReturnLimits& limits, const std::optional<SliceBand>& slice,
                          const NoiseWindow& window, ReturnsMemory& memory);

}  // namespace depthgrid
