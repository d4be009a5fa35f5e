// The inner loops of mapper/scan/bearing_returns.cc: many bearings at once, one per SIMD lane. Each
// lane computes what SampleAt and FindNearest define, operation by operation, so the values do not
// depend on the width of the vectors and are those of the plain code bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapper/scan/bearing_returns.h"

namespace depthgrid::internal {

// Most blocks sampled together (a stripe): 128 image columns suffice for the hardware prefetcher,
// and their samples stay in the L2 cache.
constexpr std::size_t kMostStripeBlocks = 4;
constexpr std::size_t StripeBlocks(std::size_t bearings, int width_px) {
  constexpr std::size_t kColumns = 128, kLeast = 2;
  const std::size_t in_columns = kColumns * bearings / static_cast<std::size_t>(width_px);
  return std::clamp(in_columns / kBlockBearings, kLeast, kMostStripeBlocks);
}

// Rows are sampled in groups of this size, the same for all blocks. Each group's smallest sample is
// stored, so that searches for near samples can skip groups.
constexpr std::size_t kGroupRows = 16;

struct BearingBlock {
  const BearingLineBlock* lines = nullptr;
  RowRange rows;          // rows used by any lane, extended to the first group's start
  RowRange shared_rows;   // rows used by all lanes
  bool all_ahead = true;  // no ray of these rows points backwards
  BlockLane first, last;  // rows of each lane

  std::size_t RowCount() const {
    return rows.last < rows.first ? 0 : static_cast<std::size_t>(rows.last - rows.first + 1);
  }
  std::size_t GroupCount() const { return (RowCount() + kGroupRows - 1) / kGroupRows; }
  RowRange RowsOfGroup(std::size_t group) const {
    const int from = rows.first + static_cast<int>(group * kGroupRows);
    return {from, std::min(from + static_cast<int>(kGroupRows) - 1, rows.last)};
  }
  // Whether all lanes use all of these rows.
  bool AreShared(const RowRange& some) const {
    return some.first >= shared_rows.first && some.last <= shared_rows.last;
  }
};

BearingBlock MakeBearingBlock(const BearingLineBlock& lines, const ReturnLimits& limits);

// A block's samples of one band: samples[row - rows.first][lane], and nearest[group][lane], the
// smallest of each group of rows. Samples may be missing in groups whose smallest is no range.
// Unlike SampleAt's, ranges may exceed the limit, which saves a comparison; readers stop at it.
// least_depth[group][lane] (null for a slice): if usable, so are all samples of the group; if not,
// the unusable samples are stored.
struct BandSamples {
  float* samples = nullptr;
  float* nearest = nullptr;
  float* least_depth = nullptr;
};

// Smallest sample of a group that was skipped as too far away.
constexpr float kSkipped = 1.5e9F;
static_assert(kSkipped > kPassing && kSkipped < kUnusable);

// Results per lane.
struct BandFound {
  BandSamples samples;
  BlockLane nearest;       // smallest sample
  BlockLane skipped_from;  // skipped groups hold no smaller range
};

// Samples of `slice` are ranges within it or kPassing, stored only in groups whose smallest is a
// range.
struct BlockSamples {
  BandFound band, slice;
  BlockLane least_depth;  // minimum over groups
};

struct ImageBands {
  const DepthImage& image;
  const ReturnLimits& limits;
  SliceBand slice;
};

// Width of the noise window at the end of each step of range.
struct SkipWidths {
  static constexpr std::size_t kSteps = 32;
  static constexpr float kStepM = 0.25F;
  std::array<float, kSteps> width_m;
};
SkipWidths SkipWidthsOf(const NoiseWindow& window);

// Samples blocks group by group from the lowest rows up, where the nearest surfaces are seen, and
// skips groups too far behind these to matter. `found` has an entry per block; `survey` is memory.
void SampleBlocks(const ImageBands& bands, const SkipWidths& widths,
                  std::span<const BearingBlock> blocks, std::vector<float>& survey,
                  std::span<BlockSamples> found);
// Samples the skipped groups of a lane (and neighbouring lanes) after all.
void SampleSkipped(const ImageBands& bands, const BearingBlock& block, std::size_t lane,
                   BlockSamples& found);

// Statistics of the depths in each column over some rows.
class Survey {
 public:
  Survey(int width_px, std::vector<float>& memory) : width_(static_cast<std::size_t>(width_px)) {
    memory.resize(4 * width_);
    columns_ = memory.data();
  }
  float* least() const { return columns_; }
  float* most() const { return columns_ + width_; }
  // Least depth ignoring missing pixels; very large if all are missing.
  float* least_there() const { return columns_ + 2 * width_; }
  // Least maximum of a pixel and its right neighbour: not 0 if at least one of the two exists in
  // every row.
  float* least_of_two() const { return columns_ + 3 * width_; }

  int first = 0, end = 0;  // surveyed columns
  bool has_holes = false;  // whether the last two are computed

 private:
  std::size_t width_ = 0;
  float* columns_ = nullptr;
};
// Computes least() and most() of columns [first, end).
void SurveyColumns(const DepthImage& image, const RowRange& rows, int first, int end,
                   Survey& survey);
// Computes least_there() and least_of_two() if not done yet.
void SurveyHoles(const DepthImage& image, const RowRange& rows, Survey& survey);

// Finds the usable rows and the longest gaps between them.
void FindViews(const BearingBlock& block, const BlockLane& least_depth, const BandSamples& band,
               float min_depth_m, BlockViews& views);

// FindNearest() of the lanes whose smallest sample is supported by others. Bits of other lanes:
// `alone`, the smallest sample is unsupported; `doubtful`, skipped groups could matter.
struct NearestOfBlock {
  std::uint64_t alone = 0, doubtful = 0;
};
NearestOfBlock FindSupported(const BandFound& found, std::size_t rows, const ReturnLimits& limits,
                             const NoiseWindow& window, BlockHits& hits);

// SteadyRange() of all lanes with a hit. `found`: of the slice.
void SteadySlice(const ImageBands& bands, const NoiseWindow& window, const BearingBlock& block,
                 const BandFound& found, BlockHits& hits);
// LeaningRange() of all lanes with a hit.
void LeanSlice(const ImageBands& bands, const NoiseWindow& window, const BearingBlock& block,
               const BandFound& found, BlockHits& hits);

}  // namespace depthgrid::internal
