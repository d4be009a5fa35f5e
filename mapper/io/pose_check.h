// Checks whether the depth images of a recording fit their poses, and if not, under which other
// convention of the poses or other camera they would (docs/formats.md, "Poses that do not fit their
// images").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/pose_doubt.h"
#include "mapper/io/pose_misfit.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

// Nothing if the poses fit, or fit moderately, while no other reading is clearly better and none is
// slightly off (slight_doubt.h), or with too few pairs. `live` is not levelled yet; `y_up`: FlipY
// was applied, as for a camera with negative fy.
std::optional<PoseDoubt> DoubtOfPoses(const std::vector<ImagePair>& pairs,
                                      const PinholeCamera& camera,
                                      const std::vector<SlamPose>& live,
                                      const RecordingOptions& options, bool y_up = false);

}  // namespace depthgrid
