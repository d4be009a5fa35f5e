// Finds up and the floor in the images of a recording, and formats them for messages.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "mapper/core/slam_output.h"
#include "mapper/io/gravity.h"
#include "mapper/io/recording.h"
#include "mapper/io/world_up.h"

namespace depthgrid {

// Uses a few images spread over the recording and some of its first. Nothing if no floor is seen or
// the recording cannot be opened.
std::optional<Gravity> FindGravity(const Recording& recording, const SlamOutput& slam,
                                   const DepthReader& reader, const RecordingOptions& options);

// The floor's normal, snapped to an axis if it may be that: to `usual_up`, in which level poses are
// told, if it is as near as images differ, to another if it is as near as their mean is sure.
Eigen::Vector3d SnappedUp(const Gravity& gravity, WorldUp usual_up);

// "z" or "(0.000, 0.707, 0.707)".
std::string ShownUp(const Eigen::Vector3d& up);

}  // namespace depthgrid
