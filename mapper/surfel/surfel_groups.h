// Frames close together seen as one: what the joint adjustment moves.
#pragma once

#include <vector>

#include "mapper/core/options.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

struct SurfelGroupOptions {
  // A group ends when the sensor is this far from where it began. Within it the poses' differences
  // are those of the online estimate.
  double length_m = 0.15;
  double turn_deg = 6.0;
  // Between the surfels of a group, along a wall.
  double spacing_m = 0.04;
  // Of longer runs, neighbouring groups are adjusted as one, and where that is not enough those of
  // one place: the cost of solving for all of them grows like the cube where a wide view joins most
  // to most (docs/results.md, "A whole building").
  int most = 1000;

  void Visit(OptionsVisitor& v);
};

struct SurfelGroup {
  int first_frame = 0;          // index into the mapped frames
  int frames = 0;               // that are kept
  Pose2 map_from_group;         // the group's axes are those of its first frame
  std::vector<Surfel> surfels;  // in them
};

// Where a frame is in its group.
struct GroupPlace {
  int group = 0;
  Pose2 group_from_base;
};

// How a group begins, as far as it may be joined to earlier ones.
struct GroupStart {
  bool apart = false;    // SLAM jumped between it and the one before, or frames were not kept
  bool settled = false;  // where it is in the map was told by what was seen there before
  bool of_prior_map = false;
};
// How many are a prior map's.
int PriorGroups(const std::vector<GroupStart>& starts);

// How many groups there may be, as far as they can be joined.
struct GroupLimits {
  int most = 0;
  int most_of_prior_map = 0;  // of them
  bool in_place = false;  // whether settled groups of one place are joined, whenever it was seen
};

// What joined groups are wanted for: what was seen takes most of the time to join.
enum class GroupContent { kSurfels, kPosesOnly };

class SurfelGroups {
 public:
  explicit SurfelGroups(const SurfelGroupOptions& options) : options_(options) {}

  // The next frame; it belongs to the newest group.
  void Add(const std::vector<Surfel>& pieces, const Pose2& map_from_base);
  // The next frame, which moves with an earlier one and adds nothing to what its group saw.
  void AddTied(int tied_to, const Pose2& map_from_base);
  // The newest group is elsewhere than the estimate had it, by this motion of the map's axes. The
  // first stays, as all others are placed by it; so does one that the next frame does not go
  // on from.
  void MoveNewest(const Pose2& motion);
  // The next frame begins a group, wherever it is.
  void BeginPart() { part_begins_ = true; }
  const std::vector<SurfelGroup>& groups() const { return groups_; }
  const std::vector<GroupPlace>& places() const { return places_; }  // one a frame
  // Corrected poses, one a frame. What the groups saw does not change.
  void MoveTo(const std::vector<Pose2>& map_from_base);
  // The same frames in no more groups than the limits allow, as far as these may be joined: groups
  // that follow each other, and settled ones, as those of a prior map, with those of one place.
  SurfelGroups Joined(const GroupLimits& limits, const std::vector<GroupStart>& starts,
                      GroupContent content = GroupContent::kSurfels) const;

 private:
  // `times` its length and turn.
  bool Ends(const Pose2& group_from_base, int times = 1) const;
  void Begin(int first_frame, const Pose2& map_from_group);
  // More surfels of the newest group.
  void Collect(const std::vector<Surfel>& surfels, const Pose2& group_from_surfels);
  // How groups are joined: to so many times their length along the way, and those of a place.
  struct JoinRule {
    int times = 1;
    bool in_place = false;  // those that are settled
    int prior_times = 0;    // of a prior map, which are joined in place then; 0: as the others
  };
  // The groups that each of these is joined to: their poses, and this one's place in one of them.
  struct Joining {
    std::vector<SurfelGroup> groups;
    std::vector<GroupPlace> places;
  };
  Joining JoinedBy(const JoinRule& rule, const std::vector<GroupStart>& starts) const;
  Joining JoinedWithin(const GroupLimits& limits, const std::vector<GroupStart>& starts) const;
  // The nearest that has room for a group there; -1: none.
  int NearestAround(const Pose2& map_from_group, const std::vector<SurfelGroup>& joined,
                    int times) const;
  SurfelGroups Filled(Joining joining, GroupContent content) const;
  SurfelGroups WithoutSurfels() const;

  SurfelGroupOptions options_;
  std::vector<SurfelGroup> groups_;
  std::vector<GroupPlace> places_;
  bool part_begins_ = false;
  std::size_t last_added_ = 0;  // the newest frame that is not tied
  SurfelStore newest_;          // the surfels of the last group, found by place
};

}  // namespace depthgrid
