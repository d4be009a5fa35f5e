#include "mapper/grid/scan_cells.h"

#include "mapper/grid/ray.h"

namespace depthgrid {

ScanCells CellsOfScanPlain(const ScanSegments& segments) {
  ScanCells cells;
  cells.hit.Reset(segments.min_cell, segments.max_cell);
  cells.passed.Reset(segments.min_cell, segments.max_cell);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments.hit[i] != 0) {
      cells.hit.Set({FloorToInt(segments.end_x[i]), FloorToInt(segments.end_y[i])});
    }
    if (segments.clears[i] == 0) continue;
    VisitSegmentSpans(
        {segments.from_x[i], segments.from_y[i]}, {segments.to_x[i], segments.to_y[i]},
        [&](const CellSpan& span) { cells.passed.SetSpan(span.y, span.first_x, span.last_x); });
  }
  cells.passed.Remove(cells.hit);
  return cells;
}

}  // namespace depthgrid
