// Whether the depth images of a recording fit the poses given for them; and if not, how the poses
// would have to be read, or what the camera would have to be, so that they do (docs/formats.md,
// "Poses that do not fit their images").
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/recording.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

// Two images that show much of the same, by their stamps.
struct ImagePair {
  double first_s = 0.0;
  double second_s = 0.0;
  std::shared_ptr<const DepthImage> first;
  std::shared_ptr<const DepthImage> second;
};

// Other ways to mean poses than they are read.
enum class PoseReading {
  kWFirst,           // rows are t x y z qw qx qy qz
  kInverse,          // they map the world to the camera
  kBodyAxes,         // of a robot's axes at the camera: x forward, y left, z up
  kGlAxes,           // of a camera with x right, y up, z backward
  kShifted,          // their clock is another than the images'
  kScaled,           // their unit of length is another than the images'
  kPitched,          // of axes from which the camera is pitched
  kPitchedBodyAxes,  // of a robot's axes from which the camera is pitched
  kFocal,            // right, of a camera with other fx and fy
  kImageSize,        // right, of a camera with other fx, fy, cx and cy: for images of another size
};

struct PoseDoubt {
  PoseReading reading = PoseReading::kWFirst;  // with which the images fit
  double time_offset_s = 0.0;                  // RecordingOptions' own, with which they fit
  double time_unsure_s = 0.0;                  // so much to either side fits alike
  // The poses' positions (kScaled), the focal lengths (kFocal) or all four of the camera's numbers
  // (kImageSize) times this fit the images.
  double scale = 1.0;
  double down_rad = 0.0;  // so far the camera looks below the axes' level (kPitched...)
  // Means of MisfitOf over the pairs, with the poses as given and as they would fit.
  double misfit = 0.0;
  double better_misfit = 0.0;
};

// The images to check poses by, two a pair, spread over the recording: each with the first one half
// a second later. None across a pause.
std::vector<RecordedImage> PairsAmong(std::span<const RecordedImage> images);

// How far the surfaces of one image lie from where the other one has them, as a share of their
// depth: the median over what both show, 1 where that is next to nothing.
double MisfitOf(const ImagePair& pair, const PinholeCamera& camera, const Pose3& second_from_first);

using PoseChange = std::function<Pose3(const Pose3&)>;

// Nothing where the poses fit, where no other reading of them fits clearly better, or where there
// are too few pairs to tell. `live` is not levelled yet; `as_written` takes a pose of it back to
// what the file said, and is its own inverse (FlipY).
std::optional<PoseDoubt> DoubtOfPoses(
    const std::vector<ImagePair>& pairs, const PinholeCamera& camera,
    const std::vector<SlamPose>& live, const RecordingOptions& options,
    const PoseChange& as_written = [](const Pose3& pose) { return pose; });

}  // namespace depthgrid
