// Up and the floor as the images of a recording show them, and how they are said.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "mapper/core/slam_output.h"
#include "mapper/io/gravity.h"
#include "mapper/io/recording.h"

namespace depthgrid {

// From a few images spread over the recording, and some of its first. Nothing where no floor is
// seen or the recording cannot be opened.
std::optional<Gravity> FindGravity(const Recording& recording, const SlamOutput& slam,
                                   const DepthReader& reader, const RecordingOptions& options);

// Up as the floor in the images has it, one of the axes where it is near enough to one.
Eigen::Vector3d SnappedUp(const Gravity& gravity);

// "z" or "(0.000, 0.707, 0.707)".
std::string ShownUp(const Eigen::Vector3d& up);

}  // namespace depthgrid
