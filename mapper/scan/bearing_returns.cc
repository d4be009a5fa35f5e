#include "mapper/scan/bearing_returns.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "mapper/scan/bearing_block.h"

namespace depthgrid {
namespace {

using internal::BandSamples;
using internal::BearingBlock;
using internal::BlockLane;
using internal::BlockMean;
using internal::BlockSamples;
using internal::BlockViews;
using internal::kBlockBearings;
using internal::kGroupRows;
using internal::SampleRows;

using Lanes = ReturnsMemory::Lanes;
constexpr std::size_t kLanesPerRow = sizeof(BlockLane) / sizeof(Lanes);

// Room for the samples and the smallest ones of a block.
BandSamples RoomFor(const BearingBlock& block, std::vector<Lanes>& lanes) {
  const std::size_t rows = block.RowCount();
  const std::size_t needed = (rows + 2 * block.GroupCount()) * kLanesPerRow;
  if (needed > lanes.size()) lanes.resize(needed);
  float* const samples = lanes.data()->lane;
  float* const nearest = samples + rows * kBlockBearings;
  return {samples, nearest, nearest + block.GroupCount() * kBlockBearings};
}

// The ranges of a lane.
std::span<const float> RangesOf(const BandSamples& band, std::size_t rows, std::size_t lane,
                                const ReturnLimits& limits, std::vector<float>& column) {
  column.clear();
  for (std::size_t first = 0; first < rows; first += kGroupRows) {
    if (band.nearest[first / kGroupRows * kBlockBearings + lane] > limits.max_range_m) continue;
    for (std::size_t r = first; r < std::min(first + kGroupRows, rows); ++r) {
      const float sample = band.samples[r * kBlockBearings + lane];
      if (sample <= limits.max_range_m) column.push_back(sample);
    }
  }
  return column;
}

// Contains no height.
constexpr SliceBand kNoSlice{std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity()};

RowRange RangeOf(float first, float last) {
  return {static_cast<int>(first), static_cast<int>(last)};
}

RowRange GapOf(float from, float to) { return to - from > 1.0F ? RangeOf(from, to) : RowRange{}; }

// FindNearest for a block. Lanes whose smallest sample is not supported by others (a stray pixel)
// are done one by one.
void FindNearestOfBlock(const BearingBlock& block, const BandSamples& band,
                        const BlockLane& nearest, const ReturnLimits& limits,
                        const NoiseWindow& window, ReturnsMemory& memory, BearingReturns* returns) {
  const std::size_t rows = block.RowCount();
  BlockLane width, high;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    width[i] = window.At(nearest[i]);
    high[i] = std::min(nearest[i] + width[i], limits.max_range_m);
  }
  const BlockMean first = internal::MeanUpTo(band, rows, high, nearest);
  BlockLane low;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    const float half_m = 0.5F * width[i];
    low[i] = first.mean[i] - half_m;
    high[i] = std::min(first.mean[i] + half_m, limits.max_range_m);
  }
  const BlockMean second = internal::MeanWithin(band, rows, low, high, first.mean);
  for (std::size_t i = 0; i < block.bearings; ++i) {
    if (nearest[i] > limits.max_range_m) continue;
    if (first.count[i] >= static_cast<float>(limits.min_returns)) {
      returns[i].hit = true;
      returns[i].range_m = second.mean[i];
    } else {
      FindNearest(RangesOf(band, rows, i, limits, memory.column), limits, window, memory.heap,
                  returns[i]);
    }
  }
}

void FindViewsOfBlock(const BearingBlock& block, const BlockSamples& found, const BandSamples& band,
                      float min_depth_m, BearingReturns* returns) {
  const bool all_usable =
      *std::min_element(found.least_depth.begin(), found.least_depth.end()) >= min_depth_m;
  if (all_usable) {
    for (std::size_t i = 0; i < block.bearings; ++i) {
      if (block.first[i] <= block.last[i]) {
        returns[i].seen = RangeOf(block.first[i], block.last[i]);
      }
    }
    return;
  }
  const BlockViews views = internal::FindViews(block, found.least_depth, band, min_depth_m);
  for (std::size_t i = 0; i < block.bearings; ++i) {
    if (views.first[i] <= views.last[i]) {
      returns[i].seen = RangeOf(views.first[i], views.last[i]);
    }
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
    const BearingBlock block = internal::MakeBearingBlock(lines, begin, limits);
    if (block.RowCount() == 0) continue;
    const SampleRows out{RoomFor(block, memory.samples), RoomFor(block, memory.slice_samples)};
    const BlockSamples found =
        internal::SampleBlock(image, limits, slice.value_or(kNoSlice), block, out);
    BearingReturns* const obstacles = &all.obstacles[begin];
    FindViewsOfBlock(block, found, out.band, limits.min_depth_m, obstacles);
    if (slice) std::copy_n(obstacles, block.bearings, &all.slice[begin]);
    FindNearestOfBlock(block, out.band, found.nearest, limits, window, memory, obstacles);
    if (!slice) continue;
    FindNearestOfBlock(block, out.slice, found.slice_nearest, limits, window, memory,
                       &all.slice[begin]);
  }
  return all;
}

}  // namespace depthgrid
