// Opens a recorded sequence of any kind: detects the kind and gives its frames and poses in a level
// world.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/io/frame_names.h"
#include "mapper/io/pose_check.h"
#include "mapper/io/sequence_options.h"

namespace depthgrid {

// Up according to the floor in the images, if a different axis was given.
struct UpDoubt {
  std::string up;         // "z", "-y" or a direction
  bool opposite = false;  // to the given axis; also if the camera is mounted the other way up
};
std::string UpDoubtText(const UpDoubt& doubt, const RecordingOptions& options);

struct Sequence {
  std::unique_ptr<FrameSource> source;
  std::string kind;                // "TUM RGB-D folder"
  std::vector<std::string> notes;  // findings about it, one line each
  // z of the floor in the poses' level world, if found; set to 0 within 2 cm of 0.
  std::optional<double> floor_z_m;
  // The same as measured, also for a given axis. Empty if it may be a table.
  std::optional<double> seen_floor_z_m;
  // Units a metre that its images were read with; empty where they are not PNG images.
  std::optional<double> depth_scale_per_m;
  // SLAM's final poses, in the level world and the frames' clock; empty when unknown.
  Trajectory final_poses;
  // Set if the images fit the poses only under another reading.
  std::optional<PoseDoubt> pose_doubt;
  std::optional<UpDoubt> up_doubt;
};

// Detects the kind of a path. Throws InputError for an unknown kind.
SequenceFormat DetectFormat(const std::string& path);
// The format set in the options, else the detected one.
SequenceFormat FormatOf(const std::string& path, const SequenceOptions& options);

// How poses and events refer to the frames of the whole recording (the scans of a laser log), and
// which frames are the part.
FrameNames SequenceFrames(const std::string& path, const SequenceOptions& options = {});

// `slam` replaces the folder's own poses; a TUM folder's are groundtruth.txt, used with a note. For
// a laser log it may have loops, between laser poses (OpenCarmenLog). Throws InputError.
Sequence OpenSequence(const std::string& path, const SequenceOptions& options = {},
                      const std::optional<SlamOutput>& slam = {});

}  // namespace depthgrid
