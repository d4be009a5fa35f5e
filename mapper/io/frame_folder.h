// Folders with one depth image and one pose file per frame, as of 7-Scenes, 3DMatch and
// ScanNet-like exports (docs/formats.md, "Frame folder").
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
  Tally without_pose;       // single-pose files that are damaged or have no pose
  std::string poses_fault;  // of its list of poses, which counts if no others are given
  std::string camera_path;  // empty when the folder has none
};

// Whether the folder has numbered depth images. Poses may come from elsewhere.
bool IsFrameFolder(const std::string& folder);

// Throws InputError when there are no depth images.
FrameFolder ListFrameFolder(const std::string& folder, const RecordingOptions& options = {});

// The folder's own poses. Throws InputError when there are none, naming the fault of their list, or
// the first single-pose file and its fault, if any.
SlamOutput OwnPoses(const FrameFolder& folder);

// The folder's camera, or that of `camera_path` when not empty, with image size and depth scale
// filled in if its file lacks them. Throws InputError when there is none.
CameraDescription FrameFolderCamera(const FrameFolder& folder, const std::string& camera_path,
                                    std::vector<std::string>& warnings);

}  // namespace depthgrid
