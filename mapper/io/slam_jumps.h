// Finds SLAM's corrections of itself in its trajectories when it does not report them: steps of the
// live poses that differ from the final trajectory or from the motion around them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/slam_output.h"

namespace depthgrid {

// Indices in `live` (one entry per input frame) where the step from the previous pose differs by a
// jump from the same step of the final trajectory (which may be empty) or from the steps around it.
// ORB-SLAM2's small corrections are a few centimetres, closed loops tenths of a metre.
std::vector<int> FindJumps(const std::vector<SlamPose>& live, const Trajectory& final);

// The loops that explain the jumps: between the frame after a jump and an earlier frame near it in
// the final trajectory. Ordered by the frame that reports them.
std::vector<LoopClosure> LoopsFromRevision(const std::vector<SlamPose>& live,
                                           const Trajectory& final, const std::vector<int>& jumps);

// The typical speed between successive poses if it is impossible for anything on wheels or legs;
// nothing otherwise or with too few speeds.
std::optional<double> ImpossibleSpeedMps(std::vector<double> speeds_mps);

// A message if most steps jump or are faster than a car, as with poses in millimetres or of another
// recording; nothing otherwise.
std::optional<std::string> DoubtOf(const std::vector<SlamPose>& live,
                                   const std::vector<int>& jumps);

// Starts a new epoch at each of the indices.
void StartEpochs(const std::vector<int>& jumps, std::vector<SlamPose>& live);

}  // namespace depthgrid
