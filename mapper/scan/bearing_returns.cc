#include "mapper/scan/bearing_returns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "mapper/scan/bearing_block.h"
#include "mapper/scan/slanting.h"

namespace depthgrid {
namespace {

using internal::BandFound;
using internal::BandSamples;
using internal::BearingBlock;
using internal::BlockSamples;
using internal::ImageBands;
using internal::kGroupRows;
using internal::kSkipped;

using Lanes = ReturnsMemory::Lanes;
constexpr std::size_t kFloatsPerLanes = sizeof(Lanes) / sizeof(float);
constexpr std::size_t kLanesPerRow = sizeof(BlockLane) / sizeof(Lanes);

std::size_t LanesOf(const BearingBlock& block) {
  return (block.RowCount() + 2 * block.GroupCount()) * kLanesPerRow;
}

// Divides the storage into a block's samples and its two minima per group.
BandSamples RoomAt(const BearingBlock& block, float* samples) {
  float* const nearest = samples + block.RowCount() * kBlockBearings;
  return {samples, nearest, nearest + block.GroupCount() * kBlockBearings};
}

// The samples of a lane, one per row. Samples of a group without a range may be missing; any value
// that does not mark will do.
std::span<const float> SamplesOf(const BandSamples& band, std::size_t rows, std::size_t lane,
                                 const ReturnLimits& limits, std::vector<float>& column) {
  column.clear();
  for (std::size_t first = 0; first < rows; first += kGroupRows) {
    const std::size_t end = std::min(first + kGroupRows, rows);
    const float nearest = band.nearest[first / kGroupRows * kBlockBearings + lane];
    if (nearest > limits.max_range_m) {
      column.insert(column.end(), end - first, std::max(nearest, kPassing));
      continue;
    }
    for (std::size_t r = first; r < end; ++r) {
      const float sample = band.samples[r * kBlockBearings + lane];
      const bool is_too_far = sample > limits.max_range_m && sample < kPassing;
      column.push_back(is_too_far ? kPassing : sample);
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

struct ReturnsJob {
  ImageBands bands;
  const BearingLineTable& lines;
  const NoiseWindow& window;
  ReturnsMemory& memory;
};

// FindNearest, or FindNearestOrSlanting for obstacles, for a block of `bearings` bearings. Lanes
// whose smallest sample is not supported by others (a stray pixel, a surface at a slant) are
// processed one by one. Returns a lane whose result could depend on skipped samples, or none.
template <bool kSlanting>
std::optional<std::size_t> FindNearestOfBlock(const ReturnsJob& job, const BearingBlock& block,
                                              const BandFound& found, std::size_t bearings,
                                              std::size_t at, BlockHits& hits) {
  const ReturnLimits& limits = job.bands.limits;
  const std::size_t rows = block.RowCount();
  auto [alone, doubtful] = internal::FindSupported(found, rows, limits, job.window, hits);
  if (bearings < kBlockBearings) {
    const std::uint64_t taken = (std::uint64_t{1} << bearings) - 1;
    alone &= taken;
    doubtful &= taken;
  }
  for (; alone != 0 && doubtful == 0; alone &= alone - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(alone));
    const std::span<const float> samples =
        SamplesOf(found.samples, rows, i, limits, job.memory.column);
    BearingReturns returns;
    const float mattered_m =
        kSlanting
            ? FindNearestOrSlanting(samples, block.rows.first, job.lines[at * kBlockBearings + i],
                                    limits, job.window, job.memory.sorted, returns)
            : FindNearest(samples, limits, job.window, job.memory.sorted, returns);
    hits.is_hit[i] = returns.hit ? 1.0F : 0.0F;
    hits.range_m[i] = returns.range_m;
    if (std::min(mattered_m, limits.max_range_m) >= found.skipped_from[i]) return i;
  }
  if (doubtful == 0) return std::nullopt;
  return static_cast<std::size_t>(std::countr_zero(doubtful));
}

void FindViewsOfBlock(const BearingBlock& block, const BlockSamples& found, float min_depth_m,
                      BlockViews& views) {
  const bool all_usable =
      *std::min_element(found.least_depth.begin(), found.least_depth.end()) >= min_depth_m;
  if (!all_usable) {
    return internal::FindViews(block, found.least_depth, found.band.samples, min_depth_m, views);
  }
  views.first = block.first;
  views.last = block.last;
  views.has_gaps = false;
}

BlockViews NoViews() {
  BlockViews views;
  views.first.fill(0.0F);
  views.last.fill(-1.0F);
  return views;
}

// Processes block number `at` of the image, with `bearings` bearings.
void FindReturnsOfBlock(const ReturnsJob& job, const BearingBlock& block, std::size_t bearings,
                        std::size_t at, BlockSamples& found) {
  ImageReturns& all = job.memory.returns;
  const std::size_t rows = block.RowCount();
  const bool has_slice = !all.slice.empty();
  if (rows == 0) {
    all.views[at] = NoViews();
    all.obstacles[at] = {};
    if (has_slice) all.slice[at] = {};
    return;
  }
  FindViewsOfBlock(block, found, job.bands.limits.min_depth_m, all.views[at]);
  while (const auto lane =
             FindNearestOfBlock<true>(job, block, found.band, bearings, at, all.obstacles[at])) {
    internal::SampleSkipped(job.bands, block, *lane, found);
  }
  if (!has_slice) return;
  FindNearestOfBlock<false>(job, block, found.slice, bearings, at, all.slice[at]);
  if (job.bands.slice.agree_sigmas > 0.0F) {
    internal::SteadySlice(job.bands, job.window, block, found.slice, all.slice[at]);
  }
  if (job.bands.slice.lean_sigmas > 0.0F) {
    internal::LeanSlice(job.bands, job.window, block, found.slice, all.slice[at]);
  }
}

// A number of neighbouring blocks that are read together.
struct Stripe {
  std::array<BearingBlock, internal::kMostStripeBlocks> blocks;
  std::array<BlockSamples, internal::kMostStripeBlocks> found;
  std::size_t size = 0;
};

void LayOut(std::span<const BearingLineBlock> lines, const ReturnLimits& limits,
            std::vector<Lanes>& memory, Stripe& stripe) {
  std::size_t lanes = 0;
  stripe.size = lines.size();
  for (std::size_t b = 0; b < stripe.size; ++b) {
    stripe.blocks[b] = internal::MakeBearingBlock(lines[b], limits);
    lanes += 2 * LanesOf(stripe.blocks[b]);
  }
  if (memory.size() < lanes) memory.resize(lanes);
  float* room = memory.empty() ? nullptr : memory.front().lane;  // null while no block has rows
  for (std::size_t b = 0; b < stripe.size; ++b) {
    for (BandFound* band : {&stripe.found[b].band, &stripe.found[b].slice}) {
      band->samples = RoomAt(stripe.blocks[b], room);
      room += LanesOf(stripe.blocks[b]) * kFloatsPerLanes;
    }
  }
}

}  // namespace

BearingReturns ImageReturns::At(std::size_t k, const std::vector<BlockHits>& hits) const {
  const BlockViews& block = views[k / kBlockBearings];
  const std::size_t i = k % kBlockBearings;
  BearingReturns returns;
  returns.hit = hits[k / kBlockBearings].is_hit[i] > 0.0F;
  returns.range_m = hits[k / kBlockBearings].range_m[i];
  if (block.first[i] <= block.last[i]) returns.seen = RangeOf(block.first[i], block.last[i]);
  if (!block.has_gaps) return returns;
  returns.gap_below = GapOf(block.below_from[i], block.below_to[i]);
  returns.gap_above = GapOf(block.above_from[i], block.above_to[i]);
  return returns;
}

ImageReturns& FindReturns(const DepthImage& image, const BearingLineTable& lines,
                          const ReturnLimits& limits, const std::optional<SliceBand>& slice,
                          const NoiseWindow& window, ReturnsMemory& memory) {
  ImageReturns& all = memory.returns;
  all.size = lines.size();
  all.views.resize(lines.blocks.size());
  all.obstacles.resize(lines.blocks.size());
  all.slice.resize(slice ? lines.blocks.size() : 0);
  const ReturnsJob job{{image, limits, slice.value_or(kNoSlice)}, lines, window, memory};
  const internal::SkipWidths widths = internal::SkipWidthsOf(window);
  Stripe stripe;
  const std::size_t most = internal::StripeBlocks(lines.size(), image.width_px);
  for (std::size_t begin = 0; begin < lines.blocks.size(); begin += stripe.size) {
    const std::size_t count = std::min(most, lines.blocks.size() - begin);
    LayOut(std::span(lines.blocks).subspan(begin, count), limits, memory.samples, stripe);
    internal::SampleBlocks(job.bands, widths, std::span(stripe.blocks).first(count), memory.survey,
                           std::span(stripe.found).first(count));
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t at = begin + b;
      const std::size_t bearings = std::min(kBlockBearings, lines.size() - at * kBlockBearings);
      FindReturnsOfBlock(job, stripe.blocks[b], bearings, at, stripe.found[b]);
    }
  }
  return all;
}

}  // namespace depthgrid
