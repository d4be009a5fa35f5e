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

// For each frame, whether its pose equals its neighbours' bit for bit while half of the depths
// changed since the first of them, or until the last of them where no pose differed before.
// Somebody who fills the view of a standing camera has the same effect. Also held are all but the
// first frames of each pose where nearly every pose of the moving camera is given more than once,
// whatever the images show. Nothing is held where all poses are equal. Of the images only those of frames with equal poses are asked for, and few.
std::vector<bool> HeldFrames(const std::vector<std::optional<Pose3>>& slam_from_camera,
                             const ImageOfFrame& image);

}  // namespace depthgrid
