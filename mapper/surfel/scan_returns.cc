#include "mapper/surfel/scan_returns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace depthgrid {
namespace {

// Hits up to this many steps apart are neighbours: beams may be lost between them.
constexpr double kMaxGapSteps = 3.5;
// Relative change of range after which the noise, which varies slowly, is looked up again.
constexpr double kNoiseLookupShare = 0.1;

}  // namespace

void ScanReturns::Read(const Scan& scan, const RangeNoise& noise, int stride) {
  LearnDirections(scan);
  step_rad_ = stride * beam_step_rad_;
  returns_.clear();
  independent_share_ = static_cast<double>(stride) / noise.stride();
  max_range_m_ = noise.TellsCutoff() ? scan.max_range_m : 0.0;
  double looked_up_m = 0.0;
  double relative_sigma = 0.0;
  for (std::size_t i = 0; i < scan.beams.size(); i += static_cast<std::size_t>(stride)) {
    if (!scan.beams[i].hit) continue;
    const double range_m = scan.beams[i].range_m;
    if (std::abs(range_m - looked_up_m) > kNoiseLookupShare * looked_up_m) {
      looked_up_m = range_m;
      relative_sigma = noise.RelativeSigma(range_m);
    }
    returns_.push_back({bearings_rad_[i], directions_[i], range_m, 1.0 / range_m, relative_sigma,
                        independent_share_});
  }
  DropLoneOutliers();
  Cut();
}

// Scans of one sensor share their bearings: sines and cosines are computed once.
void ScanReturns::LearnDirections(const Scan& scan) {
  const auto& beams = scan.beams;
  const auto same = [](const Beam& beam, float bearing) { return beam.bearing_rad == bearing; };
  if (beams.size() == bearings_rad_.size() &&
      std::equal(beams.begin(), beams.end(), bearings_rad_.begin(), same)) {
    return;
  }
  bearings_rad_.clear();
  directions_.clear();
  for (const Beam& beam : beams) {
    const double bearing_rad = beam.bearing_rad;
    bearings_rad_.push_back(beam.bearing_rad);
    directions_.emplace_back(std::cos(bearing_rad), std::sin(bearing_rad));
  }
  if (beams.size() > 1) {
    beam_step_rad_ = (beams.back().bearing_rad - beams.front().bearing_rad) /
                     static_cast<double>(beams.size() - 1);
  }
}

bool ScanReturns::Jumps(const ScanReturn& a, const ScanReturn& b) const {
  const double gap_rad = b.bearing_rad - a.bearing_rad;
  if (gap_rad > kMaxGapSteps * step_rad_) return true;
  const double relative =
      std::abs(a.inverse_range - b.inverse_range) / std::min(a.inverse_range, b.inverse_range);
  return relative >
         jump_sigmas_ * std::numbers::sqrt2 * a.relative_sigma + kSteepestTangent * gap_rad;
}

// Drops hits that differ from both neighbours while these agree with each other.
void ScanReturns::DropLoneOutliers() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < returns_.size(); ++i) {
    if (kept > 0 && i + 1 < returns_.size()) {
      const ScanReturn& left = returns_[kept - 1];
      const ScanReturn& right = returns_[i + 1];
      if (Jumps(left, returns_[i]) && Jumps(returns_[i], right) && !Jumps(left, right)) continue;
    }
    returns_[kept++] = returns_[i];
  }
  returns_.resize(kept);
}

void ScanReturns::Cut() {
  runs_.clear();
  int begin = 0;
  for (int i = 1; i <= size(); ++i) {
    if (i < size() && !Jumps((*this)[i - 1], (*this)[i])) continue;
    if (i > begin) runs_.push_back({begin, i});
    begin = i;
  }
}

}  // namespace depthgrid
