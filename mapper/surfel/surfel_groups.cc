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

}  // namespace

void SurfelGroupOptions::Visit(OptionsVisitor& v) {
  v.Number("length_m", length_m, {0.0, 10.0}, "a group ends this far from where it began");
  v.Number("turn_deg", turn_deg, {0.0, 180.0}, "or when it has turned so far");
  v.Number("spacing_m", spacing_m, {0.005, 1.0}, "between a group's surfels along a wall");
}

bool SurfelGroups::Ends(const Pose2& group_from_base) const {
  return group_from_base.translation().norm() > options_.length_m ||
         std::abs(group_from_base.yaw_rad) > RadFromDeg(options_.turn_deg);
}

void SurfelGroups::Add(const std::vector<Surfel>& pieces, const Pose2& map_from_base) {
  if (groups_.empty() || Ends(Between(groups_.back().map_from_group, map_from_base))) {
    SurfelGroup group;
    group.first_frame = static_cast<int>(places_.size());
    group.map_from_group = map_from_base;
    groups_.push_back(group);
    newest_.Clear();
  }
  SurfelGroup& group = groups_.back();
  ++group.frames;
  const Pose2 group_from_base = Between(group.map_from_group, map_from_base);
  places_.push_back({static_cast<int>(groups_.size()) - 1, group_from_base});
  const Motion2 motion(group_from_base);
  const double min_cosine = std::cos(RadFromDeg(kMaxAngleDeg));
  for (const Surfel& piece : pieces) {
    const double sigma_m = 1.0 / std::sqrt(piece.information);
    newest_.Merge(motion * piece,
                  {0.5 * options_.spacing_m, kGateM + kGateSigmas * sigma_m, min_cosine});
  }
  // Room for the frames to come, as neighbouring groups are alike; not a little more each frame.
  if (group.surfels.capacity() < newest_.surfels().size()) {
    const std::size_t like_before =
        groups_.size() > 1 ? groups_[groups_.size() - 2].surfels.size() : 0;
    group.surfels.reserve(std::max(like_before, newest_.surfels().size()) * 5 / 4);
  }
  group.surfels = newest_.surfels();
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
