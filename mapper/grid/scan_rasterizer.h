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
    bool operator==(const RowRange&) const = default;
  };
  static RowRange Overlap(const RowRange& a, const RowRange& b) {
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
  }

  void Resize(std::size_t padded);
  void FindEndSpans(const ScanSegments& segments);
  void FindTouching(const ScanSegments& segments);
  void SetHits(const ScanSegments& segments);
  void SetEndSpans(const ScanSegments& segments);
  void FillRuns(const ScanSegments& segments);
  int LeftCell(std::size_t beam, int row) const;
  int RightCell(std::size_t beam, int row) const;
  double AllowedDistance(std::size_t beam) const;
  RowRange TouchingRows(std::size_t beam, double origin_y, const RowRange& rows) const;
  // Begins, or ends, a run of beams with this one in rows `first` to `last`, above or below the
  // origin.
  void Open(std::size_t beam, bool above, int first, int last);
  void Close(std::size_t beam, bool above, int first, int last);

  SegmentBuilder builder_;
  ScanCells cells_;
  // One entry a beam, and some to fill the last vector: the lower end of its clear interval, dx /
  // dy, rows from the origin to the farther end, the rows of the two ends, its spans of cells in
  // these rows, and whether it touches the beam before it.
  std::vector<double> low_x_, low_y_, slope_, reach_;
  std::vector<std::int32_t> first_row_, last_row_;
  std::vector<std::int32_t> first_span_first_, first_span_last_;
  std::vector<std::int32_t> last_span_first_, last_span_last_;
  std::vector<std::int32_t> touches_;
  std::vector<std::int32_t> open_x_;  // per row of the mask: outer end of the open run
};

}  // namespace depthgrid
