// Rejects loops that do not fit a joint adjustment (docs/math.md, "Joint adjustment").
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/surfel/group_links.h"

namespace depthgrid {

// The worst loop may make others look wrong. So the worst is rejected together with those at least
// half as bad, all is adjusted again, and so on; then rejected loops that now fit are accepted
// again, once.
class LoopJury {
 public:
  // A loop farther than `max_sigmas` from the adjusted poses is rejected.
  LoopJury(const std::vector<GroupLink>& loops, double max_sigmas)
      : loops_(loops),
        max_sigmas_(max_sigmas),
        accepted_(loops.size(), true),
        came_back_(loops.size(), false) {}

  // One for each loop.
  const std::vector<bool>& accepted() const { return accepted_; }

  // Judges the loops at poses adjusted with the accepted ones. True when the accepted loops
  // changed, so that all must be adjusted again; false when the decision is final, as when the
  // worst loop is one on trial.
  bool ReviseAccepted(const std::vector<Pose2>& map_from_group);

 private:
  std::size_t WorstAccepted(const std::vector<double>& sigmas) const;
  bool TakeBack(const std::vector<double>& sigmas);

  const std::vector<GroupLink>& loops_;
  double max_sigmas_;
  std::vector<bool> accepted_;
  std::vector<bool> came_back_;  // once per loop, so that the process terminates
};

}  // namespace depthgrid
