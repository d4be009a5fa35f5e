// Poses that a source gives for several frames in a row.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/pose3.h"

namespace depthgrid {

// Frames from `begin` to before `end` that have one pose, bit for bit.
struct PoseRun {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

// Frames without a pose are in no run.
std::vector<PoseRun> PoseRunsOf(const std::vector<std::optional<Pose3>>& poses);

// Poses that are only read more often than they are made, as nearly every pose of the moving sensor
// then is: no robot moves in jerks throughout.
struct RepeatedPoses {
  std::size_t times = 1;  // each is given so often; 1: that is not so
  // All frames but the first of each pose from which the sensor moved on; if it had stood, only
  // those since the last time that a pose was made. Those of the last pose as well, unless it stood
  // then.
  std::vector<bool> held;
};
RepeatedPoses FindRepeated(const std::vector<PoseRun>& runs,
                           const std::vector<std::optional<Pose3>>& poses);

}  // namespace depthgrid
