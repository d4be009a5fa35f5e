#include "eval/output/run_tables.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "eval/metrics/statistics.h"
#include "eval/run/consistency.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// x, y, yaw of the base under a camera, or three empty cells.
std::string BaseCells(const std::optional<Pose3>& pose) {
  if (!pose) return ",,";
  const Pose2 base = BaseOf(*pose);
  return fmt::format("{},{},{}", base.x_m, base.y_m, base.yaw_rad);
}

std::string ErrorCell(const std::optional<Pose3>& pose, const Pose3* truth) {
  if (!pose || truth == nullptr) return "";
  return fmt::format("{}", (pose->translation - truth->translation).head<2>().norm());
}

std::string MatchCells(const FrameReport& report) {
  if (!report.match.found) return ",,,,,,,,,,,,,";
  const Pose2& m = report.match.map_from_base;
  const auto& g = report.gain;
  const auto& i = report.innovation;
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", m.x_m, m.y_m, m.yaw_rad, g[0],
                     g[1], g[2], i[0], i[1], i[2], report.innovation_chi2,
                     DirectionsSeen(report.match), report.match.score, report.match.iterations,
                     report.innovation_rejected ? 1 : 0);
}

std::string CovarianceCells(const Eigen::Matrix3d& c) {
  return fmt::format("{},{},{},{},{},{}", c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2));
}

std::string MotionCells(const FrameReport& report) {
  if (report.motion_from < 0) return ",,,,,,";
  return fmt::format("{},{}", report.motion_from, CovarianceCells(report.motion_covariance));
}

// The number of beams; empty for a frame without a pose, which may have no scan.
std::string BeamsCell(const FrameReport& report) {
  return report.slam_from_camera || report.beams > 0 ? fmt::format("{}", report.beams) : "";
}

std::string HeightCell(const FrameReport& report) {
  return report.stand ? fmt::format("{:.4f}", report.stand->height_m) : "";
}

constexpr const char* kFrameColumns =
    "frame,stamp_s,slam_epoch,slam_x_m,slam_y_m,slam_yaw_rad,map_x_m,map_y_m,map_yaw_rad,"
    "match_x_m,match_y_m,match_yaw_rad,gain_forward,gain_left,gain_yaw,"
    "innovation_forward_m,innovation_left_m,innovation_yaw_rad,"
    "innovation_chi2,innovation_directions,match_score,match_iterations,innovation_rejected,cov_xx,"
    "cov_xy,cov_xyaw,cov_yy,cov_yyaw,"
    "cov_yawyaw,motion_from,motion_cov_xx,motion_cov_xy,motion_cov_xyaw,motion_cov_yy,"
    "motion_cov_yyaw,motion_cov_yawyaw,beams,loops_accepted,loops_rejected,inserted,guessed,"
    "carried,"
    "camera_height_m,slam_error_m,map_error_m\n";

}  // namespace

std::string FramesCsv(const MappingRun& run, const Trajectory* truth) {
  std::map<double, const Pose3*> truth_at;
  if (truth != nullptr) {
    for (const StampedPose& pose : *truth) truth_at[pose.stamp_s] = &pose.world_from_camera;
  }
  std::string csv = kFrameColumns;
  for (const FrameReport& r : run.reports) {
    const auto true_pose = truth_at.find(r.stamp_s);
    const Pose3* true_camera = true_pose == truth_at.end() ? nullptr : true_pose->second;
    csv += fmt::format(
        "{},{:.6f},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.index, r.stamp_s,
        r.slam_epoch, BaseCells(r.slam_from_camera), BaseCells(r.map_from_camera), MatchCells(r),
        CovarianceCells(r.covariance), MotionCells(r), BeamsCell(r), r.loops_accepted,
        r.loops_rejected, r.inserted ? 1 : 0, r.guessed ? 1 : 0, r.carried ? 1 : 0, HeightCell(r),
        ErrorCell(r.slam_from_camera, true_camera), ErrorCell(r.map_from_camera, true_camera));
  }
  return csv;
}

std::string TimingCsv(const MappingRun& run) {
  std::string csv = "frame,scan_us,match_us,fuse_us,insert_us,loops_us,rest_us,total_us\n";
  for (const FrameReport& r : run.reports) {
    const StageTimes& t = r.times;
    const double rest_us =
        t.total_us - (t.scan_us + t.match_us + t.fuse_us + t.insert_us + t.loops_us);
    csv += fmt::format("{},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f}\n", r.index, t.scan_us,
                       t.match_us, t.fuse_us, t.insert_us, t.loops_us, std::max(0.0, rest_us),
                       t.total_us);
  }
  return csv;
}

std::string TimingJson(const MappingRun& run, double wall_s_total, double cpu_s_total) {
  std::vector<double> totals_us = TimesOfMappedFrames(run);
  if (totals_us.empty()) totals_us = {0.0};
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto rounded = [](double value) { return std::round(value * 1e3) / 1e3; };
  constexpr double kP95 = 0.95;
  nlohmann::ordered_json json;
  json["frames"] = run.reports.size();
  const double sum_us = std::accumulate(totals_us.begin(), totals_us.end(), 0.0);
  json["cpu_us_per_frame_mean"] = rounded(sum_us / static_cast<double>(totals_us.size()));
  json["cpu_us_per_frame_median"] = rounded(Percentile(totals_us, 0.5));
  json["cpu_us_per_frame_p95"] = rounded(Percentile(totals_us, kP95));
  json["cpu_us_per_frame_max"] = rounded(*std::max_element(totals_us.begin(), totals_us.end()));
  json["mapper_cpu_s"] = rounded(run.cpu_s);
  json["cpu_s_total"] = rounded(cpu_s_total);
  json["wall_s_total"] = rounded(wall_s_total);
  json["peak_rss_mib"] = rounded(static_cast<double>(usage.ru_maxrss) / 1024.0);  // KiB on Linux
  return json.dump(2) + "\n";
}

}  // namespace depthgrid
