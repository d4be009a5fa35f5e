// Matches two places and tests the result.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/known_place.h"
#include "mapper/graph/loop_search_options.h"

namespace depthgrid {

class PlaceMatcher {
 public:
  PlaceMatcher(const LoopSearchOptions& options, const OverlapOptions& overlap)
      : options_(options), overlap_(overlap) {}

  // Searches within half_m and half_rad of the current relative pose. Empty if they are not the
  // same place or the pose is ambiguous.
  std::optional<PlanarLoop> LoopBetween(const std::vector<MappedFrame>& frames, int first,
                                        int second, double half_m, double half_rad) const;

  // The same with cached places.
  std::optional<PlanarLoop> LoopBetween(const std::vector<MappedFrame>& frames, KnownPlace& first,
                                        KnownPlace& second, double half_m, double half_rad) const;

  // Refines and tests a loop found by other means. The places consist of the given members, in axes
  // of the loop's two frames.
  std::optional<PlanarLoop> Confirmed(const std::vector<MappedFrame>& frames,
                                      const std::vector<int>& first_members,
                                      const std::vector<int>& second_members, PlanarLoop loop,
                                      double min_agreement) const;

 private:
  // Whether a loop is still plausible, given first_from_second after a number of steps.
  using MayStill = std::function<bool(const Pose2&, std::size_t)>;
  bool Refine(const std::vector<MappedFrame>& frames, SurfelMap& first_map,
              const std::vector<int>& second_members, const MayStill& may_agree,
              PlanarLoop& loop) const;
  // Whether both places agree by `share`, relative to the lower of their agreements with
  // themselves.
  bool Agree(const std::vector<MappedFrame>& frames, KnownPlace& first, KnownPlace& second,
             const Pose2& first_from_second, double share) const;

  LoopSearchOptions options_;
  OverlapOptions overlap_;
};

}  // namespace depthgrid
