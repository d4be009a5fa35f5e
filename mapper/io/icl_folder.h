// ICL-NUIM folders: depth/<n>.png (as its TUM-compatible downloads) or scene_00_<n>.depth (as
// rendered: the length of each ray, in text), with *.gt.freiburg or *.gt.sim (docs/formats.md,
// "ICL-NUIM folder").
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "mapper/core/frame.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/recording.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

bool IsIclFolder(const std::string& folder);

// Lists the images; their stamps are their numbers, as in the .gt.freiburg files.
Recording ListIclFolder(const std::string& folder);

// The folder's own poses, as written: of a camera whose y axis points up. What was mended is added
// to the recording's warnings.
SlamOutput ReadIclPoses(const std::string& folder, Recording& recording);

// ICL-NUIM's camera, unless the folder has a camera.yaml.
CameraDescription IclCamera(const std::string& folder, std::vector<std::string>& warnings);

// Ray lengths as text, in metres or (as the office's) centimetres, to z-depth. Throws InputError.
DepthImage ParseRayLengths(const std::string& text, const PinholeCamera& camera,
                           const std::string& place);

// Reads either kind of depth image.
DepthReader IclDepthReader(const CameraFile& camera, const RecordingOptions& options);

// The frames with the folder's own poses or with `slam`, which are turned by FlipY when the camera
// has a negative fy, so that the world's up is -y.
std::unique_ptr<FrameSource> OpenIclFolder(const std::string& folder,
                                           const std::optional<SlamOutput>& slam = {},
                                           const RecordingOptions& options = {},
                                           const std::string& camera_path = {});

}  // namespace depthgrid
