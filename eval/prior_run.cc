#include "eval/prior_run.h"

#include <cmath>
#include <filesystem>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/io/scan_file.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Scans that say where a run begins: so many, each of another view, so that a camera with a narrow
// one has looked around a little.
constexpr int kStartScans = 8;
constexpr double kNextViewM = 0.3;
constexpr double kNextViewRad = RadFromDeg(12.0);
// SLAM's drift over the scans that are laid over the map together.
constexpr double kStartPathM = 3.0;

// And over those that say it more exactly; how far SLAM may have drifted in between.
constexpr double kFirstPathM = 1.0;
constexpr double kMostShiftM = 0.7;

bool IsNextView(const Pose2& last, const Pose2& now) {
  const Pose2 moved = Between(last, now);
  return std::hypot(moved.x_m, moved.y_m) > kNextViewM || std::abs(moved.yaw_rad) > kNextViewRad;
}

std::vector<PlacedScan> FirstScans(FrameSource& source, const MapperOptions& options) {
  FrameScanner scanner(source.Camera(), options.scan);
  std::vector<PlacedScan> scans;
  int epoch = 0;
  while (const auto frame = source.Next()) {
    if (!frame->slam_from_camera) continue;
    if (!scans.empty() && frame->slam_epoch != epoch) break;
    const Pose2 slam_from_base = BaseOf(*frame->slam_from_camera);
    if (!scans.empty() && !IsNextView(scans.back().slam_from_base, slam_from_base)) continue;
    const FrameScans both = scanner.ScansOf(*frame);
    if (!both.obstacles) continue;
    if (!scans.empty()) {
      const Pose2 moved = Between(scans.front().slam_from_base, slam_from_base);
      if (std::hypot(moved.x_m, moved.y_m) > kStartPathM) break;
    }
    scans.push_back({both.obstacles, slam_from_base});
    epoch = frame->slam_epoch;
    if (static_cast<int>(scans.size()) == kStartScans) break;
  }
  return scans;
}

// The same place by the first views alone, over which SLAM has hardly drifted. Few views fit in
// more places than many: one that is not near the place found says nothing.
FoundPlace Nearer(const FoundPlace& found, const OccupancyMap& map,
                  const std::vector<PlacedScan>& scans) {
  std::vector<PlacedScan> first;
  for (const PlacedScan& scan : scans) {
    const Pose2 moved = Between(scans.front().slam_from_base, scan.slam_from_base);
    if (std::hypot(moved.x_m, moved.y_m) > kFirstPathM) break;
    first.push_back(scan);
  }
  if (first.size() == scans.size()) return found;
  const auto again = FindPlace(map, first, found.map_from_slam);
  if (!again || again->score < found.score) return found;
  const Pose2& first_base = scans.front().slam_from_base;
  const Pose2 shift = Between(found.map_from_slam * first_base, again->map_from_slam * first_base);
  if (std::hypot(shift.x_m, shift.y_m) > kMostShiftM) return found;
  FoundPlace nearer = found;
  nearer.map_from_slam = again->map_from_slam;
  return nearer;
}

}  // namespace

PriorMap ReadPriorRun(const std::string& folder) {
  const fs::path drawn_path = fs::path(folder) / "scans.bin";
  const fs::path matched_path = fs::path(folder) / "matched.bin";
  if (!fs::exists(fs::path(folder) / "run.yaml")) {
    throw InputError(folder, "is no run's folder: it has no run.yaml");
  }
  const std::vector<StoredScan> drawn = ReadScans(drawn_path.string());
  const std::vector<StoredScan> matched =
      fs::exists(matched_path) ? ReadScans(matched_path.string()) : drawn;
  if (drawn.empty()) throw InputError(drawn_path.string(), "holds no scan");
  if (matched.size() != drawn.size()) {
    throw InputError(matched_path.string(), "does not belong to scans.bin");
  }
  PriorMap prior;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    MappedFrame frame;
    frame.frame = static_cast<int>(i) - static_cast<int>(drawn.size());
    frame.stamp_s = drawn[i].stamp_s;
    frame.obstacles = drawn[i].scan;
    frame.scan = matched[i].scan;
    frame.map_from_base = drawn[i].map_from_base;
    prior.frames.push_back(std::move(frame));
  }
  return prior;
}

std::optional<FoundPlace> FindStart(const PriorMap& prior, FrameSource& source,
                                    const MapperOptions& options) {
  MapDrawing drawing(options.grid);
  for (const MappedFrame& frame : prior.frames) drawing.Add(*frame.obstacles, frame.map_from_base);
  const OccupancyMap map = drawing.Map();
  const std::vector<PlacedScan> scans = FirstScans(source, options);
  const auto found = FindPlace(map, scans, Pose2{});
  return found ? Nearer(*found, map, scans) : found;
}

}  // namespace depthgrid
