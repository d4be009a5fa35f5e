#include <algorithm>

#include "eval/pictures/map_picture.h"
#include "eval/report/frame_reference.h"
#include "eval/report/match_surface.h"
#include "eval/report/report_json_impl.h"
#include "eval/report/worst_frames_impl.h"

namespace depthgrid {
namespace {

// Margin around the scan in its picture.
constexpr double kPictureMarginM = 0.3;

ReportJson PoseJson(const std::optional<Pose2>& pose) {
  if (!pose) return nullptr;
  return {Rounded(pose->x_m, 4), Rounded(pose->y_m, 4), Rounded(pose->yaw_rad, 5)};
}

// The rectangle around all points of the scan and the base.
GridGeometry RectangleAround(const MatchPoints& points, const Pose2& map_from_base,
                             double resolution_m) {
  Eigen::Vector2d low = map_from_base.translation();
  Eigen::Vector2d high = low;
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    const Eigen::Vector2d point = map_from_base * Eigen::Vector2d(points.x_m[i], points.y_m[i]);
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector2d margin(kPictureMarginM, kPictureMarginM);
  const Cell first = CellOf(low - margin, resolution_m);
  const Cell last = CellOf(high + margin, resolution_m);
  return {resolution_m, first, last.x - first.x + 1, last.y - first.y + 1};
}

ReportJson MapJson(const OccupancyMap& map, const GridGeometry& part) {
  return {{"resolution", part.resolution_m},
          {"origin", {part.OriginM().x(), part.OriginM().y()}},
          {"width", part.width_cells},
          {"height", part.height_cells},
          {"image", PngUri(PictureOf(map, part))}};
}

ReportJson SurfaceJson(const MatchSurface& surface) {
  constexpr int kDecimals = 3;  // of a share of one
  return {{"step_m", surface.step_m},
          {"half_steps", surface.half_steps},
          {"residual", RoundedAll(surface.residual, kDecimals)},
          {"yaw_step_deg", DegFromRad(surface.yaw_step_rad)},
          {"yaw_residual", RoundedAll(surface.yaw_residual, kDecimals)}};
}

// Adds the match, or why there is none.
void AddMatch(const RunFiles& run, std::size_t scan_index, const Pose2& map_from_base,
              const GridOptions& grid, const SubmapOptions& submap, ReportJson& json) {
  MatchPoints points;
  points.Assign(*run.scans[scan_index].scan);
  const OccupancyMap reference = ReferenceOf(run, scan_index, grid, submap);
  if (points.size() == 0) {
    json["no_match"] = "Its scan has no return.";
    return;
  }
  if (reference.geometry.size() == 0) {
    json["no_match"] = "Nothing was mapped yet that this frame could be matched against.";
    return;
  }
  json["map"] = MapJson(reference, RectangleAround(points, map_from_base, grid.resolution_m));
  json["surface"] = SurfaceJson(MatchSurfaceAround(points, ViewOf(reference), map_from_base, {}));
}

// Searches the run's own scans, which are sorted by frame.
std::optional<std::size_t> ScanOfFrame(const RunFiles& run, int frame) {
  const auto first = run.scans.begin() + static_cast<std::ptrdiff_t>(run.prior_scans);
  const auto found =
      std::lower_bound(first, run.scans.end(), frame,
                       [](const StoredScan& scan, int wanted) { return scan.frame < wanted; });
  if (found == run.scans.end() || found->frame != frame) return std::nullopt;
  return static_cast<std::size_t>(found - run.scans.begin());
}

std::string WhyNoScan(const RunFiles& run) {
  return run.only_placed
             ? "It was matched against the finished map; of frames that are only placed "
               "no scan is kept to draw."
             : "No scan of it is kept.";
}

}  // namespace

std::vector<std::size_t> WorstRows(const std::vector<double>& badness) {
  constexpr std::size_t kHowMany = 10;
  constexpr std::size_t kApartShare = 50;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < badness.size(); ++i) {
    if (std::isfinite(badness[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return badness[a] > badness[b]; });
  const std::size_t apart = std::max<std::size_t>(1, badness.size() / kApartShare);
  std::vector<std::size_t> worst;
  for (const std::size_t row : order) {
    const bool near = std::any_of(worst.begin(), worst.end(), [&](std::size_t other) {
      return (row > other ? row - other : other - row) < apart;
    });
    if (!near) worst.push_back(row);
    if (worst.size() == kHowMany) break;
  }
  return worst;
}

ReportJson WorstFramesJson(const RunFiles& run, const std::vector<std::size_t>& rows,
                           const std::vector<std::optional<Pose2>>& truth, const GridOptions& grid,
                           const SubmapOptions& submap) {
  const std::vector<double>& frame_of_row = run.frames.Column("frame");
  ReportJson list = ReportJson::array();
  for (const std::size_t row : rows) {
    ReportJson json = {{"row", row}};
    if (const std::optional<FrameAtTheTime> frame = FrameAtRow(run.frames, row)) {
      json["estimate"] = PoseJson(frame->map_from_base);
      json["prediction"] = PoseJson(frame->predicted_map_from_base);
      json["match"] = PoseJson(frame->matched_map_from_base);
      json["truth"] = truth.empty() ? ReportJson(nullptr) : PoseJson(truth[row]);
      const auto scan = ScanOfFrame(run, static_cast<int>(frame_of_row[row]));
      if (scan) {
        AddMatch(run, *scan, frame->map_from_base, grid, submap, json);
      } else {
        json["no_match"] = WhyNoScan(run);
      }
    } else {
      json["no_match"] = "No pose of this frame is known.";
    }
    list.push_back(json);
  }
  return list;
}

}  // namespace depthgrid
