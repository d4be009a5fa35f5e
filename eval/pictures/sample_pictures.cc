#include "eval/pictures/sample_pictures.h"

#include <fmt/format.h>

#include <filesystem>

#include "eval/pictures/depth_picture.h"
#include "mapper/io/png.h"
#include "sim/colour/colour_camera.h"

namespace depthgrid {
namespace {

const MappedFrame* MappedOf(const MappingRun& run, int frame) {
  for (const MappedFrame& mapped : run.result.mapped) {
    if (mapped.frame == frame) return &mapped;
  }
  return nullptr;
}

const FrameReport* ReportOf(const MappingRun& run, int frame) {
  for (const FrameReport& report : run.reports) {
    if (report.index == frame) return &report;
  }
  return nullptr;
}

RgbImage PictureOf(const SampleFrame& sample, const MappingRun& run, const ScanOptions& options) {
  const MappedFrame* mapped = MappedOf(run, sample.frame);
  const FrameReport* report = ReportOf(run, sample.frame);
  if (mapped == nullptr || report == nullptr || !report->stand || !run.camera) {
    return DepthPicture(*sample.depth, options.max_range_m);
  }
  return DepthPictureWithBeams(*sample.depth, *run.camera, *report->stand, *mapped->obstacles,
                               options);
}

std::string StemOf(const std::string& folder, const SampleFrame& sample) {
  return fmt::format("{}/frames/{:06}", folder, sample.frame);
}

}  // namespace

void WriteDepthPictures(const std::string& folder, const MappingRun& run,
                        const ScanOptions& options) {
  if (run.samples.empty()) return;
  std::filesystem::create_directory(folder + "/frames");
  for (const SampleFrame& sample : run.samples) {
    WriteRgbPng(StemOf(folder, sample) + "_depth.png", PictureOf(sample, run, options));
  }
}

void WriteColourPictures(const std::string& folder, const MappingRun& run, const World& world) {
  if (run.samples.empty() || !run.camera) return;
  ColourCamera camera(world.scene, *run.camera);
  for (const SampleFrame& sample : run.samples) {
    const auto frame = static_cast<std::size_t>(sample.frame);
    const Pose3& pose = world.trajectory[frame].world_from_camera;
    const auto movers = world.movers.At(world.trajectory, frame);
    WriteRgbPng(StemOf(folder, sample) + "_colour.png", camera.Render(pose, movers).rgb);
  }
}

}  // namespace depthgrid
