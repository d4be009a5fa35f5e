#include "mapper/scan/bearing_returns.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "mapper/scan/bearing_block.h"

namespace depthgrid {
namespace {

using internal::BandFound;
using internal::BandSamples;
using internal::BearingBlock;
using internal::BlockLane;
using internal::BlockMean;
using internal::BlockSamples;
using internal::BlockViews;
using internal::ImageBands;
using internal::kBlockBearings;
using internal::kGroupRows;
using internal::kSkipped;

using Lanes = ReturnsMemory::Lanes;
constexpr std::size_t kLanesPerRow = sizeof(BlockLane) / sizeof(Lanes);

std::size_t LanesOf(const BearingBlock& block) {
  return (block.RowCount() + 2 * block.GroupCount()) * kLanesPerRow;
}

// Room for the samples and the smallest ones of a block.
BandSamples RoomAt(const BearingBlock& block, Lanes* lanes) {
  float* const samples = lanes->lane;
  float* const nearest = samples + block.RowCount() * kBlockBearings;
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
// are done one by one. A lane of which what was skipped could matter, or none.
std::optional<std::size_t> FindNearestOfBlock(const BearingBlock& block, const BandFound& found,
                                              const ReturnLimits& limits, const NoiseWindow& window,
                                              ReturnsMemory& memory, BearingReturns* returns) {
  const std::size_t rows = block.RowCount();
  const BandSamples& band = found.samples;
  const BlockLane& nearest = found.nearest;
  BlockLane width, high;
  window.At(nearest, width.data());
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    high[i] = std::min(nearest[i] + width[i], limits.max_range_m);
  }
  const BlockMean first = internal::MeanUpTo(band, rows, high, nearest);
  BlockLane low, farthest = high;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    const float half_m = 0.5F * width[i];
    low[i] = first.mean[i] - half_m;
    high[i] = std::min(first.mean[i] + half_m, limits.max_range_m);
    farthest[i] = std::max(farthest[i], high[i]);
  }
  const BlockMean second = internal::MeanWithin(band, rows, low, high, first.mean);
  for (std::size_t i = 0; i < block.bearings; ++i) {
    if (nearest[i] > limits.max_range_m) continue;
    float mattered_m = farthest[i];
    if (first.count[i] >= static_cast<float>(limits.min_returns)) {
      returns[i].hit = true;
      returns[i].range_m = second.mean[i];
    } else {
      returns[i].hit = false;
      mattered_m = FindNearest(RangesOf(band, rows, i, limits, memory.column), limits, window,
                               memory.sorted, returns[i]);
    }
    if (std::min(mattered_m, limits.max_range_m) >= found.skipped_from[i]) return i;
  }
  return std::nullopt;
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

// Some neighbouring blocks.
struct Stripe {
  std::array<BearingBlock, internal::kMostStripeBlocks> blocks;
  std::array<BlockSamples, internal::kMostStripeBlocks> found;
  std::size_t size = 0;
};

void LayOut(const std::vector<BearingLine>& lines, std::size_t begin, const ReturnLimits& limits,
            std::size_t blocks, std::vector<Lanes>& memory, Stripe& stripe) {
  std::size_t lanes = 0;
  stripe.size = 0;
  for (; stripe.size < blocks && begin < lines.size(); begin += kBlockBearings) {
    stripe.blocks[stripe.size] = internal::MakeBearingBlock(lines, begin, limits);
    lanes += 2 * LanesOf(stripe.blocks[stripe.size++]);
  }
  if (memory.size() < lanes) memory.resize(lanes);
  Lanes* room = memory.data();
  for (std::size_t b = 0; b < stripe.size; ++b) {
    for (BandFound* band : {&stripe.found[b].band, &stripe.found[b].slice}) {
      band->samples = RoomAt(stripe.blocks[b], room);
      room += LanesOf(stripe.blocks[b]);
    }
  }
}

}  // namespace

const ImageReturns& FindReturns(const DepthImage& image, const std::vector<BearingLine>& lines,
                                const ReturnLimits& limits, const std::optional<SliceBand>& slice,
                                const NoiseWindow& window, ReturnsMemory& memory) {
  ImageReturns& all = memory.returns;
  all.obstacles.assign(lines.size(), {});
  all.slice.assign(slice ? lines.size() : 0, {});
  const ImageBands bands{image, limits, slice.value_or(kNoSlice)};
  Stripe stripe;
  const std::size_t blocks = internal::StripeBlocks(lines.size(), image.width_px);
  for (std::size_t begin = 0; begin < lines.size(); begin += stripe.size * kBlockBearings) {
    LayOut(lines, begin, limits, blocks, memory.samples, stripe);
    internal::SampleBlocks(bands, window, std::span(stripe.blocks).first(stripe.size),
                           memory.survey, std::span(stripe.found).first(stripe.size));
    for (std::size_t b = 0; b < stripe.size; ++b) {
      const BearingBlock& block = stripe.blocks[b];
      BlockSamples& found = stripe.found[b];
      if (block.RowCount() == 0) continue;
      const std::size_t at = begin + b * kBlockBearings;
      BearingReturns* const obstacles = &all.obstacles[at];
      FindViewsOfBlock(block, found, found.band.samples, limits.min_depth_m, obstacles);
      if (slice) std::copy_n(obstacles, block.bearings, &all.slice[at]);
      while (const auto lane =
                 FindNearestOfBlock(block, found.band, limits, window, memory, obstacles)) {
        internal::SampleSkipped(bands, block, *lane, found);
      }
      if (slice) FindNearestOfBlock(block, found.slice, limits, window, memory, &all.slice[at]);
    }
  }
  return all;
}

}  // namespace depthgrid
