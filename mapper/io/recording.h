// A recorded depth sequence as a frame source: a list of image files with stamps, a camera and
// poses. Readers of the folder layouts (TUM, frame folder, ICL-NUIM) only make the list.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/frame_names.h"
#include "mapper/io/frame_part.h"
#include "mapper/io/png.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

struct RecordedImage {
  double stamp_s = 0.0;     // stamp of the frame and its pose
  std::string depth_path;   // empty: the frame has no image
  std::int64_t number = 0;  // number in the original recording, see FrameNames
};

struct Recording {
  std::string name;  // the folder, for warnings
  std::vector<RecordedImage> images;
  CameraFile camera;
  std::vector<std::string> warnings;  // found while listing
  FramePart part = {};                // the images that are read and become frames
  // The poses are not the folder's own: their reader told if most of the frames have none.
  bool poses_given = false;
};

FramePart FindPart(const PartOptions& part, const Recording& recording);
std::span<const RecordedImage> ImagesOfPart(const Recording& recording);

// The recording with its images replaced.
Recording WithImages(Recording recording, std::vector<RecordedImage> images);

// With the stamps as recorded plus the options' offset.
FrameNames NamesOf(const Recording& recording, const RecordingOptions& options = {});

// Reads one depth image; throws InputError. Called on several threads at once.
using DepthReader = std::function<DepthImage(const std::string& path)>;

// 16-bit PNG images.
DepthReader PngDepthReader(const DepthPngFormat& format);

// The depth format of a recording's PNG images.
DepthPngFormat DepthFormatOf(const CameraFile& camera, const RecordingOptions& options);

// Sets an unknown image size to that of the part's first readable PNG. Throws InputError if the
// camera has several sizes and none of them is this.
void CompleteSize(const Recording& recording, CameraDescription& camera);

// Frames of the recording's part in its order, without the camera's distortion, numbered as in the
// whole recording. Images that are missing, damaged or of the wrong size become frames with a pose
// only and are counted, as do repeated images while the camera moved (FrozenImages); loops with an
// end outside the part are left out. Throws InputError when there is no image, when none of the
// first images can be read, when their size is not the camera's, or when no image has a pose. With
// more than one core the next few images are read on other threads while the caller processes a
// frame; results are the same.
std::unique_ptr<FrameSource> OpenRecording(Recording recording, const SlamOutput& slam,
                                           const RecordingOptions& options, DepthReader reader);

}  // namespace depthgrid
