#include "mapper/scan/depth_to_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/error.h"
#include "mapper/scan/farthest_seen.h"

namespace depthgrid {
namespace {

void Transpose(const DepthImage& image, DepthImage& transposed) {
  transposed.width_px = image.height_px;
  transposed.height_px = image.width_px;
  transposed.z_m.resize(image.z_m.size());
  for (int v = 0; v < transposed.height_px; ++v) {
    for (int u = 0; u < transposed.width_px; ++u) transposed.Row(v)[u] = image.At(v, u);
  }
}

// The image that is read; the lines along which it is read are in the memory.
struct Reading {
  bool transposed = false;
  const DepthImage* image = nullptr;
};

Reading ReadingOf(const DepthImage& depth, const PinholeCamera& camera, const CameraStand& stand,
                  int beams, ScanMemory& memory) {
  Require(depth.width_px == camera.width_px && depth.height_px == camera.height_px,
          "depth images have the camera's size");
  const Eigen::Quaterniond& level_from_camera = stand.level_from_camera;
  Reading reading;
  reading.transposed = LinesRunAlongRows(camera, level_from_camera);
  if (reading.transposed) Transpose(depth, memory.transposed);
  reading.image = reading.transposed ? &memory.transposed : &depth;
  memory.lines = BearingLines(camera, level_from_camera,
                              ScanBearings(camera, level_from_camera, beams, memory.fan),
                              reading.transposed, std::move(memory.lines));
  return reading;
}

// Samples count up to a noise window beyond max_range_m. Without those beyond it, the mean for a
// surface near max_range_m would be too short.
ReturnLimits LimitsOf(const ScanOptions& options, const PinholeCamera& camera, bool transposed,
                      double camera_height_m, const NoiseWindow& window) {
  ReturnLimits limits;
  const auto reach_m = static_cast<float>(options.max_range_m);
  limits.min_depth_m = static_cast<float>(options.min_range_m);
  limits.max_range_m = reach_m + window.At(reach_m);
  limits.low_m = static_cast<float>(options.band_low_m - camera_height_m);
  limits.high_m = static_cast<float>(options.band_high_m - camera_height_m);
  const int rows = transposed ? camera.width_px : camera.height_px;
  const double centre = transposed ? camera.cx_px : camera.cy_px;
  int used = rows;
  if (options.mode == ScanMode::kCentreRow) used = 1;
  if (options.mode == ScanMode::kRowBand) used = std::min(rows, options.band_rows);
  limits.first_row = 0;
  if (used < rows) {
    limits.first_row =
        std::clamp(static_cast<int>(std::lround(centre - 0.5 * (used - 1))), 0, rows - used);
  }
  limits.last_row = limits.first_row + used - 1;
  limits.min_returns = std::min(options.min_returns, used);
  return limits;
}

void DropBeyond(double reach_m, std::vector<BlockHits>& hits) {
  const auto reach = static_cast<float>(reach_m);
  for (BlockHits& block : hits) {
    for (std::size_t i = 0; i < kBlockBearings; ++i) {
      const bool is_within = block.range_m[i] <= reach;
      block.is_hit[i] = is_within ? block.is_hit[i] : 0.0F;
      block.range_m[i] = is_within ? block.range_m[i] : 0.0F;
    }
  }
}

// One of an image's scans: its returns and limits.
struct Band {
  const ScanOptions& options;
  const ReturnLimits& limits;
  double camera_height_m;
};

Scan ScanOf(const DepthImage& image, const Band& band, std::vector<BlockHits>& hits,
            ScanMemory& memory, Scan scan = {}) {
  DropBeyond(band.options.max_range_m, hits);
  scan = ScanOf(memory.fan.bearings, memory.views, hits, band.camera_height_m, band.options,
                memory.beams, std::move(scan));
  EndWhereNothingWasSeen(image, memory.lines, band.limits, scan);
  return scan;
}

// Options for a slice, with the camera `-low_m` above a floor that begins where the slice does.
ScanOptions SliceOptions(ScanOptions options, const SliceHeights& slice) {
  options.band_low_m = 0.0;
  options.band_high_m = slice.high_m - slice.low_m;
  return options;
}

void RequireUsable(const PinholeCamera& camera) {
  if (camera.HasDistortion()) {
    throw InputError("camera",
                     "has distortion, must be that of undistorted images "
                     "(mapper/io/undistort.h makes them)");
  }
  if (camera.width_px < 2 || camera.height_px < 2) {
    throw InputError("camera", "is " + std::to_string(camera.width_px) + " x " +
                                   std::to_string(camera.height_px) +
                                   " pixels, must be 2 x 2 or more");
  }
}

}  // namespace

DepthToScan::DepthToScan(const PinholeCamera& camera, const ScanOptions& options)
    : camera_(camera), options_(options) {
  RequireUsable(camera);
  RequireInRange(options, "mapper.scan");
}

Scan DepthToScan::Convert(const DepthImage& depth, const CameraStand& stand) const {
  ScanMemory memory;
  const Reading reading = ReadingOf(depth, camera_, stand, options_.beams, memory);
  const NoiseWindow window(depth, memory.noise);
  const ReturnLimits limits =
      LimitsOf(options_, camera_, reading.transposed, stand.height_m, window);
  ImageReturns& returns =
      FindReturns(*reading.image, memory.lines, limits, std::nullopt, window, memory.returns);
  FindViews(memory.lines, returns.views, memory.views);
  return ScanOf(*reading.image, {options_, limits, stand.height_m}, returns.obstacles, memory);
}

ScanPair DepthToScan::ConvertBoth(const DepthImage& depth, const CameraStand& stand,
                                  const SliceHeights& slice, ScanMemory& memory,
                                  ScanPair scans) const {
  const Reading reading = ReadingOf(depth, camera_, stand, options_.beams, memory);
  const NoiseWindow window(depth, memory.noise);
  const ReturnLimits limits =
      LimitsOf(options_, camera_, reading.transposed, stand.height_m, window);
  const ScanOptions slice_options = SliceOptions(options_, slice);
  const ReturnLimits slice_limits =
      LimitsOf(slice_options, camera_, reading.transposed, -slice.low_m, window);
  ImageReturns& returns = FindReturns(*reading.image, memory.lines, limits,
                                      SliceBand{slice_limits.low_m, slice_limits.high_m,
                                                static_cast<float>(options_.slice_agree_sigmas),
                                                static_cast<float>(options_.slice_lean_sigmas)},
                                      window, memory.returns);
  FindViews(memory.lines, returns.views, memory.views);
  return {ScanOf(*reading.image, {options_, limits, stand.height_m}, returns.obstacles, memory,
                 std::move(scans.obstacles)),
          ScanOf(*reading.image, {slice_options, slice_limits, -slice.low_m}, returns.slice, memory,
                 std::move(scans.slice)),
          window};
}

std::vector<Eigen::Vector2d> DepthToScan::HitPixels(const DepthImage& depth,
                                                    const CameraStand& stand,
                                                    const Scan& scan) const {
  ScanMemory memory;
  const Reading reading =
      ReadingOf(depth, camera_, stand, static_cast<int>(scan.beams.size()), memory);
  const ReturnLimits limits = LimitsOf(options_, camera_, reading.transposed, stand.height_m,
                                       NoiseWindow(depth, memory.noise));
  std::vector<Eigen::Vector2d> pixels(scan.beams.size(), {-1.0, -1.0});
  for (std::size_t k = 0; k < scan.beams.size(); ++k) {
    if (!scan.beams[k].hit) continue;
    const BearingLine line = memory.lines[k];
    const RowRange rows = RowsOf(line, limits);
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int v = rows.first; v <= rows.last; ++v) {
      const double away_m =
          std::abs(SampleAt(*reading.image, line, limits, v) - scan.beams[k].range_m);
      if (away_m >= nearest_m) continue;
      nearest_m = away_m;
      pixels[k] = {line.u0 + line.u1 * static_cast<double>(v), static_cast<double>(v)};
    }
    if (reading.transposed) std::swap(pixels[k].x(), pixels[k].y());
  }
  return pixels;
}

}  // namespace depthgrid
