// The inner loops of mapper/scan/bearing_returns.cc: many bearings at once, one a vector lane. Each
// lane computes what SampleAt and FindNearest define, operation by operation, so the values do not
// depend on the width of the vectors and are those of the plain code bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
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
  RowRange rows;             // in which any lane takes part
  RowRange shared_rows;      // in which all of them do
  bool all_ahead = true;     // no ray of these rows points backwards
  BlockLane u0, u1, h0, h1, g0, g1;
  BlockLane first, last;  // rows of each lane

  std::size_t RowCount() const {
    return rows.last < rows.first ? 0 : static_cast<std::size_t>(rows.last - rows.first + 1);
  }
  std::size_t GroupCount() const { return (RowCount() + kGroupRows - 1) / kGroupRows; }
};

BearingBlock MakeBearingBlock(const std::vector<BearingLine>& lines, std::size_t begin,
                              const ReturnLimits& limits);

// A block's samples of one band: samples[row - rows.first][lane], and nearest[group][lane], the
// smallest of each group of rows; least_depth[group][lane] likewise, null of a slice. Unlike
// SampleAt's, ranges may exceed the limit: that is one comparison less for each, and whoever reads
// them stops at it.
struct BandSamples {
  float* samples = nullptr;
  float* nearest = nullptr;
  float* least_depth = nullptr;
};

// `slice` has a range in the slice or kPassing, and only in groups whose smallest is a range; null
// without a slice.
struct SampleRows {
  BandSamples band;
  BandSamples slice;
};

// Of each lane.
struct BlockSamples {
  BlockLane nearest;        // smallest sample
  BlockLane slice_nearest;  // smallest of the slice
  BlockLane least_depth;    // in the lane's own rows
};

BlockSamples SampleBlock(const DepthImage& image, const ReturnLimits& limits,
                         const std::optional<SliceBand>& slice, const BearingBlock& block,
                         const SampleRows& rows);

// Mean of the samples in [low, high] of each lane, high below kPassing; `otherwise` where there is
// none. `count`: their number.
struct BlockMean {
  BlockLane mean, count;
};
BlockMean MeanWithin(const BandSamples& band, std::size_t rows, const BlockLane& low,
                     const BlockLane& high, const BlockLane& otherwise);

// Which rows are usable, and the longest gaps between them.
struct BlockViews {
  BlockLane first, last;                                 // usable rows; first > last when none
  BlockLane below_from, below_to, above_from, above_to;  // from == to when none
};
BlockViews FindViews(const BearingBlock& block, const BlockLane& least_depth,
                     const BandSamples& band, float min_depth_m);

}  // namespace depthgrid::internal
