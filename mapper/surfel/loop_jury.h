// Which loops of a joint adjustment are believed (docs/math.md, "Joint adjustment").
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/surfel/group_links.h"

namespace depthgrid {

// The worst loop may be what makes others look wrong, so those that are half as bad or worse are
// taken out first, all adjusted again, and so on; then what fits without them comes back.
class LoopJury {
 public:
  // A loop farther than `max_sigmas` from the adjusted poses is taken out.
  LoopJury(const std::vector<GroupLink>& loops, double max_sigmas)
      : loops_(loops),
        max_sigmas_(max_sigmas),
        accepted_(loops.size(), true),
        came_back_(loops.size(), false) {}

  // One for each loop.
  const std::vector<bool>& accepted() const { return accepted_; }

  // Judges the loops by where the accepted ones have adjusted the groups to. True when these are
  // others now, so that all must be adjusted again; false when that was the last word, as it is
  // when one on trial is the worst.
  bool Changes(const std::vector<Pose2>& map_from_group);

 private:
  std::size_t WorstAccepted(const std::vector<double>& sigmas) const;
  bool TakeBack(const std::vector<double>& sigmas);

  const std::vector<GroupLink>& loops_;
  double max_sigmas_;
  std::vector<bool> accepted_;
  std::vector<bool> came_back_;  // each may once, so that it ends
};

}  // namespace depthgrid
