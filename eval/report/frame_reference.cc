#include "eval/report/frame_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/grid/scan_rasterizer.h"

namespace depthgrid {
namespace {

// frames.csv has a row per input frame; scans.bin refers to frames by the same index.
std::optional<std::size_t> RowOf(const CsvTable& frames, int frame) {
  const std::vector<double>& index = frames.Column("frame");
  const auto found = std::lower_bound(index.begin(), index.end(), frame);
  if (found == index.end() || *found != frame) return std::nullopt;
  return static_cast<std::size_t>(found - index.begin());
}

// `whose`: the columns' prefix, "map" or "match".
std::optional<Pose2> PoseAt(const CsvTable& frames, std::size_t row,
                            const std::string& whose = "map") {
  const Pose2 pose = {frames.Column(whose + "_x_m")[row], frames.Column(whose + "_y_m")[row],
                      frames.Column(whose + "_yaw_rad")[row]};
  // Missing or damaged: valid poses are within reach.
  if (!IsWithinReach({pose.x_m, pose.y_m, 0.0}) || !std::isfinite(pose.yaw_rad))
    return std::nullopt;
  return pose;
}

bool LoopsBetween(const CsvTable& frames, std::size_t first_row, std::size_t last_row) {
  const std::vector<double>& loops = frames.Column("loops_accepted");
  return std::any_of(loops.begin() + static_cast<std::ptrdiff_t>(first_row),
                     loops.begin() + static_cast<std::ptrdiff_t>(last_row) + 1,
                     [](double accepted) { return accepted > 0.0; });
}

Eigen::Vector3d AxesAt(const CsvTable& frames, std::size_t row,
                       const std::array<const char*, 3>& names) {
  return {frames.Column(names[0])[row], frames.Column(names[1])[row], frames.Column(names[2])[row]};
}

// The matched pose, for runs of versions that did not store it. Inverts Eq. 3, estimate =
// prediction * (K innovation). The table has only the diagonal of K, so this is exact where K is
// diagonal.
Pose2 MatchFromGain(const CsvTable& frames, std::size_t row, const Pose2& estimate,
                    const Eigen::Vector3d& innovation) {
  const Eigen::Vector3d gain = AxesAt(frames, row, {"gain_forward", "gain_left", "gain_yaw"});
  return estimate * Inverse(Pose2::FromVector(gain.cwiseProduct(innovation))) *
         Pose2::FromVector(innovation);
}

// Distance from the base that a scan reaches.
double ReachM(const Scan& scan) {
  float reach_m = 0.0F;
  for (const Beam& beam : scan.beams) {
    reach_m = std::max({reach_m, beam.clear_to_m, beam.hit ? beam.range_m : 0.0F});
  }
  return reach_m;
}

// Whether `scan` has no cell among those that matching or drawing `shown` reads: the rectangle
// around its points, whose corners are up to sqrt(2) as far away, and a margin.
bool AreApart(const Scan& scan, const Pose2& pose, const Scan& shown, const Pose2& shown_pose,
              double resolution_m) {
  constexpr double kMarginM = 1.0;  // for the offsets of MatchSurface and the picture's margin
  constexpr double kMarginCells = 8.0;
  const double surroundings_m = std::numbers::sqrt2 * (ReachM(shown) + kMarginM);
  const double distance_m = (pose.translation() - shown_pose.translation()).norm();
  return distance_m > ReachM(scan) + surroundings_m + kMarginCells * resolution_m;
}

// The poses of a run's scans at the time of one of them. Where loops moved the map after the first
// scan that matters here, the map is assumed to have moved as a whole.
struct PosesThen {
  const RunFiles& run;
  bool corrected = false;
  Pose2 then_from_final;

  Pose2 Of(std::size_t scan_index) const {
    const StoredScan& stored = run.scans[scan_index];
    // Scans of a prior map have no row, but they do not move.
    if (scan_index < run.prior_scans) return stored.map_from_base;
    const std::optional<std::size_t> row = RowOf(run.frames, stored.frame);
    const std::optional<Pose2> pose = row ? PoseAt(run.frames, *row) : std::nullopt;
    return corrected || !pose ? then_from_final * stored.map_from_base : *pose;
  }
};

}  // namespace

std::optional<FrameAtTheTime> FrameAtRow(const CsvTable& frames, std::size_t row) {
  const std::optional<Pose2> estimate = PoseAt(frames, row);
  if (!estimate) return std::nullopt;
  FrameAtTheTime frame;
  frame.map_from_base = *estimate;
  const Eigen::Vector3d innovation =
      AxesAt(frames, row, {"innovation_forward_m", "innovation_left_m", "innovation_yaw_rad"});
  if (!innovation.allFinite()) return frame;
  const std::optional<Pose2> matched =
      frames.columns.contains("match_x_m")
          ? PoseAt(frames, row, "match")
          : std::optional(MatchFromGain(frames, row, *estimate, innovation));
  if (!matched) return frame;
  frame.matched_map_from_base = matched;
  frame.predicted_map_from_base = *matched * Inverse(Pose2::FromVector(innovation));
  return frame;
}

OccupancyMap ReferenceOf(const RunFiles& run, std::size_t scan_index, const GridOptions& grid,
                         const SubmapOptions& submap) {
  Require(scan_index < run.scans.size(), "a scan of the run");
  const auto scans = static_cast<std::size_t>(submap.scans);
  const std::size_t submap_index = scan_index / scans;
  const std::size_t first = submap_index > 0 ? (submap_index - 1) * scans : 0;
  if (scan_index < run.prior_scans) return {};
  const std::size_t first_own = std::min(std::max(first, run.prior_scans), scan_index);
  const std::optional<std::size_t> first_row = RowOf(run.frames, run.scans[first_own].frame);
  const std::optional<std::size_t> row = RowOf(run.frames, run.scans[scan_index].frame);
  const std::optional<Pose2> pose_then = row ? PoseAt(run.frames, *row) : std::nullopt;
  if (!first_row || !pose_then) return {};
  const PosesThen poses{run, LoopsBetween(run.frames, *first_row, *row),
                        *pose_then * Inverse(run.scans[scan_index].map_from_base)};
  const Scan shown = *run.scans[scan_index].scan;
  ActiveSubmaps submaps(submap, grid);
  submaps.RestartAt(static_cast<int>(first));
  ScanRasterizer rasterizer;
  for (std::size_t i = first; i < scan_index; ++i) {
    Pose2 pose = poses.Of(i);
    Scan scan = *run.scans[i].scan;
    // It still counts as one of the submap's scans, but needs no part of the grid.
    if (AreApart(scan, pose, shown, *pose_then, grid.resolution_m)) {
      scan.beams.clear();
      pose = *pose_then;
    }
    submaps.Insert(rasterizer.Rasterize(scan, pose, grid.resolution_m), scan, pose);
  }
  Submap* matching = submaps.matching();
  return matching != nullptr ? matching->map() : OccupancyMap{};
}

}  // namespace depthgrid
