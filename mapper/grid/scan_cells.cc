#include "mapper/grid/scan_cells.h"

#include <algorithm>

#include "mapper/grid/ray.h"

namespace depthgrid {
namespace {

Cell CellAtPoint(const Eigen::Vector2d& point_cells) {
  return {FloorToInt(point_cells.x()), FloorToInt(point_cells.y())};
}

void Include(const Eigen::Vector2d& point_cells, ScanSegments& segments) {
  const Cell cell = CellAtPoint(point_cells);
  segments.min_cell = {std::min(segments.min_cell.x, cell.x),
                       std::min(segments.min_cell.y, cell.y)};
  segments.max_cell = {std::max(segments.max_cell.x, cell.x),
                       std::max(segments.max_cell.y, cell.y)};
}

}  // namespace

ScanSegments SegmentsOf(const Scan& scan, const Pose2& map_from_base, double resolution_m,
                        double clear_margin_m) {
  const Eigen::Vector2d origin = map_from_base.translation() / resolution_m;
  ScanSegments segments;
  segments.min_cell = segments.max_cell = CellAtPoint(origin);
  segments.beams.reserve(scan.beams.size());
  for (const Beam& beam : scan.beams) {
    const double bearing_rad = map_from_base.yaw_rad + static_cast<double>(beam.bearing_rad);
    const Eigen::Vector2d per_metre =
        Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)) / resolution_m;
    const double clear_from_m = beam.clear_from_m;
    const double stop_m = beam.hit ? beam.range_m - clear_margin_m : beam.clear_to_m;
    const double clear_to_m = std::min<double>(beam.clear_to_m, stop_m);
    ScanSegments::Segment segment;
    segment.hit = beam.hit;
    segment.clears = clear_to_m > clear_from_m;
    if (segment.hit) {
      segment.end = origin + beam.range_m * per_metre;
      Include(segment.end, segments);
    }
    if (segment.clears) {
      segment.clear_from = origin + clear_from_m * per_metre;
      segment.clear_to = origin + clear_to_m * per_metre;
      Include(segment.clear_from, segments);
      Include(segment.clear_to, segments);
    }
    segments.beams.push_back(segment);
  }
  // Rounding where a segment crosses a row can put it a hair outside its end points' cells.
  --segments.min_cell.x;
  ++segments.max_cell.x;
  return segments;
}

ScanCells CellsOfScanPlain(const ScanSegments& segments) {
  ScanCells cells;
  cells.hit.Reset(segments.min_cell, segments.max_cell);
  cells.passed.Reset(segments.min_cell, segments.max_cell);
  for (const ScanSegments::Segment& beam : segments.beams) {
    if (beam.hit) cells.hit.Set(CellAtPoint(beam.end));
    if (!beam.clears) continue;
    VisitSegmentSpans(beam.clear_from, beam.clear_to, [&](const CellSpan& span) {
      cells.passed.SetSpan(span.y, span.first_x, span.last_x);
    });
  }
  for (int y = cells.hit.first_row(); y < cells.hit.first_row() + cells.hit.rows(); ++y) {
    for (int word = 0; word < cells.hit.words_per_row(); ++word) {
      cells.passed.Row(y)[word] &= ~cells.hit.Row(y)[word];
    }
  }
  return cells;
}

}  // namespace depthgrid
