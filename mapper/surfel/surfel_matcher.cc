#include "mapper/surfel/surfel_matcher.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mapper/core/symmetric_eigen.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

// Three unknowns need three pieces.
constexpr int kMinPieces = 3;
// Steps smaller than this are negligible: a tenth of the best map's accuracy.
constexpr double kConvergedM = 2e-5;
constexpr double kConvergedRad = 4e-6;
// Steps before the misfit is used (1 is too few, 3 no better: docs/tried.md, "When a match is
// judged"). Before, residuals are large because the prediction is wrong, and the misfit would keep
// the match at it.
constexpr int kStepsBeforeJudging = 2;
// A factor of Misfit that chance gives: sigma by the median of n normal variables has a standard
// deviation of 1.17 / sqrt(n) of itself (Rousseeuw and Croux 1993); three of those for n = 70.
// Well below SurfelMatchOptions::debias, so that what noise feigns is taken off all the same.
constexpr double kChanceFactor = 2.0;
// Surfels whose mean frame is among the last this many (a third of a second) may belong to
// something that moves (5, 7 and 20 are no better: docs/tried.md, "What moves").
constexpr double kYoungFrames = 10.0;
// Not applied to a run's first frames: all surfels are young, SLAM's noise is unknown, and before a
// single wall SLAM alone would decide what moves along it (docs/tried.md, "What moves").
constexpr double kFirstFrames = 60.0;
// Young surfels move if their mean chi-square exceeds this at the pose found without them; single
// ones if that much each is saved by leaving them free.
constexpr double kMovingChi2 = 6.0;
// Fewer misfits may be chance; so may those that most of what is near them contradicts: where
// nobody walks these two are met in 2 frames of 1,000 (docs/tried.md, "What moves").
constexpr int kMinMisfits = 2;
constexpr double kLeastShareOfMisfits = 0.2;
// Nor is anybody most of what is seen. In a run's first frames SLAM may err by more than is assumed
// of it: most of a wall ahead is misfits then (docs/tried.md, "What moves").
constexpr double kMostAreMisfits = 1.0 / 2.0;
constexpr double kMostAreMisfitsAtFirst = 1.0 / 3.0;
// Least share of the information (prediction included) that must remain in every direction without
// young surfels.
constexpr double kLeastShareWithoutYoung = 0.1;
constexpr int kStepsWithoutYoung = 4;
// Only to look for misfits.
constexpr int kStepsByOld = 2;
// By so much a frame SLAM may err although it was perfect so far: else, where it begins to drift,
// walls are misfits, and that it drifts is not learnt (docs/tried.md, "What moves"). m, m, rad.
const Eigen::Vector3d kLeastMotionSigma(0.006, 0.006, 0.006);
// Added to the prediction's variances (0.01 mm, 0.01 mrad) so that the inverse exists.
constexpr double kLeastVariance = 1e-10;
// Limit on the last, linearised step: larger ones only occur in directions that the match hardly
// constrains.
constexpr double kFarthestM = 0.1;
constexpr double kFarthestRad = 0.05;

Eigen::Matrix3d InformationOf(const Eigen::Matrix3d& covariance) {
  return (covariance + kLeastVariance * Eigen::Matrix3d::Identity()).inverse();
}

// h^-1 g over the directions in which h has information.
Eigen::Vector3d SeenStep(const NormalEquations& equations) {
  const Eigen::Vector3d& unit = kMotionUnit;
  const Eigen::Matrix3d h = unit.asDiagonal() * equations.h * unit.asDiagonal();
  const Eigen::Vector3d g = unit.cwiseProduct(equations.g);
  const SymmetricEigen axes = EigenOf(h);
  constexpr double kUnseen = 1e-9;  // of the largest eigenvalue
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = axes.values[i];
    if (value <= kUnseen * axes.values[2]) continue;
    const Eigen::Vector3d direction = axes.vectors.col(i);
    step += std::clamp(direction.dot(g) / value, -kFarthestM, kFarthestM) * direction;
  }
  step = unit.cwiseProduct(step);
  step.z() = std::clamp(step.z(), -kFarthestRad, kFarthestRad);
  return step;
}

}  // namespace

void SurfelMatchOptions::Visit(OptionsVisitor& v) {
  v.Number("gate_m", gate_m, {0.01, 10.0},
           "nothing farther along the normal than this plus 2 sigmas is associated");
  v.Number("along_m", along_m, {0.01, 10.0}, "nothing farther along the wall is associated");
  v.Number("max_angle_deg", max_angle_deg, {1.0, 90.0},
           "angle between associated normals, at most; the map merges none farther apart either");
  v.Number("huber_sigmas", huber_sigmas, {0.1, 100.0}, "residuals of more sigmas count linearly");
  v.Flag("judge_misfit", judge_misfit,
         "whether a match whose surfels fit worse than their noise explains is believed less");
  v.Flag(
      "judge_sharing", judge_sharing,
      "whether a match is believed less where neighbours err alike, as the joint adjustment found");
  v.Flag("judge_moving", judge_moving,
         "whether newly mapped surfels are left out where they move against all others");
  v.Number("normal_floor_rad", normal_floor_rad, {0.0, 1.0},
           "no normal is taken to be known better than this");
  v.Number("normal_floor_share", normal_floor_share, {0.0, 1.0},
           "no normal's variance is taken to be below this share of that of one scan's line");
  v.Number("debias", debias, {0.0, 100.0},
           "a direction with less than this times the information that noisy normals feign counts "
           "as not seen; 0 believes all");
  v.Number("max_iterations", max_iterations, {1, 1000}, "iterations of the least squares, at most");
}

AssociationGate GateOf(const SurfelMatchOptions& options) {
  return {options.along_m, options.gate_m, std::cos(RadFromDeg(options.max_angle_deg))};
}

PairGates SurfelMatcher::Gates() const {
  return {GateOf(options_), options_.huber_sigmas, options_.normal_floor_rad,
          options_.normal_floor_share};
}

PairEvaluation SurfelMatcher::Judged(PairEvaluation evaluation) const {
  if (options_.judge_misfit) {
    const double factor = evaluation.variance_factor;
    evaluation.equations.h /= factor;
    evaluation.equations.g /= factor;
    // The weights fall by the factor. Where beams err alike it is mostly noise's, and the normals'
    // variances rise by it, as points and normals come from the same ranges: not by what may be
    // chance. Elsewhere it is mostly the map's, whose normals hold all the same.
    evaluation.equations.false_h /= beams_err_alike_ ? std::min(factor, kChanceFactor) : factor;
  }
  return evaluation;
}

PairEvaluation SurfelMatcher::Evaluate(const SurfelStore& map, const Pose2& map_from_base,
                                       bool judged) {
  const PairGates gates = Gates();
  pairs_.Associate(map, gates, map_from_base);
  PairEvaluation evaluation = pairs_.Evaluate(gates, map_from_base);
  return judged ? Judged(evaluation) : evaluation;
}

Eigen::Vector3d SurfelMatcher::Step(const Prior& prior, Solution& solution) const {
  solution.seen = Debiased(solution.evaluation.equations, options_.debias);
  const Eigen::Vector3d back = Between(solution.map_from_base, prior.map_from_base).vector();
  const Eigen::Vector3d step = (solution.seen.h + prior.information)
                                   .ldlt()
                                   .solve(solution.seen.g + prior.information * back);
  solution.map_from_base = solution.map_from_base * Pose2::FromVector(step);
  solution.seen.g -= solution.seen.h * step;  // the gradient after the step
  return step;
}

SurfelMatcher::Solution SurfelMatcher::Solve(const SurfelStore& map, const Prior& prior) {
  Solution solution;
  solution.map_from_base = prior.map_from_base;
  const int unjudged =
      options_.judge_misfit ? std::min(kStepsBeforeJudging, options_.max_iterations - 1) : 0;
  while (solution.iterations < options_.max_iterations) {
    const bool judged = solution.iterations >= unjudged;
    solution.evaluation = Evaluate(map, solution.map_from_base, judged);
    ++solution.iterations;
    if (solution.evaluation.used < kMinPieces) return solution;
    const Eigen::Vector3d step = Step(prior, solution);
    const bool converged =
        step.head<2>().norm() < kConvergedM && std::abs(step.z()) < kConvergedRad;
    if (judged && converged) break;
  }
  solution.found = true;
  return solution;
}

void SurfelMatcher::StepPaired(int step, const Prior& prior, Solution& solution) {
  solution.evaluation = pairs_.Evaluate(Gates(), solution.map_from_base);
  if (step >= kStepsBeforeJudging) solution.evaluation = Judged(solution.evaluation);
  Step(prior, solution);
}

SurfelMatcher::Solution SurfelMatcher::SolvePaired(int steps, const Prior& prior, Solution from) {
  from.map_from_base = prior.map_from_base;
  for (int i = 0; i < steps; ++i) StepPaired(i, prior, from);
  return from;
}

// With the current associations. Empty where too little information remains.
std::optional<SurfelMatcher::Solution> SurfelMatcher::SolveWithoutYoung(double frame,
                                                                        const Prior& prior,
                                                                        const Solution& with_all) {
  pairs_.LeaveOutYoung(frame);
  Solution solution = with_all;
  solution.map_from_base = prior.map_from_base;
  for (int i = 0; i < kStepsWithoutYoung; ++i) {
    StepPaired(i, prior, solution);
    if (i > 0) continue;
    const SymmetricEigen share = GeneralizedEigenOf(solution.seen.h + prior.information,
                                                    with_all.seen.h + prior.information);
    if (share.values[0] < kLeastShareWithoutYoung) return std::nullopt;
  }
  return solution;
}

// Somebody who walks is drawn anew in each frame and matched at the previous position. The older
// surfels and the prediction then imply another motion.
void SurfelMatcher::LeaveOutMoving(double frame, const Prior& prior, Solution& solution) {
  const SurfelPairs::YoungPairs young = pairs_.YoungAt(frame, solution.map_from_base);
  if (young.count < kMinPieces || young.others < kMinPieces) return;
  const std::optional<Solution> without = SolveWithoutYoung(frame, prior, solution);
  pairs_.TakeInAll();
  if (!without || pairs_.YoungAt(frame, without->map_from_base).chi2 <= kMovingChi2) return;
  pairs_.LeaveOutYoung(frame);
  solution = *without;
}

// Who walks along with the robot is lost in the mean of the walls that come into view, and young
// pairs are often most of what tells the way. So single young pairs are judged, by SLAM's newest
// motion: does one motion of all that is young explain them?
bool SurfelMatcher::LeaveOutMisfits(double frame, const Prior& recent, const Prior& prior,
                                    Solution& solution) {
  const double most =
      frame + kYoungFrames < kFirstFrames ? kMostAreMisfitsAtFirst : kMostAreMisfits;
  // Spares most frames the rest: the pose by what is old lies between these two.
  if (pairs_.MisfitsAt(frame, recent.map_from_base).empty() &&
      pairs_.MisfitsAt(frame, solution.map_from_base).empty()) {
    return false;
  }
  pairs_.LeaveOutYoung(frame);
  const Pose2 by_old = SolvePaired(kStepsByOld, recent, solution).map_from_base;
  pairs_.TakeInAll();
  const std::vector<std::size_t>& misfits = pairs_.MisfitsAt(frame, by_old);
  const auto count = static_cast<int>(misfits.size());
  if (count < kMinMisfits || count > most * solution.evaluation.used) return false;
  const std::vector<std::size_t>& moving = pairs_.YoungNear(frame);
  if (count < kLeastShareOfMisfits * static_cast<double>(moving.size())) return false;
  const auto least_cost = [&] {
    const Pose2 found = SolvePaired(kStepsWithoutYoung, recent, solution).map_from_base;
    const Eigen::Vector3d back = Between(found, recent.map_from_base).vector();
    return pairs_.Chi2At(found) + back.dot(recent.information * back);
  };
  const double all_move_as_one = least_cost();
  pairs_.LeaveOut(misfits);
  const double misfits_are_free = least_cost();
  if (all_move_as_one - misfits_are_free <= kMovingChi2 * count) {
    pairs_.TakeInAll();
    return false;
  }
  pairs_.LeaveOut(moving);
  solution = SolvePaired(kStepsWithoutYoung, prior, solution);
  return true;
}

MatchResult SurfelMatcher::Match(const std::vector<Surfel>& pieces, const SurfelStore& map,
                                 const Prediction& prediction, std::vector<MapPart>* parts) {
  const Prior prior{prediction.map_from_base, InformationOf(prediction.covariance)};
  pairs_.Assign(pieces, options_.judge_sharing ? correlation_ : 0.0);
  Solution solution = Solve(map, prior);
  MatchResult match;
  match.map_from_base = prediction.map_from_base;
  match.iterations = solution.iterations;
  if (!solution.found) return match;
  const double frame = map.newest_frame() - kYoungFrames;
  if (options_.judge_moving && prediction.motion_covariance) {
    const Prior recent{prediction.map_from_base,
                       InformationOf(*prediction.motion_covariance + Squared(kLeastMotionSigma))};
    match.left_out_misfits = LeaveOutMisfits(frame, recent, prior, solution);
  }
  if (options_.judge_moving && !match.left_out_misfits && map.newest_frame() >= kFirstFrames) {
    LeaveOutMoving(frame, prior, solution);
  }
  if (parts != nullptr) pairs_.PartsOf(Gates(), solution.map_from_base, *parts);
  match.found = true;
  match.map_from_base = solution.map_from_base * Pose2::FromVector(SeenStep(solution.seen));
  match.information = solution.seen.h;
  match.explained = solution.evaluation.explained;
  match.score =
      static_cast<double>(solution.evaluation.explained) / static_cast<double>(pieces.size());
  return match;
}

}  // namespace depthgrid
