// Options for opening a recorded sequence.
#pragma once

#include <string>

#include "mapper/core/options.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/frame_part.h"
#include "mapper/io/recording_options.h"
#include "mapper/io/world_up.h"

namespace depthgrid {

enum class SequenceFormat { kAuto, kTum, kIcl, kFrames, kCarmen };

struct SequenceOptions {
  SequenceFormat format = SequenceFormat::kAuto;
  // The axis of the poses' world that points up. `auto` finds it from the floor seen in the images
  // and, where none is seen, takes z (-y for ICL-NUIM).
  WorldUp world_up = WorldUp::kAuto;
  std::string camera;  // a camera file in place of the folder's own
  // A file with the camera's place on the body whose poses the recording's own are
  // (camera_mount.h); empty: they are the camera's. For poses from elsewhere: SlamReading::mount.
  std::string camera_mount;
  // The part of the frames to read, numbered as in the whole recording. What does not concern
  // single frames (order of poses, up) is found from the whole recording, so that its parts share a
  // world and fit its other files.
  PartOptions part;
  RecordingOptions recording;
  CarmenLogOptions laser;

  void Visit(OptionsVisitor& v);
};

std::string NameOf(SequenceFormat format);

}  // namespace depthgrid
