// The simulated depth sensor: which camera, which noise, which of a real sensor's weaknesses.
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
// All of them; what differs between them is in noise_traits.h.
inline constexpr std::array kDepthNoiseModels = {
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kNone, "none"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kNguyen, "nguyen"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kHanda, "handa"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kD435, "d435"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kKinectV2, "kinect_v2"},
    ChoiceName<DepthNoiseModel>{DepthNoiseModel::kAzure, "azure"}};

// Of an image: what the colour camera draws in memory that most have (1 GB); each run
// makes some such pictures.
constexpr int kMaxImageSidePx = 8192;

constexpr double kNoGrazingLimitDeg = 90.0;  // as grazing_limit_deg: no pixel is lost

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
  double noise_scale = 1.0;  // times every standard deviation; a model's own quantisation stays
  // Errors along the rays are alike in neighbouring pixels: their correlation at a distance of d
  // pixels is exp(-(d / this)^2 / 2). 0: each pixel errs by itself, as the models have it. Stereo
  // that compares blocks of pixels, and filters, make it several pixels.
  double noise_correlation_px = 0.0;
  // Measured depths outside become invalid; 0 takes the model's own limit (docs/sensors.md).
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  // Pixels meeting the surface more obliquely are lost: Handa's 82 degrees, which no other model's
  // source contradicts. With softness the limit is drawn for each pixel, normal about the first.
  // kNoGrazingLimitDeg: none is lost, softness or not.
  double grazing_limit_deg = 82.0;
  double grazing_softness_deg = 0.0;
  // Share of the pixels at a depth edge that measure a mix of both sides, as time of flight does.
  double flying_pixels = 0.0;
  // Distance of the pattern projector to the camera's right: what it does not light is lost. 0 off;
  // a Kinect v1 has 0.075.
  double shadow_baseline_m = 0.0;

  RayIsa isa = RayIsa::kAvx2;  // part of the result; AVX2 is on every machine of the last decade

  void Visit(OptionsVisitor& v);
};

// z-depths the sensor can measure.
struct DepthRange {
  double min_m = 0.0;
  double max_m = std::numeric_limits<double>::infinity();
};

// The preset's camera with the overrides. Throws InputError, "PLACE: cx is ...", for a camera
// nobody can build.
PinholeCamera SensorCamera(const SensorOptions& options, const std::string& place = "sensor");

// The noise model's range with the overrides. Throws InputError when nothing is left of it.
DepthRange SensorRange(const SensorOptions& options);

}  // namespace depthgrid
