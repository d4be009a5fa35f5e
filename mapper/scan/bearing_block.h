// The inner loops of mapper/scan/bearing_returns.cc: many bearings at once, one a vector lane. Each
// lane computes what SampleAt and FindNearest define, operation by operation, so the values do not
// depend on the width of the vectors and are those of the plain code bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "mapper/scan/bearing_returns.h"

namespace depthgrid::internal {

// Bearings a block: their pixels are a few cache lines of each image row, so that the image is read
// once, and their samples (120 kB for 480 rows) stay in the second-level cache.
constexpr std::size_t kBlockBearings = 64;

struct alignas(64) BlockLane : std::array<float, kBlockBearings> {};

// The smallest sample is kept of so many rows: whoever looks for near ones passes over the others.
constexpr std::size_t kGroupRows = 16;

struct BearingBlock {
  std::size_t bearings = 0;  // lanes after these repeat the last one
  RowRange rows;             // in which any lane takes part, and those before in the first group
  RowRange shared_rows;      // in which all of them do
  bool all_ahead = true;     // no ray of these rows points backwards
  BlockLane u0, u1, h0, h1, g0, g1;
  BlockLane first, last;  // rows of each lane

  std::size_t RowCount() const {
    return rows.last < rows.first ? 0 : static_cast<std::size_t>(rows.last - rows.first + 1);
  }
  std::size_t GroupCount() const { return (RowCount() + kGroupRows - 1) / kGroupRows; }
  RowRange RowsOfGroup(std::size_t group) const {
    const int from = rows.first + static_cast<int>(group * kGroupRows);
    return {from, std::min(from + static_cast<int>(kGroupRows) - 1, rows.last)};
  }
  // Whether every lane takes part in every row.
  bool AreShared(const RowRange& some) const {
    return some.first >= shared_rows.first && some.last <= shared_rows.last;
  }
};

BearingBlock MakeBearingBlock(const std::vector<BearingLine>& lines, std::size_t begin,
                              const ReturnLimits& limits);

// A block's samples of one band: samples[row - rows.first][lane], and nearest[group][lane], the
// smallest of each group of rows. Of groups whose smallest is no range the samples may be missing.
// Unlike SampleAt's, ranges may exceed the limit: that is one comparison less for each, and whoever
// reads them stops at it. least_depth[group][lane], null of a slice: no usable depth is smaller;
// where it is not usable itself, all samples of the group are there.
struct BandSamples {
  float* samples = nullptr;
  float* nearest = nullptr;
  float* least_depth = nullptr;
};

// `slice` has a range in the slice or kPassing, and only in groups whose smallest is a range.
struct SampleRows {
  BandSamples band;
  BandSamples slice;
};

// Of each lane.
struct BlockSamples {
  BlockLane nearest;        // smallest sample
  BlockLane slice_nearest;  // smallest of the slice
  BlockLane least_depth;    // of its groups
};

BlockSamples SampleBlock(const DepthImage& image, const ReturnLimits& limits,
                         const SliceBand& slice, const BearingBlock& block, const SampleRows& rows);

// Mean of the samples in [low, high] of each lane, high below kPassing; `otherwise` where there is
// none. `count`: their number.
struct BlockMean {
  BlockLane mean, count;
};
BlockMean MeanWithin(const BandSamples& band, std::size_t rows, const BlockLane& low,
                     const BlockLane& high, const BlockLane& otherwise);
// The same of all samples up to `high`.
BlockMean MeanUpTo(const BandSamples& band, std::size_t rows, const BlockLane& high,
                   const BlockLane& otherwise);

// Which rows are usable, and the longest gaps between them.
struct BlockViews {
  BlockLane first, last;                                 // usable rows; first > last when none
  BlockLane below_from, below_to, above_from, above_to;  // from == to when none
};
BlockViews FindViews(const BearingBlock& block, const BlockLane& least_depth,
                     const BandSamples& band, float min_depth_m);

}  // namespace depthgrid::internal
