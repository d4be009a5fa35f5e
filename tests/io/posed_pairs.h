// Pairs of depth images of a furnished room, and what a file says of their poses.
#pragma once

#include <memory>
#include <vector>

#include "mapper/core/rng.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/pose_fits.h"
#include "mapper/io/pose_misfit.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {

inline constexpr double kPairsFrameS = 0.1;
inline constexpr int kPairsFrames = 120;
inline constexpr int kPairsFramesAround = 50;  // poses without images
inline const PinholeCamera kPairsCamera{80, 60, 60.2, 60.0, 39.5, 29.5, {}};

inline Pose3 TruePoseAt(double time_s) {
  const double yaw_rad = 0.4 * time_s + 0.5 * std::sin(1.1 * time_s);
  return TiltedCamera({0.8 * std::cos(0.5 * time_s), 0.6 * std::sin(0.7 * time_s), yaw_rad}, 1.2,
                      0.3 + 0.1 * std::sin(0.9 * time_s), 0.1 * std::cos(1.3 * time_s));
}

using PoseAt = Pose3 (*)(double time_s);

// Half a second apart, `noise` of the depth.
inline std::vector<ImagePair> PosedPairs(double noise, PoseAt pose_at = TruePoseAt) {
  AnalyticRoom room;
  room.boxes = {{{1.2, -1.0, 0.0}, {2.4, 0.6, 0.75}}, {{-2.6, 0.8, 0.0}, {-1.4, 2.2, 1.1}}};
  RandomStream random(4, RandomStage::kTest);
  const auto image_at = [&](double time_s) {
    auto image = std::make_shared<DepthImage>(room.Render(kPairsCamera, pose_at(time_s)));
    for (float& z_m : image->z_m) z_m *= static_cast<float>(1.0 + noise * random.Normal());
    return image;
  };
  std::vector<ImagePair> pairs;
  for (int i = 20; i < 100; i += 5) {
    const double first_s = i * kPairsFrameS, second_s = first_s + 0.5;
    pairs.push_back({first_s, second_s, image_at(first_s), image_at(second_s)});
  }
  return pairs;
}

// What a file says whose poses are `written` and whose clock is ahead by `ahead_s`.
inline std::vector<SlamPose> GivenPoses(const PoseChange& written, double ahead_s = 0.0,
                                        PoseAt pose_at = TruePoseAt) {
  std::vector<SlamPose> live;
  for (int i = -kPairsFramesAround; i < kPairsFrames + kPairsFramesAround; ++i) {
    live.push_back({i * kPairsFrameS, written(pose_at(i * kPairsFrameS - ahead_s)), 0});
  }
  return live;
}

inline Pose3 AsItIs(const Pose3& pose) { return pose; }

}  // namespace depthgrid
