// Events that a SLAM system reported while running (loop closures and relocalisations), from a
// file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/slam_output.h"
#include "mapper/io/frame_names.h"

namespace depthgrid {

struct SlamEvent {
  int frame = 0;             // the input frame, from 0, with whose pose it takes effect
  std::optional<int> epoch;  // SLAM's epoch from this frame on, if the file counts epochs
  bool new_epoch = false;    // otherwise: whether SLAM's poses jump at this frame
  std::optional<LoopClosure> loop;
};

// SlamEvents::kind of files that count the epochs.
constexpr const char* kOwnEvents = "loops.csv";
// Of files whose loops join cameras even where the poses are those of an IMU.
constexpr const char* kOrbSlamEvents = "ORB-SLAM2 events";

struct SlamEvents {
  std::string kind;               // for display: "loops.csv"
  std::vector<SlamEvent> events;  // ordered by frame
  std::vector<std::string> warnings;
};

// Three kinds, told apart by the first word (docs/formats.md, "Loop closures"):
//   loops.csv            frames by number and stamp, as `depthgrid slam` writes it
//   ORB-SLAM2 events     LOOP frame stamp matched_frame stamp ... Tcm 3x4 | RELOC frame n t stamp
//   stamped loops        first_stamp second_stamp tx ty tz qx qy qz qw [sigma_m sigma_rad]
// Stamps name the nearest frame, at most `max_difference_s` away. Loops of missing frames and
// damaged rows are left out and counted in the warnings. Throws InputError for an empty file and
// one with mostly damaged rows.
SlamEvents ParseSlamEvents(const std::string& text, const std::string& place,
                           const FrameNames& frames, double max_difference_s);

}  // namespace depthgrid
