#include "mapper/io/camera_keys.h"

#include <gtest/gtest.h>

#include "tests/refusal.h"

namespace depthgrid {
namespace {

CameraDescription Described(const std::string& text) { return ParseCameraDescription(text, "c"); }
std::string Refused(const std::string& text) {
  return RefusalOf([&] { Described(text); });
}

const PinholeCamera kUndistorted{640, 480, 525.5, 526.5, 319.25, 239.75, {}};
const PinholeCamera kDistorted{
    640, 480, 525.5, 526.5, 319.25, 239.75, {0.1, -0.2, 0.001, 0.002, 0.0}};

constexpr const char* kOpen3d =
    "{\n\t\"width\" : 640,\n\t\"height\" : 480,\n\t\"intrinsic_matrix\" : \n\t[\n\t\t525.5,\n\t\t0,"
    "\n\t\t0,\n\t\t0,\n\t\t526.5,\n\t\t0,\n\t\t319.25,\n\t\t239.75,\n\t\t1\n\t]\n}";

TEST(CameraKeys, Open3dsIntrinsics) {
  const CameraDescription camera = Described(kOpen3d);
  EXPECT_EQ(camera.kind, "Open3D intrinsics");
  EXPECT_EQ(camera.file.camera, kUndistorted);
  EXPECT_TRUE(camera.has_size);
  EXPECT_FALSE(camera.has_depth_scale);
  // By rows, as some programs write it; the metadata of a recording; a saved view.
  const std::string by_rows = "\"intrinsic_matrix\": [525.5, 0, 319.25, 0, 526.5, 239.75, 0, 0, 1]";
  const std::string size = "\"height\": 480, \"width\": 640, ";
  EXPECT_EQ(Described("{" + size + by_rows + "}").file.camera, kUndistorted);
  const CameraDescription recorded = Described(
      "{\"class_name\": \"RGBDVideoMetadata\", \"color_channels\": 3, \"depth_scale\": 1000.0, " +
      size + by_rows + ", \"serial_number\": \"8211\", \"fps\": 30.0}");
  EXPECT_TRUE(recorded.has_depth_scale);
  EXPECT_EQ(recorded.file.depth_scale_per_m, 1000.0);
  const CameraDescription view = Described(
      "{\"class_name\": \"PinholeCameraParameters\", \"extrinsic\": [1, 0], "
      "\"intrinsic\": {" +
      size + by_rows + "}}");
  EXPECT_EQ(view.file.camera, kUndistorted);
}

TEST(CameraKeys, ARealSenseStreams) {
  const std::string rest =
      "\"width\": 640, \"height\": 480, \"fx\": 525.5, \"fy\": 526.5, \"ppx\": 319.25, \"ppy\": "
      "239.75, ";
  const std::string zeros = "\"coeffs\": [0, 0, 0, 0, 0]}";
  const std::string some = "\"coeffs\": [0.1, -0.2, 0.001, 0.002, 0.0]}";
  const auto with = [&](const std::string& model, const std::string& coeffs) {
    return "{" + rest + "\"model\": " + model + ", " + coeffs;
  };
  int read = 0;
  for (const char* model : {"\"distortion.inverse_brown_conrady\"", "\"Brown Conrady\"", "2",
                            "\"none\"", "\"modified_brown_conrady\""}) {
    const CameraDescription camera = Described(with(model, zeros));
    EXPECT_EQ(camera.kind, "RealSense intrinsics");
    EXPECT_EQ(camera.file.camera, kUndistorted) << model;
    EXPECT_FALSE(camera.has_depth_scale);
    ++read;
  }
  EXPECT_EQ(read, 5);
  EXPECT_EQ(Described(with("\"distortion.brown_conrady\"", some)).file.camera, kDistorted);
  EXPECT_EQ(Described(with("4", some)).file.camera, kDistorted);
  EXPECT_EQ(Refused(with("\"inverse_brown_conrady\"", some)),
            "c:1: model is inverse_brown_conrady, must be brown_conrady, or all coeffs 0");
  EXPECT_EQ(Refused(with("\"kannala_brandt4\"", zeros)),
            "c:1: model is kannala_brandt4, must be brown_conrady");
  EXPECT_EQ(Refused(with("4", "\"coeffs\": [0.1, 0.2]}")),
            "c:1: 'coeffs' has 2 numbers, must have the five k1 k2 p1 p2 k3");
  // In metres a unit or, as elsewhere, units a metre.
  for (const char* scale : {"0.001", "1000"}) {
    const CameraDescription camera =
        Described("{" + rest + "\"depth_scale\": " + std::string(scale) + "}");
    EXPECT_NEAR(camera.file.depth_scale_per_m, 1000.0, 1e-9);
  }
}

TEST(CameraKeys, KalibrsChain) {
  const std::string cam0 =
      "cam0:\n  cam_overlaps: []\n  camera_model: pinhole\n  distortion_coeffs: [0.1, -0.2, 0.001, "
      "0.002]\n  distortion_model: radtan\n  intrinsics: [525.5, 526.5, 319.25, 239.75]\n  "
      "resolution: [640, 480]\n  rostopic: /depth\n";
  const CameraDescription one = Described(cam0);
  EXPECT_EQ(one.kind, "Kalibr camera");
  EXPECT_EQ(one.file.camera, kDistorted);
  EXPECT_EQ(one.taken, "");
  EXPECT_FALSE(one.has_depth_scale);
  const CameraDescription two =
      Described("%YAML:1.0\n" + cam0 + "cam1:\n  intrinsics: [1, 1, 1, 1]\n");
  EXPECT_EQ(two.file.camera, kDistorted);
  EXPECT_NE(two.taken, "");
  // EuRoC's sensor.yaml.
  const CameraDescription euroc = Described(
      "sensor_type: camera\nresolution: [640, 480]\ncamera_model: pinhole\nintrinsics: [525.5, "
      "526.5, 319.25, 239.75] #fu, fv, cu, cv\ndistortion_model: radial-tangential\n"
      "distortion_coefficients: [0.1, -0.2, 0.001, 0.002]\n");
  EXPECT_EQ(euroc.file.camera, kDistorted);
}

TEST(CameraKeys, OneClearLineForEachFaultOfKalibrs) {
  const auto chain = [](const std::string& model, const std::string& distortion,
                        const std::string& coeffs, const std::string& intrinsics,
                        const std::string& resolution) {
    return "cam0:\n  camera_model: " + model + "\n  distortion_model: " + distortion +
           "\n  distortion_coeffs: " + coeffs + "\n  intrinsics: " + intrinsics +
           "\n  resolution: " + resolution + "\n";
  };
  const std::string four = "[0.1, 0, 0, 0]", focal = "[525, 525, 320, 240]", size = "[640, 480]";
  EXPECT_EQ(Refused(chain("pinhole", "none", "[]", focal, size)), "no error");
  EXPECT_EQ(Refused("intrinsics: [525, 525, 320, 240]\nresolution: [640, 480]\n"
                    "distortion_coefficients: [0.1, 0, 0, 0]\n"),
            "c: distortion_model is missing, must be radtan or none");
  EXPECT_EQ(Refused("intrinsics: [525, 525, 320, 240]\ndistortion_model: radtan\n"),
            "c: key 'resolution' is missing");
  EXPECT_EQ(Refused(chain("omni", "radtan", four, focal, size)),
            "c:2: cam0.camera_model is omni, must be pinhole");
  EXPECT_EQ(Refused(chain("pinhole", "equidistant", four, focal, size)),
            "c:3: cam0.distortion_model is equidistant, must be radtan or none");
  EXPECT_EQ(Refused(chain("pinhole", "radtan", "[0.1]", focal, size)),
            "c:4: 'cam0.distortion_coeffs' has 1 number, must have the four or five k1 k2 p1 p2 "
            "k3");
  EXPECT_EQ(Refused(chain("pinhole", "radtan", four, "[0.9, 525, 525, 320, 240]", size)),
            "c:5: 'cam0.intrinsics' has 5 numbers, must have four, fu fv pu pv");
  EXPECT_EQ(Refused(chain("pinhole", "radtan", four, focal, "[640]")),
            "c:6: 'cam0.resolution' has 1 number, must have two, width and height");
  EXPECT_EQ(Refused(chain("pinhole", "radtan", four, focal, "[640.5, 480]")),
            "c:6: 'cam0.resolution' is 640.5, must be a whole number of pixels");
  EXPECT_EQ(Refused(chain("pinhole", "radtan", four, "[525, a, 320, 240]", size)),
            "c:5: 'cam0.intrinsics' holds a, must be a list of numbers");
}

TEST(CameraKeys, OneClearLineForEachFaultOfOpen3ds) {
  const std::string whole = kOpen3d;
  EXPECT_EQ(Refused(whole.substr(0, whole.size() - 1)), "c:1: not valid YAML: '{' is not closed");
  const auto with = [&](const std::string& a, const std::string& b) {
    std::string text = whole;
    text.replace(text.find(a), a.size(), b);
    return Refused(text);
  };
  EXPECT_EQ(with("640", "640.5"), "c:2: 'width' is 640.5, must be a whole number of pixels");
  EXPECT_EQ(with("\"height\"", "\"hight\""), "c: key 'height' is missing");
  EXPECT_EQ(with("526.5", "\"x\""), "c:5: 'intrinsic_matrix' holds x, must be a list of numbers");
  EXPECT_EQ(with("525.5,", ""), "c:5: the camera matrix must have three rows of three numbers");
  EXPECT_EQ(with("239.75", "0,\n7"), "c:5: the camera matrix must be [fx 0 cx; 0 fy cy; 0 0 1]");
}

TEST(CameraFormats, NumbersOnOneLine) {
  const CameraDescription bare = Described("525.5 526.5 319.25 239.75\n");
  EXPECT_EQ(bare.kind, "fx fy cx cy");
  EXPECT_FALSE(bare.has_size);
  EXPECT_EQ(bare.file.camera.cy_px, 239.75);
  const CameraDescription sized = Described("# depth\n525.5, 526.5, 319.25, 239.75, 640, 480\n");
  EXPECT_TRUE(sized.has_size);
  EXPECT_EQ(sized.file.camera, kUndistorted);
  EXPECT_EQ(Described("525.5 0 319.25 0 0 526.5 239.75 0 0 0 1 0\n").file.camera.fy_px, 526.5);
  EXPECT_EQ(Refused("525.5 526.5 319.25\n"),
            "c:1: has 3 numbers, must have 4 (fx fy cx cy), 6 (these, width and height) or those "
            "of a matrix (9, 12, 16)");
  EXPECT_EQ(Refused("525.5 526.5 319.25 239.75 640 480.5\n"),
            "c:1: 'height' is 480.5, must be a whole number of pixels");
  EXPECT_NE(Refused("577 0 318 0\n"), "no error");  // the first row of a matrix
  EXPECT_NE(Refused("525.5 526.5 319.25 239.75 -640 480\n"), "no error");
  EXPECT_NE(Refused("525.5 526.5 nan 239.75\n"), "no error");
}

}  // namespace
}  // namespace depthgrid
