// A SLAM system's output as files: `slam.txt` (live) and `slam_final.txt` (after all corrections),
// TUM trajectories without the frames in which tracking was lost, and `loops.csv`, its events.
//
// loops.csv has a header line and one row an event, ordered by frame:
//   kind                  loop | relocalisation
//   frame                 the input frame, counted from 0, with whose pose the event takes effect
//   epoch                 SLAM's epoch from this frame on; unchanged when SLAM did not correct
//   itself first, second         the frames a loop joins; empty for a relocalisation, as all that
//   follows tx_m .. qw            first_from_second, the measured relative camera pose
//   sigma_translation_m, sigma_rotation_rad   its standard deviations
#pragma once

#include <string>
#include <vector>

#include "mapper/core/slam_output.h"

namespace depthgrid {

std::string LoopsText(const SlamOutput& output);
// Writes slam.txt, slam_final.txt and loops.csv into an existing folder.
void WriteSlamFiles(const std::string& folder, const SlamOutput& output);

struct SlamFilePaths {
  std::string live;
  std::string final;  // empty: the live trajectory is the final one
  std::string loops;  // empty: no events, one epoch
};

// The output the files were written from, given the stamps of all input frames (a lost frame is in
// no file). A pose belongs to the frame with the nearest stamp, at most 0.01 s away. Throws
// InputError for a file that does not fit the frames or says something impossible.
SlamOutput ReadSlamFiles(const SlamFilePaths& paths, const std::vector<double>& frame_stamps_s);

}  // namespace depthgrid
