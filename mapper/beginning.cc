#include "mapper/beginning.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>

namespace depthgrid {
namespace {

constexpr std::size_t kMostFrames = 300;

void Silence(std::shared_ptr<const Scan>& scan, std::size_t begin, std::size_t end) {
  if (!scan) return;
  const auto rest = std::make_shared<Scan>(*scan);
  for (std::size_t i = begin; i < end; ++i) {
    rest->beams[i] = Silent(rest->beams[i]);
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

bool Beginning::TakeOut(const std::vector<MovingObjects::Beams>& object) {
  bool any = false;
  auto next = object.begin();
  for (Seen& seen : frames_) {
    while (next != object.end() && next->frame < seen.frame.index) ++next;
    if (next == object.end()) break;
    if (!seen.scans.matched) continue;
    std::size_t begin = next->begin, end = next->end;
    if (next->frame > seen.frame.index) {
      if (next == object.begin()) continue;
      begin = std::min(begin, std::prev(next)->begin);
      end = std::max(end, std::prev(next)->end);
    }
    Silence(seen.scans.matched, begin, end);
    Silence(seen.scans.standing, begin, end);
    any = true;
  }
  return any;
}

void Beginning::End() {
  lasts_ = false;
  frames_ = {};
}

}  // namespace depthgrid
