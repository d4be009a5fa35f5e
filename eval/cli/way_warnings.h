// Warnings about the lengths and directions of a run's motions, by SLAM and in the map.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/run/mapping_run.h"
#include "mapper/io/carmen_log.h"

namespace depthgrid::cli {

// Warns of different scales of poses and map; which is wrong cannot be determined.
// `depth_scale_per_m`: Sequence's.
void CheckScale(const std::string& input, std::optional<double> depth_scale_per_m,
                const MappingRun& run, std::vector<std::string>& warnings);

// For laser logs: warns of disagreeing directions of odometry and scans.
void CheckDirections(const std::string& input, const CarmenLogOptions& laser, const MappingRun& run,
                     std::vector<std::string>& warnings);

}  // namespace depthgrid::cli
