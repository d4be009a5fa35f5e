// The same cells as CellsOfScanPlain, without visiting a cell once for every beam that crosses it.
//
// In a grid row that two neighbouring beams both cross from side to side, their spans of cells
// touch each other unless the beams are far apart there. So per row only the first and the last
// beam of a run of such neighbours matter, and what is between their outer ends is filled at once:
// work grows with the outline of the free area, not with its cells times beams. Where a beam begins
// or ends inside a row, its own span is set by itself.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mapper/grid/scan_cells.h"

namespace depthgrid {

// Keeps its memory from scan to scan.
class ScanRasterizer {
 public:
  // The result is good until the next call.
  const ScanCells& Rasterize(const ScanSegments& segments);
  const ScanCells& Rasterize(const Scan& scan, const Pose2& map_from_base, double resolution_m,
                             double clear_margin_m = 0.0) {
    return Rasterize(builder_.Build(scan, map_from_base, resolution_m, clear_margin_m));
  }

 private:
  // Rows first..last, none if last < first.
  struct RowRange {
    int first = 0;
    int last = -1;
    bool empty() const { return last < first; }
  };
  struct Span {
    int first_x = 0;
    int last_x = 0;
  };

  void OrientUpwards(const ScanSegments& segments);
  void FindEndSpans(std::size_t count);
  void SetHits(const ScanSegments& segments);
  void SetEndSpans(const ScanSegments& segments);
  void FillRuns(const ScanSegments& segments);
  Span CrossingSpan(std::size_t beam, int row) const;
  RowRange CrossedRows(std::size_t beam) const {
    return {first_row_[beam] + 1, last_row_[beam] - 1};
  }
  RowRange ContiguousRows(std::size_t beam, double origin_y) const;
  static RowRange Overlap(const RowRange& a, const RowRange& b) {
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
  }
  // A run of beams begins, or ends, with this one in the rows from `first` to `last`.
  void Open(std::size_t beam, int first, int last);
  void Close(std::size_t beam, int first, int last);

  SegmentBuilder builder_;
  ScanCells cells_;
  // One entry a beam: its clear interval from the lower to the higher end.
  std::vector<double> low_x_, low_y_, high_x_, high_y_, slope_;
  std::vector<std::uint8_t> goes_up_;
  std::vector<double> first_high_x_, last_low_x_;  // where it leaves its first row, enters its last
  std::vector<std::int32_t> first_row_, last_row_;
  std::vector<std::int32_t> first_span_first_, first_span_last_;
  std::vector<std::int32_t> last_span_first_, last_span_last_;
  std::vector<std::int32_t> open_x_;  // per row of the mask: the outer end of the run that is open
};

}  // namespace depthgrid
