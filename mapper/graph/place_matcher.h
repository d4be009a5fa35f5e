// Two places laid over each other: where they fit, and whether that can be trusted.
#pragma once

#include <optional>
#include <vector>

#include "mapper/graph/loop_search_options.h"
#include "mapper/reference_map.h"

namespace depthgrid {

class PlaceMatcher {
 public:
  PlaceMatcher(const LoopSearchOptions& options, const OverlapOptions& overlap)
      : options_(options), overlap_(overlap) {}

  // Searches so far around where the frames are. Empty: not the same place, or not known where in
  // it.
  std::optional<PlanarLoop> LoopBetween(const std::vector<MappedFrame>& frames, int first,
                                        int second, double half_m, double half_rad) const;

  // A place found by other means: laid over precisely and tested like a loop. The places are those
  // of the members, in axes of the loop's two frames.
  std::optional<PlanarLoop> Confirmed(const std::vector<MappedFrame>& frames,
                                      const std::vector<int>& first_members,
                                      const std::vector<int>& second_members, PlanarLoop loop,
                                      double min_agreement) const;

 private:
  bool Refine(const std::vector<MappedFrame>& frames, const std::vector<int>& first_members,
              const std::vector<int>& second_members, PlanarLoop& loop) const;

  LoopSearchOptions options_;
  OverlapOptions overlap_;
};

}  // namespace depthgrid
