#include "mapper/surfel/surfel_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Gate for merging pieces into a group's surfels: its poses agree to millimetres, so the pieces'
// noise decides.
constexpr double kGateM = 0.02;
constexpr double kGateSigmas = 3.0;
constexpr double kMaxAngleDeg = 40.0;
// Like kAlongShare: a group's surfels end up half to one spacing apart.
constexpr double kGroupAlongShare = 0.5;
// After more tied frames than this (a second), the online estimate no longer relates two frames to
// millimetres.
constexpr std::size_t kLongestGapFrames = 30;
// 8 * 0.15 m = 1.2 m: farther on, another part of the room is in view.
constexpr int kMostJoined = 8;

}  // namespace

int PriorGroups(const std::vector<GroupStart>& starts) {
  return static_cast<int>(std::count_if(
      starts.begin(), starts.end(), [](const GroupStart& start) { return start.of_prior_map; }));
}

void SurfelGroupOptions::Visit(OptionsVisitor& v) {
  v.Number("length_m", length_m, {0.0, 10.0}, "a group ends this far from where it began");
  v.Number("turn_deg", turn_deg, {0.0, 180.0}, "a group ends when it has turned this far");
  v.Number("spacing_m", spacing_m, {0.005, 1.0}, "distance between a group's surfels along a wall");
  v.Number("most", most, {1, 1e9},
           "with more groups than this, neighbouring ones are adjusted as one");
}

bool SurfelGroups::Ends(const Pose2& group_from_base, int times) const {
  return group_from_base.translation().norm() > options_.length_m * times ||
         std::abs(group_from_base.yaw_rad) > RadFromDeg(options_.turn_deg * times);
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
  // Reserves memory once, for about as many surfels as the previous group has.
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

int SurfelGroups::NearestAround(const Pose2& map_from_group, const std::vector<SurfelGroup>& joined,
                                int times) const {
  const double reach_m = options_.length_m * times;
  const double reach_rad = RadFromDeg(options_.turn_deg * times);
  int nearest = -1;
  double least = 2.0;  // squared distance in units of the reach
  for (std::size_t i = 0; i < joined.size(); ++i) {
    const Pose2& there = joined[i].map_from_group;
    const double way2 = (there.translation() - map_from_group.translation()).squaredNorm();
    if (way2 > reach_m * reach_m) continue;
    const double turn = std::abs(WrapAngle(there.yaw_rad - map_from_group.yaw_rad));
    if (turn > reach_rad) continue;
    const double apart = way2 / (reach_m * reach_m) + turn * turn / (reach_rad * reach_rad);
    if (apart >= least) continue;
    least = apart;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

SurfelGroups::Joining SurfelGroups::JoinedBy(const JoinRule& rule,
                                             const std::vector<GroupStart>& starts) const {
  Joining joining;
  int into = -1;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const SurfelGroup& group = groups_[g];
    const bool prior = starts[g].of_prior_map && rule.prior_times > 0;
    const int times = prior ? rule.prior_times : rule.times;
    const auto from = [&](int joined) {
      return Between(joining.groups[static_cast<std::size_t>(joined)].map_from_group,
                     group.map_from_group);
    };
    const bool goes_on = into >= 0 && !starts[g].apart && !Ends(from(into), times);
    if (!goes_on) {
      const bool in_place = prior || (rule.in_place && starts[g].settled);
      into = in_place ? NearestAround(group.map_from_group, joining.groups, times) : -1;
    }
    if (into < 0) {
      into = static_cast<int>(joining.groups.size());
      joining.groups.push_back({group.first_frame, 0, group.map_from_group, {}});
    }
    joining.groups[static_cast<std::size_t>(into)].frames += group.frames;
    joining.places.push_back({into, from(into)});
  }
  return joining;
}

SurfelGroups::Joining SurfelGroups::JoinedWithin(const GroupLimits& limits,
                                                 const std::vector<GroupStart>& starts) const {
  Joining joining;
  JoinRule rule;
  int most = limits.most;
  auto count = static_cast<int>(groups_.size());
  const auto fits = [&] {
    joining = JoinedBy(rule, starts);
    count = static_cast<int>(joining.groups.size());
    return count <= most;
  };
  if (const int prior = PriorGroups(starts); prior > limits.most_of_prior_map) {
    const int others = static_cast<int>(groups_.size()) - prior;
    for (rule.prior_times = 2; !fits() && rule.prior_times < kMostJoined; ++rule.prior_times) {
      if (count - others <= limits.most_of_prior_map) break;
    }
    // The run's own groups are not joined further when the prior map alone exceeds its limit.
    most = std::max(most, count - others + limits.most - limits.most_of_prior_map);
    if (count <= most) return joining;
  }
  rule.times = std::min((count + most - 1) / most, kMostJoined);
  for (; !fits() && rule.times < kMostJoined; ++rule.times) {
  }
  if (count <= most || !limits.in_place) return joining;
  rule.in_place = true;
  for (rule.times = 2; !fits() && rule.times < kMostJoined; ++rule.times) {
  }
  return joining;
}

SurfelGroups SurfelGroups::Filled(Joining joining, GroupContent content) const {
  SurfelGroups joined(options_);
  joined.places_.reserve(places_.size());
  for (const GroupPlace& place : places_) {
    const GroupPlace& group = joining.places[static_cast<std::size_t>(place.group)];
    joined.places_.push_back({group.group, group.group_from_base * place.group_from_base});
  }
  joined.groups_ = std::move(joining.groups);
  if (content == GroupContent::kPosesOnly) return joined;
  std::vector<std::vector<std::size_t>> members(joined.groups_.size());
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    members[static_cast<std::size_t>(joining.places[g].group)].push_back(g);
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    joined.newest_.Clear();
    for (const std::size_t g : members[i]) {
      joined.Collect(groups_[g].surfels, joining.places[g].group_from_base);
    }
    joined.groups_[i].surfels = joined.newest_.surfels();
  }
  return joined;
}

SurfelGroups SurfelGroups::Joined(const GroupLimits& limits, const std::vector<GroupStart>& starts,
                                  GroupContent content) const {
  const auto groups = static_cast<int>(groups_.size());
  if (groups <= limits.most && PriorGroups(starts) <= limits.most_of_prior_map) {
    return content == GroupContent::kSurfels ? *this : WithoutSurfels();
  }
  return Filled(JoinedWithin(limits, starts), content);
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

void SurfelGroups::LeaveOutAstray(const std::vector<MappedFrame>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].led_astray) groups_[static_cast<std::size_t>(places_[i].group)].surfels.clear();
  }
}

}  // namespace depthgrid
