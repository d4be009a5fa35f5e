// Poses and surfels corrected together (docs/math.md, "Joint adjustment").
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
  // They go on to so many while the prior turns out better with each.
  int most_rounds = 6;
  // Rounds and first gate of adjustments during the run without new loops, or with loops that bend
  // no pose, and nothing 3 m away from it, by more than `little_m`.
  int refine_rounds = 3;
  double refine_gate_m = 0.2;
  double little_m = 0.1;
  // Of more groups than these two neighbours are adjusted as one during the run: half the time and
  // no less accurate (docs/tried.md, "Loops that hold up a frame"). Of a prior map, so many more.
  int refine_groups = 150;
  // What groups see is one landmark when it lies this near: in the first round, in the last.
  double first_gate_m = 0.5;
  double last_gate_m = 0.1;
  double landmark_m = 0.05;  // length of a landmark along its wall
  double max_angle_deg = 40.0;
  // Little more than the 95 % efficiency of 1.345: sightings have many wrong associations (measured
  // in docs/tried.md).
  double huber_sigmas = 1.25;
  // Landmarks count over their Misfit between the groups that saw them.
  bool judge_misfit = true;
  // And over what neighbours share of their SightingErrors.
  bool judge_sharing = true;
  // And each one over how much worse its sightings fit than most landmarks' do: what has no surface
  // of its own, such as a plant, looks different from everywhere.
  bool judge_landmarks = true;
  // What SLAM's motions err by is told by each as far as it was seen (MotionSigma); else by all
  // alike.
  bool judge_motions = true;
  // Where SLAM errs by far more than elsewhere it is believed less (MotionGrowth).
  bool judge_stretches = true;
  // SLAM's errors go on from group to group as much as they are seen to (MotionPersistence).
  bool learn_persistence = true;
  double loop_huber_sigmas = 2.0;
  // A loop farther than this from the adjusted poses is taken out, and all adjusted again.
  double max_loop_sigmas = 5.0;

  void Visit(OptionsVisitor& v);
};

// How well a prior map's adjustment joined its neighbouring groups: it had all that was seen, and
// loops. m, m, rad.
inline const Eigen::Vector3d kPriorMapSigma(0.0005, 0.0005, 0.0003);

// The prior's motion from the group before, over so many frames; nothing is known when `known` is
// false (SLAM jumped).
struct GroupMotion {
  bool known = false;
  Pose2 before_from_group;
  int frames = 0;
  // Between groups of a prior map: as it came out there, not as SLAM had it.
  bool of_prior_map = false;
  // The frame before the group's first moves with an earlier group: where it is there, and the
  // motion from it.
  std::optional<GroupLink> tie = {};
};

struct JointResult {
  std::vector<Pose2> map_from_group;  // the first is unchanged
  std::vector<bool> loop_accepted;
  Eigen::Vector3d motion_sigma = Eigen::Vector3d::Zero();        // of the prior, a frame, as learnt
  std::vector<Eigen::Vector3d> motion_growth;                    // MotionGrowth(); empty: none
  Eigen::Vector3d motion_seen = Eigen::Vector3d::Zero();         // SeenSigma() of it
  Eigen::Vector3d motion_persistence = Eigen::Vector3d::Zero();  // of its errors, as learnt
  double correlation = 0.0;                                      // of SightingErrors, as learnt
  // The equations of the last round; null when nothing was solved.
  std::unique_ptr<PoseMatrix> factored;
};

// `motions` has one entry a group; the first is not used. `loops` are links without an order of
// time.
JointResult AdjustJointly(const std::vector<SurfelGroup>& groups,
                          const std::vector<GroupMotion>& motions,
                          const std::vector<GroupLink>& loops, const JointOptions& options);

}  // namespace depthgrid
