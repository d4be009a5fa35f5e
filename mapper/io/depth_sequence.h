// A folder of depth images of any layout: its images, their reader, and the poses in the folder's
// own world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/slam_output.h"
#include "mapper/io/recording.h"
#include "mapper/io/sequence_options.h"
#include "mapper/io/world_up.h"

namespace depthgrid {

// The camera's y axis points down.
struct DepthSequence {
  Recording recording;
  DepthReader reader;
  SlamOutput slam;
  WorldUp usual_up = WorldUp::kZ;
  bool y_up = false;               // the poses were turned by FlipY
  Pose3 body_from_camera;          // the poses of a body were multiplied by it
  std::vector<std::string> notes;  // findings about it, one line each
};

// Lists only the images, and which are in the part. `format` is one of images. Throws InputError.
Recording ListDepthImages(const std::string& path, SequenceFormat format,
                          const SequenceOptions& options);

// Reads a folder as OpenSequence does, but without finding up. The robot is removed from the images
// unless `options` keeps it. `slam`, if given, has the camera's poses; the folder's own may be a
// body's (options.camera_mount). `format`, one of images, replaces `options.format`. Throws
// InputError.
DepthSequence ReadDepthSequence(const std::string& path, SequenceFormat format,
                                const SequenceOptions& options = {},
                                const std::optional<SlamOutput>& slam = {});

}  // namespace depthgrid
