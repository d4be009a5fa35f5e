#include "mapper/scan/scan_beams.h"

#include <algorithm>
#include <array>
#include <limits>

#include "mapper/scan/clear_interval.h"

namespace depthgrid {
namespace {

constexpr std::size_t kBatch = BearingViews::kBatch;

std::size_t Padded(std::size_t count) { return (count + kBatch - 1) / kBatch * kBatch; }

// Of a batch of bearings, as numbers that the compiler can take by vectors. Those after `count` are
// of lines without rows.
class BatchSlopes {
 public:
  BatchSlopes(const BearingLine* lines, const BearingReturns* returns, std::size_t count)
      : returns_(returns), count_(count) {
    for (std::size_t k = 0; k < count; ++k) {
      g0_[k] = lines[k].g0;
      g1_[k] = lines[k].g1;
      h0_[k] = lines[k].h0;
      h1_[k] = lines[k].h1;
    }
  }
  // Of the rays of these rows of each bearing; `none` and its negative where there are no rows.
  // Whether there were any.
  bool Find(RowRange BearingReturns::*rows, float none, float* __restrict low,
            float* __restrict high) const {
    std::array<float, kBatch> first, last;
    first.fill(0.0F);
    last.fill(-1.0F);
    bool any = false;
    for (std::size_t k = 0; k < count_; ++k) {
      const RowRange& range = returns_[k].*rows;
      first[k] = static_cast<float>(range.first);
      last[k] = static_cast<float>(range.last);
      any |= range.first <= range.last;
    }
    if (!any) {
      std::fill_n(low, kBatch, none);
      std::fill_n(high, kBatch, -none);
      return false;
    }
    for (std::size_t k = 0; k < kBatch; ++k) {
      const float a = (g0_[k] + g1_[k] * first[k]) / (h0_[k] + h1_[k] * first[k]);
      const float b = (g0_[k] + g1_[k] * last[k]) / (h0_[k] + h1_[k] * last[k]);
      const float lower = b < a ? b : a, higher = a < b ? b : a;
      low[k] = first[k] <= last[k] ? lower : none;
      high[k] = first[k] <= last[k] ? higher : -none;
    }
    return true;
  }

 private:
  const BearingReturns* returns_;
  std::size_t count_;
  std::array<float, kBatch> g0_{}, g1_{}, h0_{}, h1_{};
};

// Of scans that are read like a laser's.
void FindClearOfLaser(const BearingViews& views, double camera_height_m, const ScanOptions& options,
                      BeamNumbers& beams) {
  for (std::size_t k = 0; k < beams.limit_m.size(); ++k) {
    BearingView view;
    const SlopeRange seen{views.seen.low[k], views.seen.high[k]};
    if (seen.low <= seen.high) view.seen = seen;
    const Distances clear = LaserClearInterval(view, camera_height_m, beams.limit_m[k], options);
    beams.clear_from_m[k] = static_cast<float>(clear.from_m);
    beams.clear_to_m[k] = static_cast<float>(clear.to_m);
  }
}

void FindLimits(const std::vector<BearingReturns>& returns, const ScanOptions& options,
                BeamNumbers& beams) {
  const std::size_t count = returns.size(), padded = Padded(count);
  beams.limit_m.resize(padded);
  beams.clear_from_m.resize(padded);
  beams.clear_to_m.resize(padded);
  for (std::size_t k = 0; k < count; ++k) {
    beams.limit_m[k] = returns[k].hit ? returns[k].range_m : options.max_range_m;
  }
}

}  // namespace

void FindViews(const std::vector<BearingLine>& lines, const std::vector<BearingReturns>& returns,
               BearingViews& views) {
  const std::size_t count = lines.size(), padded = Padded(count);
  for (Slopes* slopes : {&views.seen, &views.below, &views.above}) {
    slopes->low.resize(padded);
    slopes->high.resize(padded);
  }
  views.has_gap.resize(padded / kBatch);
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const BatchSlopes slopes(&lines[begin], &returns[begin], std::min(kBatch, count - begin));
    const auto find = [&](RowRange BearingReturns::*rows, float none, Slopes& to) {
      return slopes.Find(rows, none, &to.low[begin], &to.high[begin]);
    };
    find(&BearingReturns::seen, std::numeric_limits<float>::infinity(), views.seen);
    const bool is_below = find(&BearingReturns::gap_below, 0.0F, views.below);
    const bool is_above = find(&BearingReturns::gap_above, 0.0F, views.above);
    views.has_gap[begin / kBatch] = is_below || is_above ? 1 : 0;
  }
}

Scan ScanOf(const std::vector<Bearing>& bearings, const BearingViews& views,
            const std::vector<BearingReturns>& returns, double camera_height_m,
            const ScanOptions& options, BeamNumbers& memory, Scan scan) {
  FindLimits(returns, options, memory);
  if (options.mode == ScanMode::kFull) {
    internal::FindClear(views, camera_height_m, options, memory);
  } else {
    FindClearOfLaser(views, camera_height_m, options, memory);
  }
  scan.max_range_m = options.max_range_m;
  scan.beams.resize(returns.size());
  for (std::size_t k = 0; k < returns.size(); ++k) {
    scan.beams[k] = {static_cast<float>(bearings[k].angle_rad), returns[k].range_m,
                     memory.clear_from_m[k], memory.clear_to_m[k], returns[k].hit};
  }
  return scan;
}

}  // namespace depthgrid
