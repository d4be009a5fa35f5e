// A folder of depth images of any layout, as it is written: its images, how they are read, and
// poses in the folder's own world.
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
  std::vector<std::string> notes;  // what was found out about it, a line each
};

// Its images alone, with those of the part. `format` is one of images. Throws InputError.
Recording ListDepthImages(const std::string& path, SequenceFormat format,
                          const SequenceOptions& options);

// As OpenSequence takes it, but for which way is up, and without the robot in its images unless
// `options` keeps it. `options.format` is not looked at, but `format`, one of images. Throws
// InputError.
DepthSequence ReadDepthSequence(const std::string& path, SequenceFormat format,
                                const SequenceOptions& options = {},
                                const std::optional<SlamOutput>& slam = {});

}  // namespace depthgrid
