#include "mapper/scan/bearing_returns.h"

#include <algorithm>
#include <memory>
#include <new>

#include "mapper/scan/bearing_block.h"

namespace depthgrid {
namespace {

using internal::BearingBlock;
using internal::BlockLane;
using internal::BlockMean;
using internal::BlockSamples;
using internal::BlockViews;
using internal::kBlockBearings;
using internal::SampleRows;

using Lanes = ReturnsMemory::Lanes;
constexpr std::size_t kLanesPerRow = sizeof(BlockLane) / sizeof(Lanes);

// Room for so many rows of samples.
float* Rows(std::vector<Lanes>& lanes, std::size_t rows) {
  if (rows * kLanesPerRow > lanes.size()) lanes.resize(rows * kLanesPerRow);
  return lanes.data()->lane;
}

// The samples of a block's bearings in some rows, and the smallest of each.
struct BandSamples {
  const float* samples = nullptr;
  std::size_t rows = 0;
  const BlockLane& nearest;
};

RowRange RangeOf(float first, float last) {
  return {static_cast<int>(first), static_cast<int>(last)};
}

RowRange GapOf(float from, float to) { return to - from > 1.0F ? RangeOf(from, to) : RowRange{}; }

// FindNearest for a block. Lanes whose smallest sample is not supported by others (a stray pixel)
// are done one by one.
void FindNearestOfBlock(const BandSamples& band, std::size_t bearings, const ReturnLimits& limits,
                        const NoiseWindow& window, std::vector<float>& column,
                        BearingReturns* returns) {
  BlockLane width, high;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    width[i] = window.At(band.nearest[i]);
    high[i] = std::min(band.nearest[i] + width[i], limits.max_range_m);
  }
  const BlockMean first =
      internal::MeanWithin(band.samples, band.rows, band.nearest, high, band.nearest);
  BlockLane low;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    const float half_m = 0.5F * width[i];
    low[i] = first.mean[i] - half_m;
    high[i] = std::min(first.mean[i] + half_m, limits.max_range_m);
  }
  const BlockMean second = internal::MeanWithin(band.samples, band.rows, low, high, first.mean);
  for (std::size_t i = 0; i < bearings; ++i) {
    if (band.nearest[i] > limits.max_range_m) continue;
    if (first.count[i] >= static_cast<float>(limits.min_returns)) {
      returns[i].hit = true;
      returns[i].range_m = second.mean[i];
      continue;
    }
    column.clear();
    for (std::size_t r = 0; r < band.rows; ++r) {
      const float sample = band.samples[r * kBlockBearings + i];
      column.push_back(sample <= limits.max_range_m ? sample : kPassing);
    }
    FindNearest(column, limits, window, returns[i]);
  }
}

void FindViewsOfBlock(const BearingBlock& block, const BlockSamples& found, const float* samples,
                      BearingReturns* returns) {
  const bool all_usable =
      *std::max_element(found.farthest.begin(), found.farthest.end()) < kUnusable;
  if (all_usable) {
    for (std::size_t i = 0; i < block.bearings; ++i) returns[i].seen = block.rows;
    return;
  }
  const BlockViews views = internal::FindViews(block, found.farthest, samples);
  for (std::size_t i = 0; i < block.bearings; ++i) {
    returns[i].seen = RangeOf(views.first[i], views.last[i]);
    returns[i].gap_below = GapOf(views.below_from[i], views.below_to[i]);
    returns[i].gap_above = GapOf(views.above_from[i], views.above_to[i]);
  }
}

}  // namespace

const ImageReturns& FindReturns(const DepthImage& image, const std::vector<BearingLine>& lines,
                                const ReturnLimits& limits, const std::optional<SliceBand>& slice,
                                const NoiseWindow& window, ReturnsMemory& memory) {
  ImageReturns& all = memory.returns;
  all.obstacles.assign(lines.size(), {});
  all.slice.assign(slice ? lines.size() : 0, {});
  for (std::size_t begin = 0; begin < lines.size(); begin += kBlockBearings) {
    const BearingBlock block = internal::MakeBearingBlock(lines, begin, limits, slice);
    const std::size_t rows = block.RowCount();
    if (rows == 0) continue;
    const SampleRows out{Rows(memory.samples, rows),
                         slice ? Rows(memory.slice_samples, rows) : nullptr};
    const BlockSamples found = internal::SampleBlock(image, limits, slice, block, out);
    BearingReturns* const obstacles = &all.obstacles[begin];
    FindNearestOfBlock({out.samples, rows, found.nearest}, block.bearings, limits, window,
                       memory.column, obstacles);
    FindViewsOfBlock(block, found, out.samples, obstacles);
    if (!slice) continue;
    for (std::size_t i = 0; i < block.bearings; ++i) {
      BearingReturns& returns = all.slice[begin + i] = obstacles[i];
      returns.hit = false;
      returns.range_m = 0.0F;
    }
    const auto skipped = static_cast<std::size_t>(block.slice_rows.first - block.rows.first);
    const auto taken = static_cast<std::size_t>(block.slice_rows.last - block.slice_rows.first + 1);
    FindNearestOfBlock({out.slice + skipped * kBlockBearings, taken, found.slice_nearest},
                       block.bearings, limits, window, memory.column, &all.slice[begin]);
  }
  return all;
}

}  // namespace depthgrid
