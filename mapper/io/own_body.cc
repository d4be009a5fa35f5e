#include "mapper/io/own_body.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/median.h"
#include "mapper/io/body_rule.h"

namespace depthgrid {
namespace {

constexpr std::size_t kMostViews = 64;
constexpr double kLastingShare = 0.95;
// Beams at the edge of a part hit it only sometimes.
constexpr double kEdgeRad = RadFromDeg(1.0);

}  // namespace

void OwnBody::Add(const CarmenScan& line, double min_range_m) {
  if (views_m_.size() >= kMostViews) return;
  if (views_m_.empty()) {
    count_ = line.range_m.size();
    step_rad_ = line.bearing_step_rad;
  } else if (std::abs(WrapAngle(line.odom_from_laser.yaw_rad - yaw_rad_)) <
             RadFromDeg(kBodyViewTurnDeg)) {
    return;
  }
  if (line.range_m.size() != count_) return;
  yaw_rad_ = line.odom_from_laser.yaw_rad;
  views_m_.push_back(line.range_m);
  for (double& range_m : views_m_.back()) {
    if (!(range_m >= min_range_m && range_m < kMostBodyM)) range_m = 0.0;
  }
}

double OwnBody::LastedAtM(std::size_t reading) const {
  std::vector<double> near_m;
  for (const std::vector<double>& view_m : views_m_) {
    if (view_m[reading] > 0.0) near_m.push_back(view_m[reading]);
  }
  const double least = kLastingShare * static_cast<double>(views_m_.size());
  if (static_cast<double>(near_m.size()) < least) return 0.0;
  const double middle_m = UpperMedian(near_m);
  const auto lasted = std::count_if(near_m.begin(), near_m.end(), [&](double range_m) {
    return std::abs(range_m - middle_m) < BodyBandM(middle_m);
  });
  return static_cast<double>(lasted) < least ? 0.0 : middle_m;
}

void OwnBody::Find() {
  if (views_m_.size() < kFewestBodyViews) return;
  const auto edge = static_cast<std::size_t>(
      std::max(2.0, std::ceil(kEdgeRad / std::max(std::abs(step_rad_), 1e-9))));
  std::vector<double> lasted_m;  // of the part at the end
  for (std::size_t i = 0; i < count_; ++i) {
    const double range_m = LastedAtM(i);
    if (range_m == 0.0) continue;
    body_to_m_.resize(count_, 0.0);
    const std::size_t end = std::min(count_, i + edge + 1);
    for (std::size_t beside = i < edge ? 0 : i - edge; beside < end; ++beside) {
      body_to_m_[beside] = std::max(body_to_m_[beside], range_m + BodyBandM(range_m));
    }
    if (parts_.empty() || i > parts_.back().last + edge) {
      parts_.push_back({.first = i});
      lasted_m.clear();
    }
    lasted_m.push_back(range_m);
    Part& part = parts_.back();
    part.last = i;
    part.range_m = UpperMedian(lasted_m);
  }
  views_m_.clear();
}

void OwnBody::Drop(CarmenScan& line) const {
  if (body_to_m_.empty() || line.range_m.size() != count_) return;
  for (std::size_t i = 0; i < count_; ++i) {
    if (line.range_m[i] < body_to_m_[i]) line.range_m[i] = 0.0;
  }
}

}  // namespace depthgrid
