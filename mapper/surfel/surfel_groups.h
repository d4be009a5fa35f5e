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

  void Visit(OptionsVisitor& v);
};

struct SurfelGroup {
  int first_frame = 0;  // index into the mapped frames
  int frames = 0;
  Pose2 map_from_group;         // the group's axes are those of its first frame
  std::vector<Surfel> surfels;  // in them
};

// Where a frame is in its group.
struct GroupPlace {
  int group = 0;
  Pose2 group_from_base;
};

class SurfelGroups {
 public:
  explicit SurfelGroups(const SurfelGroupOptions& options) : options_(options) {}

  // The next frame.
  void Add(const std::vector<Surfel>& pieces, const Pose2& map_from_base);
  const std::vector<SurfelGroup>& groups() const { return groups_; }
  const std::vector<GroupPlace>& places() const { return places_; }  // one a frame
  // Corrected poses, one a frame. What the groups saw does not change.
  void MoveTo(const std::vector<Pose2>& map_from_base);

 private:
  bool Ends(const Pose2& group_from_base) const;

  SurfelGroupOptions options_;
  std::vector<SurfelGroup> groups_;
  std::vector<GroupPlace> places_;
  SurfelStore newest_;  // the surfels of the last group, found by place
};

}  // namespace depthgrid
