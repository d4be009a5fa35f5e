// Representations of a place for matching it with others, each computed on first use and cached: a
// search needs them again for every candidate.
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
// The members' scans as surfels.
SurfelMap SurfelsOfPlace(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                         int middle);

// Always pass the frames that the place was constructed with (more may have been appended).
class KnownPlace {
 public:
  KnownPlace(const std::vector<MappedFrame>& frames, int middle, const PlaceOptions& place,
             const OverlapOptions& overlap)
      : KnownPlace(frames, middle, place, overlap, static_cast<int>(frames.size())) {}
  // The place as of before frame `end`.
  KnownPlace(const std::vector<MappedFrame>& frames, int middle, const PlaceOptions& place,
             const OverlapOptions& overlap, int end);

  // False if made of other frames, or if their poses differ.
  bool operator==(const KnownPlace& other) const {
    return middle_ == other.middle_ && members_ == other.members_ && seen_by_ == other.seen_by_ &&
           poses_ == other.poses_;
  }
  int middle() const { return middle_; }
  const std::vector<int>& members() const { return members_; }

  // `frames` as given to the constructor, or more of them.
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
  std::vector<Pose2> poses_;  // of the middle, the members and seen_by_
  std::optional<WallPyramid> walls_;
  std::optional<std::vector<Eigen::Vector2d>> points_;
  std::unique_ptr<SurfelMap> surfels_;
  std::optional<SeenPlace> seen_;
  double with_itself_ = 0.0;  // agreement, valid with seen_
};

// Cache of the places used last.
class KnownPlaces {
 public:
  KnownPlace& Of(KnownPlace place);

 private:
  static constexpr std::size_t kMost = 4;  // neighbouring searches share two places of three
  std::deque<KnownPlace> places_;          // the newest last
};

}  // namespace depthgrid
