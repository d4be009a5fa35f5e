#include "mapper/beginning.h"

#include <cstddef>
#include <utility>

namespace depthgrid {
namespace {

constexpr std::size_t kMostFrames = 300;

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

void Beginning::End() {
  lasts_ = false;
  frames_ = {};
}

}  // namespace depthgrid
