#include "mapper/grid/scan_rasterizer.h"

#include <algorithm>
#include <cmath>

#include "mapper/grid/ray.h"

namespace depthgrid {
namespace {

// Neighbours count as touching only with this much to spare, so that no rounding decides.
constexpr double kTouchMargin = 0.99;

}  // namespace

const ScanCells& ScanRasterizer::Rasterize(const ScanSegments& segments) {
  if (!segments.bearings_increase) {
    cells_ = CellsOfScanPlain(segments);
    return cells_;
  }
  cells_.hit.Reset(segments.min_cell, segments.max_cell);
  cells_.passed.Reset(segments.min_cell, segments.max_cell);
  OrientUpwards(segments);
  FindEndSpans(segments.size());
  SetHits(segments);
  SetEndSpans(segments);
  FillRuns(segments);
  cells_.passed.Remove(cells_.hit);
  return cells_;
}

void ScanRasterizer::OrientUpwards(const ScanSegments& segments) {
  const std::size_t count = segments.size();
  for (auto* values : {&low_x_, &low_y_, &high_x_, &high_y_, &slope_}) values->resize(count);
  goes_up_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool down = segments.from_y[i] > segments.to_y[i];
    goes_up_[i] = down ? 0 : 1;
    low_x_[i] = down ? segments.to_x[i] : segments.from_x[i];
    low_y_[i] = down ? segments.to_y[i] : segments.from_y[i];
    high_x_[i] = down ? segments.from_x[i] : segments.to_x[i];
    high_y_[i] = down ? segments.from_y[i] : segments.to_y[i];
    const double rise = high_y_[i] - low_y_[i];
    slope_[i] = (high_x_[i] - low_x_[i]) / (rise > 0.0 ? rise : 1.0);
  }
}

// The spans of RowSpan (mapper/grid/ray.h) in the first and in the last row, as vector loops.
void ScanRasterizer::FindEndSpans(std::size_t count) {
  for (auto* values : {&first_high_x_, &last_low_x_}) values->resize(count);
  for (auto* values : {&first_row_, &last_row_, &first_span_first_, &first_span_last_,
                       &last_span_first_, &last_span_last_}) {
    values->resize(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double first_row = std::floor(low_y_[i]);
    const double last_row = std::floor(high_y_[i]);
    const bool one_row = first_row == last_row;
    first_row_[i] = static_cast<std::int32_t>(first_row);
    last_row_[i] = static_cast<std::int32_t>(last_row);
    const double leave_x = low_x_[i] + (first_row + 1.0 - low_y_[i]) * slope_[i];
    const double enter_x = low_x_[i] + (last_row - low_y_[i]) * slope_[i];
    first_high_x_[i] = one_row ? high_x_[i] : leave_x;
    last_low_x_[i] = one_row ? low_x_[i] : enter_x;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double a = low_x_[i];
    const double b = first_high_x_[i];
    const bool one_row = first_row_[i] == last_row_[i];
    const double first = std::floor(a <= b ? a : b);
    const double closed_last = std::floor(a <= b ? b : a);
    const double open_last = std::ceil(b) - 1.0;
    const double last = a <= b && !one_row ? open_last : closed_last;
    first_span_first_[i] = static_cast<std::int32_t>(first);
    first_span_last_[i] = static_cast<std::int32_t>(last > first ? last : first);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double a = last_low_x_[i];
    const double b = high_x_[i];
    const bool one_row = first_row_[i] == last_row_[i];
    const double first = std::floor(a <= b ? a : b);
    const double closed_last = std::floor(a <= b ? b : a);
    const double open_last = std::ceil(a) - 1.0;
    const double last = a > b && !one_row ? open_last : closed_last;
    last_span_first_[i] = static_cast<std::int32_t>(first);
    last_span_last_[i] = static_cast<std::int32_t>(last > first ? last : first);
  }
}

void ScanRasterizer::SetHits(const ScanSegments& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments.hit[i] == 0) continue;
    cells_.hit.Set({FloorToInt(segments.end_x[i]), FloorToInt(segments.end_y[i])});
  }
}

void ScanRasterizer::SetEndSpans(const ScanSegments& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments.clears[i] == 0) continue;
    cells_.passed.SetSpan(first_row_[i], first_span_first_[i], first_span_last_[i]);
    cells_.passed.SetSpan(last_row_[i], last_span_first_[i], last_span_last_[i]);
  }
}

ScanRasterizer::Span ScanRasterizer::CrossingSpan(std::size_t beam, int row) const {
  const CellSpan span = RowSpan({low_x_[beam], low_y_[beam]}, {high_x_[beam], high_y_[beam]},
                                slope_[beam], row, false, false);
  return {span.first_x, span.last_x};
}

// The rows in which the crossing spans of a beam and of the one before it touch, as far as their
// distance goes. Both start at the origin: at a height h above it they are h |slope difference|
// apart, and within a row each is as wide as its slope.
ScanRasterizer::RowRange ScanRasterizer::ContiguousRows(std::size_t beam, double origin_y) const {
  const double slope = slope_[beam];
  const double before = slope_[beam - 1];
  const double width = slope * before > 0.0 ? std::min(std::abs(slope), std::abs(before)) : 0.0;
  const double apart = std::abs(slope - before);
  constexpr double kFar = 1e8;  // cells: beyond any grid, within an int
  const double reach = apart * kFar > 1.0 + width ? kTouchMargin * (1.0 + width) / apart : kFar;
  return {static_cast<int>(std::ceil(origin_y - reach)) - 1,
          static_cast<int>(std::floor(origin_y + reach))};
}

// Above the origin x falls from beam to beam, below it rises.
void ScanRasterizer::Open(std::size_t beam, int first, int last) {
  for (int row = first; row <= last; ++row) {
    const Span span = CrossingSpan(beam, row);
    open_x_[static_cast<std::size_t>(row - cells_.passed.first_row())] =
        goes_up_[beam] != 0 ? span.last_x : span.first_x;
  }
}

void ScanRasterizer::Close(std::size_t beam, int first, int last) {
  for (int row = first; row <= last; ++row) {
    const Span span = CrossingSpan(beam, row);
    const int open_x = open_x_[static_cast<std::size_t>(row - cells_.passed.first_row())];
    if (goes_up_[beam] != 0) {
      cells_.passed.SetSpan(row, span.first_x, open_x);
    } else {
      cells_.passed.SetSpan(row, open_x, span.last_x);
    }
  }
}

void ScanRasterizer::FillRuns(const ScanSegments& segments) {
  open_x_.resize(static_cast<std::size_t>(cells_.passed.rows()));
  RowRange open;  // rows in which a run goes on up to the beam before
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const RowRange crossed = segments.clears[i] != 0 ? CrossedRows(i) : RowRange{};
    RowRange shared = Overlap(open, crossed);
    if (!shared.empty()) shared = Overlap(shared, ContiguousRows(i, segments.origin.y()));
    if (shared.empty()) {
      if (i > 0) Close(i - 1, open.first, open.last);
      Open(i, crossed.first, crossed.last);
    } else {
      Close(i - 1, open.first, shared.first - 1);
      Close(i - 1, shared.last + 1, open.last);
      Open(i, crossed.first, shared.first - 1);
      Open(i, shared.last + 1, crossed.last);
    }
    open = crossed;
  }
  if (segments.size() > 0) Close(segments.size() - 1, open.first, open.last);
}

}  // namespace depthgrid
