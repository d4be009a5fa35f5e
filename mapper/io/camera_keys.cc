#include "mapper/io/camera_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/camera_values.h"
#include "mapper/io/realsense_listing.h"

namespace depthgrid {
namespace {

void TakeSize(const Config& config, const std::vector<std::string>& width_keys,
              const std::vector<std::string>& height_keys, PinholeCamera& camera) {
  camera.width_px = WholeAt(config, NeededOf(config, width_keys));
  camera.height_px = WholeAt(config, NeededOf(config, height_keys));
}

// As many numbers as one of the two counts says.
std::vector<double> CountedNumbersAt(const Config& config, const std::string& key,
                                     std::pair<std::size_t, std::size_t> counts, const char* what) {
  std::vector<double> numbers = NumbersAt(config, key);
  if (numbers.size() == counts.first || numbers.size() == counts.second) return numbers;
  throw InputError(config.PlaceOfKey(key), fmt::format("'{}' has {}, must have {}", key,
                                                       Counted(numbers.size(), "number"), what));
}

bool Distorts(const std::vector<double>& coefficients) {
  return std::any_of(coefficients.begin(), coefficients.end(), [](double k) { return k != 0.0; });
}

// sensor_msgs/CameraInfo: as camera_calibration writes it (camera_matrix, distortion_coefficients)
// or as a message is printed (K or k, D or d).
CameraDescription FromRos(const Config& config) {
  CameraDescription camera;
  camera.kind = "ROS CameraInfo";
  camera.has_depth_scale = false;
  PinholeCamera& pinhole = camera.file.camera;
  TakeSize(config, {"image_width", "width"}, {"image_height", "height"}, pinhole);
  const std::string matrix = NeededOf(config, {"camera_matrix.data", "K", "k"});
  SetMatrix(NumbersAt(config, matrix), 3, config.PlaceOfKey(matrix), pinhole);
  const std::string model = config.Text("distortion_model", "plumb_bob");
  const std::string key = FirstOf(config, {"distortion_coefficients.data", "D", "d"});
  const std::vector<double> distortion =
      key.empty() ? std::vector<double>{} : NumbersAt(config, key);
  if (Distorts(distortion) && model.find("plumb_bob") == std::string::npos &&
      model.find("rational_polynomial") == std::string::npos) {
    throw InputError(config.PlaceOfKey("distortion_model"),
                     fmt::format("distortion_model is {}, must be plumb_bob", model));
  }
  SetDistortion(distortion, config.PlaceOfKey(key), pinhole);
  return camera;
}

// By columns, as Open3D's matrices are in memory. A last row of 0 0 1 tells it from one by rows.
std::vector<double> RowMajorOf(std::vector<double> matrix) {
  if (matrix.size() == 9 && matrix[2] == 0.0 && matrix[5] == 0.0) {
    std::swap(matrix[1], matrix[3]);
    std::swap(matrix[2], matrix[6]);
    std::swap(matrix[5], matrix[7]);
  }
  return matrix;
}

// Open3D's PinholeCameraIntrinsic, alone or in the metadata of its RealSense recordings (the group
// is ""), or within PinholeCameraParameters ("intrinsic.").
CameraDescription FromOpen3d(const Config& config, const std::string& group) {
  CameraDescription camera;
  camera.kind = "Open3D intrinsics";
  TakeSize(config, {group + "width"}, {group + "height"}, camera.file.camera);
  const std::string matrix = NeededOf(config, {group + "intrinsic_matrix"});
  SetMatrix(RowMajorOf(NumbersAt(config, matrix)), 3, config.PlaceOfKey(matrix),
            camera.file.camera);
  camera.has_depth_scale = config.Has("depth_scale");
  if (camera.has_depth_scale) camera.file.depth_scale_per_m = NumberAt(config, "depth_scale");
  return camera;
}

// A stream's rs2_intrinsics, as scripts write them.
CameraDescription FromRealSense(const Config& config) {
  CameraDescription camera;
  camera.kind = "RealSense intrinsics";
  PinholeCamera& pinhole = camera.file.camera;
  TakeSize(config, {"width"}, {"height"}, pinhole);
  pinhole.fx_px = NumberAt(config, NeededOf(config, {"fx"}));
  pinhole.fy_px = NumberAt(config, NeededOf(config, {"fy"}));
  pinhole.cx_px = NumberAt(config, NeededOf(config, {"ppx"}));
  pinhole.cy_px = NumberAt(config, NeededOf(config, {"ppy"}));
  if (config.Has("coeffs")) {
    SetDistortion(CountedNumbersAt(config, "coeffs", {5, 5}, "the five k1 k2 p1 p2 k3"),
                  config.PlaceOfKey("coeffs"), pinhole);
  }
  RequireRealSenseModel(config.Text("model", "none"), pinhole.HasDistortion(), "model",
                        config.PlaceOfKey("model"));
  camera.has_depth_scale = config.Has("depth_scale");
  if (camera.has_depth_scale) {
    // librealsense gives metres a unit.
    const double scale = NumberAt(config, "depth_scale");
    camera.file.depth_scale_per_m = scale > 0.0 && scale < kLeastDepthScale ? 1.0 / scale : scale;
  }
  return camera;
}

void TakeKalibrFocal(const Config& config, const std::string& key, PinholeCamera& camera) {
  const auto numbers = CountedNumbersAt(config, key, {4, 4}, "four, fu fv pu pv");
  camera.fx_px = numbers[0];
  camera.fy_px = numbers[1];
  camera.cx_px = numbers[2];
  camera.cy_px = numbers[3];
}

void TakeKalibrSize(const Config& config, const std::string& key, PinholeCamera& camera) {
  const auto numbers = CountedNumbersAt(config, key, {2, 2}, "two, width and height");
  const std::string place = config.PlaceOfKey(key);
  camera.width_px = PixelsOf(numbers[0], key, place);
  camera.height_px = PixelsOf(numbers[1], key, place);
}

void TakeKalibrDistortion(const Config& config, const std::string& group, PinholeCamera& camera) {
  const std::string model_key = group + "distortion_model";
  const std::string model = config.Text(model_key, "none");
  const std::vector<std::string> keys = {group + "distortion_coeffs",
                                         group + "distortion_coefficients"};
  if (model == "none" && (config.Has(model_key) || FirstOf(config, keys).empty())) return;
  if (model != "radtan" && model != "radial-tangential") {
    throw InputError(config.PlaceOfKey(model_key),
                     fmt::format("{} is {}, must be radtan or none", model_key,
                                 config.Has(model_key) ? model : "missing"));
  }
  const std::string key = NeededOf(config, keys);
  SetDistortion(CountedNumbersAt(config, key, {4, 5}, "the four or five k1 k2 p1 p2 k3"),
                config.PlaceOfKey(key), camera);
}

// A camera of Kalibr's chain ("cam0."), or the same keys alone (""), as in EuRoC's sensor.yaml.
CameraDescription FromKalibr(const Config& config, const std::string& group) {
  CameraDescription camera;
  camera.kind = "Kalibr camera";
  camera.has_depth_scale = false;
  const std::string model = config.Text(group + "camera_model", "pinhole");
  if (model != "pinhole") {
    throw InputError(config.PlaceOfKey(group + "camera_model"),
                     fmt::format("{}camera_model is {}, must be pinhole", group, model));
  }
  PinholeCamera& pinhole = camera.file.camera;
  TakeKalibrFocal(config, NeededOf(config, {group + "intrinsics"}), pinhole);
  TakeKalibrSize(config, NeededOf(config, {group + "resolution"}), pinhole);
  TakeKalibrDistortion(config, group, pinhole);
  if (config.Has("cam1")) {
    camera.taken = "of several cameras the first, cam0, is taken for the one of the depth images";
  }
  return camera;
}

}  // namespace

std::optional<CameraDescription> CameraByKeys(const Config& config) {
  if (!FirstOf(config, {"camera_matrix", "K", "k"}).empty()) return FromRos(config);
  if (config.Has("intrinsic_matrix")) return FromOpen3d(config, "");
  if (config.Has("intrinsic.intrinsic_matrix")) return FromOpen3d(config, "intrinsic.");
  if (config.Has("ppx") || config.Has("ppy")) return FromRealSense(config);
  if (config.Has("cam0.intrinsics")) return FromKalibr(config, "cam0.");
  if (config.Has("intrinsics") || config.Has("resolution")) return FromKalibr(config, "");
  return {};
}

}  // namespace depthgrid
