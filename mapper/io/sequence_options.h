// What kind of recorded sequence it is and how it is read.
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
  // Which of its frames are given, numbered as in the whole recording. All that is not of single
  // frames (poses' order, up) is found from the whole, so that parts of one recording share a world
  // and fit its other files.
  PartOptions part;
  RecordingOptions recording;
  CarmenLogOptions laser;

  void Visit(OptionsVisitor& v);
};

std::string NameOf(SequenceFormat format);

}  // namespace depthgrid
