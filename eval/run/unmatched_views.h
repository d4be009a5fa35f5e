// What the depth images show of which too little could be matched: why, in the user's terms.
#pragma once

#include <array>
#include <cstddef>

#include "mapper/core/camera.h"
#include "mapper/core/camera_stand.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/frame_report.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// A frame that was not matched with hits on less than this share of the beams showed too little; if
// there are more hits, the scans are not the cause.
constexpr double kFewBeams = 0.25;

enum class ShownView {
  kNoDepth,  // a tenth of the pixels or less has a depth
  // Less than kFewBeams of the pixels that look ahead at the camera's own height have a depth from
  // min_range_m to max_range_m; most of them have
  kNoDepthAhead,  // ... none
  kBeyondRange,   // ... a farther one
  kBelowRange,    // ... a nearer one
  kFloor,         // nine tenths of what it shows are below band_low_m
  kCeiling,       // ... above band_high_m
  kFloorAndCeiling,
  kOther,
};
constexpr std::size_t kShownViews = 8;

ShownView ShownIn(const DepthImage& depth, const PinholeCamera& camera, const CameraStand& stand,
                  const ScanOptions& options);

// Counts the frames that showed too little, from the first mapped one on.
class UnmatchedViews {
 public:
  void Add(const FrameReport& report, const DepthImage& depth, const PinholeCamera& camera,
           const ScanOptions& options);

  int frames() const { return frames_; }
  int Count(ShownView view) const { return Of(view).frames; }
  int First(ShownView view) const { return Of(view).first; }  // Frame::index

 private:
  struct OfView {
    int frames = 0;
    int first = 0;
  };
  const OfView& Of(ShownView view) const { return views_[static_cast<std::size_t>(view)]; }

  bool any_mapped_ = false;
  int frames_ = 0;
  std::array<OfView, kShownViews> views_ = {};
};

}  // namespace depthgrid
