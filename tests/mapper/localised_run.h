// A tour of a furnished room, its finished map, and runs that are localised in it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/place_watch.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {

inline constexpr int kTourFrames = 240;
inline constexpr PlanarLaser kTourLaser{.beams = 320, .sigma_of_range = 0.01};

// Once round a furnished room.
inline Pose2 TourAt(int i) {
  const double turn_rad = 2.0 * kPi * i / kTourFrames;
  return {3.0 + 0.7 * std::cos(turn_rad), 1.7 + 0.7 * std::sin(turn_rad),
          WrapAngle(turn_rad + 0.5 * kPi)};
}

// Of the first `frames` of the tour.
inline PriorMap TourMap(int frames = kTourFrames) {
  PriorMap prior;
  for (int i = 0; i < frames; ++i) {
    MappedFrame frame = MappedFrameAt(FurnishedRoom(), kTourLaser, TourAt(i), TourAt(i), i);
    frame.frame -= kTourFrames;
    prior.frames.push_back(frame);
  }
  prior.map_from_slam = Pose2{};
  prior.fixed = true;
  return prior;
}

// A localised run, frame by frame.
struct LocalisedRun {
  IncrementalMapper mapper{MapperOptions(), std::nullopt};
  PlaceWatch watch;
  std::vector<FrameReport> reports;
  std::vector<Pose2> truths;

  // `map_from_slam`: where the run is told to begin.
  explicit LocalisedRun(const Pose2& map_from_slam = {}, int frames_of_map = kTourFrames) {
    PriorMap prior = TourMap(frames_of_map);
    prior.map_from_slam = map_from_slam;
    mapper.StartFrom(std::move(prior));
  }

  // `count` frames at the true poses from `first` on, in SLAM's world moved by `off`.
  void Drive(int first, int count, const Pose2& off, int epoch, const PlanarWorld& world) {
    for (int i = 0; i < count; ++i) {
      truths.push_back(TourAt(first + i));
      Add(CameraOf(off * truths.back(), 1.0), epoch,
          std::make_shared<const Scan>(ScanOf(world, truths.back(), kTourLaser, 4,
                                              static_cast<std::uint32_t>(reports.size()))));
    }
  }
  void Lose(int count) {
    for (int i = 0; i < count; ++i) {
      truths.push_back({});
      Add({}, 0, {});
    }
  }
  void Add(const std::optional<Pose3>& pose, int epoch, std::shared_ptr<const Scan> scan) {
    Frame frame;
    frame.index = static_cast<int>(reports.size());
    frame.stamp_s = frame.index / 30.0;
    frame.slam_epoch = epoch;
    frame.slam_from_camera = pose;
    frame.scan = std::move(scan);
    reports.push_back(mapper.AddFrame(frame));
    watch.Add(reports.back());
  }
  // The largest error of the result from this frame on.
  double WorstErrorM(const MapperResult& result, std::size_t first) const {
    double worst_m = 0.0;
    for (std::size_t i = first; i < truths.size(); ++i) {
      const Pose2 pose = BaseOf(*result.map_from_camera[i]);
      worst_m = std::max(worst_m, (pose.translation() - truths[i].translation()).norm());
    }
    return worst_m;
  }
  int Relocations() const {
    int count = 0;
    for (const FrameReport& report : reports) count += report.relocated ? 1 : 0;
    return count;
  }
};

}  // namespace depthgrid
