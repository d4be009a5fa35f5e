// A SLAM system's output as files: `slam.txt` (live) and `slam_final.txt` (after all corrections),
// TUM trajectories without the frames in which tracking was lost, and `loops.csv`, its events.
//
// loops.csv has a header line and one row an event, ordered by frame:
//   kind                  loop | relocalisation
//   frame                 the input frame, counted from 0, with whose pose the event takes effect
//   epoch                 SLAM's epoch from this frame on; unchanged when it did not correct itself
//   first, second         the frames a loop joins; empty for a relocalisation, as all that follows
//   tx_m .. qw            first_from_second, the measured relative camera pose
//   sigma_translation_m, sigma_rotation_rad   its standard deviations
//   stamp_s, first_stamp_s, second_stamp_s    of `frame`, `first` and `second`; may be left out
#pragma once

#include <string>
#include <vector>

#include "mapper/core/slam_output.h"
#include "mapper/io/frame_names.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

std::string LoopsText(const SlamOutput& output);
// Writes slam.txt, slam_final.txt and loops.csv into an existing folder.
void WriteSlamFiles(const std::string& folder, const SlamOutput& output);

struct SlamFilePaths {
  std::string live;
  std::string final;  // empty: unknown, the live trajectory stands for it
  std::string loops;  // empty: events are read off the trajectories (mapper/io/slam_jumps.h)
};

struct SlamInput {
  SlamOutput slam;
  std::vector<std::string> notes;     // what was found, in the part where it is of frames
  std::vector<std::string> warnings;  // what was wrong and survived, a line each
};

struct SlamReading {
  // A pose belongs to the frame with the nearest stamp, at most this far away: evo's, and less than
  // half a frame at 30 Hz.
  double max_difference_s = 0.01;
  // Takes what lies between the two neighbouring poses instead of the nearest one.
  bool interpolate = false;
  double max_interpolation_gap_s = RecordingOptions{}.max_interpolation_gap_s;
};

// The output of a SLAM system as files: its poses (TUM, or a matrix a frame in order), its revised
// poses and its events, given all input frames; lost frames are in no file. Poses of no frame are
// counted. Throws InputError for a file that is damaged or has nothing to do with the frames.
// Of loops only those within the part of the frames are given; the others are counted in a note.
SlamInput ReadSlamFiles(const SlamFilePaths& paths, const FrameNames& frames,
                        const SlamReading& reading = {});

// A file of loops by itself, for recordings that bring their poses.
SlamInput ReadLoops(const std::string& path, const FrameNames& frames, double max_difference_s);

}  // namespace depthgrid
