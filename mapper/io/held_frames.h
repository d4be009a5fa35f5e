// Detects poses of a recording that stay the same while its images move, as from a tracker that was
// lost, has not begun yet or is read more often than it answers: the true poses are unknown.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// Frame i's image; null if it cannot be read.
using ImageOfFrame = std::function<std::shared_ptr<const DepthImage>(std::size_t)>;

// For each frame, whether its pose equals its neighbours' bit for bit though it should not. Either
// four frames or more have one pose while half of the depths changed by 5 cm and twice what noise
// changes since the first of them, or until the last of them where no pose differed before: then
// all but that one, or, if the camera stood for more than four frames, those since. Somebody who
// fills the view of a standing camera has the same effect. Or nearly every pose of the moving
// camera is given more than once: all but the first frame of each. Nothing is held where all poses
// are equal. Images are asked for, several times, none from frame `end` on and none before frame
// `first` but those of its pose, only of frames with equal poses.
std::vector<bool> HeldFrames(const std::vector<std::optional<Pose3>>& slam_from_camera,
                             std::size_t first, std::size_t end, const ImageOfFrame& image);

}  // namespace depthgrid
