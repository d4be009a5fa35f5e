// The lines of a block's bearings, one a lane.
#include <algorithm>
#include <cmath>

#include "mapper/scan/bearing_block.h"

namespace depthgrid::internal {
namespace {

// The rows of which some lane can see a surface in the slice: from min_depth on, the slice is seen
// within these slopes (heights are z (g0 + g1 v)).
RowRange SliceRows(const BearingBlock& block, const ReturnLimits& limits, const SliceBand& slice) {
  if (!(limits.min_depth_m > 0.0F)) return block.rows;
  constexpr float kRowsToSpare = 1.0F;  // more than any rounding
  constexpr float kLeastSlope = 1e-6F;  // a row; a camera's is a hundredth or more
  const float low = slice.low_m / limits.min_depth_m;
  const float high = slice.high_m / limits.min_depth_m;
  float first = static_cast<float>(block.rows.last);
  float last = static_cast<float>(block.rows.first);
  for (std::size_t i = 0; i < block.bearings; ++i) {
    if (!(std::abs(block.g1[i]) > kLeastSlope)) return block.rows;
    const float per_slope = 1.0F / block.g1[i];
    const float a = (low - block.g0[i]) * per_slope;
    const float b = (high - block.g0[i]) * per_slope;
    first = std::min(first, std::min(a, b));
    last = std::max(last, std::max(a, b));
  }
  const auto within = [&](float row) {
    return static_cast<int>(
        std::clamp(row, static_cast<float>(block.rows.first), static_cast<float>(block.rows.last)));
  };
  return {within(first - kRowsToSpare), within(last + kRowsToSpare)};
}

}  // namespace

BearingBlock MakeBearingBlock(const std::vector<BearingLine>& lines, std::size_t begin,
                              const ReturnLimits& limits, const std::optional<SliceBand>& slice) {
  BearingBlock block;
  block.bearings = std::min(kBlockBearings, lines.size() - begin);
  block.rows = {limits.last_row + 1, limits.first_row - 1};
  block.shared_rows = {limits.first_row, limits.last_row};
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    const BearingLine& line = lines[begin + std::min(i, block.bearings - 1)];
    const RowRange rows = RowsOf(line, limits);
    block.u0[i] = line.u0;
    block.u1[i] = line.u1;
    block.h0[i] = line.h0;
    block.h1[i] = line.h1;
    block.g0[i] = line.g0;
    block.g1[i] = line.g1;
    block.first[i] = static_cast<float>(rows.first);
    block.last[i] = static_cast<float>(rows.last);
    block.shared_rows.first = std::max(block.shared_rows.first, rows.first);
    block.shared_rows.last = std::min(block.shared_rows.last, rows.last);
    if (rows.first > rows.last) continue;
    block.rows.first = std::min(block.rows.first, rows.first);
    block.rows.last = std::max(block.rows.last, rows.last);
  }
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    for (const int v : {block.rows.first, block.rows.last}) {
      block.all_ahead = block.all_ahead && block.h0[i] + block.h1[i] * static_cast<float>(v) > 0.0F;
    }
  }
  if (slice && block.RowCount() > 0) block.slice_rows = SliceRows(block, limits, *slice);
  return block;
}

}  // namespace depthgrid::internal
