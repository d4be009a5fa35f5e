#include "sim/depth/sensor_options.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"

namespace depthgrid {
namespace {

SensorOptions FromYaml(const std::string& text) {
  SensorOptions options;
  Config::FromText(text, "test.yaml").Read(options);
  return options;
}

double HfovDeg(const PinholeCamera& camera) {
  return DegFromRad(2.0 * std::atan(0.5 * camera.width_px / camera.fx_px));
}

double VfovDeg(const PinholeCamera& camera) {
  return DegFromRad(2.0 * std::atan(0.5 * camera.height_px / camera.fy_px));
}

TEST(SensorOptions, DefaultIsIclNuimWithoutNoise) {
  EXPECT_EQ(SensorCamera(SensorOptions{}), PinholeCamera{});
  EXPECT_EQ(SensorOptions{}.noise, DepthNoiseModel::kNone);
  EXPECT_NEAR(HfovDeg(PinholeCamera{}), 67.25, 0.01);
  EXPECT_NEAR(VfovDeg(PinholeCamera{}), 53.13, 0.01);
}

TEST(SensorOptions, PresetsByName) {
  const PinholeCamera d435 = SensorCamera(FromYaml("{camera: d435, noise: d435}"));
  EXPECT_EQ(d435.width_px, 848);
  EXPECT_NEAR(d435.fx_px, 424.0, 1e-9);
  EXPECT_NEAR(HfovDeg(SensorCamera(FromYaml("camera: kinect_v1"))), 57.0, 1e-9);
  const PinholeCamera tof = SensorCamera(FromYaml("camera: tof_540x360"));
  EXPECT_EQ(tof.width_px, 540);
  EXPECT_EQ(tof.height_px, 360);
  EXPECT_THROW(FromYaml("camera: kinect"), InputError);
}

TEST(SensorOptions, ANewSizeKeepsTheFieldOfView) {
  const PinholeCamera half = SensorCamera(FromYaml("{camera: tum_fr1, width: 320, height: 240}"));
  EXPECT_NEAR(half.fx_px, 517.3 / 2, 1e-12);
  EXPECT_NEAR(half.fy_px, 516.5 / 2, 1e-12);
  EXPECT_NEAR(half.cx_px, (318.6 + 0.5) / 2 - 0.5, 1e-12);
  EXPECT_NEAR(half.cy_px, (255.3 + 0.5) / 2 - 0.5, 1e-12);
}

// Before anything is rendered, and by the name that the size was given under.
TEST(SensorOptions, AnImageIsAtLeastTwoPixelsEachWay) {
  EXPECT_EQ(SensorCamera(FromYaml("{width: 2, height: 2}")).height_px, 2);
  for (const char* size : {"height: 1", "width: 1"}) {
    try {
      SensorCamera(FromYaml(size), "--set sensor: sensor");
      ADD_FAILURE() << size;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("--set sensor: sensor: the image is "), 0U);
    }
  }
}

TEST(SensorOptions, ExplicitIntrinsicsWin) {
  const PinholeCamera camera =
      SensorCamera(FromYaml("{width: 320, hfov_deg: 90, fy: 200, cx: 0, cy: 7.5}"));
  EXPECT_NEAR(camera.fx_px, 160.0, 1e-9);
  EXPECT_EQ(camera.fy_px, 200.0);
  EXPECT_EQ(camera.cx_px, 0.0);
  EXPECT_EQ(camera.cy_px, 7.5);
}

TEST(SensorOptions, AnAxisThroughTheImagesEdgeIsOne) {
  const PinholeCamera camera = SensorCamera(FromYaml("{cx: -0.5, cy: -0.25}"));
  EXPECT_EQ(camera.cx_px, -0.5);
  EXPECT_EQ(camera.cy_px, -0.25);
  const PinholeCamera own = SensorCamera(FromYaml("{camera: tum_fr1, cx: -1, cy: -1}"));
  EXPECT_EQ(own.cx_px, 318.6);
  EXPECT_EQ(own.cy_px, 255.3);
}

TEST(SensorOptions, RangesAreTheModelsUnlessOverridden) {
  EXPECT_EQ(SensorRange(FromYaml("noise: kinect_v2")).max_m, 4.5);
  EXPECT_EQ(SensorRange(FromYaml("{noise: kinect_v2, max_range_m: 3}")).max_m, 3.0);
  EXPECT_EQ(SensorRange(FromYaml("{noise: kinect_v2, max_range_m: 3}")).min_m, 0.5);
  EXPECT_TRUE(std::isinf(SensorRange(FromYaml("noise: handa")).max_m));
  EXPECT_THROW(SensorRange(FromYaml("{noise: kinect_v2, max_range_m: 0.4}")), InputError);
}

}  // namespace
}  // namespace depthgrid
