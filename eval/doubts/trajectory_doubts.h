// Warnings about an estimated trajectory whose errors may have another cause than SLAM, one line
// each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/metrics/association.h"
#include "eval/metrics/trajectory_metrics.h"

namespace depthgrid {

// Names for messages to the user.
struct TrajectoryNames {
  std::string reference;
  std::string estimate;
};

// The rule that an estimate breaks which shares no stamp with a reference of this name, with the
// time that each covers: "shares no stamp with truth.txt (within 0.01 s): it is from ...".
std::string SpansApart(const Trajectory& reference, const Trajectory& estimate,
                       const std::string& reference_name, double limit_s);

// Warns of an estimate that stands still, is reversed in time, has another scale, or has other axes
// or another order of quaternions than the reference.
std::vector<std::string> DoubtsOfPairs(const std::vector<PosePair>& pairs,
                                       const TrajectoryNames& names);
// Warns of an estimate that covers only a part of the reference's time.
std::vector<std::string> DoubtsOfTime(const TrajectoryScore& score, const TrajectoryNames& names);
// Warns of an estimate that fits the reference in space but not in the plane.
std::optional<std::string> DoubtOfPlane(const TrajectoryScore& score,
                                        const std::vector<PosePair>& pairs,
                                        const TrajectoryNames& names);
// The units of an estimate that fits the reference a thousand or a hundred times as large or as
// small: "millimetres where truth.txt is in metres". Empty for other scales, and where the
// reference hardly moves.
std::optional<std::string> OtherUnits(const std::vector<PosePair>& pairs,
                                      const TrajectoryNames& names);
// Warns of stamps from another clock or poses of another point of the robot, whichever fits better.
// `added_s` has already been added to the estimate's stamps.
std::vector<std::string> DoubtsOfClock(const Trajectory& reference, const Trajectory& estimate,
                                       const TrajectoryNames& names, double added_s = 0.0);

}  // namespace depthgrid
