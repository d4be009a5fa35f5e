#include "mapper/surfel/surfel_groups.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Within a group poses agree to millimetres; a piece belongs to a surfel by its own noise.
constexpr double kGateM = 0.02;
constexpr double kGateSigmas = 3.0;
constexpr double kMaxAngleDeg = 40.0;
// As kAlongShare: a group's surfels end up half to a whole spacing apart.
constexpr double kGroupAlongShare = 0.5;
// Over more tied frames than this, a second, the online estimate does not join two to millimetres.
constexpr std::size_t kLongestGapFrames = 30;

}  // namespace

void SurfelGroupOptions::Visit(OptionsVisitor& v) {
  v.Number("length_m", length_m, {0.0, 10.0}, "a group ends this far from where it began");
  v.Number("turn_deg", turn_deg, {0.0, 180.0}, "or when it has turned so far");
  v.Number("spacing_m", spacing_m, {0.005, 1.0}, "between a group's surfels along a wall");
  v.Number("most", most, {1, 1e9}, "with more groups neighbouring ones are adjusted as one");
}

bool SurfelGroups::Ends(const Pose2& group_from_base) const {
  return group_from_base.translation().norm() > options_.length_m ||
         std::abs(group_from_base.yaw_rad) > RadFromDeg(options_.turn_deg);
}

void SurfelGroups::Begin(int first_frame, const Pose2& map_from_group) {
  SurfelGroup group;
  group.first_frame = first_frame;
  group.map_from_group = map_from_group;
  groups_.push_back(group);
  newest_.Clear();
}

void SurfelGroups::Collect(const std::vector<Surfel>& surfels, const Pose2& group_from_surfels) {
  const Motion2 motion(group_from_surfels);
  const double min_cosine = std::cos(RadFromDeg(kMaxAngleDeg));
  for (const Surfel& surfel : surfels) {
    const double sigma_m = 1.0 / std::sqrt(surfel.information);
    newest_.Merge(motion * surfel, {kGroupAlongShare * options_.spacing_m,
                                    kGateM + kGateSigmas * sigma_m, min_cosine});
  }
}

void SurfelGroups::Add(const std::vector<Surfel>& pieces, const Pose2& map_from_base) {
  if (groups_.empty() || part_begins_ || places_.size() - last_added_ > kLongestGapFrames ||
      Ends(Between(groups_.back().map_from_group, map_from_base))) {
    Begin(static_cast<int>(places_.size()), map_from_base);
  }
  part_begins_ = false;
  last_added_ = places_.size();
  SurfelGroup& group = groups_.back();
  ++group.frames;
  const Pose2 group_from_base = Between(group.map_from_group, map_from_base);
  places_.push_back({static_cast<int>(groups_.size()) - 1, group_from_base});
  Collect(pieces, group_from_base);
  // Room for the frames to come, as neighbouring groups are alike; not a little more each frame.
  if (group.surfels.capacity() < newest_.surfels().size()) {
    const std::size_t like_before =
        groups_.size() > 1 ? groups_[groups_.size() - 2].surfels.size() : 0;
    group.surfels.reserve(std::max(like_before, newest_.surfels().size()) * 5 / 4);
  }
  group.surfels = newest_.surfels();
}

void SurfelGroups::MoveNewest(const Pose2& motion) {
  const bool leads_on = !part_begins_ && last_added_ + 1 == places_.size();
  if (groups_.size() < 2 || !leads_on) return;
  Pose2& map_from_group = groups_.back().map_from_group;
  map_from_group = motion * map_from_group;
}

void SurfelGroups::AddTied(int tied_to, const Pose2& map_from_base) {
  const int group = places_[static_cast<std::size_t>(tied_to)].group;
  const Pose2& map_from_group = groups_[static_cast<std::size_t>(group)].map_from_group;
  places_.push_back({group, Between(map_from_group, map_from_base)});
}

SurfelGroups SurfelGroups::WithoutSurfels() const {
  SurfelGroups bare(options_);
  bare.places_ = places_;
  for (const SurfelGroup& group : groups_) {
    bare.groups_.push_back({group.first_frame, group.frames, group.map_from_group, {}});
  }
  return bare;
}

SurfelGroups SurfelGroups::JoinedBy(int factor, const std::vector<bool>& apart,
                                    GroupContent content) const {
  SurfelGroupOptions wider = options_;
  wider.length_m *= factor;
  wider.turn_deg *= factor;
  SurfelGroups joined(wider);
  std::vector<GroupPlace> place_of_group;  // in the joined groups
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const SurfelGroup& group = groups_[g];
    if (g == 0 || apart[g] ||
        joined.Ends(Between(joined.groups_.back().map_from_group, group.map_from_group))) {
      joined.Begin(group.first_frame, group.map_from_group);
    }
    SurfelGroup& into = joined.groups_.back();
    const Pose2 into_from_group = Between(into.map_from_group, group.map_from_group);
    place_of_group.push_back({static_cast<int>(joined.groups_.size()) - 1, into_from_group});
    into.frames += group.frames;
    if (content == GroupContent::kPosesOnly) continue;
    joined.Collect(group.surfels, into_from_group);
    into.surfels = joined.newest_.surfels();
  }
  joined.places_.reserve(places_.size());
  for (const GroupPlace& place : places_) {
    const GroupPlace& group = place_of_group[static_cast<std::size_t>(place.group)];
    joined.places_.push_back({group.group, group.group_from_base * place.group_from_base});
  }
  return joined;
}

SurfelGroups SurfelGroups::Joined(int most, const std::vector<bool>& apart,
                                  GroupContent content) const {
  constexpr int kMostJoined = 8;  // 1.2 m: farther on another part of the room is in view
  const int groups = static_cast<int>(groups_.size());
  if (groups <= most) return content == GroupContent::kSurfels ? *this : WithoutSurfels();
  int factor = (groups + most - 1) / most;
  while (true) {
    SurfelGroups joined = JoinedBy(std::min(factor, kMostJoined), apart, content);
    if (factor >= kMostJoined || static_cast<int>(joined.groups_.size()) <= most) {
      return joined;
    }
    ++factor;
  }
}

void SurfelGroups::MoveTo(const std::vector<Pose2>& map_from_base) {
  Require(map_from_base.size() == places_.size(), "one corrected pose a frame");
  for (SurfelGroup& group : groups_) {
    group.map_from_group = map_from_base[static_cast<std::size_t>(group.first_frame)];
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const SurfelGroup& group = groups_[static_cast<std::size_t>(places_[i].group)];
    places_[i].group_from_base = Between(group.map_from_group, map_from_base[i]);
  }
}

}  // namespace depthgrid
