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

struct BearingBlock {
  std::size_t bearings = 0;  // lanes after these repeat the last one
  RowRange rows;             // in which any lane takes part
  RowRange shared_rows;      // in which all of them do
  RowRange slice_rows;       // of `rows`, those that can see the slice
  bool all_ahead = true;     // no ray of these rows points backwards
  BlockLane u0, u1, h0, h1, g0, g1;
  BlockLane first, last;  // rows of each lane

  std::size_t RowCount() const {
    return rows.last < rows.first ? 0 : static_cast<std::size_t>(rows.last - rows.first + 1);
  }
};

BearingBlock MakeBearingBlock(const std::vector<BearingLine>& lines, std::size_t begin,
                              const ReturnLimits& limits, const std::optional<SliceBand>& slice);

// samples[row - rows.first][lane], and the same of the slice: a range in it, or kPassing. Only its
// rows `slice_rows` are filled, none without a slice. Unlike SampleAt's, ranges may exceed the
// limit: that is one comparison less for each, and whoever reads them stops at it.
struct SampleRows {
  float* samples = nullptr;
  float* slice = nullptr;
};

struct BlockSamples {
  BlockLane nearest;        // smallest sample
  BlockLane farthest;       // largest: kUnusable when any sample is
  BlockLane slice_nearest;  // smallest of the slice
};

BlockSamples SampleBlock(const DepthImage& image, const ReturnLimits& limits,
                         const std::optional<SliceBand>& slice, const BearingBlock& block,
                         const SampleRows& rows);

// Mean of the samples in [low, high] of each lane; `otherwise` where there is none. `count`: their
// number.
struct BlockMean {
  BlockLane mean, count;
};
BlockMean MeanWithin(const float* samples, std::size_t rows, const BlockLane& low,
                     const BlockLane& high, const BlockLane& otherwise);

// Which rows are usable, and the longest gaps between them. `farthest` as of SampleBlock.
struct BlockViews {
  BlockLane first, last;                                 // usable rows; first > last when none
  BlockLane below_from, below_to, above_from, above_to;  // from == to when none
};
BlockViews FindViews(const BearingBlock& block, const BlockLane& farthest, const float* samples);

}  // namespace depthgrid::internal
