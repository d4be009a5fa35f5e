// The rows of a block's bearings, one bearing per vector lane (bearing_block.h).
#include "mapper/scan/bearing_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_block_setup.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBlockBearings>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

HWY_INLINE int Least(Vec rows) {
  return static_cast<int>(hn::GetLane(hn::MinOfLanes(Floats(), rows)));
}
HWY_INLINE int Most(Vec rows) {
  return static_cast<int>(hn::GetLane(hn::MaxOfLanes(Floats(), rows)));
}

// `rows` has those in which any bearing takes part, `shared_rows` those in which all do.
void ChooseRows(const BearingLineBlock& lines, const ReturnLimits& limits, BearingBlock& block) {
  const Floats d;
  const Vec first_row = hn::Set(d, static_cast<float>(limits.first_row));
  const Vec last_row = hn::Set(d, static_cast<float>(limits.last_row));
  const Vec one = hn::Set(d, 1.0F);
  Vec first_of_any = hn::Add(last_row, one), last_of_any = hn::Sub(first_row, one);
  Vec first_of_all = first_row, last_of_all = last_row;
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const Vec first = hn::Max(hn::Load(d, &lines.first_row[i]), first_row);
    const Vec last = hn::Min(hn::Load(d, &lines.last_row[i]), last_row);
    const Mask any = hn::Le(first, last);
    hn::Store(first, d, &block.first[i]);
    hn::Store(last, d, &block.last[i]);
    first_of_any = hn::IfThenElse(any, hn::Min(first_of_any, first), first_of_any);
    last_of_any = hn::IfThenElse(any, hn::Max(last_of_any, last), last_of_any);
    first_of_all = hn::Max(first_of_all, first);
    last_of_all = hn::Min(last_of_all, last);
  }
  block.rows = {Least(first_of_any), Most(last_of_any)};
  block.shared_rows = {Most(first_of_all), Least(last_of_all)};
}

bool AreAllAhead(const BearingLineBlock& lines, const RowRange& rows) {
  const Floats d;
  const Vec first = hn::Set(d, static_cast<float>(rows.first));
  const Vec last = hn::Set(d, static_cast<float>(rows.last));
  Mask ahead = hn::FirstN(d, hn::Lanes(d));
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const Vec h0 = hn::Load(d, &lines.h0[i]), h1 = hn::Load(d, &lines.h1[i]);
    for (const Vec row : {first, last}) {
      ahead = hn::And(ahead, hn::Gt(hn::Add(h0, hn::Mul(h1, row)), hn::Zero(d)));
    }
  }
  return hn::AllTrue(d, ahead);
}

void SetUp(const BearingLineBlock& lines, const ReturnLimits& limits, BearingBlock& block) {
  block.lines = &lines;
  ChooseRows(lines, limits, block);
  if (block.RowCount() > 0) {
    const int before = block.rows.first - limits.first_row;
    block.rows.first -= before % static_cast<int>(kGroupRows);
  }
  block.all_ahead = AreAllAhead(lines, block.rows);
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SetUp);

BearingBlock MakeBearingBlock(const BearingLineBlock& lines, const ReturnLimits& limits) {
  BearingBlock block;
  HWY_DYNAMIC_DISPATCH(SetUp)(lines, limits, block);
  return block;
}

SkipWidths SkipWidthsOf(const NoiseWindow& window) {
  SkipWidths widths;
  for (std::size_t k = 0; k < SkipWidths::kSteps; ++k) {
    widths.width_m[k] = window.At(SkipWidths::kStepM * static_cast<float>(k + 1));
  }
  return widths;
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
