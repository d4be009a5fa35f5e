#include "mapper/place_watch.h"

#include <algorithm>
#include <bit>

namespace depthgrid {
namespace {

// Number of frames judged, and the share of them off the map that means lost.
constexpr int kFrames = 30;
constexpr double kLostShare = 0.9;

}  // namespace

std::optional<bool> IsOffMap(const FrameReport& report) {
  if (!report.map_from_camera || report.beams == 0) return {};
  if (report.guessed) return true;
  return !report.match.found || report.match.score < kLeastOnMap;
}

void PlaceWatch::Add(const FrameReport& report) {
  const auto off = IsOffMap(report);
  if (!off) return;
  constexpr std::uint32_t kMask = (1U << kFrames) - 1U;
  last_ = (last_ << 1U | (*off ? 1U : 0U)) & kMask;
  count_ = std::min(count_ + 1, kFrames);
}

double PlaceWatch::off_map() const {
  return count_ == 0 ? 0.0 : static_cast<double>(std::popcount(last_)) / count_;
}

bool PlaceWatch::lost() const { return count_ == kFrames && off_map() >= kLostShare; }

}  // namespace depthgrid
