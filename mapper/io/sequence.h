// One door for every recorded sequence: what kind it is, its poses in a level world, and its
// frames.
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

// What the floor seen in the images says of up, where another axis was given.
struct UpDoubt {
  std::string up;         // "z", "-y" or a direction
  bool opposite = false;  // to the axis: so it is, too, if the camera is mounted upside down
};

struct Sequence {
  std::unique_ptr<FrameSource> source;
  std::string kind;                // "TUM RGB-D folder"
  std::vector<std::string> notes;  // what was found out about it, a line each
  // z of the floor in the poses' level world, where it was found; 0 when it is within 2 cm of 0.
  std::optional<double> floor_z_m;
  // The same as it was seen, of a given axis too. Nothing where it may be a table.
  std::optional<double> seen_floor_z_m;
  // SLAM's own, in the level world and by the clock of the frames; empty when unknown.
  Trajectory final_poses;
  // Where the images fit the poses only if these are read otherwise.
  std::optional<PoseDoubt> pose_doubt;
  std::optional<UpDoubt> up_doubt;
};

// The kind a path looks like. Throws InputError when it is none that is known.
SequenceFormat DetectFormat(const std::string& path);
// The one that is forced, or the one it looks like.
SequenceFormat FormatOf(const std::string& path, const SequenceOptions& options);

// How poses and events name the frames of the whole recording, for a laser log its scans, and which
// of them are the part.
FrameNames SequenceFrames(const std::string& path, const SequenceOptions& options = {});

// `slam` replaces the folder's own poses; a TUM folder has none but groundtruth.txt, which is taken
// with a note. For a laser log it may hold loops, between lasers (OpenCarmenLog). Throws
// InputError.
Sequence OpenSequence(const std::string& path, const SequenceOptions& options = {},
                      const std::optional<SlamOutput>& slam = {});

}  // namespace depthgrid
