#include "mapper/scan/frame_scans.h"

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// A band of the slice's thickness above a floor that lies half of it below the camera.
ScanOptions SliceOptions(ScanOptions options) {
  options.band_low_m = 0.0;
  options.band_high_m = 2.0 * options.slice_half_height_m;
  return options;
}

}  // namespace

FrameScanner::FrameScanner(const std::optional<PinholeCamera>& camera, const ScanOptions& options)
    : slice_half_height_m_(options.slice_half_height_m) {
  if (!camera) return;
  obstacles_.emplace(*camera, options);
  // The other modes read few rows at the camera's height already.
  if (options.mode == ScanMode::kFull && slice_half_height_m_ > 0.0) {
    slice_.emplace(*camera, SliceOptions(options));
  }
}

FrameScans FrameScanner::ScansOf(const Frame& frame) const {
  if (frame.scan) return {frame.scan, frame.scan};
  if (!frame.depth || !frame.slam_from_camera) return {};
  Require(obstacles_.has_value(), "a source of depth images has a camera");
  FrameScans scans;
  scans.obstacles =
      std::make_shared<const Scan>(obstacles_->Convert(*frame.depth, *frame.slam_from_camera));
  scans.matched = scans.obstacles;
  if (slice_) {
    scans.matched = std::make_shared<const Scan>(
        slice_->ConvertAtHeight(*frame.depth, *frame.slam_from_camera, slice_half_height_m_));
  }
  return scans;
}

}  // namespace depthgrid
