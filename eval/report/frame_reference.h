// What one frame of a finished run was matched against, drawn again from the run's folder.
#pragma once

#include <optional>

#include "eval/files/run_files.h"
#include "mapper/grid/grid_options.h"
#include "mapper/grid/submap.h"

namespace depthgrid {

// A row of frames.csv, as it was known at the time.
struct FrameAtTheTime {
  std::optional<Pose2> predicted_map_from_base;  // without a match: empty
  std::optional<Pose2> matched_map_from_base;
  Pose2 map_from_base;  // the online estimate
};

// Nothing for a frame without a pose.
std::optional<FrameAtTheTime> FrameAtRow(const CsvTable& frames, std::size_t row);

// The older active submap (mapper/grid/submap.h) as it was when run.scans[scan_index] came: of the
// scans before it at the poses they had then. If SLAM closed a loop in between, the finished map's
// scans moved so that this one lies where it lay at the time. Scans of a map that the run went on
// in lie as they lie in the end. Unknown everywhere for the first scan. Only its surroundings:
// scans too far away to share a cell with them are left out, so that the map stays small however
// far the poses fly.
OccupancyMap ReferenceOf(const RunFiles& run, std::size_t scan_index, const GridOptions& grid,
                         const SubmapOptions& submap);

}  // namespace depthgrid
