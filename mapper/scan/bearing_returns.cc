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

// Lanes of samples, row by row.
class SampleBuffer {
 public:
  float* Rows(std::size_t rows) {
    if (rows > lanes_.size()) lanes_.resize(rows);
    return lanes_.data()->data();
  }

 private:
  std::vector<BlockLane> lanes_;
};

RowRange RangeOf(float first, float last) {
  return {static_cast<int>(first), static_cast<int>(last)};
}

RowRange GapOf(float from, float to) { return to - from > 1.0F ? RangeOf(from, to) : RowRange{}; }

// FindNearest for a block. Lanes whose smallest sample is not supported by others (a stray pixel)
// are done one by one.
void FindNearestOfBlock(const BearingBlock& block, const BlockSamples& found, const float* samples,
                        const ReturnLimits& limits, const NoiseWindow& window,
                        BearingReturns* returns) {
  BlockLane width, high;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    width[i] = window.At(found.nearest[i]);
    high[i] = found.nearest[i] + width[i];
  }
  const std::size_t rows = block.RowCount();
  const BlockMean first = internal::MeanWithin(samples, rows, found.nearest, high, found.nearest);
  BlockLane low;
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    const float half_m = 0.5F * width[i];
    low[i] = first.mean[i] - half_m;
    high[i] = first.mean[i] + half_m;
  }
  const BlockMean second = internal::MeanWithin(samples, rows, low, high, first.mean);
  std::vector<float> column;
  for (std::size_t i = 0; i < block.bearings; ++i) {
    if (found.nearest[i] >= kPassing) continue;
    if (first.count[i] >= static_cast<float>(limits.min_returns)) {
      returns[i].hit = true;
      returns[i].range_m = second.mean[i];
      continue;
    }
    column.clear();
    for (std::size_t r = 0; r < rows; ++r) column.push_back(samples[r * kBlockBearings + i]);
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
  const BlockViews views = internal::FindViews(block, samples);
  for (std::size_t i = 0; i < block.bearings; ++i) {
    returns[i].seen = RangeOf(views.first[i], views.last[i]);
    returns[i].gap_below = GapOf(views.below_from[i], views.below_to[i]);
    returns[i].gap_above = GapOf(views.above_from[i], views.above_to[i]);
  }
}

}  // namespace

std::vector<BearingReturns> FindReturns(const DepthImage& image,
                                        const std::vector<BearingLine>& lines,
                                        const ReturnLimits& limits, const NoiseWindow& window) {
  std::vector<BearingReturns> all(lines.size());
  SampleBuffer buffer;
  for (std::size_t begin = 0; begin < lines.size(); begin += kBlockBearings) {
    const BearingBlock block = internal::MakeBearingBlock(lines, begin, limits);
    if (block.RowCount() == 0) continue;
    float* samples = buffer.Rows(block.RowCount());
    const BlockSamples found = internal::SampleBlock(image, limits, block, samples);
    FindNearestOfBlock(block, found, samples, limits, window, &all[begin]);
    FindViewsOfBlock(block, found, samples, &all[begin]);
  }
  return all;
}

}  // namespace depthgrid
