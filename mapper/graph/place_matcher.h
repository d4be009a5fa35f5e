// Two places laid over each other: where they fit, and whether that can be trusted.
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

  // Searches so far around where the frames are. Empty: not the same place, or not known where in
  // it.
  std::optional<PlanarLoop> LoopBetween(const std::vector<MappedFrame>& frames, int first,
                                        int second, double half_m, double half_rad) const;

  // The same of places that were asked for before.
  std::optional<PlanarLoop> LoopBetween(const std::vector<MappedFrame>& frames, KnownPlace& first,
                                        KnownPlace& second, double half_m, double half_rad) const;

  // A place found by other means: laid over precisely and tested like a loop. The places are those
  // of the members, in axes of the loop's two frames.
  std::optional<PlanarLoop> Confirmed(const std::vector<MappedFrame>& frames,
                                      const std::vector<int>& first_members,
                                      const std::vector<int>& second_members, PlanarLoop loop,
                                      double min_agreement) const;

 private:
  // Whether a loop can still be believed, given its first_from_second after so many steps.
  using MayStill = std::function<bool(const Pose2&, std::size_t)>;
  bool Refine(const std::vector<MappedFrame>& frames, SurfelMap& first_map,
              const std::vector<int>& second_members, const MayStill& may_agree,
              PlanarLoop& loop) const;
  // Whether what both saw agrees by this share of what is possible.
  bool Agree(const std::vector<MappedFrame>& frames, KnownPlace& first, KnownPlace& second,
             const Pose2& first_from_second, double share) const;

  LoopSearchOptions options_;
  OverlapOptions overlap_;
};

}  // namespace depthgrid
