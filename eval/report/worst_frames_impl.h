// The worst frames of a run, with data to explain why: scan, match surface and poses.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "eval/files/run_files.h"
#include "mapper/grid/grid_options.h"
#include "mapper/grid/submap.h"

namespace depthgrid {

// Rows of frames.csv with the largest values, at most ten, at least a fiftieth of the run apart,
// because neighbours of a bad frame are bad for the same reason. NaN is never chosen.
std::vector<std::size_t> WorstRows(const std::vector<double>& badness);

// One object per row: the poses at the time and, if the row has a scan, what it was matched against
// and the residuals around the estimate; else the reason. `truth` has an entry per row, or none.
nlohmann::ordered_json WorstFramesJson(const RunFiles& run, const std::vector<std::size_t>& rows,
                                       const std::vector<std::optional<Pose2>>& truth,
                                       const GridOptions& grid, const SubmapOptions& submap);

}  // namespace depthgrid
