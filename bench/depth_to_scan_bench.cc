// Depth images to scans: hand-held tilt, Handa's noise. Floor: the image copied, the fastest
// anything can read and write it.
#include "bench/bench_data.h"
#include "bench/bench_table.h"
#include "mapper/core/rng.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid::bench {
namespace {

std::string SizeText(int width_px) {
  return std::to_string(width_px) + "x" + std::to_string(width_px * 3 / 4);
}

std::vector<DepthImage> WithHoles(std::vector<DepthImage> images, double share) {
  RandomStream random(1, RandomStage::kTest);
  for (DepthImage& image : images) {
    for (float& z_m : image.z_m) {
      if (random.Uniform() < share) z_m = kInvalidDepth;
    }
  }
  return images;
}

struct ScanCase {
  std::string name;
  ScanOptions options;
  int width_px = 640;
  double missing_share = 0.0;
  bool clean = false;
  bool slow = false;
};

void AddScanCase(const ScanCase& c) {
  AddCase({"depth to scan", SizeText(c.width_px) + ", " + c.name, AddCopyFloor(c.width_px),
           [=](benchmark::State& state) {
             const DepthWalk& walk = DepthWalkOf(c.width_px, c.width_px * 3 / 4);
             std::vector<DepthImage> images = walk.noisy;
             if (c.clean) {
               for (std::size_t k = 0; k < images.size(); ++k) images[k] = walk.clean[k].depth;
             }
             images = WithHoles(std::move(images), c.missing_share);
             const DepthToScan converter(walk.camera, c.options);
             std::size_t k = 0;
             for (auto _ : state) {
               const std::size_t i = k++ % images.size();
               benchmark::DoNotOptimize(converter.Convert(images[i], walk.poses[i]));
             }
           },
           c.slow});
}

// Obstacle scan and level slice: what a frame costs.
void AddFrameScansCase(int width_px, const std::string& name, const ScanOptions& options) {
  AddCase({"depth to scan", SizeText(width_px) + ", " + name, AddCopyFloor(width_px),
           [=](benchmark::State& state) {
             const DepthWalk& walk = DepthWalkOf(width_px, width_px * 3 / 4);
             std::vector<Frame> frames(walk.noisy.size());
             for (std::size_t k = 0; k < frames.size(); ++k) {
               frames[k].depth = std::make_shared<const DepthImage>(walk.noisy[k]);
               frames[k].slam_from_camera = walk.poses[k];
             }
             FrameScanner scanner(walk.camera, options);
             std::size_t k = 0;
             for (auto _ : state) {
               benchmark::DoNotOptimize(scanner.ScansOf(frames[k++ % frames.size()]));
             }
           }});
}

[[maybe_unused]] const bool added = [] {
  ScanOptions full;
  full.floor = FloorSource::kPose;
  ScanOptions centre_row;
  centre_row.mode = ScanMode::kCentreRow;
  ScanOptions row_band;
  row_band.mode = ScanMode::kRowBand;
  const ScanOptions floor;  // the default
  for (const int width_px : {320, 640, 1280}) AddFrameScansCase(width_px, "both scans", full);
  AddFrameScansCase(640, "both scans, floor followed", floor);
  AddScanCase({"obstacles", full});
  AddScanCase({"obstacles, no noise", full, 640, 0.0, true});
  AddScanCase({"obstacles, 1 % missing", full, 640, 0.01});
  AddScanCase({"obstacles, 33 % missing", full, 640, 0.33});
  for (const int beams : {160, 1280}) {
    ScanOptions options;
    options.beams = beams;
    AddScanCase({"obstacles, " + std::to_string(beams) + " beams", options});
  }
  AddScanCase({"row band", row_band});
  AddScanCase({"centre row", centre_row});
  return true;
}();

}  // namespace
}  // namespace depthgrid::bench
