#include "mapper/io/camera_formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "mapper/core/error.h"
#include "mapper/io/camera_keys.h"
#include "mapper/io/camera_mount.h"
#include "mapper/io/camera_values.h"
#include "mapper/io/config.h"
#include "mapper/io/damage.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/realsense_listing.h"

namespace depthgrid {
namespace {

CameraDescription FromOwn(const Config& config, const std::string& text, const std::string& place) {
  CameraDescription camera;
  camera.kind = "camera.yaml";
  camera.takes_usual_scale = !config.Has("depth_scale");
  const double fy = config.Has("fy") ? NumberAt(config, "fy") : 0.0;
  camera.y_up = fy < 0.0;
  if (camera.y_up) {
    Config upright = config;
    upright.Set("fy", fmt::format("{}", -fy));
    camera.file = ParseCameraFile(upright.ToYaml(), place);
  } else {
    camera.file = ParseCameraFile(text, place);
  }
  return camera;
}

// ORB-SLAM3 names the projection; its fisheye has coefficients of the same names.
void RequirePinhole(std::string_view type, const std::string& place) {
  while (type.starts_with('"')) type.remove_prefix(1);
  while (type.ends_with('"')) type.remove_suffix(1);
  if (type == "PinHole" || type == "Pinhole" || type == "Rectified") return;
  throw InputError(place, fmt::format("Camera.type is {}, must be PinHole or Rectified", type));
}

// The numbers of ORB-SLAM2's settings ("Camera.fx") or ORB-SLAM3's ("Camera1.fx") by ORB-SLAM2's
// names; dots are part of them.
using OrbSlamNumbers = std::map<std::string, double, std::less<>>;

OrbSlamNumbers OrbSlamNumbersOf(const std::string& text, const std::string& place) {
  OrbSlamNumbers numbers;
  for (const TextRow& row : SplitRows(text)) {
    if (row.fields.size() < 2 || !row.fields[0].ends_with(':')) continue;
    std::string key(row.fields[0].substr(0, row.fields[0].size() - 1));
    if (key.starts_with("Camera1.")) key.replace(0, 8, "Camera.");
    if (key == "Camera.type") RequirePinhole(row.fields[1], PlaceOfLine(place, row.line));
    if (const auto number = ParseNumber(row.fields[1])) numbers.emplace(key, *number);
  }
  return numbers;
}

CameraDescription FromOrbSlam(const std::string& text, const std::string& place) {
  CameraDescription camera;
  camera.kind = "ORB-SLAM settings";
  const OrbSlamNumbers numbers = OrbSlamNumbersOf(text, place);
  const auto find = [&](std::string_view key) -> std::optional<double> {
    const auto found = numbers.find(key);
    return found == numbers.end() ? std::nullopt : std::optional(found->second);
  };
  const auto need = [&](std::string_view key) {
    const auto value = find(key);
    if (!value) throw InputError(place, fmt::format("key '{}' is missing", key));
    return *value;
  };
  PinholeCamera& pinhole = camera.file.camera;
  pinhole.fx_px = need("Camera.fx");
  pinhole.fy_px = need("Camera.fy");
  pinhole.cx_px = need("Camera.cx");
  pinhole.cy_px = need("Camera.cy");
  pinhole.distortion = {find("Camera.k1").value_or(0.0), find("Camera.k2").value_or(0.0),
                        find("Camera.p1").value_or(0.0), find("Camera.p2").value_or(0.0),
                        find("Camera.k3").value_or(0.0)};
  camera.has_size = find("Camera.width") && find("Camera.height");
  if (camera.has_size) {
    pinhole.width_px = PixelsOf(*find("Camera.width"), "Camera.width", place);
    pinhole.height_px = PixelsOf(*find("Camera.height"), "Camera.height", place);
  }
  const auto scale = find("DepthMapFactor") ? find("DepthMapFactor") : find("RGBD.DepthMapFactor");
  camera.has_depth_scale = scale.has_value();
  // ORB-SLAM takes values below 1e-5 for "already metres".
  if (scale) camera.file.depth_scale_per_m = *scale > 1e-5 ? *scale : 1.0;
  return camera;
}

// fx fy cx cy, and perhaps width height, on one line; or a matrix in rows or on one line.
CameraDescription FromNumbers(const std::string& text, const std::string& place) {
  CameraDescription camera;
  camera.has_depth_scale = false;
  PinholeCamera& pinhole = camera.file.camera;
  const std::vector<TextRow> rows = SplitRows(text);
  std::size_t columns = rows.front().fields.size();
  std::vector<double> row_major;
  for (const TextRow& row : rows) {
    const std::vector<double> numbers = NumbersIn(row, columns, place);
    row_major.insert(row_major.end(), numbers.begin(), numbers.end());
  }
  const bool is_one_line = rows.size() == 1;
  const std::string place_of_line = PlaceOfLine(place, rows.front().line);
  camera.has_size = is_one_line && columns == 6;
  if (is_one_line && (columns == 4 || columns == 6)) {
    camera.kind = "fx fy cx cy";
    pinhole.fx_px = row_major[0];
    pinhole.fy_px = row_major[1];
    pinhole.cx_px = row_major[2];
    pinhole.cy_px = row_major[3];
    if (columns == 6) {
      pinhole.width_px = PixelsOf(row_major[4], "width", place_of_line);
      pinhole.height_px = PixelsOf(row_major[5], "height", place_of_line);
    }
    return camera;
  }
  if (is_one_line && columns != 9 && columns != 12 && columns != 16) {
    throw InputError(place_of_line,
                     fmt::format("has {} numbers, must have 4 (fx fy cx cy), 6 (these, width and "
                                 "height) or those of a matrix (9, 12, 16)",
                                 columns));
  }
  camera.kind = "camera matrix";
  if (is_one_line) columns = columns == 9 ? 3 : 4;
  SetMatrix(row_major, columns, place, pinhole);
  return camera;
}

CameraDescription ParseCamera(const std::string& text, const std::string& place) {
  if (text.empty()) throw InputError(place, "is empty, must describe a camera");
  for (const TextRow& row : SplitRows(text)) RequireText(row, place);
  if (BeginsWithNumber(text)) return FromNumbers(text, place);
  if (text.find("Camera.fx:") != std::string::npos ||
      text.find("Camera1.fx:") != std::string::npos) {
    return FromOrbSlam(text, place);
  }
  if (IsRealSenseListing(text)) return ParseRealSenseListing(text, place);
  const Config config = ConfigOfOthers(text, place);
  auto camera = CameraByKeys(config);
  if (!camera) return FromOwn(config, text, place);
  camera->mount_key = MountKeyIn(config);
  return *camera;
}

}  // namespace

CameraDescription ParseCameraDescription(const std::string& text, const std::string& place) {
  CameraDescription camera = ParseCamera(text, place);
  PinholeCamera& pinhole = camera.file.camera;
  if (pinhole.fy_px < 0.0) {
    camera.y_up = true;
    pinhole.fy_px = -pinhole.fy_px;
  }
  PinholeCamera checked = pinhole;
  if (!camera.sizes.empty()) return camera;  // checked one by one
  if (!camera.has_size) {                    // checked again with the first image's size
    checked.width_px = checked.height_px = kMostImageSidePx;
  }
  Validate(checked, place);
  if (!(camera.file.depth_scale_per_m >= kLeastDepthScale)) {
    throw InputError(place,
                     fmt::format("the depth scale is {:g}, must be from {:g}: it is in units "
                                 "a metre, 1000 of millimetres",
                                 camera.file.depth_scale_per_m, kLeastDepthScale));
  }
  return camera;
}

CameraDescription ReadCameraDescription(const std::string& path) {
  std::vector<std::string> unsaid;
  return ReadCameraDescription(path, unsaid);
}

CameraDescription ReadCameraDescription(const std::string& path,
                                        std::vector<std::string>& warnings) {
  const std::string text = ReadTextFile(path);
  CameraDescription camera = ParseCameraDescription(text, path);
  camera.path = path;
  // What is in brackets cannot be cut.
  if (!text.ends_with('}')) WarnOfCut(path, text, warnings);
  if (!camera.taken.empty()) warnings.push_back(path + ": " + camera.taken);
  return camera;
}

void TakeSize(int width_px, int height_px, const std::string& image_path,
              CameraDescription& camera) {
  PinholeCamera& pinhole = camera.file.camera;
  if (camera.sizes.empty()) {
    pinhole.width_px = width_px;
    pinhole.height_px = height_px;
    Validate(pinhole, "camera of " + image_path);
    return;
  }
  std::vector<std::string> listed;
  for (const PinholeCamera& one : camera.sizes) {
    listed.push_back(fmt::format("{}x{}", one.width_px, one.height_px));
    if (one.width_px != width_px || one.height_px != height_px) continue;
    pinhole = one;
    return;
  }
  throw InputError(
      camera.path,
      fmt::format("lists the depth stream at {}, must list it at {}x{}, the size of {}",
                  fmt::join(listed, ", "), width_px, height_px, image_path));
}

std::string NoDepthScale(const std::string& path, double scale_per_m) {
  return fmt::format(
      "{}: states no depth_scale; {} units per metre are taken unless "
      "sequence.recording.depth_scale is set",
      path, scale_per_m);
}

Pose3 FlipY(const Pose3& world_from_camera) {
  // Conjugation with a reflection of y turns the rotation axis (x, y, z) into (-x, y, -z).
  const Eigen::Quaterniond& q = world_from_camera.rotation;
  const Eigen::Vector3d& t = world_from_camera.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

SlamOutput FlipY(SlamOutput slam) {
  for (SlamPose& pose : slam.live) {
    if (pose.slam_from_camera) pose.slam_from_camera = FlipY(*pose.slam_from_camera);
  }
  for (StampedPose& pose : slam.final) pose.world_from_camera = FlipY(pose.world_from_camera);
  for (LoopClosure& loop : slam.loops) loop.first_from_second = FlipY(loop.first_from_second);
  return slam;
}

}  // namespace depthgrid
