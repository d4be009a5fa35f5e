#include "mapper/io/held_poses.h"

#include <cmath>
#include <utility>

#include "mapper/core/median.h"
#include "mapper/io/held_motion.h"

namespace depthgrid {
namespace {

using internal::kBegunShare;
using internal::kFewReadings;
using internal::kMovedM;
using internal::kTimesNoise;

// The median difference of the readings that both have; 0 if they are few.
double DifferenceM(const std::vector<double>& a_m, const std::vector<double>& b_m) {
  std::vector<double> differences_m;
  for (std::size_t i = 0; i < std::min(a_m.size(), b_m.size()); ++i) {
    if (a_m[i] > 0.0 && b_m[i] > 0.0) differences_m.push_back(std::abs(a_m[i] - b_m[i]));
  }
  return differences_m.size() < kFewReadings ? 0.0 : UpperMedian(std::move(differences_m));
}

}  // namespace

void HeldPoses::Add(const Pose2& odom_from_laser, std::vector<double> range_m, double min_range_m,
                    double no_return_m) {
  for (double& reading_m : range_m) {
    if (!(reading_m >= min_range_m && reading_m < no_return_m)) reading_m = 0.0;
  }
  held_.push_back(false);
  const std::size_t scan = held_.size() - 1;
  if (!pose_ || *pose_ != odom_from_laser) {
    moves_ = pose_.has_value();
    pose_ = odom_from_laser;
    first_m_ = range_m;
    moved_from_ = scan + 1;
  } else {
    const double since_first_m = DifferenceM(first_m_, range_m);
    const double since_last_m = DifferenceM(last_m_, range_m);
    const double moved_m = kMovedM + kTimesNoise * since_last_m;
    if (since_first_m < kBegunShare * moved_m) moved_from_ = scan + 1;
    if (moves_ && since_first_m > moved_m) {
      for (std::size_t i = moved_from_; i <= scan; ++i) held_[i] = true;
    }
  }
  last_m_ = std::move(range_m);
}

}  // namespace depthgrid
