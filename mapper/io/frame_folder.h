// Folders with a depth image and a pose a frame, as 7-Scenes, 3DMatch and ScanNet-like exports have
// them (docs/formats.md, "Frame folder").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/damage.h"
#include "mapper/io/recording.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

struct FrameFolder {
  Recording recording;      // without a camera
  SlamOutput poses;         // the folder's own
  Tally without_pose;       // of files of one pose each, those that are damaged or hold none
  std::string camera_path;  // empty when the folder has none
};

// Whether the folder looks like one: numbered depth images. Poses may be a file's elsewhere.
bool IsFrameFolder(const std::string& folder);

// Throws InputError when there are no depth images.
FrameFolder ListFrameFolder(const std::string& folder, const RecordingOptions& options = {});

// The folder's own poses. Throws InputError when there are none, with the first file and what is
// wrong there when files of one pose each hold none.
SlamOutput OwnPoses(const FrameFolder& folder);

// The folder's camera, or that of `camera_path` when not empty, with what its file leaves open
// (image size, depth scale) filled in. Throws InputError when there is none.
CameraDescription FrameFolderCamera(const FrameFolder& folder, const std::string& camera_path,
                                    std::vector<std::string>& warnings);

}  // namespace depthgrid
