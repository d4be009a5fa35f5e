#include "mapper/scan/frame_scans.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// A band of the slice's thickness above a floor that lies half of it below the camera.
ScanOptions SliceOptions(ScanOptions options) {
  options.band_low_m = 0.0;
  options.band_high_m = 2.0 * options.slice_half_height_m;
  return options;
}

// One sum tells of three numbers whether all are finite.
bool IsSound(const Beam& beam) {
  const float known = beam.bearing_rad + beam.clear_from_m + beam.clear_to_m;
  if (!std::isfinite(known) || beam.clear_from_m < 0.0F) return false;
  return !beam.hit || (std::isfinite(beam.range_m) && beam.range_m >= 0.0F);
}

std::shared_ptr<const Scan> SoundPart(const std::shared_ptr<const Scan>& scan) {
  if (std::all_of(scan->beams.begin(), scan->beams.end(), IsSound)) return scan;
  Scan sound;
  sound.max_range_m = scan->max_range_m;
  std::copy_if(scan->beams.begin(), scan->beams.end(), std::back_inserter(sound.beams), IsSound);
  return std::make_shared<const Scan>(std::move(sound));
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
  if (frame.scan) {
    const std::shared_ptr<const Scan> scan = SoundPart(frame.scan);
    return {scan, frame.matched_scan ? SoundPart(frame.matched_scan) : scan};
  }
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
