// How well the depth images of a recording fit its poses when both are read in one way or another.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/pose_misfit.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

using PoseChange = std::function<Pose3(const Pose3&)>;

// An interpretation of poses and camera.
struct PoseAttempt {
  PoseChange change;
  PinholeCamera camera;
  double shift_s = 0.0;  // of the poses' stamps
  DepthMeaning meaning = DepthMeaning::kZ;
};

class PoseFits {
 public:
  static constexpr std::size_t kLeastPairs = 6;
  // Cap, so that one pair across a correction of SLAM does not dominate.
  static constexpr double kMostMisfit = 0.3;

  // Keeps a reference to `pairs`.
  PoseFits(const std::vector<ImagePair>& pairs, const std::vector<SlamPose>& live,
           const RecordingOptions& options);

  // Mean misfit. Nothing when fewer than `least` pairs have poses, or as soon as it must exceed
  // `most`: most readings are so wrong that the first pairs show it.
  std::optional<double> Mean(const PoseAttempt& attempt, std::size_t least,
                             double most = kMostMisfit) const;
  // The same over only the pairs that overlap according to the poses, as in fast turns others do
  // not overlap, which is no fault. 0 if these pairs are fewer than kLeastPairs.
  double WhereShared(const PoseAttempt& attempt, PairPoints which) const;
  // Of these pairs, the share with a misfit above `misfit`.
  double ShareAbove(double misfit, const PoseAttempt& attempt, PairPoints which) const;
  // The misfit of each pair; nothing for those without poses.
  std::vector<std::optional<double>> OfEach(const PoseAttempt& attempt) const;
  std::size_t PairsWithPoses() const;

 private:
  std::vector<double> SharedMisfits(const PoseAttempt& attempt, PairPoints which) const;
  // Nothing if a pose is missing or SLAM corrected itself in between.
  std::optional<Pose3> RelativeIn(const ImagePair& pair, const PoseAttempt& attempt) const;

  const std::vector<ImagePair>& pairs_;
  PoseTrack track_;
};

}  // namespace depthgrid
