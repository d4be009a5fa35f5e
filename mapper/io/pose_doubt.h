// What is doubted of a recording's poses or camera, and how they would fit its images.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mapper/io/pose_misfit.h"

namespace depthgrid {

// Other interpretations of the poses or the camera.
enum class PoseReading {
  kWFirst,           // rows are t x y z qw qx qy qz
  kWLast,            // rows that were read so are t x y z qx qy qz qw
  kInverse,          // the poses are camera_from_world
  kPositions,        // positions and rotations are in different world axes
  kYUp,              // for a camera whose y axis points up (negative fy)
  kYDown,            // for a camera whose y axis points down (positive fy)
  kAxes,             // for a body with other axes at the camera's position
  kShifted,          // the poses' clock is offset from the images'
  kScaled,           // the poses' unit of length differs from the images'
  kPitched,          // for axes relative to which the camera is pitched
  kPitchedBodyAxes,  // for a robot's axes relative to which the camera is pitched
  kFocal,            // poses are right, the camera has other fx and fy
  kImageSize,        // poses are right, the camera is for another image size
  kCentre,           // poses are right, the camera has other cx and cy (another crop)
  kRayLengths,       // poses are right, the images store ray lengths
  kStanding,         // no reading fits: all positions are equal
  kUnturned,         // no reading fits: all rotations are equal
  kNone,             // none fits
};

struct PoseDoubt {
  PoseReading reading = PoseReading::kWFirst;  // the reading with which the images fit
  double time_offset_s = 0.0;                  // the RecordingOptions::time_offset_s that fits
  // Offsets this much to either side fit equally, or its standard deviation if that is more.
  double time_unsure_s = 0.0;
  // The factor of the poses' positions (kScaled), of the focal lengths (kFocal) or of all four
  // intrinsics (kImageSize) that fits the images.
  double scale = 1.0;
  // Standard deviation of a factor's logarithm, or of the time offset in seconds, where the poses
  // fit and are slightly off (slight_doubt.h); else 0.
  double sigma = 0.0;
  // The camera's cx and cy that fit the images (kCentre).
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  // kPositions: world_from_positions. kAxes: camera_from_pose.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double down_rad = 0.0;  // pitch of the camera below the axes' level (kPitched...)
  // Means of MisfitOf over the pairs, with the poses as given and with the (nearly) fitting
  // reading.
  double misfit = 0.0;
  double better_misfit = 0.0;
  // kNone: what most of the points show where they keep their depth from one image to the next;
  // empty where fewer do.
  std::optional<KeptDepth> kept;
};

}  // namespace depthgrid
