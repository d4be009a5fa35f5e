// Groups of nearby frames, which the joint adjustment moves as one.
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"
#include "mapper/core/options.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

struct SurfelGroupOptions {
  // A group ends when the sensor is this far from its start. Within it, relative poses are those of
  // the online estimate.
  double length_m = 0.15;
  double turn_deg = 6.0;
  // Spacing of a group's surfels along a wall.
  double spacing_m = 0.04;
  // With more groups, neighbouring ones are joined, and if that is not enough those of one place:
  // the cost of solving grows like the cube of their number where a wide view couples most of them
  // (docs/results.md, "A whole building").
  int most = 1000;

  void Visit(OptionsVisitor& v);
};

struct SurfelGroup {
  int first_frame = 0;          // index into the mapped frames
  int frames = 0;               // number of kept frames
  Pose2 map_from_group;         // the group's axes are those of its first frame
  std::vector<Surfel> surfels;  // in its axes
};

// A frame's group and its pose in it.
struct GroupPlace {
  int group = 0;
  Pose2 group_from_base;
};

// Properties of a group's start that decide to which earlier ones it may be joined.
struct GroupStart {
  bool apart = false;    // SLAM jumped or frames were tied between it and the previous one
  bool settled = false;  // its pose in the map is accurately known from a match with older surfels
  bool of_prior_map = false;
};
// Number of groups of a prior map.
int PriorGroups(const std::vector<GroupStart>& starts);

// Limits on the number of groups, kept as far as groups can be joined.
struct GroupLimits {
  int most = 0;
  int most_of_prior_map = 0;  // of these, a prior map's
  bool in_place = false;      // whether settled groups of one place are joined, whatever their time
};

// What joined groups contain: merging surfels takes most of the time.
enum class GroupContent { kSurfels, kPosesOnly };

class SurfelGroups {
 public:
  explicit SurfelGroups(const SurfelGroupOptions& options) : options_(options) {}

  // Adds the next frame to the newest group, or to a new one.
  void Add(const std::vector<Surfel>& pieces, const Pose2& map_from_base);
  // Adds the next frame as tied to an earlier one; its group's surfels do not change.
  void AddTied(int tied_to, const Pose2& map_from_base);
  // Moves the newest group by `motion`, in map axes. Does nothing to the first group, by which all
  // others are placed, and to one that the next frame does not continue.
  void MoveNewest(const Pose2& motion);
  // Makes the next frame begin a new group.
  void BeginPart() { part_begins_ = true; }
  const std::vector<SurfelGroup>& groups() const { return groups_; }
  const std::vector<GroupPlace>& places() const { return places_; }  // one per frame
  // Sets corrected poses, one per frame. The groups' surfels do not change.
  void MoveTo(const std::vector<Pose2>& map_from_base);
  // Drops the surfels of groups with frames that were led astray.
  void LeaveOutAstray(const std::vector<MappedFrame>& frames);
  // The same frames in fewer groups, within the limits as far as possible: joins consecutive
  // groups, and settled ones, such as a prior map's, with others of the same place.
  SurfelGroups Joined(const GroupLimits& limits, const std::vector<GroupStart>& starts,
                      GroupContent content = GroupContent::kSurfels) const;

 private:
  // Whether the pose is outside a group of `times` the usual length and turn.
  bool Ends(const Pose2& group_from_base, int times = 1) const;
  void Begin(int first_frame, const Pose2& map_from_group);
  // Merges surfels into the newest group.
  void Collect(const std::vector<Surfel>& surfels, const Pose2& group_from_surfels);
  // How groups are joined: along the path up to `times` their length, and by place.
  struct JoinRule {
    int times = 1;
    bool in_place = false;  // also by place, settled groups only
    int prior_times = 0;    // for groups of a prior map, joined by place; 0: like the others
  };
  // The joined groups, and for each original group its place in one of them.
  struct Joining {
    std::vector<SurfelGroup> groups;
    std::vector<GroupPlace> places;
  };
  Joining JoinedBy(const JoinRule& rule, const std::vector<GroupStart>& starts) const;
  Joining JoinedWithin(const GroupLimits& limits, const std::vector<GroupStart>& starts) const;
  // The nearest joined group within `times` the length and turn; -1: none.
  int NearestAround(const Pose2& map_from_group, const std::vector<SurfelGroup>& joined,
                    int times) const;
  SurfelGroups Filled(Joining joining, GroupContent content) const;
  SurfelGroups WithoutSurfels() const;

  SurfelGroupOptions options_;
  std::vector<SurfelGroup> groups_;
  std::vector<GroupPlace> places_;
  bool part_begins_ = false;
  std::size_t last_added_ = 0;  // the newest kept frame
  SurfelStore newest_;          // the surfels of the last group, with spatial index
};

}  // namespace depthgrid
