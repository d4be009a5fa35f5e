#include "mapper/graph/known_place.h"

#include <algorithm>
#include <utility>

namespace depthgrid {

std::vector<CutScan> CutScans(SurfelMap& map, const std::vector<MappedFrame>& frames,
                              const std::vector<int>& members, int middle) {
  const Pose2 place_from_map = Inverse(FrameAt(frames, middle).map_from_base);
  std::vector<CutScan> scans;
  for (const int i : members) {
    const MappedFrame& frame = FrameAt(frames, i);
    scans.push_back({place_from_map * frame.map_from_base, map.Cut(*frame.scan)});
  }
  return scans;
}

SurfelMap SurfelsOfPlace(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                         int middle) {
  SurfelMap map(SurfelOptions{});
  for (const CutScan& scan : CutScans(map, frames, members, middle)) {
    map.InsertCut(scan.pieces, scan.place_from_base);
  }
  return map;
}

KnownPlace::KnownPlace(const std::vector<MappedFrame>& frames, int middle,
                       const PlaceOptions& place, const OverlapOptions& overlap, int end)
    : place_(place),
      overlap_(overlap),
      middle_(middle),
      members_(FramesAround(frames, middle, place, 0, end)),
      seen_by_(FramesOfPlace(frames, middle, overlap, end)) {
  poses_.push_back(FrameAt(frames, middle).map_from_base);
  for (const std::vector<int>* some : {&members_, &seen_by_}) {
    for (const int i : *some) poses_.push_back(FrameAt(frames, i).map_from_base);
  }
}

const WallPyramid& KnownPlace::Walls(const std::vector<MappedFrame>& frames) {
  if (!walls_) walls_.emplace(DrawPlace(frames, members_, middle_, place_.resolution_m));
  return *walls_;
}

const std::vector<Eigen::Vector2d>& KnownPlace::Points(const std::vector<MappedFrame>& frames) {
  if (!points_) points_ = PointsOfPlace(frames, members_, middle_, place_.resolution_m);
  return *points_;
}

const SurfelMap& KnownPlace::Surfels(const std::vector<MappedFrame>& frames) {
  if (!surfels_) surfels_ = std::make_unique<SurfelMap>(SurfelsOfPlace(frames, members_, middle_));
  return *surfels_;
}

const SeenPlace& KnownPlace::Seen(const std::vector<MappedFrame>& frames) {
  if (!seen_) {
    SeenInHalves seen = SeenInHalvesFrom(frames, seen_by_, middle_, overlap_);
    with_itself_ = OverlapWithItself(seen).agreement();
    seen_ = std::move(seen.all);
  }
  return *seen_;
}

double KnownPlace::AgreementWithItself(const std::vector<MappedFrame>& frames) {
  Seen(frames);
  return with_itself_;
}

KnownPlace& KnownPlaces::Of(KnownPlace place) {
  const auto found = std::find(places_.begin(), places_.end(), place);
  if (found != places_.end()) {
    KnownPlace known = std::move(*found);
    places_.erase(found);
    return places_.emplace_back(std::move(known));
  }
  if (places_.size() == kMost) places_.pop_front();
  return places_.emplace_back(std::move(place));
}

}  // namespace depthgrid
