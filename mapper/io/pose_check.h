// Whether the depth images of a recording fit the poses given for them; and if not, how the poses
// would have to be read, or what the camera would have to be, so that they do (docs/formats.md,
// "Poses that do not fit their images").
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/pose_misfit.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

// Other ways to mean poses than they are read.
enum class PoseReading {
  kWFirst,           // rows are t x y z qw qx qy qz
  kInverse,          // they map the world to the camera
  kPositions,        // their positions are in other axes of the world than their rotations
  kYUp,              // of a camera whose y points up, as one with negative fy
  kYDown,            // of a camera whose y points down, as one with positive fy
  kAxes,             // of other axes at the camera than its own
  kShifted,          // their clock is another than the images'
  kScaled,           // their unit of length is another than the images'
  kPitched,          // of axes from which the camera is pitched
  kPitchedBodyAxes,  // of a robot's axes from which the camera is pitched
  kFocal,            // right, of a camera with other fx and fy
  kImageSize,        // right, of a camera with other fx, fy, cx and cy: for images of another size
  kCentre,           // right, of a camera with another cx and cy: for images cut otherwise
  kRayLengths,       // right, of images that hold the lengths of rays
  kStanding,         // none fits: all positions are the same
  kUnturned,         // none fits: all rotations are the same
  kNone,             // none fits
};

struct PoseDoubt {
  PoseReading reading = PoseReading::kWFirst;  // with which the images fit
  double time_offset_s = 0.0;                  // RecordingOptions' own, with which they fit
  double time_unsure_s = 0.0;                  // so much to either side fits alike
  // The poses' positions (kScaled), the focal lengths (kFocal) or all four of the camera's numbers
  // (kImageSize) times this fit the images.
  double scale = 1.0;
  // The camera's cx and cy that fit the images (kCentre).
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  // kPositions: the world's axes from those of the positions. kAxes: the camera's axes from the
  // poses' own.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double down_rad = 0.0;  // so far the camera looks below the axes' level (kPitched...)
  // Means of MisfitOf over the pairs, with the poses as given and as they would fit or nearly do.
  double misfit = 0.0;
  double better_misfit = 0.0;
};

// Nothing where the poses fit, where other readings of them fit hardly better and they do not fit
// badly, or where there are too few pairs to tell. `live` is not levelled yet; `y_up`: it was
// turned by FlipY, as for a camera with negative fy.
std::optional<PoseDoubt> DoubtOfPoses(const std::vector<ImagePair>& pairs,
                                      const PinholeCamera& camera,
                                      const std::vector<SlamPose>& live,
                                      const RecordingOptions& options, bool y_up = false);

}  // namespace depthgrid
