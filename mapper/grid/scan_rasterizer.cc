#include "mapper/grid/scan_rasterizer.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "mapper/grid/ray.h"

namespace depthgrid {
namespace {

// Safety factor for neighbours to count as touching, so that rounding does not matter.
constexpr double kTouchMargin = 0.99;

// Farther than any scan, but within int.
constexpr double kFarCells = 1e8;

namespace hn = hwy::HWY_NAMESPACE;
using DoubleLanes = hn::CappedTag<double, 4>;
using Doubles = hn::Vec<DoubleLanes>;
constexpr DoubleLanes kDoubles;

// Converts whole numbers to 32-bit integers.
void StoreInts(Doubles values, std::int32_t* out) {
  const hn::Rebind<std::int32_t, DoubleLanes> ints;
  hn::StoreU(hn::DemoteTo(ints, values), ints, out);
}

// The last cell of the points between `end`, inclusive, and `crossing`, exclusive unless the
// segment ends there.
Doubles LastCellBetween(Doubles end, Doubles crossing, hn::Mask<DoubleLanes> one_row) {
  const Doubles below_crossing = hn::Sub(hn::Ceil(crossing), hn::Set(kDoubles, 1.0));
  const auto open = hn::AndNot(one_row, hn::Gt(crossing, end));
  const Doubles last = hn::IfThenElse(open, below_crossing, hn::Floor(hn::Max(end, crossing)));
  return hn::Max(last, hn::Floor(hn::Min(end, crossing)));
}

}  // namespace

const ScanCells& ScanRasterizer::Rasterize(const ScanSegments& segments) {
  if (!segments.bearings_increase) {
    cells_ = CellsOfScanPlain(segments);
    return cells_;
  }
  cells_.hit.Reset(segments.min_cell, segments.max_cell);
  cells_.passed.Reset(segments.min_cell, segments.max_cell);
  Resize(segments.from_x.size());
  FindEndSpans(segments);
  FindTouching(segments);
  SetHits(segments);
  SetEndSpans(segments);
  FillRuns(segments);
  cells_.passed.Remove(cells_.hit);
  return cells_;
}

void ScanRasterizer::Resize(std::size_t padded) {
  // One element more, as each beam is read together with its neighbour.
  for (auto* values : {&low_x_, &low_y_, &slope_, &reach_}) values->resize(padded + 1);
  touches_.resize(padded + 1);
  for (auto* values : {&first_row_, &last_row_, &first_span_first_, &first_span_last_,
                       &last_span_first_, &last_span_last_}) {
    values->resize(padded);
  }
}

// RowSpan (mapper/grid/ray.h) for the first and for the last row of every beam.
void ScanRasterizer::FindEndSpans(const ScanSegments& segments) {
  const Doubles one = hn::Set(kDoubles, 1.0);
  const Doubles origin_y = hn::Set(kDoubles, segments.origin.y());
  for (std::size_t i = 0; i < segments.size(); i += hn::Lanes(kDoubles)) {
    const Doubles from_x = hn::LoadU(kDoubles, segments.from_x.data() + i);
    const Doubles from_y = hn::LoadU(kDoubles, segments.from_y.data() + i);
    const Doubles to_x = hn::LoadU(kDoubles, segments.to_x.data() + i);
    const Doubles to_y = hn::LoadU(kDoubles, segments.to_y.data() + i);
    const auto down = hn::Gt(from_y, to_y);
    const Doubles low_x = hn::IfThenElse(down, to_x, from_x);
    const Doubles low_y = hn::IfThenElse(down, to_y, from_y);
    const Doubles high_x = hn::IfThenElse(down, from_x, to_x);
    const Doubles high_y = hn::IfThenElse(down, from_y, to_y);
    const Doubles rise = hn::Sub(high_y, low_y);
    const Doubles divisor = hn::IfThenElse(hn::Gt(rise, hn::Zero(kDoubles)), rise, one);
    const Doubles quotient = hn::Div(hn::Sub(high_x, low_x), divisor);
    // As in VisitSegmentSpans: a segment along a row boundary, whose slope overflows, belongs to
    // the row above.
    const auto has_slope = hn::IsFinite(quotient);
    const Doubles slope = hn::IfThenElseZero(has_slope, quotient);
    hn::StoreU(low_x, kDoubles, low_x_.data() + i);
    hn::StoreU(low_y, kDoubles, low_y_.data() + i);
    hn::StoreU(slope, kDoubles, slope_.data() + i);

    const Doubles last_row = hn::Floor(high_y);
    const Doubles first_row = hn::IfThenElse(has_slope, hn::Floor(low_y), last_row);
    const Doubles reach = hn::Max(hn::Sub(last_row, origin_y), hn::Sub(origin_y, first_row));
    hn::StoreU(reach, kDoubles, reach_.data() + i);
    StoreInts(first_row, first_row_.data() + i);
    StoreInts(last_row, last_row_.data() + i);
    const auto one_row = hn::Eq(first_row, last_row);
    const Doubles rows_end = hn::Sub(hn::Add(first_row, one), low_y);
    const Doubles rows_begin = hn::Sub(last_row, low_y);
    const Doubles leave_x =
        hn::IfThenElse(one_row, high_x, hn::Add(low_x, hn::Mul(rows_end, slope)));
    const Doubles enter_x =
        hn::IfThenElse(one_row, low_x, hn::Add(low_x, hn::Mul(rows_begin, slope)));
    StoreInts(hn::Floor(hn::Min(low_x, leave_x)), first_span_first_.data() + i);
    StoreInts(LastCellBetween(low_x, leave_x, one_row), first_span_last_.data() + i);
    StoreInts(hn::Floor(hn::Min(high_x, enter_x)), last_span_first_.data() + i);
    StoreInts(LastCellBetween(high_x, enter_x, one_row), last_span_last_.data() + i);
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

// RowSpan for a beam that crosses the whole row: its leftmost and rightmost cell.
inline int ScanRasterizer::LeftCell(std::size_t beam, int row) const {
  const double below = low_x_[beam] + (row - low_y_[beam]) * slope_[beam];
  const double above = low_x_[beam] + (row + 1 - low_y_[beam]) * slope_[beam];
  return FloorToInt(std::min(below, above));
}

inline int ScanRasterizer::RightCell(std::size_t beam, int row) const {
  const double below = low_x_[beam] + (row - low_y_[beam]) * slope_[beam];
  const double above = low_x_[beam] + (row + 1 - low_y_[beam]) * slope_[beam];
  return std::max(FloorToInt(std::min(below, above)), LastCellBelow(std::max(below, above)));
}

// The spans of a beam and of the one before it touch in a row if h |slope difference| does not
// exceed this, with h the height above the origin at which they enter the row. Both start at the
// origin, so h |slope difference| is their distance there, and each span is as wide as its slope.
inline double ScanRasterizer::AllowedDistance(std::size_t beam) const {
  const double slope = slope_[beam];
  const double before = slope_[beam - 1];
  const double width = slope * before > 0.0 ? std::min(std::abs(slope), std::abs(before)) : 0.0;
  return kTouchMargin * (1.0 + width);
}

// For every beam, whether it touches the one before it in every row that both cross.
void ScanRasterizer::FindTouching(const ScanSegments& segments) {
  const Doubles one = hn::Set(kDoubles, 1.0);
  const Doubles margin = hn::Set(kDoubles, kTouchMargin);
  for (std::size_t i = 1; i < segments.size(); i += hn::Lanes(kDoubles)) {
    const Doubles slope = hn::LoadU(kDoubles, slope_.data() + i);
    const Doubles before = hn::LoadU(kDoubles, slope_.data() + i - 1);
    const auto same_side = hn::Gt(hn::Mul(slope, before), hn::Zero(kDoubles));
    const Doubles width = hn::IfThenElseZero(same_side, hn::Min(hn::Abs(slope), hn::Abs(before)));
    const Doubles height =
        hn::Max(hn::LoadU(kDoubles, reach_.data() + i), hn::LoadU(kDoubles, reach_.data() + i - 1));
    const auto touches = hn::Le(hn::Mul(height, hn::Abs(hn::Sub(slope, before))),
                                hn::Mul(margin, hn::Add(one, width)));
    StoreInts(hn::IfThenElseZero(touches, one), touches_.data() + i);
  }
}

// The part of `rows` in which a beam touches the one before it.
ScanRasterizer::RowRange ScanRasterizer::TouchingRows(std::size_t beam, double origin_y,
                                                      const RowRange& rows) const {
  const double reach = AllowedDistance(beam) / std::abs(slope_[beam] - slope_[beam - 1]);
  if (!(reach < kFarCells)) return rows;
  return Overlap(rows, {static_cast<int>(std::ceil(origin_y - reach)) - 1,
                        static_cast<int>(std::floor(origin_y + reach))});
}

// With increasing bearing x decreases above the origin and increases below it.
inline void ScanRasterizer::Open(std::size_t beam, bool above, int first, int last) {
  for (int row = first; row <= last; ++row) {
    open_x_[static_cast<std::size_t>(row - cells_.passed.first_row())] =
        above ? RightCell(beam, row) : LeftCell(beam, row);
  }
}

inline void ScanRasterizer::Close(std::size_t beam, bool above, int first, int last) {
  for (int row = first; row <= last; ++row) {
    const int open_x = open_x_[static_cast<std::size_t>(row - cells_.passed.first_row())];
    if (above) {
      cells_.passed.SetSpan(row, LeftCell(beam, row), open_x);
    } else {
      cells_.passed.SetSpan(row, open_x, RightCell(beam, row));
    }
  }
}

void ScanRasterizer::FillRuns(const ScanSegments& segments) {
  open_x_.resize(static_cast<std::size_t>(cells_.passed.rows()));
  const double origin_y = segments.origin.y();
  const auto is_above = [origin_y](const RowRange& rows) { return rows.first >= origin_y; };
  RowRange open;  // rows in which a run includes the previous beam
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const RowRange crossed =
        segments.clears[i] != 0 ? RowRange{first_row_[i] + 1, last_row_[i] - 1} : RowRange{};
    if (crossed == open && touches_[i] != 0) continue;  // the usual case
    RowRange shared = Overlap(open, crossed);
    if (!shared.empty() && touches_[i] == 0) shared = TouchingRows(i, origin_y, shared);
    if (shared.empty()) {
      if (!open.empty()) Close(i - 1, is_above(open), open.first, open.last);
      Open(i, is_above(crossed), crossed.first, crossed.last);
    } else {
      const bool above = is_above(shared);
      Close(i - 1, above, open.first, shared.first - 1);
      Close(i - 1, above, shared.last + 1, open.last);
      Open(i, above, crossed.first, shared.first - 1);
      Open(i, above, shared.last + 1, crossed.last);
    }
    open = crossed;
  }
  if (!open.empty()) Close(segments.size() - 1, is_above(open), open.first, open.last);
}

}  // namespace depthgrid
