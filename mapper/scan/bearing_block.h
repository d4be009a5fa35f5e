// The inner loops of mapper/scan/bearing_returns.cc: many bearings at once, one a vector lane. Each
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

// Blocks that are sampled together at most: 128 columns of the image are lines of memory enough for
// the processor to foresee the next ones, and their samples stay in the second-level cache.
constexpr std::size_t kMostStripeBlocks = 4;
constexpr std::size_t StripeBlocks(std::size_t bearings, int width_px) {
  constexpr std::size_t kColumns = 128, kLeast = 2;
  const std::size_t in_columns = kColumns * bearings / static_cast<std::size_t>(width_px);
  return std::clamp(in_columns / kBlockBearings, kLeast, kMostStripeBlocks);
}

// Rows are sampled in groups of so many, the same for all blocks. The smallest sample of each is
// kept: whoever looks for near ones passes over the others.
constexpr std::size_t kGroupRows = 16;

struct BearingBlock {
  const BearingLineBlock* lines = nullptr;
  RowRange rows;          // in which any lane takes part, and those before in the first group
  RowRange shared_rows;   // in which all of them do
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
  // Whether every lane takes part in every row.
  bool AreShared(const RowRange& some) const {
    return some.first >= shared_rows.first && some.last <= shared_rows.last;
  }
};

BearingBlock MakeBearingBlock(const BearingLineBlock& lines, const ReturnLimits& limits);

// A block's samples of one band: samples[row - rows.first][lane], and nearest[group][lane], the
// smallest of each group of rows. Of groups whose smallest is no range the samples may be missing.
// Unlike SampleAt's, ranges may exceed the limit: that is one comparison less for each, and whoever
// reads them stops at it. least_depth[group][lane], null of a slice: if it is usable, so are all
// samples of the group; where it is not, those that are not are there.
struct BandSamples {
  float* samples = nullptr;
  float* nearest = nullptr;
  float* least_depth = nullptr;
};

// Stands for the smallest of a group that was too far away to be sampled.
constexpr float kSkipped = 1.5e9F;
static_assert(kSkipped > kPassing && kSkipped < kUnusable);

// Of each lane.
struct BandFound {
  BandSamples samples;
  BlockLane nearest;       // smallest sample
  BlockLane skipped_from;  // groups that were skipped hold no smaller range
};

// `slice` has a range in the slice or kPassing, and only in groups whose smallest is a range.
struct BlockSamples {
  BandFound band, slice;
  BlockLane least_depth;  // of its groups
};

struct ImageBands {
  const DepthImage& image;
  const ReturnLimits& limits;
  SliceBand slice;
};

// The noise window's width at the end of each of so many steps.
struct SkipWidths {
  static constexpr std::size_t kSteps = 32;
  static constexpr float kStepM = 0.25F;
  std::array<float, kSteps> width_m;
};
SkipWidths SkipWidthsOf(const NoiseWindow& window);

// Samples blocks group by group from the lowest rows up, where the nearest things are seen, and
// skips what lies so far behind them that it hardly matters. `found` has room for each block;
// `survey` is memory.
void SampleBlocks(const ImageBands& bands, const SkipWidths& widths,
                  std::span<const BearingBlock> blocks, std::vector<float>& survey,
                  std::span<BlockSamples> found);
// Samples what was skipped of a lane, and others beside it, after all.
void SampleSkipped(const ImageBands& bands, const BearingBlock& block, std::size_t lane,
                   BlockSamples& found);

// What the columns of some rows hold.
class Survey {
 public:
  Survey(int width_px, std::vector<float>& memory) : width_(static_cast<std::size_t>(width_px)) {
    memory.resize(4 * width_);
    columns_ = memory.data();
  }
  float* least() const { return columns_; }
  float* most() const { return columns_ + width_; }
  // Least depth but that of missing pixels; very large when all are missing.
  float* least_there() const { return columns_ + 2 * width_; }
  // Least of the greater depths of each pixel and the one to its right: not 0 when one of two
  // neighbours is there everywhere.
  float* least_of_two() const { return columns_ + 3 * width_; }

  int first = 0, end = 0;  // the columns that are surveyed
  bool has_holes = false;  // whether the last two are found as well

 private:
  std::size_t width_ = 0;
  float* columns_ = nullptr;
};
// Finds the first two of the columns from `first` up to `end`.
void SurveyColumns(const DepthImage& image, const RowRange& rows, int first, int end,
                   Survey& survey);
// Finds the last two, unless they are found.
void SurveyHoles(const DepthImage& image, const RowRange& rows, Survey& survey);

// Which rows are usable, and the longest gaps between them.
void FindViews(const BearingBlock& block, const BlockLane& least_depth, const BandSamples& band,
               float min_depth_m, BlockViews& views);

// FindNearest of the lanes whose smallest sample is supported by others. Of each lane whose bit is
// set: `alone`, the smallest sample is not; `doubtful`, what was skipped could matter.
struct NearestOfBlock {
  std::uint64_t alone = 0, doubtful = 0;
};
NearestOfBlock FindSupported(const BandFound& found, std::size_t rows, const ReturnLimits& limits,
                             const NoiseWindow& window, BlockHits& hits);

// SteadyRange of all lanes with a hit. `found` is the slice's.
void SteadySlice(const ImageBands& bands, const NoiseWindow& window, const BearingBlock& block,
                 const BandFound& found, BlockHits& hits);

}  // namespace depthgrid::internal
