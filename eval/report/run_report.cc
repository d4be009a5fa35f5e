#include "eval/report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "eval/experiment/changed_settings.h"
#include "eval/files/json_text_impl.h"
#include "eval/files/run_files.h"
#include "eval/pictures/map_picture.h"
#include "eval/pictures/placed_path.h"
#include "eval/report/report_json_impl.h"
#include "eval/report/web_assets.h"
#include "eval/report/worst_frames_impl.h"
#include "eval/run/prior_run.h"
#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/core/trajectory.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/laser_mount.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using Json = ReportJson;

constexpr double kSameStampS = 1e-6;  // the resolution of stamps in files

Json MapJson(const RunFiles& run) {
  GridGeometry part = KnownPart(run.map, kMapMarginCells);
  if (run.truth_map) part = Union(part, KnownPart(*run.truth_map, kMapMarginCells));
  part = OrAllOf(run.map, WithPath(part, run.est, kMapMarginCells));
  Json json;
  json["resolution"] = part.resolution_m;
  json["origin"] = {part.OriginM().x(), part.OriginM().y()};
  json["width"] = part.width_cells;
  json["height"] = part.height_cells;
  json["layers"]["estimate"] = PngUri(PictureOf(run.map, part));
  if (run.truth_map) {
    json["layers"]["truth"] = PngUri(PictureOf(*run.truth_map, part));
    json["layers"]["difference"] =
        PngUri(DifferencePicture(*run.truth_map, run.map, run.observable, part));
  }
  if (run.observable) json["layers"]["observable"] = PngUri(PictureOf(*run.observable, part));
  return json;
}

// One per row of frames.csv, null where there is none.
using PosesOfRows = std::vector<std::optional<Pose3>>;

PosesOfRows PosesAt(const Trajectory& trajectory, const std::vector<double>& stamps_s) {
  const std::vector<double> known_s = StampsOf(trajectory);
  PosesOfRows poses;
  for (const double stamp_s : stamps_s) {
    const auto entry = NearestStamp(known_s, stamp_s, kSameStampS);
    poses.push_back(entry ? std::optional(trajectory[*entry].world_from_camera) : std::nullopt);
  }
  return poses;
}

// Trajectories of sources without a camera are planar (docs/formats.md, "Laser logs"). A real
// camera never looks exactly straight up.
bool IsPlanar(const Pose3& pose) { return pose.rotation.x() == 0.0 && pose.rotation.y() == 0.0; }

Pose2 BaseOfRow(const Pose3& pose) { return IsPlanar(pose) ? PlanarPoseOf(pose) : BaseOf(pose); }

Json PathJson(const PosesOfRows& poses) {
  Json json = {{"x", Json::array()}, {"y", Json::array()}, {"yaw", Json::array()}};
  for (const auto& pose : poses) {
    const Pose2 base = pose ? BaseOfRow(*pose) : Pose2{};
    json["x"].push_back(pose ? Rounded(base.x_m, 4) : Json(nullptr));
    json["y"].push_back(pose ? Rounded(base.y_m, 4) : Json(nullptr));
    json["yaw"].push_back(pose ? Rounded(base.yaw_rad, 4) : Json(nullptr));
  }
  return json;
}

std::vector<std::optional<Pose2>> BasesOf(const PosesOfRows& poses) {
  std::vector<std::optional<Pose2>> bases;
  for (const auto& pose : poses)
    bases.push_back(pose ? std::optional(BaseOfRow(*pose)) : std::nullopt);
  return bases;
}

std::vector<double> FinalErrors(const PosesOfRows& est, const PosesOfRows& truth) {
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < est.size(); ++i) {
    errors_m.push_back(
        est[i] && truth[i] ? (est[i]->translation - truth[i]->translation).head<2>().norm() : NAN);
  }
  return errors_m;
}

Json FramesJson(const CsvTable& frames, const std::vector<double>& final_errors_m) {
  Json json;
  json["frame"] = RoundedAll(frames.Column("frame"), 0);
  json["stamp_s"] = RoundedAll(frames.Column("stamp_s"), 3);
  for (const char* name : {"gain_forward", "gain_left", "gain_yaw", "innovation_forward_m",
                           "innovation_left_m", "innovation_yaw_rad", "match_score", "beams"}) {
    json[name] = RoundedAll(frames.Column(name), 5);
  }
  if (!final_errors_m.empty()) {
    json["slam_error_m"] = RoundedAll(frames.Column("slam_error_m"), 5);
    json["map_error_m"] = RoundedAll(frames.Column("map_error_m"), 5);
    json["est_error_m"] = RoundedAll(final_errors_m, 5);
  }
  return json;
}

// The laser in the base's axes: the run's trajectories are the base's, its scans the laser's.
Pose2 BaseFromLaserOf(Config settings) {
  LaserMount mount;
  settings.Take("sequence").Take("laser").Take("mount").Read(mount);
  return mount.base_from_laser();
}

// Hits of some of the run's own scans in base axes, in whole centimetres: evenly spread scans, and
// those of the worst frames.
Json ScansJson(const RunFiles& run, const Pose2& base_from_laser,
               const std::vector<std::size_t>& worst) {
  constexpr std::size_t kSpreadScans = 150;
  constexpr std::size_t kMaxHits = 160;
  const std::vector<double>& frame_of_row = run.frames.Column("frame");
  const std::size_t step =
      std::max<std::size_t>(1, (run.scans.size() - run.prior_scans) / kSpreadScans);
  Json json = Json::array();
  std::size_t row = 0;
  for (std::size_t i = run.prior_scans; i < run.scans.size(); ++i) {
    const StoredScan& stored = run.scans[i];
    while (row < frame_of_row.size() && frame_of_row[row] < stored.frame) ++row;
    const bool is_worst = std::find(worst.begin(), worst.end(), row) != worst.end();
    if (i % step != 0 && !is_worst) continue;
    std::vector<Eigen::Vector2d> hits;
    const Scan scan = *stored.scan;
    for (const Beam& beam : scan.beams) {
      if (beam.hit) hits.push_back(base_from_laser * EndPoint(beam));
    }
    Json cm = Json::array();
    const std::size_t hit_step = std::max<std::size_t>(1, hits.size() / kMaxHits);
    for (std::size_t k = 0; k < hits.size(); k += hit_step) {
      cm.push_back(std::lround(hits[k].x() * 100.0));
      cm.push_back(std::lround(hits[k].y() * 100.0));
    }
    json.push_back({{"row", row}, {"cm", cm}});
  }
  return json;
}

// The number of the frame in a picture's file name.
std::optional<int> SampleFrameOf(const std::string& stem) {
  int frame = 0;
  const char* end = stem.data() + stem.size();
  const auto [stop, error] = std::from_chars(stem.data(), end, frame);
  const bool is_frame = error == std::errc() && stop == end && frame >= 0;
  return is_frame ? std::optional(frame) : std::nullopt;
}

Json SamplesJson(const std::string& folder) {
  std::map<int, std::string> stems;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder + "/frames", missing)) {
    const std::string name = entry.path().filename().string();
    constexpr std::string_view kDepthEnd = "_depth.png";
    if (!name.ends_with(kDepthEnd)) continue;
    const std::string stem = name.substr(0, name.size() - kDepthEnd.size());
    // There may be other pictures too.
    if (const std::optional<int> frame = SampleFrameOf(stem)) stems[*frame] = stem;
  }
  Json json = Json::array();
  for (const auto& [frame, stem] : stems) {
    const std::string base = folder + "/frames/" + stem;
    Json sample;
    sample["frame"] = frame;
    sample["depth"] = PngUri(ReadFile(base + "_depth.png"));
    if (fs::exists(base + "_colour.png")) {
      sample["colour"] = PngUri(ReadFile(base + "_colour.png"));
    }
    json.push_back(sample);
  }
  return json;
}

std::string TitleOf(const Config& settings) {
  const std::string scene_name = SettingOf(settings, "provenance.scene_name");
  if (!scene_name.empty()) return scene_name;
  for (const char* key : {"scene", "input"}) {
    const std::string value = SettingOf(settings, key);
    if (value.empty()) continue;
    // Only known endings are removed, because a folder's name may contain dots.
    const fs::path name = fs::path(value).filename();
    constexpr std::array kEndings = {".yaml", ".yml", ".log", ".clf", ".txt"};
    const bool is_file =
        std::find(kEndings.begin(), kEndings.end(), name.extension().string()) != kEndings.end();
    return (is_file ? name.stem() : name).string();
  }
  return "Run";
}

// The settings in run.yaml that determine what a frame was matched against.
std::pair<GridOptions, SubmapOptions> GridSettingsOf(Config settings, bool went_on_in_a_map) {
  GridOptions grid;
  SubmapOptions submap;
  Config mapper = settings.Take("mapper");
  mapper.Take("grid").Read(grid);
  mapper.Take("submap").Read(submap);
  if (went_on_in_a_map) submap.scans = kAllScansInOneSubmap;
  return {grid, submap};
}

Json PathsJson(const RunFiles& run, const PosesOfRows& est, const PosesOfRows& truth) {
  const std::vector<double>& stamps_s = run.frames.Column("stamp_s");
  const bool in_prior_map = run.prior_scans > 0;
  Json json;
  json["slam"] =
      PathJson(PosesAt(in_prior_map ? PlacedWhereItBegins(run.slam, run.est) : run.slam, stamps_s));
  json["online"] = PathJson(PosesAt(run.online, stamps_s));
  json["est"] = PathJson(est);
  if (run.truth) json["truth"] = PathJson(truth);
  return json;
}

// How bad each row is: its final error or, without ground truth, the misfit of its match.
std::vector<double> BadnessOf(const RunFiles& run, const std::vector<double>& final_errors_m) {
  if (run.truth) return final_errors_m;
  std::vector<double> badness;
  for (const double score : run.frames.Column("match_score")) badness.push_back(1.0 - score);
  return badness;
}

Json RunJson(const RunFiles& run, const Config& settings) {
  const std::vector<double>& stamps_s = run.frames.Column("stamp_s");
  const PosesOfRows est = PosesAt(run.est, stamps_s);
  const PosesOfRows truth = run.truth ? PosesAt(*run.truth, stamps_s) : PosesOfRows{};
  const std::vector<double> final_errors_m =
      run.truth ? FinalErrors(est, truth) : std::vector<double>{};
  Json json;
  json["subtitle"] = Counted(run.frames.rows, "frame") + MainSettings(settings);
  json["changed"] = fmt::format("{}", fmt::join(ChangedSettings(settings), ", "));
  json["method"] = SettingOf(settings, "mapper.method");
  json["settings"] = run.settings;
  json["warnings"] = run.warnings;
  json["metrics"] = run.metrics_json.empty() ? Json(nullptr) : Json::parse(run.metrics_json);
  const bool planar = !run.slam.empty() && IsPlanar(run.slam.front().world_from_camera);
  json["input_poses"] = planar ? "odometry" : "SLAM";
  json["own_scans"] = run.scans.size() - run.prior_scans;
  json["prior_scans"] = run.prior_scans;
  json["only_placed"] = run.only_placed;
  json["map"] = MapJson(run);
  json["paths"] = PathsJson(run, est, truth);
  json["frames"] = FramesJson(run.frames, final_errors_m);
  const std::vector<std::size_t> worst = WorstRows(BadnessOf(run, final_errors_m));
  const auto [grid, submap] = GridSettingsOf(settings, run.prior_scans > 0);
  json["worst"] = WorstFramesJson(run, worst, BasesOf(truth), grid, submap);
  json["worst_by"] = run.truth ? "Chosen by the distance of the final estimate from the truth."
                               : "Chosen by the match score, the lowest first.";
  json["scans"] = ScansJson(run, BaseFromLaserOf(settings), worst);
  json["samples"] = SamplesJson(run.folder);
  return json;
}

// timing.csv as a script beside the page, because times are not reproducible and the page is.
void WriteTimesScript(const std::string& folder, const std::string& into) {
  if (!fs::exists(folder + "/timing.csv")) return;
  Json json;
  for (const auto& [name, values] : ReadCsv(folder + "/timing.csv").columns) {
    if (name != "frame") json[name] = RoundedAll(values, 1);
  }
  WriteFile(into + "/timing.js", "window.RUN_TIMES = " + JsonText(json) + ";\n");
}

}  // namespace

void WriteRunReport(const std::string& folder, const ReportPlace& place) {
  const RunFiles run = ReadRunFolder(folder);
  const Config settings = Config::FromText(run.settings, folder + "/run.yaml");
  Json json;
  try {
    json = RunJson(run, settings);
  } catch (const Json::exception&) {
    throw InputError(folder + "/metrics.json", "is not valid JSON");
  }
  WriteTimesScript(folder, place.into);
  WriteFile(place.into + "/report.html", FillPage("run.html", TitleOf(settings), JsonText(json)));
}

}  // namespace depthgrid
