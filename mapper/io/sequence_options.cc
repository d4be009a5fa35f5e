#include "mapper/io/sequence_options.h"

namespace depthgrid {

void SequenceOptions::Visit(OptionsVisitor& v) {
  v.Choice("format", format,
           {{SequenceFormat::kAuto, "auto"},
            {SequenceFormat::kTum, "tum"},
            {SequenceFormat::kIcl, "icl"},
            {SequenceFormat::kFrames, "frames"},
            {SequenceFormat::kCarmen, "carmen"}},
           "kind of the recorded sequence");
  v.Choice("world_up", world_up,
           {{WorldUp::kAuto, "auto"},
            {WorldUp::kX, "x"},
            {WorldUp::kMinusX, "-x"},
            {WorldUp::kY, "y"},
            {WorldUp::kMinusY, "-y"},
            {WorldUp::kZ, "z"},
            {WorldUp::kMinusZ, "-z"}},
           "axis of the poses' world that points up; auto finds it from the floor");
  v.Text("camera", camera, "a camera file in place of the folder's own");
  v.Text(
      "camera_mount", camera_mount,
      "a file that says where the camera is on the body (an IMU, a robot) whose poses are given; "
      "empty: poses are the camera's");
  part.Visit(v);
  v.Group("recording", recording, "depth images and how poses are found for them");
  v.Group("laser", laser, "laser logs");
}

std::string NameOf(SequenceFormat format) {
  switch (format) {
    case SequenceFormat::kTum:
      return "TUM RGB-D folder";
    case SequenceFormat::kIcl:
      return "ICL-NUIM folder";
    case SequenceFormat::kFrames:
      return "folder of frames";
    case SequenceFormat::kCarmen:
      return "CARMEN laser log";
    case SequenceFormat::kAuto:
      break;
  }
  return "unknown";
}

}  // namespace depthgrid
