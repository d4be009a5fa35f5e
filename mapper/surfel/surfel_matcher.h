// Matches a scan's surfels against the map's by robust point-to-line least squares.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/core/options.h"
#include "mapper/surfel/surfel_pairs.h"

namespace depthgrid {

struct SurfelMatchOptions {
  double gate_m = 0.15;             // association gate along the normal (GateOf)
  double along_m = 0.075;           // and along the wall; the map's surfels are 5 cm apart
  double max_angle_deg = 45.0;      // and between normals; also for merging
  double huber_sigmas = 2.5;        // larger residuals count linearly
  bool judge_misfit = true;         // divide information by the matched surfels' Misfit
  bool judge_sharing = true;        // and by the correlation of neighbours' errors
  bool judge_moving = true;         // leave out recently drawn surfels that seem to move
  double normal_floor_rad = 0.01;   // least sigma of a normal
  double normal_floor_share = 0.3;  // least variance, as share of the piece's line's
  double debias = 3.0;              // threshold of Debiased()
  int max_iterations = 10;

  void Visit(OptionsVisitor& v);
};

// The association gate; a match adds two sigmas of the piece along the normal.
// SurfelMap::ShareSeenBefore() uses it as it is, and merging uses its angle.
AssociationGate GateOf(const SurfelMatchOptions& options);

class SurfelMatcher {
 public:
  explicit SurfelMatcher(const SurfelMatchOptions& options) : options_(options) {}

  // Sets the correlation of companions' errors (shared_errors.h) for later matches.
  void ShareErrors(double correlation) { correlation_ = correlation; }
  double shared_errors() const { return correlation_; }
  // Sets whether neighbouring beams share their errors (RangeNoise::stride() above 1). A misfit
  // then tells that normals err by as much more as points do.
  void SetBeamsErrAlike(bool alike) { beams_err_alike_ = alike; }

  // Iterates to the maximum a posteriori, in which the prediction fixes directions that the scan
  // does not constrain. Returns the match alone: the minimum of the debiased equations and their
  // information. `parts`, if given, receives the map parts matched against.
  MatchResult Match(const std::vector<Surfel>& pieces, const SurfelStore& map,
                    const Prediction& prediction, std::vector<MapPart>* parts = nullptr);

 private:
  // The prediction and its information.
  struct Prior {
    Pose2 map_from_base;
    Eigen::Matrix3d information;
  };
  struct Solution {
    Pose2 map_from_base;
    NormalEquations seen;  // debiased, at map_from_base
    PairEvaluation evaluation;
    int iterations = 0;
    bool found = false;
  };
  PairGates Gates() const;
  PairEvaluation Judged(PairEvaluation evaluation) const;
  // One step towards the maximum a posteriori, which it returns.
  Eigen::Vector3d Step(const Prior& prior, Solution& solution) const;
  Solution Solve(const SurfelStore& map, const Prior& prior);
  // The same for a number of steps with the current associations.
  Solution SolvePaired(int steps, const Prior& prior, Solution from);
  void StepPaired(int step, const Prior& prior, Solution& solution);
  bool LeaveOutMisfits(double frame, const Prior& recent, const Prior& prior, Solution& solution);
  std::optional<Solution> SolveWithoutYoung(double frame, const Prior& prior,
                                            const Solution& with_all);
  void LeaveOutMoving(double frame, const Prior& prior, Solution& solution);
  PairEvaluation Evaluate(const SurfelStore& map, const Pose2& map_from_base, bool judged);

  SurfelMatchOptions options_;
  SurfelPairs pairs_;  // a member only to reuse its memory
  double correlation_ = 0.0;
  bool beams_err_alike_ = false;
};

}  // namespace depthgrid
