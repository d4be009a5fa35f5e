// Joint adjustment of poses and surfels (docs/math.md, "Joint adjustment").
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/pose_matrix.h"
#include "mapper/surfel/surfel_groups.h"

namespace depthgrid {

struct JointOptions {
  SurfelGroupOptions groups;
  int rounds = 6;
  // Rounds continue up to this number while the estimate of SLAM's motion sigma keeps falling.
  int most_rounds = 6;
  // Rounds and first gate of adjustments during the run without new loops, or with loops that bend
  // no pose, and nothing 3 m away from it, by more than `little_m`.
  int refine_rounds = 3;
  double refine_gate_m = 0.2;
  double little_m = 0.1;
  // With more groups than this, neighbours are joined in pairs during the run: half the time, equal
  // accuracy (docs/tried.md, "Loops that hold up a frame"). As many again for a prior map.
  int refine_groups = 150;
  // Gate along the normal within which surfels of groups are one landmark: in the first and the
  // last round.
  double first_gate_m = 0.5;
  double last_gate_m = 0.1;
  double landmark_m = 0.05;  // length of a landmark along its wall
  double max_angle_deg = 40.0;
  // Slightly below 1.345, of 95 % efficiency, because many sightings are wrongly associated
  // (measured in docs/tried.md).
  double huber_sigmas = 1.25;
  // Divide the information of landmarks by the Misfit between groups.
  bool judge_misfit = true;
  // Divide it as well for the correlation of neighbours (SightingErrors).
  bool judge_sharing = true;
  // Divide that of each landmark by how much worse its sightings fit than most landmarks' do: what
  // has no definite surface, such as a plant, looks different from each viewpoint.
  bool judge_landmarks = true;
  // Weight each motion by the share observed when estimating SLAM's sigma (MotionSigma); else all
  // alike.
  bool judge_motions = true;
  // Raise SLAM's sigma where its errors are far larger than elsewhere (MotionGrowth).
  bool judge_stretches = true;
  // Model SLAM's errors as correlated from group to group, as estimated (MotionPersistence).
  bool learn_persistence = true;
  double loop_huber_sigmas = 2.0;
  // A loop farther than this from the adjusted poses is rejected, and all is adjusted again.
  double max_loop_sigmas = 5.0;

  void Visit(OptionsVisitor& v);
};

// Accuracy of the relative poses of neighbouring groups in a prior map, which was adjusted with all
// surfels and loops. m, m, rad.
inline const Eigen::Vector3d kPriorMapSigma(0.0005, 0.0005, 0.0003);

// SLAM's motion from the previous group, over `frames` frames; unknown when `known` is false (SLAM
// jumped).
struct GroupMotion {
  bool known = false;
  Pose2 before_from_group;
  int frames = 0;
  // Between groups of a prior map: the relative pose in that map, not SLAM's motion.
  bool of_prior_map = false;
  // Where not `known`: how well the online estimate knows the motion, as a multiple of kEpochSigma.
  // Long gaps have more than 1.
  double gap_share = 1.0;
  // Set when the frame before the group's first belongs to an earlier group: the link from that
  // group.
  std::optional<GroupLink> tie = {};
};

struct JointResult {
  std::vector<Pose2> map_from_group;  // the first is unchanged
  std::vector<bool> loop_accepted;
  Eigen::Vector3d motion_sigma = Eigen::Vector3d::Zero();        // of SLAM per frame, as estimated
  std::vector<Eigen::Vector3d> motion_growth;                    // MotionGrowth(); empty: none
  Eigen::Vector3d motion_seen = Eigen::Vector3d::Zero();         // SeenSigma()
  Eigen::Vector3d motion_persistence = Eigen::Vector3d::Zero();  // of SLAM's errors, estimated
  double correlation = 0.0;                                      // of SightingErrors, estimated
  // The factored normal equations of the last round; null when nothing was solved.
  std::unique_ptr<PoseMatrix> factored;
};

// `motions` has one entry per group; the first is not used. `loops` may link groups in any order.
JointResult AdjustJointly(const std::vector<SurfelGroup>& groups,
                          const std::vector<GroupMotion>& motions,
                          const std::vector<GroupLink>& loops, const JointOptions& options);

}  // namespace depthgrid
