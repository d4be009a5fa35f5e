#include "mapper/io/camera_file.h"

#include <gtest/gtest.h>

#include "mapper/io/config.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

std::string CameraFileRefusal(const std::string& text) {
  return RefusalOf([&] { ParseCameraFile(text, "camera.yaml"); });
}

constexpr const char* kText =
    "width: 640\nheight: 480\nfx: 517.3\nfy: 516.5\ncx: 318.6\ncy: 255.3\n";

TEST(CameraFile, ReadsAndWrites) {
  const CameraFile file = ParseCameraFile(
      std::string(kText) + "distortion: [0.2624, -0.9531, -0.0054, 0.0026]\ndepth_scale: 1000\n",
      "x");
  EXPECT_EQ(file.camera.fx_px, 517.3);
  EXPECT_EQ(file.camera.distortion, (std::array<double, 5>{0.2624, -0.9531, -0.0054, 0.0026, 0}));
  EXPECT_EQ(file.depth_scale_per_m, 1000.0);
  EXPECT_EQ(ParseCameraFile(ToYaml(file), "x"), file);
  EXPECT_EQ(ParseCameraFile(kText, "x").depth_scale_per_m, 5000.0);
}

TEST(CameraFile, NamesKeyAndRule) {
  EXPECT_EQ(CameraFileRefusal("width: 640\n"), "camera.yaml: key 'height' is missing");
  EXPECT_EQ(CameraFileRefusal(std::string(kText) + "distortion: [1,2,3,4,5,6]\n"),
            "camera.yaml: distortion has 6 numbers, must have the four or five k1 k2 p1 p2 k3");
  EXPECT_EQ(CameraFileRefusal(std::string(kText) + "distortion: [0.1, 0.2, 0.3]\n"),
            "camera.yaml: distortion has 3 numbers, must have the four or five k1 k2 p1 p2 k3");
  EXPECT_EQ(CameraFileRefusal(std::string(kText) + "fz: 1\n"),
            "camera.yaml:7: unknown key 'fz', did you mean 'fx'?");
  EXPECT_EQ(CameraFileRefusal("width: 0\nheight: 480\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"),
            "camera.yaml:1: width is '0', must be from 1 to 16384");
  EXPECT_EQ(CameraFileRefusal("width: 64\nheight: 48\nfx: 50\nfy: 50\ncx: 31.5\ncy: 549\n"),
            "camera.yaml: cy is 549, must be within ten focal lengths of the image");
}

}  // namespace
}  // namespace depthgrid
