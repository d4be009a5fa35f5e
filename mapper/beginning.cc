#include "mapper/beginning.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>

namespace depthgrid {
namespace {

constexpr std::size_t kMostFrames = 300;

void Silence(std::shared_ptr<const Scan>& scan, float first_rad, float last_rad) {
  if (!scan) return;
  const auto rest = std::make_shared<Scan>(*scan);
  for (Beam& beam : rest->beams) {
    if (beam.bearing_rad >= first_rad && beam.bearing_rad <= last_rad) beam = Silent(beam);
  }
  scan = rest;
}

}  // namespace

void Beginning::Add(const Frame& frame, const FrameScans& scans) {
  if (!lasts_) return;
  if (frames_.size() == kMostFrames) {
    End();
    return;
  }
  Seen seen{frame, scans};
  seen.frame.depth = nullptr;
  seen.frame.scan = nullptr;
  seen.frame.matched_scan = nullptr;
  frames_.push_back(std::move(seen));
}

bool Beginning::TakeOut(const std::vector<MovingObjects::Sector>& object) {
  bool any = false;
  auto next = object.begin();
  for (int frame = 0; frame < static_cast<int>(frames_.size()); ++frame) {
    FrameScans& scans = frames_[static_cast<std::size_t>(frame)].scans;
    while (next != object.end() && next->frame < frame) ++next;
    if (next == object.end()) break;
    if (!scans.matched) continue;
    float first_rad = next->first_rad, last_rad = next->last_rad;
    if (next->frame > frame) {
      if (next == object.begin()) continue;
      first_rad = std::min(first_rad, std::prev(next)->first_rad);
      last_rad = std::max(last_rad, std::prev(next)->last_rad);
    }
    Silence(scans.matched, first_rad, last_rad);
    Silence(scans.standing, first_rad, last_rad);
    any = true;
  }
  return any;
}

void Beginning::End() {
  lasts_ = false;
  frames_ = {};
}

}  // namespace depthgrid
