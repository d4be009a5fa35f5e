// The poses of a recording, looked up by the stamps of its images.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/slam_output.h"
#include "mapper/core/trajectory.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

// A trajectory as SLAM output: one epoch, no loops.
SlamOutput SlamOutputOf(const Trajectory& trajectory);

// The pose at this share of the way from a to b: linear in the position, along the shortest turn.
Pose3 Blend(const Pose3& a, const Pose3& b, double share_of_b);

class PoseTrack {
 public:
  // `live`: SLAM's live poses; frames where it was lost have none.
  PoseTrack(const std::vector<SlamPose>& live, const RecordingOptions& options);

  struct Found {
    std::optional<Pose3> slam_from_camera;
    int epoch = 0;
    // The entry used (the nearer one when interpolated); empty when none is near.
    std::optional<std::size_t> entry;
  };
  Found At(double stamp_s) const;

 private:
  Found Interpolated(double stamp_s) const;

  RecordingOptions options_;
  std::vector<SlamPose> live_;
  std::vector<double> stamps_s_;
};

}  // namespace depthgrid
