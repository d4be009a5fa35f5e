// The lines of a block's bearings, one a lane.
#include <algorithm>
#include <cmath>

#include "mapper/scan/bearing_block.h"

namespace depthgrid::internal {
BearingBlock MakeBearingBlock(const std::vector<BearingLine>& lines, std::size_t begin,
                              const ReturnLimits& limits) {
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
  if (block.RowCount() > 0) {
    block.first_group = static_cast<std::size_t>(block.rows.first - limits.first_row) / kGroupRows;
    block.rows.first = limits.first_row + static_cast<int>(block.first_group * kGroupRows);
  }
  for (std::size_t i = 0; i < kBlockBearings; ++i) {
    for (const int v : {block.rows.first, block.rows.last}) {
      block.all_ahead = block.all_ahead && block.h0[i] + block.h1[i] * static_cast<float>(v) > 0.0F;
    }
  }
  return block;
}

}  // namespace depthgrid::internal
