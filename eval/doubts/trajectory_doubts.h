// What of an estimated trajectory makes its errors say something else than they seem to: a line
// each, for whoever scores it or fits a model to its errors.
#pragma once

#include <string>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

// How the two are named to the user.
struct TrajectoryNames {
  std::string reference;
  std::string estimate;
};

// An estimate that stands still, runs backwards, has another scale, or poses with other axes or
// another order of quaternions than the reference's.
std::vector<std::string> DoubtsOfPairs(const std::vector<PosePair>& pairs,
                                       const TrajectoryNames& names);
// Stamps of another clock, or poses of another point of the robot, whichever fits better; `added_s`
// were added to the estimate's stamps before.
std::vector<std::string> DoubtsOfClock(const Trajectory& reference, const Trajectory& estimate,
                                       const TrajectoryNames& names, double added_s = 0.0);

}  // namespace depthgrid
