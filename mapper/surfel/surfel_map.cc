#include "mapper/surfel/surfel_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/fuse/fusion.h"
#include "mapper/surfel/frame_smoother.h"
#include "mapper/surfel/group_motions.h"
#include "mapper/surfel/pose_covariance.h"

namespace depthgrid {
namespace {

// A loop between two frames as a link between their groups.
GroupLink LinkOf(const PlanarLoop& loop, const std::vector<GroupPlace>& places) {
  const GroupPlace& first = places[static_cast<std::size_t>(loop.first)];
  const GroupPlace& second = places[static_cast<std::size_t>(loop.second)];
  GroupLink link;
  link.first = first.group;
  link.second = second.group;
  link.first_from_second =
      first.group_from_base * loop.first_from_second * Inverse(second.group_from_base);
  link.sigma = {loop.sigma_translation_m, loop.sigma_translation_m, loop.sigma_yaw_rad};
  link.on_trial = loop.on_trial;
  return link;
}

// Groups of the frames at these indices; a frame not mapped yet counts to the newest group.
std::vector<int> GroupsAt(std::span<const int> frames, const std::vector<GroupPlace>& places) {
  std::vector<int> groups;
  for (const int frame : frames) {
    const auto place = std::min(static_cast<std::size_t>(frame), places.size() - 1);
    groups.push_back(places[place].group);
  }
  return groups;
}

std::vector<Pose2> PosesOf(const std::vector<GroupPlace>& places,
                           const std::vector<Pose2>& map_from_group) {
  std::vector<Pose2> poses;
  for (const GroupPlace& place : places) {
    poses.push_back(map_from_group[static_cast<std::size_t>(place.group)] * place.group_from_base);
  }
  return poses;
}

// Accuracy of adjusted groups' poses, as prediction for the frames' final matches. m, m, rad.
const Eigen::Vector3d kAdjustedSigma(0.02, 0.02, 0.01);

// With fewer groups that have surfels, SLAM's noise is not estimated.
constexpr int kMinGroupsForSpread = 4;

// Whether some groups hold frames of several visits (SurfelGroups::Joined).
bool AreJoinedInPlace(const std::vector<GroupMotion>& motions) {
  return std::any_of(motions.begin(), motions.end(),
                     [](const GroupMotion& motion) { return motion.tie && !motion.known; });
}

// Mean frames per motion, of this run's own.
double FramesAMotion(const std::vector<GroupMotion>& motions) {
  double frames = 0.0;
  int count = 0;
  for (const GroupMotion& motion : motions) {
    if (!motion.known || motion.of_prior_map) continue;
    frames += motion.frames;
    ++count;
  }
  return count > 0 ? frames / count : 1.0;
}

// SLAM's motion noise between this run's own groups.
std::optional<MotionSpread> SpreadOf(const std::vector<SurfelGroup>& groups,
                                     const std::vector<GroupMotion>& motions,
                                     const std::vector<MappedFrame>& frames,
                                     const JointResult& result) {
  const int first_new = FirstNew(frames);
  int new_groups = 0;
  int that_saw = 0;
  for (const SurfelGroup& group : groups) {
    if (group.first_frame < first_new) continue;
    ++new_groups;
    that_saw += group.surfels.empty() ? 0 : 1;
  }
  if (that_saw < kMinGroupsForSpread) return std::nullopt;
  const auto moving = std::count_if(frames.begin() + first_new, frames.end(),
                                    [](const MappedFrame& frame) { return !frame.stands; });
  double frames_a_group = std::max(static_cast<double>(moving), 1.0) / new_groups;
  if (AreJoinedInPlace(motions)) frames_a_group = FramesAMotion(motions);
  return MotionSpread{result.motion_sigma, frames_a_group, that_saw, result.motion_seen};
}

}  // namespace

void SurfelOptions::Visit(OptionsVisitor& v) {
  v.Group("scan", scan, "how a scan is cut into surfels");
  v.Group("match", match, "how they are matched against the map's");
  v.Group("joint", joint, "how poses and surfels are corrected together");
  v.Number("spacing_m", spacing_m, {0.005, 1.0}, "distance between the map's surfels along a wall");
  v.Number("merge_gate_m", merge_gate_m, {0.0, 1.0},
           "a surfel is changed by what lies this near to it along its normal");
  v.Number("merge_gate_sigmas", merge_gate_sigmas, {0.0, 100.0},
           "merge_gate_m is widened by this many sigmas of noise");
  v.Number(
      "jump_m", jump_m, {0.0, 1000.0},
      "a match that moves the pose of the frame before, or what lies 3 m from it, by more than "
      "this moves that frame's group along");
  v.Number("stay_m", stay_m, {0.0, 1000.0},
           "at the end, frames stay this near to where the joint adjustment put them; 0: no limit");
  v.Number("moving_m", moving_m, {0.0, 10.0},
           "a free-standing object is matched once it stood still while SLAM moved the camera this "
           "far; 0: from the start");
}

SurfelMap::SurfelMap(const SurfelOptions& options)
    : options_(options),
      noise_(options.scan.skip_alike),
      maker_(options.scan),
      matcher_(options.match),
      groups_(options.joint.groups) {}

void SurfelMap::Learn(const Scan& scan) {
  noise_.Add(scan);
  matcher_.SetBeamsErrAlike(noise_.stride() > 1);
}

const std::vector<Surfel>& SurfelMap::PiecesOf(const std::shared_ptr<const Scan>& scan) {
  if (scan == scan_) return pieces_;
  Learn(*scan);
  pieces_ = maker_.Make(*scan, noise_, noise_.stride(), std::move(pieces_));
  scan_ = scan;
  return pieces_;
}

std::vector<Surfel> SurfelMap::Cut(const Scan& scan) {
  Learn(scan);
  return maker_.Make(scan, noise_);
}

MatchResult SurfelMap::Match(const std::shared_ptr<const Scan>& scan,
                             const Prediction& prediction) {
  return matcher_.Match(PiecesOf(scan), map_, prediction, &parts_);
}

void SurfelMap::InsertInto(SurfelStore& map, const std::vector<Surfel>& surfels,
                           const Pose2& map_from_surfels, double frame) const {
  const Motion2 motion(map_from_surfels);
  const double min_cosine = GateOf(options_.match).min_cosine;
  for (const Surfel& surfel : surfels) {
    const double off_m =
        options_.merge_gate_m + options_.merge_gate_sigmas / std::sqrt(surfel.information);
    map.Merge(motion * surfel, {kAlongShare * options_.spacing_m, off_m, min_cosine}, frame);
  }
}

void SurfelMap::Corrected(const Pose2& map_from_previous, const Pose2& corrected) {
  const Eigen::Vector3d jump = Between(map_from_previous, corrected).vector();
  if (jump.cwiseQuotient(kMotionUnit).norm() <= options_.jump_m) return;
  groups_.MoveNewest(corrected * Inverse(map_from_previous));
}

void SurfelMap::Insert(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                       const Eigen::Matrix3d&) {
  const std::vector<Surfel>& pieces = PiecesOf(scan);
  surfels_before_.push_back(map_.size());
  InsertInto(map_, pieces, map_from_base, static_cast<double>(groups_.places().size()));
  if (noise_.stride() == 1) {
    groups_.Add(pieces, map_from_base);
  } else {
    all_pieces_ = maker_.Make(*scan, noise_, 1, std::move(all_pieces_));
    groups_.Add(all_pieces_, map_from_base);
  }
}

// Does not change the surfels: over hours even perfect matches would make the map drift.
void SurfelMap::InsertTied(const std::shared_ptr<const Scan>&, const Pose2& map_from_base,
                           int tied_to) {
  surfels_before_.push_back(map_.size());
  groups_.AddTied(tied_to, map_from_base);
}

double SurfelMap::ShareSeenBefore(const std::shared_ptr<const Scan>& scan,
                                  const Pose2& map_from_base, int frame) {
  // The range noise is not updated, as this scan was counted before.
  if (scan != scan_) {
    other_pieces_ = maker_.Make(*scan, noise_, noise_.stride(), std::move(other_pieces_));
  }
  const std::vector<Surfel>& pieces = scan == scan_ ? pieces_ : other_pieces_;
  if (pieces.empty()) return 0.0;
  const Motion2 motion(map_from_base);
  const AssociationGate gate = GateOf(options_.match);
  const auto position = static_cast<std::size_t>(frame);
  const int before = position < surfels_before_.size() ? surfels_before_[position] : map_.size();
  const auto seen = std::count_if(pieces.begin(), pieces.end(), [&](const Surfel& piece) {
    const int surfel = map_.Nearest(motion * piece, gate);
    return surfel >= 0 && surfel < before;
  });
  return static_cast<double>(seen) / static_cast<double>(pieces.size());
}

Adjustment SurfelMap::Adjust(const std::vector<MappedFrame>& frames,
                             const std::vector<PlanarLoop>& loops, AdjustEffort effort,
                             std::span<const int> asked) {
  if (effort == AdjustEffort::kCloseLoops && MoveLittle(loops, frames)) {
    effort = AdjustEffort::kRefine;
  }
  const SurfelGroups groups = GroupsOf(frames, effort);
  const JointOptions joint = JointOptionsFor(effort);
  std::vector<GroupLink> links;
  for (const PlanarLoop& loop : loops) links.push_back(LinkOf(loop, groups.places()));
  const std::vector<GroupMotion> motions = MotionsOf(groups, frames);
  JointResult result = AdjustJointly(groups.groups(), motions, links, joint);
  const double shared_before = matcher_.shared_errors();
  if (effort != AdjustEffort::kBend) matcher_.ShareErrors(result.correlation);
  Adjustment adjustment;
  adjustment.loop_accepted = result.loop_accepted;
  if (result.factored) {
    adjustment.covariance =
        PoseCovariance(*result.factored, result.map_from_group, GroupsAt(asked, groups.places()));
    result.factored.reset();
  }
  adjustment.motion_spread = SpreadOf(groups.groups(), motions, frames, result);
  adjustment.map_from_base =
      IsFinish(effort)
          ? SmoothedOver(frames, groups, result.map_from_group, adjustment.motion_spread,
                         GrowthAt(motions, result.motion_growth, groups))
          : PosesOf(groups.places(), result.map_from_group);
  // More frames may follow: their matches are judged as before.
  if (IsFinish(effort)) matcher_.ShareErrors(shared_before);
  const Pose2 shift = frames[0].map_from_base * Inverse(adjustment.map_from_base[0]);
  for (Pose2& pose : adjustment.map_from_base) pose = shift * pose;
  return adjustment;
}

bool SurfelMap::MoveLittle(const std::vector<PlanarLoop>& loops,
                           const std::vector<MappedFrame>& frames) {
  if (loops.empty() || options_.joint.little_m <= 0.0) return false;
  const Adjustment bent = Adjust(frames, loops, AdjustEffort::kBend, {});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose2 motion = Between(frames[i].map_from_base, bent.map_from_base[i]);
    if (motion.vector().cwiseQuotient(kMotionUnit).norm() > options_.joint.little_m) return false;
  }
  return true;
}

SurfelGroups SurfelMap::GroupsOf(const std::vector<MappedFrame>& frames, AdjustEffort effort) {
  const auto joined = [&](const SurfelGroups& groups) {
    Require(groups.places().size() == frames.size(), "the frames are those inserted");
    const std::vector<GroupStart> starts = StartsOf(groups, frames);
    return groups.Joined(
        LimitsFor(effort, options_.joint, starts), starts,
        effort == AdjustEffort::kBend ? GroupContent::kPosesOnly : GroupContent::kSurfels);
  };
  if (effort == AdjustEffort::kFinishMoved) {
    SurfelGroups moved = groups_;
    moved.MoveTo(PosesOf(frames));
    moved.LeaveOutAstray(frames);
    return joined(moved);
  }
  if (groups_.places().size() >= frames.size()) return joined(groups_);
  // A provisional last frame was not inserted yet.
  SurfelGroups groups = groups_;
  for (std::size_t i = groups.places().size(); i < frames.size(); ++i) {
    if (!frames[i].slam_motion) groups.BeginPart();
    groups.Add(maker_.Make(*frames[i].scan, noise_, 1), frames[i].map_from_base);
  }
  return joined(groups);
}

JointOptions SurfelMap::JointOptionsFor(AdjustEffort effort) const {
  JointOptions joint = options_.joint;
  if (effort == AdjustEffort::kRefine) {
    joint.rounds = joint.refine_rounds;
    joint.first_gate_m = joint.refine_gate_m;
  }
  if (effort == AdjustEffort::kBend) joint.rounds = 0;
  return joint;
}

// Matches each frame against the adjusted map, then smooths all with SLAM's motion. Tied frames use
// their online match, moved along with their group. A prior map's frames were smoothed when it was
// made and keep their poses in their groups.
std::vector<Pose2> SurfelMap::SmoothedOver(const std::vector<MappedFrame>& frames,
                                           const SurfelGroups& groups,
                                           const std::vector<Pose2>& map_from_group,
                                           const std::optional<MotionSpread>& spread,
                                           const std::vector<Eigen::Vector3d>& growth) {
  SurfelStore map;
  for (std::size_t g = 0; g < groups.groups().size(); ++g) {
    InsertInto(map, groups.groups()[g].surfels, map_from_group[g], 0.0);
  }
  const Eigen::Matrix3d covariance = Squared(kAdjustedSigma);
  std::vector<Pose2> poses = PosesOf(groups.places(), map_from_group);
  std::vector<SmootherFrame> smoother;
  const int first_new = FirstNew(frames);
  for (auto i = static_cast<std::size_t>(first_new); i < frames.size(); ++i) {
    MatchResult match = frames[i].match;
    if (frames[i].led_astray) {
      match = {};
    } else if (frames[i].kept()) {
      const std::vector<Surfel> pieces = maker_.Make(*frames[i].scan, noise_);
      match = matcher_.Match(pieces, map, {poses[i], covariance});
    } else {
      match.map_from_base = poses[i] * Between(frames[i].map_from_base, match.map_from_base);
    }
    smoother.push_back({poses[i], match, frames[i].slam_motion, frames[i].stands});
  }
  MotionNoise noise = NoiseOf(smoother);
  if (spread && spread->IsSure()) {
    Bound(*spread, noise);
    for (std::size_t k = 0; k < smoother.size(); ++k) {
      smoother[k].growth = growth[static_cast<std::size_t>(first_new) + k];
    }
  }
  const std::vector<Pose2> smoothed = Smoothed(smoother, noise, options_.stay_m);
  std::copy(smoothed.begin(), smoothed.end(), poses.begin() + first_new);
  return poses;
}

void SurfelMap::Rebuild(const std::vector<MappedFrame>& frames) {
  groups_.MoveTo(PosesOf(frames));
  map_.Clear();
  std::size_t frame = 0;
  int before = 0;
  const auto inserted_until = [&](int end) {
    for (; frame < static_cast<std::size_t>(end); ++frame) surfels_before_[frame] = before;
  };
  for (const SurfelGroup& group : groups_.groups()) {
    inserted_until(group.first_frame);
    before = map_.size();
    InsertInto(map_, group.surfels, group.map_from_group,
               group.first_frame + 0.5 * (group.frames - 1));
  }
  inserted_until(static_cast<int>(surfels_before_.size()));
}

}  // namespace depthgrid
