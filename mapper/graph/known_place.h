// What is made of a place to lay it over others, each part made when it is first asked for: a
// search asks the same of a place for each of the places it could be.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/graph/loop_overlap.h"
#include "mapper/graph/place.h"
#include "mapper/graph/place_search.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid {

// A scan of a place, cut once for all matches.
struct CutScan {
  Pose2 place_from_base;
  std::vector<Surfel> pieces;
};
std::vector<CutScan> CutScans(SurfelMap& map, const std::vector<MappedFrame>& frames,
                              const std::vector<int>& members, int middle);
// What the members saw, as surfels.
SurfelMap SurfelsOfPlace(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                         int middle);

// Frames are those that the place was asked for with, for as long as the place lives.
class KnownPlace {
 public:
  KnownPlace(const std::vector<MappedFrame>& frames, int middle, const PlaceOptions& place,
             const OverlapOptions& overlap)
      : KnownPlace(frames, middle, place, overlap, static_cast<int>(frames.size())) {}
  // As it was before frame `end`.
  KnownPlace(const std::vector<MappedFrame>& frames, int middle, const PlaceOptions& place,
             const OverlapOptions& overlap, int end);

  // Whether it is made of other frames, or they lie otherwise.
  bool operator==(const KnownPlace& other) const {
    return middle_ == other.middle_ && members_ == other.members_ && seen_by_ == other.seen_by_ &&
           poses_ == other.poses_;
  }
  int middle() const { return middle_; }
  const std::vector<int>& members() const { return members_; }

  // `frames` as given at first, or more of them.
  const WallPyramid& Walls(const std::vector<MappedFrame>& frames);
  const std::vector<Eigen::Vector2d>& Points(const std::vector<MappedFrame>& frames);
  const SurfelMap& Surfels(const std::vector<MappedFrame>& frames);
  const SeenPlace& Seen(const std::vector<MappedFrame>& frames);
  double AgreementWithItself(const std::vector<MappedFrame>& frames);

 private:
  PlaceOptions place_;
  OverlapOptions overlap_;
  int middle_;
  std::vector<int> members_, seen_by_;
  std::vector<Pose2> poses_;  // of the middle, the members and those it was seen by
  std::optional<WallPyramid> walls_;
  std::optional<std::vector<Eigen::Vector2d>> points_;
  std::unique_ptr<SurfelMap> surfels_;
  std::optional<SeenPlace> seen_;
  double with_itself_ = 0.0;  // agreement, once seen
};

// The places that were asked for last.
class KnownPlaces {
 public:
  KnownPlace& Of(KnownPlace place);

 private:
  static constexpr std::size_t kMost = 4;  // neighbouring searches share two places of three
  std::deque<KnownPlace> places_;          // the newest last
};

}  // namespace depthgrid
