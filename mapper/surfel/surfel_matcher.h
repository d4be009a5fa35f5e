// A scan's surfels against those of the map: robust point-to-line least squares.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/core/options.h"
#include "mapper/surfel/surfel_pairs.h"

namespace depthgrid {

struct SurfelMatchOptions {
  double gate_m = 0.15;             // farther along the normal nothing is associated (GateOf)
  double along_m = 0.075;           // nor farther along the wall: the map's surfels are 5 cm apart
  double max_angle_deg = 45.0;      // nor with normals farther apart; none such are merged
  double huber_sigmas = 2.5;        // larger residuals count linearly
  bool judge_misfit = true;         // information over the Misfit of the matched surfels
  bool judge_sharing = true;        // and over what neighbours share of their errors
  bool judge_moving = true;         // whether what was just drawn may have moved
  double normal_floor_rad = 0.01;   // no normal is known better
  double normal_floor_share = 0.3;  // nor than this share of the variance that its piece's line has
  double debias = 3.0;              // threshold of Debiased()
  int max_iterations = 10;

  void Visit(OptionsVisitor& v);
};

// Where a match looks for a piece's surfel, but for two sigmas of the piece along the normal. What
// was seen before (SurfelMap::ShareSeenBefore) is judged by it as it is, and the map merges within
// its angle.
AssociationGate GateOf(const SurfelMatchOptions& options);

class SurfelMatcher {
 public:
  explicit SurfelMatcher(const SurfelMatchOptions& options) : options_(options) {}

  // What companions among the pieces share of their errors (shared_errors.h), from now on.
  void ShareErrors(double correlation) { correlation_ = correlation; }
  double shared_errors() const { return correlation_; }
  // Iterates towards the maximum a posteriori, which keeps directions that the scan does not see
  // where the prediction puts them. What is returned is the match alone: the pose at which the
  // debiased equations have their minimum, and their information. `parts`, if given, becomes what
  // the match was made against.
  MatchResult Match(const std::vector<Surfel>& pieces, const SurfelStore& map,
                    const Prediction& prediction, std::vector<MapPart>* parts = nullptr);

 private:
  // What is known without the scan.
  struct Prior {
    Pose2 map_from_base;
    Eigen::Matrix3d information;
  };
  struct Solution {
    Pose2 map_from_base;
    NormalEquations seen;  // debiased, there
    PairEvaluation evaluation;
    int iterations = 0;
    bool found = false;
  };
  PairGates Gates() const;
  PairEvaluation Judged(PairEvaluation evaluation) const;
  // Towards the maximum a posteriori; returns the step.
  Eigen::Vector3d Step(const Prior& prior, Solution& solution) const;
  Solution Solve(const SurfelStore& map, const Prior& prior);
  std::optional<Solution> SolveWithoutYoung(double frame, const Prior& prior,
                                            const Solution& with_all);
  void LeaveOutMoving(double frame, const Prior& prior, Solution& solution);
  PairEvaluation Evaluate(const SurfelStore& map, const Pose2& map_from_base, bool judged);

  SurfelMatchOptions options_;
  SurfelPairs pairs_;  // memory only, from one match to the next
  double correlation_ = 0.0;
};

}  // namespace depthgrid
