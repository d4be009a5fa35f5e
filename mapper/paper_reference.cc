#include "mapper/paper_reference.h"

#include <algorithm>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Share of a match's variance that is the submap's own noise; measured (docs/tried.md, "Laser
// logs").
constexpr double kNoiseShare = 0.3;

}  // namespace

PaperReference::PaperReference(const GridOptions& grid, const SubmapOptions& submap,
                               const ScanMatcherOptions& match, const GraphOptions& graph)
    : resolution_m_(grid.resolution_m),
      scans_per_submap_(submap.scans),
      graph_options_(graph),
      matcher_(match),
      submaps_(submap, grid) {}

MatchResult PaperReference::Match(const std::shared_ptr<const Scan>& scan,
                                  const Prediction& prediction) {
  Submap* submap = submaps_.matching();
  if (submap == nullptr) return {};
  // All scans of the submap count alike.
  const int count = static_cast<int>(map_from_base_.size());
  const int first = std::max((count - 1) / scans_per_submap_ - 1, 0) * scans_per_submap_;
  if (first < part_begin_) return {};
  part_ = {0.5 * (first + count - 1), Eigen::Matrix3d::Identity(), kNoiseShare};
  return matcher_.Match(*scan, ViewOf(submap->map()), prediction.map_from_base);
}

void PaperReference::Insert(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                            const Eigen::Matrix3d&) {
  map_from_base_.push_back(map_from_base);
  measurements_.push_back(MeasurementOf(map_from_base_, static_cast<int>(map_from_base_.size()) - 1,
                                        scans_per_submap_));
  Draw(*scan, map_from_base);
}

void PaperReference::Draw(const Scan& scan, const Pose2& map_from_base) {
  submaps_.Insert(rasterizer_.Rasterize(scan, map_from_base, resolution_m_), scan, map_from_base);
}

Adjustment PaperReference::Adjust(const std::vector<MappedFrame>& frames,
                                  const std::vector<PlanarLoop>& loops, AdjustEffort,
                                  std::span<const int>) {
  std::vector<ScanMeasurement> measurements = measurements_;
  const std::vector<Pose2> poses = PosesOf(frames);
  // A provisional last frame was not inserted; its measurement follows from its pose.
  while (measurements.size() < frames.size()) {
    measurements.push_back(
        MeasurementOf(poses, static_cast<int>(measurements.size()), scans_per_submap_));
  }
  return AdjustScansAndSubmaps(frames, measurements, loops, scans_per_submap_, graph_options_);
}

void PaperReference::Rebuild(const std::vector<MappedFrame>& frames) {
  Require(frames.size() == map_from_base_.size(), "the map is drawn again from what was inserted");
  const int count = static_cast<int>(frames.size());
  for (int i = 0; i < count; ++i) {
    map_from_base_[static_cast<std::size_t>(i)] = frames[static_cast<std::size_t>(i)].map_from_base;
  }
  // Only the two active submaps are read again.
  const int last_submap = std::max(count - 1, 0) / scans_per_submap_;
  const int first_frame = std::max(last_submap - 1, 0) * scans_per_submap_;
  submaps_.RestartAt(first_frame);
  for (int i = first_frame; i < count; ++i) {
    const MappedFrame& frame = frames[static_cast<std::size_t>(i)];
    Draw(*frame.scan, frame.map_from_base);
  }
}

// Measurements between earlier and moved frames were made at the old guess and are replaced.
void PaperReference::RebuildMoved(const std::vector<MappedFrame>& frames, int first_moved) {
  Rebuild(frames);
  part_begin_ = 0;
  for (auto i = static_cast<std::size_t>(first_moved); i < frames.size(); ++i) {
    measurements_[i] = MeasurementOf(map_from_base_, static_cast<int>(i), scans_per_submap_);
  }
}

}  // namespace depthgrid
