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

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/slam_output.h"
#include "mapper/io/camera_mount.h"
#include "mapper/io/frame_names.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

std::string LoopsText(const SlamOutput& output);
// Writes slam.txt, slam_final.txt and loops.csv into an existing folder.
void WriteSlamFiles(const std::string& folder, const SlamOutput& output);

struct SlamFilePaths {
  std::string live;
  std::string final;  // empty: unknown, the live trajectory is used
  std::string loops;  // empty: events are derived from the trajectories (slam_jumps.h)
};

struct SlamInput {
  SlamOutput slam;
  std::vector<std::string> notes;     // findings; those on frames are for the part
  std::vector<std::string> warnings;  // tolerated faults, one line each
};

struct SlamReading {
  // A pose belongs to the frame with the nearest stamp, at most this far away: evo's default, less
  // than half a frame at 30 Hz.
  double max_difference_s = 0.01;
  // Interpolates between the two neighbouring poses instead of taking the nearest.
  bool interpolate = false;
  double max_interpolation_gap_s = RecordingOptions{}.max_interpolation_gap_s;
  // Set where the poses are those of a body; the camera's are given.
  std::optional<CameraMount> mount = {};
};

// Reads a SLAM system's output: its poses (TUM, or one matrix per frame in order), its final poses
// and its events. `frames` are all input frames; lost frames are in no file. Poses without a frame
// are counted. Throws InputError for a file that is damaged or does not belong to the frames. Only
// loops within the part are given; the others are counted in a note.
SlamInput ReadSlamFiles(const SlamFilePaths& paths, const FrameNames& frames,
                        const SlamReading& reading = {});

// Reads only a file of loops, for recordings with their own poses.
SlamInput ReadLoops(const std::string& path, const FrameNames& frames, double max_difference_s);

}  // namespace depthgrid
