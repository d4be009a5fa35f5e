#include "mapper/io/carmen_twins.h"

#include <algorithm>
#include <cmath>

#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Of the FLASER lines: the log may begin or end between two messages, and lines may be damaged.
constexpr double kLeastTwins = 0.9;
// FLASER lines are written with two decimals.
constexpr double kSameReadingM = 0.011;

bool IsSameReading(double a_m, double b_m) {
  if (a_m == b_m || (std::isnan(a_m) && std::isnan(b_m))) return true;
  return std::abs(a_m - b_m) < kSameReadingM;
}

bool AreTwins(const CarmenScan& a, const CarmenScan& b) {
  return a.states_angles != b.states_angles && IsSameStamp(a.stamp_s, b.stamp_s) &&
         std::equal(a.range_m.begin(), a.range_m.end(), b.range_m.begin(), b.range_m.end(),
                    IsSameReading);
}

}  // namespace

void CarmenTwins::Add(const CarmenScan& scan, int line_number) {
  if (!scan.states_angles && flasers_++ == 0) first_flaser_line_ = line_number;
  if (last_ && AreTwins(*last_, scan)) {
    ++twins_;
    last_.reset();
  } else {
    last_ = scan;
  }
}

std::optional<int> CarmenTwins::FirstFlaser() const {
  if (twins_ == 0 || twins_ < kLeastTwins * flasers_) return {};
  return first_flaser_line_;
}

}  // namespace depthgrid
