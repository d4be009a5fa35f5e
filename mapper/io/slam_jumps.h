// Where SLAM corrected itself, read off its trajectories when it does not say so: a step of the
// live poses that the revised trajectory, or the motion around it, does not know.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/slam_output.h"

namespace depthgrid {

// Positions in `live` (one an input frame) whose pose is not reached from the posed one before by
// motion: the step differs by a jump from the revised trajectory's (which may be empty) or from the
// steps around it. ORB-SLAM2's own small corrections are a few centimetres, closed loops tenths of
// a metre.
std::vector<int> FindJumps(const std::vector<SlamPose>& live, const Trajectory& final);

// The loops that explain the jumps: the frame after a jump and the place it had been before, where
// the revised trajectory brings both together. Ordered by the frame that reports them.
std::vector<LoopClosure> LoopsFromRevision(const std::vector<SlamPose>& live,
                                           const Trajectory& final, const std::vector<int>& jumps);

// The usual of the speeds between one pose and the next, where nothing on wheels or legs is so fast
// and they are enough to tell.
std::optional<double> ImpossibleSpeedMps(std::vector<double> speeds_mps);

// What to say when most steps jump or are faster than a car, as poses in millimetres or of another
// recording are; nothing for others.
std::optional<std::string> DoubtOf(const std::vector<SlamPose>& live,
                                   const std::vector<int>& jumps);

// Begins a new epoch at each of the positions.
void StartEpochs(const std::vector<int>& jumps, std::vector<SlamPose>& live);

}  // namespace depthgrid
