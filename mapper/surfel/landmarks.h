// Landmarks: pieces of wall seen by several groups of frames.
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
  int company = 1;                 // number of companions (CountCompanions)
  const Surfel* surfel = nullptr;  // in the group's axes
};

// Errors of sightings: variance as a multiple of what the surfels claim, and correlation between
// companions (CountCompanions).
struct SightingErrors {
  double variance_factor = 1.0;
  double correlation = 0.0;
};

// Weighting of sightings: Huber's limit, their errors, and a divisor for each landmark (FactorsAt;
// empty: 1).
struct SightingTrust {
  double huber_sigmas = 2.5;
  SightingErrors errors;
  std::vector<double> landmark_factor = {};
};

class Landmarks {
 public:
  // Merges the groups' surfels at the given poses. The groups must outlive this object.
  Landmarks(const std::vector<SurfelGroup>& groups, const std::vector<Pose2>& map_from_group,
            const AssociationGate& gate);

  const SurfelStore& store() const { return store_; }
  // Lowers first[group] to the earliest group that shares a landmark with it.
  void ExtendEnvelope(std::vector<int>& first) const;
  // Estimates the errors from the sightings' offsets from their landmarks at these poses.
  SightingErrors ErrorsAt(const std::vector<Pose2>& map_from_group) const;
  // Divisor for each landmark: the reduced chi-square of its sightings over that of the median
  // landmark, at least 1.
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
    double weight = 0.0;  // information times the robust weight
    double error_m = 0.0;
    Eigen::Vector3d jacobian;
  };
  bool SeenByOneGroup(std::size_t landmark) const {
    return sightings_[begin_[landmark]].group == sightings_[begin_[landmark + 1] - 1].group;
  }
  // The rows of one landmark's sightings.
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
  std::vector<std::size_t> begin_;   // start of each landmark's sightings, and end of the last
};

}  // namespace depthgrid
