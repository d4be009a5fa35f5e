// A furnished room's finished map, and another round through it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {

constexpr int kPriorRound = 298;  // so that it does not end where a group of frames does
constexpr PlanarLaser kPriorLaser{
    .beams = 160, .field_of_view_rad = RadFromDeg(90), .sigma_of_range = 0.01};
// SLAM's motions are off by this, a frame: over a round by 0.3 m.
inline const Pose2 kPriorDrift{1.6e-3, 1e-3, 1.2e-3};
// The new frames' place when they begin, off by so much.
inline const Pose2 kPriorStartOff{0.03, -0.02, 0.01};

// Once round a furnished room.
inline Pose2 PriorTruthAt(int i) {
  const double turn_rad = 2.0 * kPi * i / kPriorRound;
  return {3.0 + 0.8 * std::cos(turn_rad), 1.5 + 0.8 * std::sin(turn_rad),
          WrapAngle(turn_rad + 0.5 * kPi)};
}

inline Scan PriorScanAt(int i, std::uint64_t seed) {
  return ScanOf(FurnishedRoom(), PriorTruthAt(i), kPriorLaser, seed, static_cast<std::uint32_t>(i));
}

// A round's map, as good as it can be.
inline PriorMap FinishedRound() {
  ScanArchive archive;
  PriorMap prior;
  for (int i = 0; i < kPriorRound; ++i) {
    MappedFrame frame;
    frame.frame = i - kPriorRound;
    frame.stamp_s = i / 30.0;
    frame.scan = frame.obstacles = archive.Keep(PriorScanAt(i, 1));
    frame.map_from_base = PriorTruthAt(i);
    prior.frames.push_back(frame);
  }
  prior.map_from_slam = kPriorStartOff;
  return prior;
}

inline double PriorErrorM(const Pose2& pose, const Pose2& truth) {
  return Between(truth, pose).translation().norm();
}

// SLAM's pose of each frame of another round.
inline std::vector<Pose2> DriftedRound() {
  std::vector<Pose2> slam_from_base = {PriorTruthAt(0)};
  for (int i = 1; i < kPriorRound; ++i) {
    slam_from_base.push_back(slam_from_base.back() * Between(PriorTruthAt(i - 1), PriorTruthAt(i)) *
                             kPriorDrift);
  }
  return slam_from_base;
}

inline Frame PriorFrameAt(int i, const Pose2& slam_from_base) {
  Frame frame;
  frame.index = i;
  frame.stamp_s = i / 30.0;
  frame.slam_from_camera = CameraOf(slam_from_base, 0.0);
  frame.scan = std::make_shared<Scan>(PriorScanAt(i, 2));
  return frame;
}

}  // namespace depthgrid
