#include "mapper/io/camera_formats.h"

#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

std::string DescriptionRefusal(const std::string& text) {
  return RefusalOf([&] { ParseCameraDescription(text, "c"); });
}

TEST(CameraFormats, OurYamlWithEitherSignOfFy) {
  const std::string rest = "width: 640\nheight: 480\nfx: 481.2\ncx: 319.5\ncy: 239.5\n";
  const CameraDescription down = ParseCameraDescription(rest + "fy: 480\n", "c");
  EXPECT_EQ(down.kind, "camera.yaml");
  EXPECT_FALSE(down.y_up);
  const CameraDescription up = ParseCameraDescription(rest + "fy: -480.0\n", "c");
  EXPECT_TRUE(up.y_up);
  EXPECT_EQ(up.file, down.file);
}

// As a Windows shell redirects it.
TEST(CameraFormats, TextOfTwoBytesACharacterIsRefused) {
  std::string wide = "\xFF\xFE";
  for (const char c : std::string("525 525 320 240\n")) wide += {c, '\0'};
  EXPECT_EQ(DescriptionRefusal(wide),
            "c:1: holds bytes that are zero (UTF-16?), must be UTF-8 text");
}

TEST(CameraFormats, RosCalibrationAndPrintedMessage) {
  const CameraDescription calibration = ParseCameraDescription(
      "image_width: 640\nimage_height: 480\ncamera_name: rgb\ncamera_matrix:\n  rows: 3\n  cols: "
      "3\n  data: [525.5, 0, 319.25, 0, 526.5, 239.75, 0, 0, 1]\ndistortion_model: plumb_bob\n"
      "distortion_coefficients: {rows: 1, cols: 5, data: [0.1, -0.2, 0.001, 0.002, 0.3]}\n",
      "c");
  EXPECT_EQ(calibration.kind, "ROS CameraInfo");
  EXPECT_EQ(
      calibration.file.camera,
      (PinholeCamera{640, 480, 525.5, 526.5, 319.25, 239.75, {0.1, -0.2, 0.001, 0.002, 0.3}}));
  EXPECT_FALSE(calibration.has_depth_scale);
  const CameraDescription message = ParseCameraDescription(
      "header:\n  seq: 1\n  frame_id: \"depth\"\nheight: 360\nwidth: 540\ndistortion_model: "
      "\"plumb_bob\"\nD: [0.0, 0.0, 0.0, 0.0, 0.0]\nK: [450.0, 0.0, 270.0, 0.0, 451.0, 180.0, 0.0, "
      "0.0, 1.0]\nR: [1.0]\nbinning_x: 0\n---\n",
      "c");
  EXPECT_EQ(message.file.camera, (PinholeCamera{540, 360, 450.0, 451.0, 270.0, 180.0, {}}));
}

TEST(CameraFormats, OrbSlamSettings) {
  const CameraDescription camera = ParseCameraDescription(
      "%YAML:1.0\n\n# Camera Parameters\nCamera.fx: 517.306408\nCamera.fy: -516.469215\n"
      "Camera.cx: 318.643040\nCamera.cy: 255.313989\nCamera.k1: 0.262383\nCamera.k2: -0.953104\n"
      "Camera.p1: -0.005358\nCamera.p2: 0.002628\nCamera.k3: 1.163314\nCamera.width: 640\n"
      "Camera.height: 480\nDepthMapFactor: 5000.0\nORBextractor.nFeatures: 1000\n",
      "c");
  EXPECT_EQ(camera.kind, "ORB-SLAM settings");
  EXPECT_TRUE(camera.y_up);
  EXPECT_EQ(camera.file.camera.fy_px, 516.469215);
  EXPECT_EQ(camera.file.camera.distortion[4], 1.163314);
  EXPECT_EQ(camera.file.depth_scale_per_m, 5000.0);
  const CameraDescription third = ParseCameraDescription(
      "%YAML:1.0\nCamera1.fx: 500\nCamera1.fy: 501\nCamera1.cx: 320\nCamera1.cy: 240\n"
      "RGBD.DepthMapFactor: 1000\n",
      "c");
  EXPECT_FALSE(third.has_size);
  EXPECT_EQ(third.file.depth_scale_per_m, 1000.0);
}

TEST(CameraFormats, OfOrbSlam3sProjectionsOnlyThePinhole) {
  const std::string rest =
      "Camera1.fx: 500\nCamera1.fy: 501\nCamera1.cx: 320\nCamera1.cy: 240\nCamera1.k1: 0.003\n";
  for (const char* type : {"\"PinHole\"", "PinHole", "\"Rectified\""}) {
    EXPECT_EQ(DescriptionRefusal("Camera.type: " + std::string(type) + "\n" + rest), "no error");
  }
  EXPECT_EQ(DescriptionRefusal("%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\n" + rest),
            "c:2: Camera.type is KannalaBrandt8, must be PinHole or Rectified");
}

TEST(CameraFormats, AScaleTheOtherWayRoundIsRefused) {
  const std::string own = "width: 4\nheight: 3\nfx: 4\nfy: 4\ncx: 1.5\ncy: 1\ndepth_scale: ";
  EXPECT_EQ(ParseCameraDescription(own + "1\n", "c").file.depth_scale_per_m, 1.0);
  EXPECT_THROW(ParseCameraDescription(own + "0.001\n", "c"), InputError);
  const std::string orb =
      "%YAML:1.0\nCamera1.fx: 500\nCamera1.fy: 501\nCamera1.cx: 320\nCamera1.cy: 240\n"
      "RGBD.DepthMapFactor: ";
  EXPECT_THROW(ParseCameraDescription(orb + "0.001\n", "c"), InputError);
}

TEST(CameraFormats, MatrixTexts) {
  const char* three =
      " 5.70342205e+02\t  0.00000000e+00\t  3.20000000e+02\t\n 0.0 5.7e+02 2.4e+02\n 0 0 1\n";
  const CameraDescription camera = ParseCameraDescription(three, "c");
  EXPECT_EQ(camera.kind, "camera matrix");
  EXPECT_FALSE(camera.has_size);
  EXPECT_EQ(camera.file.camera.fx_px, 570.342205);
  EXPECT_EQ(camera.file.camera.cy_px, 240.0);
  // ScanNet's intrinsic_depth.txt.
  EXPECT_EQ(
      ParseCameraDescription("577 0 318 0\n0 578 242 0\n0 0 1 0\n0 0 0 1\n", "c").file.camera.fy_px,
      578.0);
  EXPECT_EQ(ParseCameraDescription("500 0 320 0 501 240 0 0 1\n", "c").file.camera.cy_px, 240.0);
}

TEST(CameraFormats, OneClearLineForEachFault) {
  EXPECT_EQ(DescriptionRefusal(""), "c: is empty, must describe a camera");
  EXPECT_EQ(DescriptionRefusal("1 2\n3 4\n"),
            "c: the camera matrix must have three rows of three numbers");
  EXPECT_EQ(DescriptionRefusal("500 0 320\n0 500 240\n0 0\n"), "c:3: has 2 columns, must have 3");
  EXPECT_EQ(DescriptionRefusal("500 0 320\n1 500 240\n0 0 1\n"),
            "c: the camera matrix must be [fx 0 cx; 0 fy cy; 0 0 1]");
  EXPECT_EQ(DescriptionRefusal("Camera.fx: 500\n"), "c: key 'Camera.fy' is missing");
  EXPECT_EQ(DescriptionRefusal("K: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n"),
            "c: key 'image_width' is missing");
  EXPECT_EQ(DescriptionRefusal("width: 640\nheight: 480\nK: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n"
                               "distortion_model: equidistant\nD: [0.1, 0, 0, 0]\n"),
            "c:4: distortion_model is equidistant, must be plumb_bob");
  for (const char* model : {"[]", "[plumb_bob]", "{a: b}"}) {
    EXPECT_EQ(DescriptionRefusal("width: 640\nheight: 480\nK: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n"
                                 "distortion_model: " +
                                 std::string(model) + "\n"),
              "c:4: distortion_model is '" + std::string(model) + "', must be a text");
  }
  const std::string small = "width: 1\nheight: 480\nfx: 480\nfy: 480\ncx: 0\ncy: 240\n";
  EXPECT_EQ(DescriptionRefusal(small), "no error");
  EXPECT_EQ(DescriptionRefusal(small + "distortion: [0.1, 0, 0, 0]\n"),
            "c: width is 1, must be from 2 to 16384 pixels");
  EXPECT_EQ(DescriptionRefusal("what: ever\n"), "c: key 'width' is missing");
  // A matrix does not say the image's size: what fits some image is no error yet.
  EXPECT_EQ(DescriptionRefusal("5000 0 1920\n0 5000 1080\n0 0 1\n"), "no error");
}

TEST(FlipY, IsConjugationWithTheReflection) {
  const Pose3 pose{Eigen::Quaterniond(0.5, -0.1, 0.7, 0.3).normalized(), {1.0, 2.0, 3.0}};
  Eigen::Matrix4d t = Eigen::Matrix4d::Identity();
  t.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  t.topRightCorner<3, 1>() = pose.translation;
  const Eigen::Matrix4d s = Eigen::Vector4d(1, -1, 1, 1).asDiagonal();
  const Eigen::Matrix4d expected = s * t * s;
  const Pose3 flipped = FlipY(pose);
  EXPECT_TRUE(flipped.rotation.toRotationMatrix().isApprox(expected.topLeftCorner<3, 3>(), 1e-12));
  EXPECT_EQ(flipped.translation, Eigen::Vector3d(1.0, -2.0, 3.0));
  EXPECT_EQ(FlipY(flipped), pose);
}

}  // namespace
}  // namespace depthgrid
