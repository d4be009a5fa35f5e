// ICL-NUIM folders: depth/<n>.png (as its TUM-compatible downloads) or scene_00_<n>.depth (as
// rendered: the length of each ray, in text), with *.gt.freiburg or *.gt.sim (docs/formats.md,
// "ICL-NUIM folder").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/recording.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

bool IsIclFolder(const std::string& folder);

// Lists the images; their stamps are their numbers, as in the .gt.freiburg files.
Recording ListIclFolder(const std::string& folder);

// The folder's own poses as written, for a camera whose y axis points up. Repairs are added to the
// recording's warnings.
SlamOutput ReadIclPoses(const std::string& folder, Recording& recording);

// ICL-NUIM's camera, unless the folder has a camera.yaml.
CameraDescription IclCamera(const std::string& folder, std::vector<std::string>& warnings);

// Ray lengths as text, row by row, in the file's unit. Throws InputError.
DepthImage ParseRayLengths(const std::string& text, const PinholeCamera& camera,
                           const std::string& place);

// Unit of an image's ray lengths in metres: 1, or 0.01 as in the office's files; 0 if it has no
// data.
double RayUnitM(const DepthImage& lengths);

// Reads either kind of depth image; the recording's camera must be set. The unit of all ray lengths
// is that of the part's first image with data.
DepthReader IclDepthReader(const Recording& recording, const RecordingOptions& options);

}  // namespace depthgrid
