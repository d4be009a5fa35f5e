#include "eval/doubts/floor_check.h"

#include <algorithm>
#include <cmath>

#include "mapper/scan/floor_tracker.h"

namespace depthgrid {
namespace {

// The tracker takes 60 frames to accept a higher floor (docs/math.md, "Height and tilt"), and what
// was drawn until then remains: in living_room (240 frames) that reduces the walls' F1 by 0.2.
constexpr int kFewestFrames = 10;

}  // namespace

bool MapsFloor(const MappingRun& run, double seen_z_m, const ScanOptions& options) {
  const double near_m =
      options.floor == FloorSource::kPose ? options.band_low_m : FloorTracker::kNearPoseM;
  int as_taken = 0;
  for (const FrameReport& report : run.reports) {
    if (!report.stand || !report.slam_from_camera) continue;
    const double used_z_m = report.slam_from_camera->translation.z() - report.stand->height_m;
    // On another storey neither height applies.
    const bool taken = std::abs(used_z_m - options.floor_z_m) <= near_m;
    as_taken += taken && seen_z_m - used_z_m > near_m ? 1 : 0;
  }
  return as_taken >= kFewestFrames;
}

}  // namespace depthgrid
