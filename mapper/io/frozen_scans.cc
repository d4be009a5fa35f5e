#include "mapper/io/frozen_scans.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/frozen_scan.h"

namespace depthgrid {
namespace {

bool IsSame(const std::vector<double>& a_m, const std::vector<double>& b_m) {
  return std::equal(a_m.begin(), a_m.end(), b_m.begin(), b_m.end(),
                    [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
}

}  // namespace

void FrozenScans::Add(double stamp_s, const Pose2& odom_from_laser,
                      const std::vector<double>& range_m, const std::function<Scan()>& scan) {
  frozen_.push_back(false);
  const std::size_t here = frozen_.size() - 1;
  if (here == 0 || !IsSame(range_m, range_m_)) {
    stamp_s_ = stamp_s;
    odom_from_laser_ = odom_from_laser;
    range_m_ = range_m;
    first_ = here;
    return;
  }
  const Pose2 motion = Between(odom_from_laser_, odom_from_laser);
  if (!MustDiffer(scan(), motion, stamp_s - stamp_s_)) return;
  for (std::size_t i = first_ + 1; i <= here; ++i) frozen_[i] = true;
}

}  // namespace depthgrid
