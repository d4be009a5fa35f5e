#include "mapper/surfel/group_motions.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/usual_step.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

// Bounds on the accuracy of a tied frame's pose, otherwise that of its match: m, m, rad.
const Eigen::Vector3d kLeastTieSigma(0.005, 0.005, 0.003);
const Eigen::Vector3d kMostTieSigma(1.0, 1.0, 0.5);
// Matches against the same noisy map are overconfident (docs/math.md, "Scans that are kept").
constexpr double kTieOverconfidence = 4.0;
constexpr double kTieHuberSigmas = 2.0;

// A frame whose match is more accurate than this is settled: consistent with the map there as well
// as frames of one group are (kGateM of surfel_groups.cc). m, m, rad.
const Eigen::Vector3d kSettledSigma(0.02, 0.02, 0.01);

Eigen::Vector3d SigmaOf(const MatchResult& match) {
  const Eigen::Matrix3d ridge =
      kMostTieSigma.cwiseProduct(kMostTieSigma).cwiseInverse().asDiagonal();
  Eigen::Matrix3d information = ridge;
  if (match.found) information += match.information / kTieOverconfidence;
  return information.inverse().diagonal().cwiseSqrt();
}

// Link from the group of a tied frame to the group of the next, kept frame, whose axes are nearly
// the tied frame's.
GroupLink TieOf(const GroupPlace& tied, const MatchResult& match, const Pose2& motion, int group) {
  return {tied.group, group, tied.group_from_base * motion, SigmaOf(match).cwiseMax(kLeastTieSigma),
          kTieHuberSigmas};
}

// Median time from a frame to the next; 0 where unknown.
double UsualFrameStepS(const std::vector<MappedFrame>& frames) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double step_s = frames[i].stamp_s - frames[i - 1].stamp_s;
    if (frames[i].slam_motion && step_s > 0.0) steps_s.push_back(step_s);
  }
  return UsualStepS(steps_s);
}

UsualMotion UsualFrameMotion(const std::vector<MappedFrame>& frames) {
  UsualMotion usual;
  for (const MappedFrame& frame : frames) {
    if (frame.slam_motion) usual.Add(*frame.slam_motion);
  }
  return usual;
}

// Number of usual steps since the previous frame: more than one after a pause in which SLAM moved,
// 0 where it stood.
int StepsTo(const MappedFrame& frame, const MappedFrame& before, double usual_s,
            const UsualMotion& usual) {
  if (frame.stands) return 0;
  if (frame.frame != before.frame + 1) return 1;
  const int steps = StepsIn(frame.stamp_s - before.stamp_s, usual_s);
  return frame.slam_motion ? MovingStepsIn(steps, *frame.slam_motion, usual) : steps;
}

// Link to a group from the (earlier) group that the frame before its first one belongs to.
std::optional<GroupLink> TieBefore(const SurfelGroups& of, const std::vector<MappedFrame>& frames,
                                   std::size_t g) {
  const auto first = static_cast<std::size_t>(of.groups()[g].first_frame);
  const std::optional<Pose2>& motion = frames[first].slam_motion;
  if (!motion) return std::nullopt;
  const GroupPlace& before = of.places()[first - 1];
  const int group = static_cast<int>(g);
  if (frames[first].of_prior_map()) {
    return GroupLink{before.group, group, before.group_from_base * *motion, kPriorMapSigma};
  }
  return TieOf(before, frames[first - 1].match, *motion, group);
}

// Whether group g follows group g - 1 in time. Not always so for groups joined in place
// (SurfelGroups::Joined), which hold frames of several visits: others may have come between, even
// where the last visit was to group g - 1 again.
bool GoesOnFromLast(const SurfelGroups& of, const std::vector<MappedFrame>& frames, std::size_t g) {
  const int last = static_cast<int>(g) - 1;
  const auto first = static_cast<std::size_t>(of.groups()[g].first_frame);
  for (auto i = static_cast<std::size_t>(of.groups()[g - 1].first_frame); i < first; ++i) {
    if (frames[i].kept() && of.places()[i].group != last) return false;
  }
  return true;
}

}  // namespace

std::vector<GroupMotion> MotionsOf(const SurfelGroups& of, const std::vector<MappedFrame>& frames) {
  const std::vector<SurfelGroup>& groups = of.groups();
  std::vector<GroupMotion> motions(groups.size());
  const double usual_s = UsualFrameStepS(frames);
  const UsualMotion usual = UsualFrameMotion(frames);
  for (std::size_t g = 1; g < groups.size(); ++g) {
    GroupMotion& motion = motions[g];
    const auto first = static_cast<std::size_t>(groups[g].first_frame);
    motion.of_prior_map = frames[first].of_prior_map();
    if (!GoesOnFromLast(of, frames, g)) {
      motion.tie = TieBefore(of, frames, g);
      continue;
    }
    motion.known = true;
    double gap_variance = 0.0;
    for (auto i = static_cast<std::size_t>(groups[g - 1].first_frame) + 1; i <= first; ++i) {
      const std::optional<Pose2>& step = frames[i].slam_motion;
      motion.known = motion.known && step;
      if (!step) gap_variance += frames[i].gap_share * frames[i].gap_share;
      motion.frames += StepsTo(frames[i], frames[i - 1], usual_s, usual);
      if (motion.known) motion.before_from_group = motion.before_from_group * *step;
    }
    // SLAM that jitters in place is not known to stand, however little its error grows meanwhile.
    if (motion.known) {
      motion.frames = MovingStepsIn(motion.frames, motion.before_from_group, usual);
    }
    motion.frames = std::max(motion.frames, 1);
    motion.gap_share = std::sqrt(gap_variance);
    if (!frames[first - 1].kept()) motion.tie = TieBefore(of, frames, g);
  }
  return motions;
}

std::vector<Eigen::Vector3d> GrowthAt(const std::vector<GroupMotion>& motions,
                                      const std::vector<Eigen::Vector3d>& motion_growth,
                                      const SurfelGroups& of) {
  std::vector<Eigen::Vector3d> growth(of.places().size(), Eigen::Vector3d::Ones());
  if (motion_growth.empty()) return growth;
  std::size_t next = 0;
  for (std::size_t g = 1; g < motions.size(); ++g) {
    if (!motions[g].known || motions[g].of_prior_map) continue;
    const auto begin = static_cast<std::size_t>(of.groups()[g - 1].first_frame) + 1;
    const auto first = static_cast<std::size_t>(of.groups()[g].first_frame);
    // No motion leads on from the last group.
    const std::size_t end = g + 1 < motions.size() ? first + 1 : growth.size();
    const Eigen::Vector3d& here = motion_growth[next++];
    for (std::size_t i = begin; i < end; ++i) growth[i] = here;
  }
  return growth;
}

std::vector<GroupStart> StartsOf(const SurfelGroups& of, const std::vector<MappedFrame>& frames) {
  std::vector<GroupStart> starts;
  bool in_place = false;  // no gap in SLAM's motion since a frame was tied
  for (const GroupMotion& motion : MotionsOf(of, frames)) {
    const SurfelGroup& group = of.groups()[starts.size()];
    const MatchResult& match = frames[static_cast<std::size_t>(group.first_frame)].match;
    in_place = motion.tie || (in_place && motion.known);
    const bool sure = (SigmaOf(match).array() <= kSettledSigma.array()).all();
    starts.push_back({!motion.known || motion.tie, in_place && sure, motion.of_prior_map});
  }
  // motions[0] is not used.
  if (!starts.empty()) starts[0].of_prior_map = frames[0].of_prior_map();
  return starts;
}

GroupLimits LimitsFor(AdjustEffort effort, const JointOptions& joint,
                      const std::vector<GroupStart>& starts) {
  const int most = joint.groups.most;
  const auto groups = static_cast<int>(starts.size());
  const int prior = PriorGroups(starts);
  // Without surfels, cost is small and only loops and the chain of groups constrain: no need to
  // join.
  if (effort == AdjustEffort::kBend) return {.most = most, .most_of_prior_map = prior};
  if (IsFinish(effort)) {
    return {.most = most,
            .most_of_prior_map = std::max(most / 2, most - (groups - prior)),
            .in_place = true};
  }
  // A limit of 2/3, to halve the number: some groups cannot be joined.
  const auto run = [&](int count) { return std::max(joint.refine_groups, 2 * count / 3); };
  // A prior map is adjusted already: few of its groups suffice to hold those of this run.
  const int of_prior = std::min(prior, joint.refine_groups);
  const int wanted = prior > of_prior ? of_prior + run(groups - prior) : run(groups);
  return {.most = std::min(most, wanted), .most_of_prior_map = of_prior, .in_place = true};
}

int FirstNew(const std::vector<MappedFrame>& frames) {
  const auto first = std::find_if(frames.begin(), frames.end(),
                                  [](const MappedFrame& frame) { return !frame.of_prior_map(); });
  return static_cast<int>(first - frames.begin());
}

}  // namespace depthgrid
