// Loop closing of the paper's chain: the poses of all scans and all submaps, optimised together.
#pragma once

#include <array>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/pose_graph.h"

namespace depthgrid {

// Standard deviations are of the relative pose of two nodes. The errors of neighbouring scans in a
// submap are nearly the same error, so a scan's constraint to its submap is made weak enough that
// all of a submap's scans together weigh one link.
struct GraphOptions {
  PoseGraphOptions solver;
  double submap_link_m = 0.05;       // between neighbouring submaps
  double submap_link_rad = 0.03;     //
  double scan_step_m = 0.004;        // between one scan and the next
  double scan_step_rad = 0.003;      //
  double epoch_speed_m_per_s = 0.3;  // across epochs: uncertainty without SLAM, per second
  double epoch_speed_rad_per_s = 0.5;
  // A loop farther than this from the optimised poses, in standard deviations, is taken out and the
  // rest optimised again.
  double max_loop_residual_sigmas = 5.0;

  void Visit(OptionsVisitor& v);
};

// A scan's poses relative to the previous scan and to its submaps, as measured at insertion.
// Corrections of the map do not change them.
struct ScanMeasurement {
  Pose2 previous_from_scan;               // identity for the first scan
  std::array<Pose2, 2> submap_from_scan;  // the newest submap, and the one before it
};

// The measurement of scan `scan`, given the poses of all scans up to it. A submap's pose is that of
// its first scan.
ScanMeasurement MeasurementOf(const std::vector<Pose2>& map_from_base, int scan,
                              int scans_per_submap);

// The poses of `frames` (initially as in the map) that agree best with measurements, one per frame,
// and loops. Without loops the frames are not moved.
Adjustment AdjustScansAndSubmaps(const std::vector<MappedFrame>& frames,
                                 const std::vector<ScanMeasurement>& measurements,
                                 const std::vector<PlanarLoop>& loops, int scans_per_submap,
                                 const GraphOptions& options);

}  // namespace depthgrid
