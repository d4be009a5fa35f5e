#include "mapper/core/trajectory.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {

std::vector<double> StampsOf(const Trajectory& trajectory) {
  std::vector<double> stamps_s;
  stamps_s.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) stamps_s.push_back(pose.stamp_s);
  return stamps_s;
}

std::optional<std::size_t> NearestStamp(const std::vector<double>& stamps_s, double stamp_s,
                                        double max_difference_s) {
  const auto after = std::lower_bound(stamps_s.begin(), stamps_s.end(), stamp_s);
  auto nearest = after;
  if (after == stamps_s.end() ||
      (after != stamps_s.begin() && stamp_s - *(after - 1) <= *after - stamp_s)) {
    if (after == stamps_s.begin()) return {};
    nearest = after - 1;
  }
  if (!(std::abs(*nearest - stamp_s) <= max_difference_s)) return {};
  return static_cast<std::size_t>(nearest - stamps_s.begin());
}

}  // namespace depthgrid
