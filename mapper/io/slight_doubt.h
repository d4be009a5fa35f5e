// Slight errors of a recording whose poses fit its images: of the focal length, of the scale of
// depth and of the poses' clock. Each is found to a fraction of its effect, with its standard
// deviation (docs/formats.md, "Poses that do not fit their images").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/pose_doubt.h"
#include "mapper/io/pose_fits.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

// The one of kFocal, kScaled and kShifted that reduces the misfit most, among those that are off by
// more than 1 % or a third of a frame and by more than five standard deviations.
std::optional<PoseDoubt> SlightDoubtOf(const PoseFits& fits, const PinholeCamera& camera,
                                       const std::vector<SlamPose>& live,
                                       const RecordingOptions& options);

// A shift of the poses' stamps, with its standard deviation.
struct FineShift {
  double shift_s = 0.0;
  double sigma_s = 0.0;
};
// The one that fits best, sought some frames to either side of `around_s`. Nothing with poses
// slower than 10 Hz, too few pairs or no least misfit there.
std::optional<FineShift> FineShiftAround(const PoseFits& fits, const PinholeCamera& camera,
                                         const std::vector<SlamPose>& live, double around_s);

}  // namespace depthgrid
