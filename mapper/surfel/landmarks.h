// Pieces of wall that several groups of frames saw.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/surfel/pose_matrix.h"
#include "mapper/surfel/surfel_groups.h"

namespace depthgrid {

// A group's surfel is a sighting of a landmark.
struct Sighting {
  int landmark = 0;
  int group = 0;
  int company = 1;                 // as CountCompanions
  const Surfel* surfel = nullptr;  // in the group's axes
};

// How sightings err: with so many times the variance that the surfels claim, and companions (see
// CountCompanions) alike to this correlation.
struct SightingErrors {
  double variance_factor = 1.0;
  double correlation = 0.0;
};

// How sightings count: larger residuals than so many sigmas linearly, companions together as much
// as their mean tells, those of each landmark over its factor (FactorsAt; empty: 1).
struct SightingTrust {
  double huber_sigmas = 2.5;
  SightingErrors errors;
  std::vector<double> landmark_factor = {};
};

class Landmarks {
 public:
  // Merges what the groups saw, placed at the given poses. The groups are to outlive it.
  Landmarks(const std::vector<SurfelGroup>& groups, const std::vector<Pose2>& map_from_group,
            const AssociationGate& gate);

  const SurfelStore& store() const { return store_; }
  // Lowers first[group] to the earliest group that shares a landmark with it.
  void ExtendEnvelope(std::vector<int>& first) const;
  // By the offsets of sightings from their landmarks, at these poses.
  SightingErrors ErrorsAt(const std::vector<Pose2>& map_from_group) const;
  // How much worse the sightings of each landmark fit than those of most: their variance over what
  // is trusted and over that of the median landmark, at least 1.
  std::vector<double> FactorsAt(const std::vector<Pose2>& map_from_group,
                                const SightingTrust& trust) const;
  // Adds all sightings to the normal equations of the groups' small motions. Each landmark's own
  // offset along its normal is an unknown too; it is eliminated (Schur complement), which couples
  // all groups that saw the landmark.
  void AddTo(const std::vector<Pose2>& map_from_group, const SightingTrust& trust, PoseMatrix& h,
             Eigen::VectorXd& g) const;

 private:
  struct Row {
    int group = 0;
    double information = 0.0;
    double weight = 0.0;  // the same, of a larger residual less
    double error_m = 0.0;
    Eigen::Vector3d jacobian;
  };
  bool SeenByOneGroup(std::size_t landmark) const {
    return sightings_[begin_[landmark]].group == sightings_[begin_[landmark + 1] - 1].group;
  }
  // Of one landmark's sightings.
  struct Rows {
    std::vector<Row> rows;
    double weights = 0.0;
    double offset_m = 0.0;  // weighted mean of the errors
  };
  Row RowOf(const Sighting& sighting, const Motion2& motion, const SightingTrust& trust) const;
  void FindRows(std::size_t landmark, const std::vector<Motion2>& motions,
                const SightingTrust& trust, Rows& found) const;

  const std::vector<SurfelGroup>& groups_;
  SurfelStore store_;
  std::vector<Sighting> sightings_;  // by landmark, then by group
  std::vector<std::size_t> begin_;   // of each landmark's sightings, and the end of the last
};

}  // namespace depthgrid
