#include "mapper/scan/frame_scans.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/scan/cut_ends.h"

namespace depthgrid {
namespace {

bool KnowsReach(const Scan& scan) {
  return scan.max_range_m > 0.0 && scan.max_range_m < kFarthestSeenM;
}

float ReachOf(const Scan& scan) {
  return static_cast<float>(KnowsReach(scan) ? scan.max_range_m : kUsualReachM);
}

// Copies the valid beams, sorted by bearing, with clear_to limited to the scan's reach.
void CopySound(const Scan& given, Scan& sound) {
  const float reach_m = ReachOf(given);
  sound.max_range_m = given.max_range_m;
  sound.beams.clear();
  for (const Beam& beam : given.beams) {
    if (!IsSound(beam, reach_m)) continue;
    // A number that stands for "no return". Taken literally it would clear the bearing up to
    // kUsualReachM.
    if (!KnowsReach(given) && !beam.hit && beam.clear_to_m > reach_m) continue;
    Beam& kept = sound.beams.emplace_back(beam);
    kept.clear_to_m = std::min(beam.clear_to_m, reach_m);
    // Drivers write infinity for no return; files and prior maps can hold only finite numbers.
    if (!std::isfinite(beam.range_m)) kept.range_m = 0.0F;
  }
  const auto before = [](const Beam& a, const Beam& b) { return a.bearing_rad < b.bearing_rad; };
  if (!std::is_sorted(sound.beams.begin(), sound.beams.end(), before)) {
    std::stable_sort(sound.beams.begin(), sound.beams.end(), before);
  }
}

// Bits of a float without its sign: ordered by magnitude, with NaN above infinity.
constexpr std::uint32_t kInfinityBits = 0x7F800000;
std::uint32_t SizeBits(float z_m) { return std::bit_cast<std::uint32_t>(z_m) & 0x7FFFFFFFU; }

// Replaces NaN, which some drivers write for invalid pixels: the vectorised comparisons that follow
// do not handle it.
std::shared_ptr<const DepthImage> SoundImage(const std::shared_ptr<const DepthImage>& depth) {
  std::uint32_t most = 0;  // a loop that vectorises: 25 us for 640 x 480 pixels
  for (const float z_m : depth->z_m) most = std::max(most, SizeBits(z_m));
  if (most <= kInfinityBits) return depth;
  auto sound = std::make_shared<DepthImage>(*depth);
  for (float& z_m : sound->z_m) {
    if (SizeBits(z_m) > kInfinityBits) z_m = kInvalidDepth;
  }
  return sound;
}

// Whether the horizon straight ahead is in the image.
bool ShowsHorizon(const PinholeCamera& camera, const CameraStand& stand) {
  const Eigen::Vector3d ahead = stand.level_from_camera.conjugate() * Eigen::Vector3d::UnitX();
  if (!(ahead.z() > 0.0)) return false;
  const Eigen::Vector2d pixel = Project(camera, ahead);
  return pixel.x() >= 0.0 && pixel.x() <= camera.width_px - 1.0 && pixel.y() >= 0.0 &&
         pixel.y() <= camera.height_px - 1.0;
}

bool LooksBelowHorizon(const PinholeCamera& camera, const CameraStand& stand) {
  const Eigen::Vector3d axis = stand.level_from_camera * Eigen::Vector3d::UnitZ();
  return axis.z() <= 0.0 && !ShowsHorizon(camera, stand);
}

}  // namespace

std::shared_ptr<Scan> ScanPool::Take() {
  const auto is_free = [](const std::shared_ptr<Scan>& scan) { return scan.use_count() == 1; };
  const auto found = std::find_if(scans_.begin(), scans_.end(), is_free);
  if (found != scans_.end()) return *found;
  return scans_.emplace_back(std::make_shared<Scan>());
}

FrameScanner::FrameScanner(const std::optional<PinholeCamera>& camera, const ScanOptions& options)
    // The other modes only read a few rows at the camera's height anyway.
    : slice_half_height_m_(options.mode == ScanMode::kFull ? options.slice_half_height_m : 0.0),
      band_low_m_(options.band_low_m),
      drop_cut_ends_(options.drop_cut_ends) {
  if (!camera) return;
  camera_ = *camera;
  converter_.emplace(*camera, options);
  floor_.emplace(*camera, options);
}

std::shared_ptr<const Scan> FrameScanner::SoundPart(const Scan& given) {
  const std::shared_ptr<Scan> sound = pool_.Take();
  CopySound(given, *sound);
  return sound;
}

SliceHeights FrameScanner::SliceOf(const CameraStand& stand) const {
  const double half_m = slice_half_height_m_;
  if (!floor_->KnowsHeight()) return {-half_m, half_m};
  const double band_low_m = band_low_m_ - stand.height_m;  // above the camera, as the slice is
  if (LooksBelowHorizon(camera_, stand)) return {band_low_m, band_low_m + 2.0 * half_m};
  return {std::clamp(band_low_m, -half_m, 0.0), half_m};
}

FrameScans FrameScanner::ScansOf(const Frame& frame) {
  if (frame.scan) {
    const std::shared_ptr<const Scan> scan = SoundPart(*frame.scan);
    return {scan, frame.matched_scan ? SoundPart(*frame.matched_scan) : scan, frame.stand};
  }
  const int epoch = epochs_.Of(frame);
  if (!frame.depth || !frame.slam_from_camera) return {};
  Require(converter_.has_value(), "a source of depth images has a camera");
  const std::shared_ptr<const DepthImage> depth = SoundImage(frame.depth);
  const CameraStand stand = floor_->Follow(*depth, *frame.slam_from_camera, epoch);
  if (slice_half_height_m_ <= 0.0) {
    const auto scan = std::make_shared<const Scan>(converter_->Convert(*depth, stand));
    return {scan, scan, stand};
  }
  const std::shared_ptr<Scan> obstacles = pool_.Take(), slice = pool_.Take();
  ScanPair scans = converter_->ConvertBoth(*depth, stand, SliceOf(stand), memory_,
                                           {std::move(*obstacles), std::move(*slice)});
  farthest_m_ = std::max(farthest_m_, scans.noise.farthest_m());
  if (drop_cut_ends_) DropCutEnds(scans.noise, farthest_m_, scans.slice);
  *obstacles = std::move(scans.obstacles);
  *slice = std::move(scans.slice);
  const bool is_in_view =
      ShowsHorizon(camera_, stand) || (floor_->KnowsHeight() && LooksBelowHorizon(camera_, stand));
  return {obstacles, is_in_view ? slice : obstacles, stand};
}

}  // namespace depthgrid
