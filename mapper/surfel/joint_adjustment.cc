#include "mapper/surfel/joint_adjustment.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "mapper/core/reference_map.h"
#include "mapper/surfel/landmarks.h"
#include "mapper/surfel/loop_jury.h"
#include "mapper/surfel/motion_persistence.h"
#include "mapper/surfel/motion_sigma.h"
#include "mapper/surfel/skyline_matrix.h"
#include "mapper/surfel/sparse_pose_matrix.h"

namespace depthgrid {
namespace {

// Accuracy of neighbouring groups' relative poses in the online estimate. Holds the chain together
// in CloseLoops(), which only has to bring revisits within the gate.
const Eigen::Vector3d kOnlineSigma(0.005, 0.005, 0.003);
// Across a gap in SLAM's motion, groups are held to their relative pose in the online estimate (as
// bent by loops), in case the two sides have no landmark in common; at most as loosely as by
// kEpochSigma.
constexpr double kGapHuberSigmas = 2.0;
// In CloseLoops() a gap yields to loops entirely, the longest first. With Huber's weight, a loop
// that turns all beyond the gap would lose (docs/math.md, "Epochs").
constexpr double kGapCauchySigmas = 2.0;
// Measured: 2 steps where nothing has to move, 8 for a gap of 24 m, 12 to 20 and more for a gap off
// by a few sigmas only, where Cauchy's weight falls slowly.
constexpr int kLoopIterations = 20;
constexpr double kLoopsClosed = 1e-4;  // m and rad of the last step
// Rounds continue while sigma falls below this share of the last one. With nearly perfect SLAM each
// round trusts it more; stopped early, poses stay at their worse online estimates.
constexpr double kSettledShare = 0.7;
// Information that holds the first group in place.
constexpr double kAnchor = 1e12;
// Relative increase of the diagonal, so that rounding in weakly determined directions does not make
// the matrix indefinite; far below any real information.
constexpr double kRidge = 1e-9;

struct Problem {
  const std::vector<SurfelGroup>& groups;
  const std::vector<GroupMotion>& motions;
  const JointOptions& options;
};

// Envelope (first non-zero column of each row) of a chain of groups, each linked to its
// `predecessors` predecessors and by `links`.
std::vector<int> ChainEnvelope(std::size_t groups, int predecessors,
                               const std::vector<GroupLink>& links) {
  std::vector<int> first(groups);
  for (std::size_t g = 0; g < groups; ++g) {
    first[g] = std::max(static_cast<int>(g) - predecessors, 0);
  }
  for (const GroupLink& link : links) {
    const auto [earlier, later] = std::minmax(link.first, link.second);
    int& place = first[static_cast<std::size_t>(later)];
    place = std::min(place, earlier);
  }
  return first;
}

// Multiplications (a tenth of a second) above which the sparse matrix is used. Below, the skyline
// in order of time is faster.
constexpr double kCostOfSparse = 3e8;

std::unique_ptr<PoseMatrix> MatrixOf(const std::vector<int>& first_group) {
  double cost = 0.0;
  for (std::size_t g = 0; g < first_group.size(); ++g) {
    const double row = 3.0 * (static_cast<double>(g) + 1.0 - first_group[g]);
    cost += 1.5 * row * row;
  }
  if (cost > kCostOfSparse) {
    return std::make_unique<SparsePoseMatrix>(static_cast<int>(first_group.size()));
  }
  std::vector<int> first;
  for (const int group : first_group) first.insert(first.end(), 3, 3 * group);
  return std::make_unique<SkylineMatrix>(first);
}

// False when the matrix is not positive definite.
bool Factor(PoseMatrix& h) {
  for (int i = 0; i < h.size(); ++i) h.Diagonal(i) *= 1.0 + kRidge;
  for (int i = 0; i < 3; ++i) h.Diagonal(i) += kAnchor;
  return h.Factor();
}

// Solves for small motions of all groups and applies them. Returns the largest component, m or rad.
double Step(const PoseMatrix& factored, const Eigen::VectorXd& g,
            std::vector<Pose2>& map_from_group) {
  const Eigen::VectorXd step = factored.Solve(g);
  for (std::size_t i = 0; i < map_from_group.size(); ++i) {
    const Eigen::Vector3d motion = step.segment<3>(3 * static_cast<Eigen::Index>(i));
    map_from_group[i] = map_from_group[i] * Pose2::FromVector(motion);
  }
  return step.lpNorm<Eigen::Infinity>();
}

// Link from the previous group across a gap, with the relative pose of `map_from_group`.
GroupLink GapLink(std::size_t group, double gap_share, const std::vector<Pose2>& map_from_group) {
  const int second = static_cast<int>(group);
  const Eigen::Vector3d gap_sigma = gap_share * kEpochSigma;
  return {second - 1, second, Between(map_from_group[group - 1], map_from_group[group]),
          (gap_sigma.cwiseAbs2() + kOnlineSigma.cwiseAbs2()).cwiseSqrt()};
}

// Constraints other than SLAM's motion: ties, gaps, and the relative poses within a prior map.
// `before`: poses before the first round.
std::vector<GroupLink> SettledLinks(const Problem& problem, const std::vector<Pose2>& before) {
  std::vector<GroupLink> links;
  for (std::size_t g = 1; g < problem.groups.size(); ++g) {
    const GroupMotion& motion = problem.motions[g];
    const int second = static_cast<int>(g);
    if (motion.tie) links.push_back(*motion.tie);
    if (!motion.known) {
      links.push_back(GapLink(g, std::min(motion.gap_share, 1.0), before));
      links.back().huber_sigmas = kGapHuberSigmas;
      continue;
    }
    if (!motion.of_prior_map) continue;
    links.push_back({second - 1, second, motion.before_from_group, kPriorMapSigma, 0.0});
  }
  return links;
}

// Bends the chain of groups to the loops, without surfels.
void CloseLoops(const Problem& problem, const std::vector<GroupLink>& loops,
                std::vector<Pose2>& map_from_group) {
  std::vector<GroupLink> links = loops;
  for (std::size_t g = 1; g < problem.groups.size(); ++g) {
    const int second = static_cast<int>(g);
    const GroupMotion& motion = problem.motions[g];
    if (!motion.known && !motion.tie) {
      links.push_back(GapLink(g, motion.gap_share, map_from_group));
      links.back().cauchy_sigmas = kGapCauchySigmas;
      continue;
    }
    const int first = motion.tie ? motion.tie->first : second - 1;
    links.push_back({first, second,
                     Between(map_from_group[static_cast<std::size_t>(first)], map_from_group[g]),
                     motion.of_prior_map ? kPriorMapSigma : kOnlineSigma, 0.0});
  }
  for (int i = 0; i < kLoopIterations; ++i) {
    const auto h = MatrixOf(ChainEnvelope(problem.groups.size(), 1, links));
    Eigen::VectorXd g = Eigen::VectorXd::Zero(h->size());
    for (const GroupLink& link : links) AddLink(link, map_from_group, *h, g);
    if (!Factor(*h)) return;
    if (Step(*h, g, map_from_group) < kLoopsClosed) return;
  }
}

// SLAM's motion links. The error is mostly a slowly varying bias: over n frames it grows like n,
// not like its root. `sigma` is that of one frame. A prior map's motions are left out, as they
// carry no SLAM error.
std::vector<GroupLink> MotionLinks(const Problem& problem, const Eigen::Vector3d& sigma) {
  std::vector<GroupLink> links;
  for (std::size_t g = 1; g < problem.groups.size(); ++g) {
    const GroupMotion& motion = problem.motions[g];
    if (!motion.known || motion.of_prior_map) continue;
    const int second = static_cast<int>(g);
    links.push_back({second - 1, second, motion.before_from_group, motion.frames * sigma, 0.0});
  }
  return links;
}

// The same with sigma 1 per frame.
std::vector<GroupLink> UnitMotionLinks(const Problem& problem) {
  return MotionLinks(problem, Eigen::Vector3d::Ones());
}

double GateOf(int round, const JointOptions& options) {
  const double share = options.rounds > 1 ? std::min(round / (options.rounds - 1.0), 1.0) : 1.0;
  return options.first_gate_m * std::pow(options.last_gate_m / options.first_gate_m, share);
}

SightingTrust TrustAt(const Landmarks& landmarks, const std::vector<Pose2>& map_from_group,
                      const JointOptions& options) {
  SightingTrust trust{options.huber_sigmas, {}};
  if (options.judge_misfit || options.judge_sharing) {
    const SightingErrors errors = landmarks.ErrorsAt(map_from_group);
    if (options.judge_misfit) trust.errors.variance_factor = errors.variance_factor;
    if (options.judge_sharing) trust.errors.correlation = errors.correlation;
  }
  if (options.judge_landmarks) trust.landmark_factor = landmarks.FactorsAt(map_from_group, trust);
  return trust;
}

// The weights of motions in estimating SLAM's sigma.
std::vector<Eigen::Vector3d> AsJudged(std::vector<Eigen::Vector3d> shares,
                                      const JointOptions& options) {
  if (!options.judge_motions) std::fill(shares.begin(), shares.end(), MeanShare(shares));
  return shares;
}

// Shares before anything is solved: 1 for motions between groups with surfels, else 0.
std::vector<Eigen::Vector3d> FirstShares(const Problem& problem,
                                         const std::vector<GroupLink>& motions) {
  const auto saw = [&](int group) {
    return !problem.groups[static_cast<std::size_t>(group)].surfels.empty();
  };
  std::vector<Eigen::Vector3d> shares;
  for (const GroupLink& link : motions) {
    const bool seen = !problem.options.judge_motions || (saw(link.first) && saw(link.second));
    shares.push_back(Eigen::Vector3d::Constant(seen ? 1.0 : 0.0));
  }
  return shares;
}

// One Gauss-Newton step: associates landmarks at the current poses, solves, then re-estimates
// SLAM's noise. False when the equations could not be solved.
bool AdjustOnce(const Problem& problem, const std::vector<GroupLink>& loops,
                const std::vector<Pose2>& before, double gate_m, JointResult& result) {
  result.factored.reset();  // two would be twice the memory
  std::vector<Pose2>& map_from_group = result.map_from_group;
  const JointOptions& options = problem.options;
  const AssociationGate gate{kAlongShare * options.landmark_m, gate_m,
                             std::cos(RadFromDeg(options.max_angle_deg))};
  const Landmarks landmarks(problem.groups, map_from_group, gate);
  std::vector<GroupLink> links = SettledLinks(problem, before);
  links.insert(links.end(), loops.begin(), loops.end());
  std::vector<int> first =
      ChainEnvelope(problem.groups.size(), options.learn_persistence ? 2 : 1, links);
  landmarks.ExtendEnvelope(first);
  auto h = MatrixOf(first);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(h->size());
  const SightingTrust trust = TrustAt(landmarks, map_from_group, options);
  result.correlation = trust.errors.correlation;
  landmarks.AddTo(map_from_group, trust, *h, g);
  std::vector<GroupLink> motions = MotionLinks(problem, result.motion_sigma);
  for (std::size_t i = 0; i < result.motion_growth.size(); ++i) {
    motions[i].sigma = motions[i].sigma.cwiseProduct(result.motion_growth[i]);
  }
  for (const GroupLink& link : links) AddLink(link, map_from_group, *h, g);
  AddMotions(motions, result.motion_persistence, result.motion_growth, map_from_group, *h, g);
  if (!Factor(*h)) return false;
  const std::vector<Eigen::Vector3d> shares = SharesSeen(motions, map_from_group, *h);
  Step(*h, g, map_from_group);
  result.factored = std::move(h);
  const std::vector<GroupLink> unit = UnitMotionLinks(problem);
  result.motion_sigma = MotionSigma(unit, map_from_group, AsJudged(shares, options));
  result.motion_seen = SeenSigma(result.motion_sigma, shares);
  if (options.judge_stretches) {
    result.motion_growth = MotionGrowth(unit, motions, map_from_group, shares, result.motion_sigma,
                                        result.motion_growth);
  }
  if (options.learn_persistence) {
    result.motion_persistence = MotionPersistence(unit, map_from_group, shares);
  }
  return true;
}

JointResult Adjust(const Problem& problem, const std::vector<GroupLink>& loops) {
  JointResult result;
  for (const SurfelGroup& group : problem.groups) {
    result.map_from_group.push_back(group.map_from_group);
  }
  const std::vector<GroupLink> unit = UnitMotionLinks(problem);
  const std::vector<Eigen::Vector3d> shares = FirstShares(problem, unit);
  result.motion_sigma = MotionSigma(unit, result.map_from_group, shares);
  if (problem.options.judge_stretches) {
    // Else the first round would move to SLAM's drift what the run had seen of it.
    result.motion_growth = MotionGrowth(unit, MotionLinks(problem, result.motion_sigma),
                                        result.map_from_group, shares, result.motion_sigma, {});
  }
  if (!loops.empty()) CloseLoops(problem, loops, result.map_from_group);
  const std::vector<Pose2> before = result.map_from_group;
  bool settled = true;
  for (int round = 0;
       round < problem.options.rounds || (!settled && round < problem.options.most_rounds);
       ++round) {
    const Eigen::Vector3d sigma_before = result.motion_sigma;
    if (!AdjustOnce(problem, loops, before, GateOf(round, problem.options), result)) break;
    settled = (result.motion_sigma.array() >= kSettledShare * sigma_before.array()).all();
  }
  return result;
}

}  // namespace

void JointOptions::Visit(OptionsVisitor& v) {
  v.Group("groups", groups, "frames that move as one");
  v.Number("rounds", rounds, {0, 1000}, "how often landmarks are found and all poses solved");
  v.Number("most_rounds", most_rounds, {0, 1000},
           "rounds go on up to this many while each finds the prior more accurate");
  v.Number("refine_rounds", refine_rounds, {0, 1000},
           "rounds of an adjustment during the run, without new loops");
  v.Number("refine_gate_m", refine_gate_m, {0.01, 10.0}, "first_gate_m of such an adjustment");
  v.Number(
      "little_m", little_m, {0.0, 10.0},
      "loops that move no pose, and nothing 3 m from it, by more than this count as no new loops");
  v.Number("refine_groups", refine_groups, {1, 1000000},
           "with more groups than this, pairs of neighbours are adjusted as one during the run");
  v.Number("first_gate_m", first_gate_m, {0.01, 10.0},
           "how far apart one landmark may be seen in the first round");
  v.Number("last_gate_m", last_gate_m, {0.01, 10.0},
           "how far apart it may be seen in the last round");
  v.Number("landmark_m", landmark_m, {0.005, 1.0}, "length of a landmark");
  v.Number("max_angle_deg", max_angle_deg, {1.0, 90.0},
           "angle between normals of one landmark, at most");
  v.Number("huber_sigmas", huber_sigmas, {0.1, 100.0}, "residuals of more sigmas count linearly");
  v.Flag("judge_misfit", judge_misfit,
         "whether landmarks that groups see at different places are believed less");
  v.Flag("judge_sharing", judge_sharing,
         "whether landmarks whose neighbours in a group's view err alike are believed less");
  v.Flag("judge_landmarks", judge_landmarks,
         "whether a landmark whose sightings fit worse than most is believed less");
  v.Flag("judge_motions", judge_motions,
         "whether each motion tells of SLAM's errors only as far as it was seen");
  v.Flag("judge_stretches", judge_stretches,
         "whether SLAM is believed less where its motions err by far more than most");
  v.Flag(
      "learn_persistence", learn_persistence,
      "whether SLAM's errors are taken to go on from group to group as much as they are seen to");
  v.Number("loop_huber_sigmas", loop_huber_sigmas, {0.1, 100.0},
           "residuals of loops of more sigmas count linearly");
  v.Number("max_loop_sigmas", max_loop_sigmas, {0.1, 1000.0},
           "a loop farther than this from the adjusted poses is taken out");
}

JointResult AdjustJointly(const std::vector<SurfelGroup>& groups,
                          const std::vector<GroupMotion>& motions,
                          const std::vector<GroupLink>& loops, const JointOptions& options) {
  const Problem problem{groups, motions, options};
  LoopJury jury(loops, options.max_loop_sigmas);
  while (true) {
    std::vector<GroupLink> believed;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const bool joins_two = loops[i].first != loops[i].second;
      if (!jury.accepted()[i] || !joins_two) continue;
      believed.push_back(loops[i]);
      believed.back().huber_sigmas = options.loop_huber_sigmas;
    }
    JointResult result = Adjust(problem, believed);
    if (jury.ReviseAccepted(result.map_from_group)) continue;
    result.loop_accepted = jury.accepted();
    return result;
  }
}

}  // namespace depthgrid
