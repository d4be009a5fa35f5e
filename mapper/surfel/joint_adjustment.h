// Poses and surfels corrected together (docs/math.md, "Joint adjustment").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

// Frames so close together that their relative poses are taken as they are, seen as one.
struct SurfelGroup {
  int first_frame = 0;
  int frames = 0;
  Pose2 map_from_group;         // the pose of its first frame
  Pose2 prior_from_group;       // the same in the prior's frame
  bool linked = true;           // the prior's motion from the group before is meaningful
  std::vector<Surfel> surfels;  // in group axes
};

struct JointOptions {
  double group_m = 0.15;
  double group_deg = 6.0;
  double landmark_m = 0.04;
  int rounds = 8;
  double first_gate_m = 0.5;
  double last_gate_m = 0.1;
  double huber_sigmas = 2.5;
  double max_angle_deg = 40.0;
  double surfel_floor_m = 0.0;
};

// Collects frames into groups.
class GroupBuilder {
 public:
  explicit GroupBuilder(const JointOptions& options) : options_(options) {}
  void Add(const std::vector<ScanSurfel>& pieces, const Pose2& map_from_base,
           const Pose2& prior_from_base, bool linked);
  const std::vector<SurfelGroup>& Groups();
  // Per frame: its group, and its pose in it.
  const std::vector<int>& group_of_frame() const { return group_of_frame_; }
  const std::vector<Pose2>& group_from_frame() const { return group_from_frame_; }

 private:
  void Close();

  JointOptions options_;
  std::vector<SurfelGroup> groups_;
  SurfelStore store_;
  std::vector<int> group_of_frame_;
  std::vector<Pose2> group_from_frame_;
};

struct JointResult {
  std::vector<Pose2> map_from_group;
  Eigen::Vector3d odometry_sigma = Eigen::Vector3d::Zero();  // a frame, learned
  int landmarks = 0;
  int observations = 0;
};

JointResult AdjustJointly(const std::vector<SurfelGroup>& groups, const JointOptions& options);

// Adds a piece of surface to the store: to the surfel it belongs to or as a new one.
int MergeSurfel(SurfelStore& store, const Surfel& piece, double reach_m, double gate_m,
                double min_cosine);

}  // namespace depthgrid
