// The simulated depth sensor: camera, noise model and artifacts.
#pragma once

#include <array>
#include <limits>
#include <string>

#include "mapper/core/camera.h"
#include "mapper/core/options.h"
#include "sim/depth/ray_isa.h"

namespace depthgrid {

// Real cameras, by their published intrinsics (docs/sensors.md has the table with its sources).
enum class CameraPreset {
  kIclNuim,
  kTumFr1,
  kTumFr2,
  kTumFr3,
  kTumDefault,
  kKinectV1,
  kD435,
  kKinectV2,
  kAzure,
  kTof540x360,
};

enum class DepthNoiseModel {
  kNone,      // exact depth
  kNguyen,    // Kinect v1: Nguyen, Izadi, Lovell 2012
  kHanda,     // ICL-NUIM's: Handa, Whelan, McDonald, Davison 2014, after Barron and Malik 2013
  kD435,      // RealSense D435: subpixel error of stereo disparity
  kKinectV2,  // time of flight: Fankhauser et al. 2015
  kAzure,     // time of flight, Azure Kinect-like
};
// All models; noise_traits.h has their properties.
inline constexpr std::array kDepthNoiseModels = {
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kNone, "none"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kNguyen, "nguyen"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kHanda, "handa"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kD435, "d435"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kKinectV2, "kinect_v2"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kAzure, "azure"}};

// Limit of the image size: the colour camera needs 1 GB for a square image of this side, and each
// run draws a few.
constexpr int kMaxImageSidePx = 8192;

constexpr double kNoGrazingLimitDeg = 90.0;  // as grazing_limit_deg: no pixel is invalidated

struct SensorOptions {
  CameraPreset camera = CameraPreset::kIclNuim;  // the paper's data set
  // Overrides of the preset; 0 keeps it. A new size alone scales the intrinsics, so that the field
  // of view stays; `hfov_deg` sets both focal lengths (square pixels).
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = -1.0;  // -1 keeps the preset: 0 is a possible centre, -0.5 the image's edge
  double cy_px = -1.0;
  double hfov_deg = 0.0;

  DepthNoiseModel noise = DepthNoiseModel::kNone;
  double noise_scale = 1.0;  // factor of every standard deviation; quantisation is not scaled
  // Correlation length of the axial errors: their correlation at a distance of d pixels is exp(-(d
  // / this)^2 / 2). 0: independent pixels, as in the published models. Block-matching stereo and
  // filters give several pixels.
  double noise_correlation_px = 0.0;
  // Measured depths outside become invalid; 0 takes the model's own limit (docs/sensors.md).
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  // Pixels with a larger angle of incidence are invalid. The default is Handa's; no other model's
  // source contradicts it. With softness (a standard deviation) the limit is drawn per pixel from a
  // normal distribution. kNoGrazingLimitDeg: no pixel is lost, whatever the softness.
  double grazing_limit_deg = 82.0;
  double grazing_softness_deg = 0.0;
  // Share of the pixels at a depth edge that measure a mix of both sides, as time of flight does.
  double flying_pixels = 0.0;
  // Distance of the pattern projector to the right of the camera; pixels it does not light are
  // invalid. 0: no shadow; a Kinect v1 has 0.075.
  double shadow_baseline_m = 0.0;

  RayIsa isa = RayIsa::kAvx2;  // changes results (ray_isa.h); AVX2 is the common denominator

  void Visit(OptionsVisitor& v);
};

// z-depths the sensor can measure.
struct DepthRange {
  double min_m = 0.0;
  double max_m = std::numeric_limits<double>::infinity();
};

// The preset's camera with the overrides. Throws InputError, "PLACE: cx is ...", for an impossible
// camera.
PinholeCamera SensorCamera(const SensorOptions& options, const std::string& place = "sensor");

// The noise model's range with the overrides. Throws InputError when it is empty.
DepthRange SensorRange(const SensorOptions& options);

}  // namespace depthgrid
