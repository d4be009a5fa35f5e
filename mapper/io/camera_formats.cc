#include "mapper/io/camera_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/damage.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

double NumberAt(const Config& config, const std::string& key, const std::string& place) {
  const auto values = config.List(key);
  const auto number = values.size() == 1 ? ParseNumber(values.front()) : std::nullopt;
  if (!number || !std::isfinite(*number)) throw InputError(place, "'" + key + "' must be a number");
  return *number;
}

std::vector<double> NumbersAt(const Config& config, const std::string& key,
                              const std::string& place) {
  std::vector<double> numbers;
  for (const std::string& item : config.List(key)) {
    const auto number = ParseNumber(item);
    if (!number || !std::isfinite(*number)) {
      throw InputError(place, "'" + key + "' must be a list of numbers");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

int PixelsOf(double number, std::string_view key, const std::string& place) {
  if (number != std::floor(number) || std::abs(number) > 1e6) {
    throw InputError(place,
                     fmt::format("'{}' is {}, must be a whole number of pixels", key, number));
  }
  return static_cast<int>(number);
}

int WholeAt(const Config& config, const std::string& key, const std::string& place) {
  return PixelsOf(NumberAt(config, key, place), key, place);
}

// The first of several alternative keys that is present; empty when there is none.
std::string FirstOf(const Config& config, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (config.Has(key)) return key;
  }
  return "";
}

void SetMatrix(const std::vector<double>& row_major, std::size_t columns, const std::string& place,
               PinholeCamera& camera) {
  if (row_major.size() < 3 * columns || columns < 3) {
    throw InputError(place, "the camera matrix must have three rows of three numbers");
  }
  const auto at = [&](std::size_t row, std::size_t column) {
    return row_major[row * columns + column];
  };
  if (at(1, 0) != 0.0 || at(2, 0) != 0.0 || at(2, 1) != 0.0 || at(2, 2) != 1.0) {
    throw InputError(place, "the camera matrix must be [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  camera.fx_px = at(0, 0);
  camera.cx_px = at(0, 2);
  camera.fy_px = at(1, 1);
  camera.cy_px = at(1, 2);
}

void SetDistortion(const std::vector<double>& coefficients, const std::string& place,
                   PinholeCamera& camera) {
  camera.distortion.fill(0.0);
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (i < camera.distortion.size()) {
      camera.distortion[i] = coefficients[i];
    } else if (coefficients[i] != 0.0) {
      throw InputError(place, "only the plumb-bob distortion k1 k2 p1 p2 k3 is known");
    }
  }
}

CameraDescription FromOwn(const Config& config, const std::string& text, const std::string& place) {
  CameraDescription camera;
  camera.kind = "camera.yaml";
  camera.takes_usual_scale = !config.Has("depth_scale");
  const double fy = config.Has("fy") ? NumberAt(config, "fy", place) : 0.0;
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

// sensor_msgs/CameraInfo: as camera_calibration writes it (camera_matrix, distortion_coefficients)
// or as a message is printed (K or k, D or d).
CameraDescription FromRos(const Config& config, const std::string& place) {
  CameraDescription camera;
  camera.kind = "ROS CameraInfo";
  camera.has_depth_scale = false;
  const auto need = [&](std::initializer_list<const char*> keys) {
    const std::string key = FirstOf(config, keys);
    if (key.empty()) throw InputError(place, fmt::format("key '{}' is missing", *keys.begin()));
    return key;
  };
  PinholeCamera& pinhole = camera.file.camera;
  pinhole.width_px = WholeAt(config, need({"image_width", "width"}), place);
  pinhole.height_px = WholeAt(config, need({"image_height", "height"}), place);
  SetMatrix(NumbersAt(config, need({"camera_matrix.data", "K", "k"}), place), 3, place, pinhole);
  const std::string model = config.Text("distortion_model", "plumb_bob");
  const std::string key = FirstOf(config, {"distortion_coefficients.data", "D", "d"});
  const std::vector<double> distortion =
      key.empty() ? std::vector<double>{} : NumbersAt(config, key, place);
  const bool distorted =
      std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0.0; });
  if (distorted && model.find("plumb_bob") == std::string::npos &&
      model.find("rational_polynomial") == std::string::npos) {
    throw InputError(place, fmt::format("distortion_model is {}, must be plumb_bob", model));
  }
  SetDistortion(distortion, place, pinhole);
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

CameraDescription FromMatrix(const std::string& text, const std::string& place) {
  CameraDescription camera;
  camera.kind = "camera matrix";
  camera.has_size = false;
  camera.has_depth_scale = false;
  std::vector<double> row_major;
  std::size_t columns = 0;
  for (const TextRow& row : SplitRows(text)) {
    columns = columns == 0 ? row.fields.size() : columns;
    const std::vector<double> numbers = NumbersIn(row, columns, place);
    row_major.insert(row_major.end(), numbers.begin(), numbers.end());
  }
  // A whole matrix on one line.
  if (row_major.size() == columns && (columns == 9 || columns == 16))
    columns = columns == 9 ? 3 : 4;
  SetMatrix(row_major, columns, place, camera.file.camera);
  return camera;
}

bool StartsWithNumber(const std::string& text) {
  const std::vector<TextRow> rows = SplitRows(std::string_view(text).substr(0, 4096));
  return !rows.empty() && ParseNumber(rows.front().fields.front()).has_value();
}

CameraDescription ParseCamera(const std::string& text, const std::string& place) {
  if (text.empty()) throw InputError(place, "is empty, must describe a camera");
  if (StartsWithNumber(text)) return FromMatrix(text, place);
  if (text.find("Camera.fx:") != std::string::npos ||
      text.find("Camera1.fx:") != std::string::npos) {
    return FromOrbSlam(text, place);
  }
  // OpenCV writes a directive that YAML 1.2 does not know.
  const bool directive = text.starts_with("%YAML");
  const Config config = Config::FromText(
      directive ? text.substr(std::min(text.find('\n'), text.size())) : text, place);
  if (!FirstOf(config, {"camera_matrix", "K", "k"}).empty()) return FromRos(config, place);
  return FromOwn(config, text, place);
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
  if (!camera.has_size) {  // checked again with the first image's size
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
  WarnOfCut(path, text, warnings);
  return ParseCameraDescription(text, path);
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
