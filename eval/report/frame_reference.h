// Redraws, from a run's folder, the map that one of its frames was matched against.
#pragma once

#include <optional>

#include "eval/files/run_files.h"
#include "mapper/grid/grid_options.h"
#include "mapper/grid/submap.h"

namespace depthgrid {

// Poses of a row of frames.csv, as known when the frame was mapped.
struct FrameAtTheTime {
  std::optional<Pose2> predicted_map_from_base;  // empty without a match
  std::optional<Pose2> matched_map_from_base;
  Pose2 map_from_base;  // the online estimate
};

// Empty for a frame without a pose.
std::optional<FrameAtTheTime> FrameAtRow(const CsvTable& frames, std::size_t row);

// The older active submap (mapper/grid/submap.h) as it was when run.scans[scan_index] was matched:
// the scans before it at their poses of that time. If SLAM has closed a loop since then, the final
// poses are used instead, moved as a whole so that this scan has its pose of that time. Scans of a
// prior map have their final poses. Unknown everywhere for the first scan. Scans too far from this
// one to share a cell with its surroundings are left out, so that the map remains small however far
// apart the poses are.
OccupancyMap ReferenceOf(const RunFiles& run, std::size_t scan_index, const GridOptions& grid,
                         const SubmapOptions& submap);

}  // namespace depthgrid
