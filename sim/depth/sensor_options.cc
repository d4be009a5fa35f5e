#include "sim/depth/sensor_options.h"

#include <cmath>
#include <string>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "sim/depth/noise_traits.h"

namespace depthgrid {
namespace {

PinholeCamera Pinhole(int width_px, int height_px, double fx_px, double fy_px, double cx_px,
                      double cy_px) {
  return {width_px, height_px, fx_px, fy_px, cx_px, cy_px, {}};
}

double FocalOf(int width_px, double hfov_deg) {
  return 0.5 * width_px / std::tan(0.5 * RadFromDeg(hfov_deg));
}

// Square pixels and a centred principal point, from a data sheet's horizontal field of view.
PinholeCamera Nominal(int width_px, int height_px, double hfov_deg) {
  const double focal_px = FocalOf(width_px, hfov_deg);
  return Pinhole(width_px, height_px, focal_px, focal_px, 0.5 * (width_px - 1),
                 0.5 * (height_px - 1));
}

PinholeCamera PresetCamera(CameraPreset preset) {
  switch (preset) {
    case CameraPreset::kIclNuim:
      return Pinhole(640, 480, 481.20, 480.00, 319.5, 239.5);
    case CameraPreset::kTumFr1:
      return Pinhole(640, 480, 517.3, 516.5, 318.6, 255.3);
    case CameraPreset::kTumFr2:
      return Pinhole(640, 480, 520.9, 521.0, 325.1, 249.7);
    case CameraPreset::kTumFr3:
      return Pinhole(640, 480, 535.4, 539.2, 320.1, 247.6);
    case CameraPreset::kTumDefault:
      return Pinhole(640, 480, 525.0, 525.0, 319.5, 239.5);
    case CameraPreset::kKinectV1:
      return Nominal(640, 480, 57.0);
    case CameraPreset::kD435:
      return Nominal(848, 480, 90.0);
    case CameraPreset::kKinectV2:
      return Nominal(512, 424, 70.0);
    case CameraPreset::kAzure:
      return Nominal(640, 576, 65.0);
    case CameraPreset::kTof540x360:
      return Nominal(540, 360, 60.0);
  }
  Broken("a preset has its camera");
}

DepthRange RangeOf(const SensorOptions& options) {
  DepthRange range = noise::TraitsOf(options.noise).range;
  if (options.min_range_m > 0) range.min_m = options.min_range_m;
  if (options.max_range_m > 0) range.max_m = options.max_range_m;
  return range;
}

}  // namespace

void SensorOptions::Visit(OptionsVisitor& v) {
  v.Choice("camera", camera,
           {{CameraPreset::kIclNuim, "icl_nuim"},
            {CameraPreset::kTumFr1, "tum_fr1"},
            {CameraPreset::kTumFr2, "tum_fr2"},
            {CameraPreset::kTumFr3, "tum_fr3"},
            {CameraPreset::kTumDefault, "tum_default"},
            {CameraPreset::kKinectV1, "kinect_v1"},
            {CameraPreset::kD435, "d435"},
            {CameraPreset::kKinectV2, "kinect_v2"},
            {CameraPreset::kAzure, "azure"},
            {CameraPreset::kTof540x360, "tof_540x360"}},
           "the camera whose size and intrinsics are taken");
  v.Number("width", width_px, {0, kMaxImageSidePx}, "image width in pixels, 0: the camera's");
  v.Number("height", height_px, {0, kMaxImageSidePx}, "image height in pixels, 0: the camera's");
  v.Number("fx", fx_px, {0, 1e6}, "focal length in pixels, 0: the camera's");
  v.Number("fy", fy_px, {0, 1e6}, "focal length in pixels, 0: the camera's");
  v.Number("cx", cx_px, {-1, 1e6}, "principal point in pixels, -1: the camera's");
  v.Number("cy", cy_px, {-1, 1e6}, "principal point in pixels, -1: the camera's");
  v.Number("hfov_deg", hfov_deg, {0, 170}, "horizontal field of view in degrees, 0: the camera's");
  v.Choice("noise", noise, kDepthNoiseModels, "depth noise model");
  v.Number("noise_scale", noise_scale, {0, 100}, "factor on the model's standard deviations");
  v.Number("noise_correlation_px", noise_correlation_px, {0, 100},
           "pixels over which errors along the rays are alike, 0: each pixel errs by itself");
  v.Number("min_range_m", min_range_m, {0, 1000},
           "nearer depths are invalid, 0: the model's limit");
  v.Number("max_range_m", max_range_m, {0, 1000},
           "farther depths are invalid, 0: the model's limit");
  const DepthRange range = RangeOf(*this);
  v.Less("min_range_m", range.min_m, "max_range_m", range.max_m);
  v.Number("grazing_limit_deg", grazing_limit_deg, {0, 90},
           "angle of incidence beyond which noisy models lose the pixel, 90: never");
  v.Number("grazing_softness_deg", grazing_softness_deg, {0, 30},
           "standard deviation of that limit from pixel to pixel");
  v.Number("flying_pixels", flying_pixels, {0, 1},
           "share of the pixels at depth edges that mix both sides");
  v.Number("shadow_baseline_m", shadow_baseline_m, {-1, 1},
           "how far to the camera's right its pattern projector is: what it does not light is "
           "invalid; 0: none");
  v.Choice("isa", isa, {{RayIsa::kAvx2, "avx2"}, {RayIsa::kAvx512, "avx512"}},
           "instruction set of the ray kernels; results differ by up to a micrometre");
}

PinholeCamera SensorCamera(const SensorOptions& options, const std::string& place) {
  PinholeCamera camera = PresetCamera(options.camera);
  const int width_px = options.width_px > 0 ? options.width_px : camera.width_px;
  const int height_px = options.height_px > 0 ? options.height_px : camera.height_px;
  const double scale_x = static_cast<double>(width_px) / camera.width_px;
  const double scale_y = static_cast<double>(height_px) / camera.height_px;
  // Scaling is about the image's left edge, u = -0.5.
  const auto scaled_centre = [](double centre_px, double scale) {
    return scale == 1.0 ? centre_px : (centre_px + 0.5) * scale - 0.5;
  };
  camera = Pinhole(width_px, height_px, camera.fx_px * scale_x, camera.fy_px * scale_y,
                   scaled_centre(camera.cx_px, scale_x), scaled_centre(camera.cy_px, scale_y));
  if (options.hfov_deg > 0) camera.fx_px = camera.fy_px = FocalOf(width_px, options.hfov_deg);
  if (options.fx_px > 0) camera.fx_px = options.fx_px;
  if (options.fy_px > 0) camera.fy_px = options.fy_px;
  if (options.cx_px > -1.0) camera.cx_px = options.cx_px;
  if (options.cy_px > -1.0) camera.cy_px = options.cy_px;
  Validate(camera, place);
  if (width_px < 2 || height_px < 2) {  // too small for a scan
    throw InputError(place, "the image is " + std::to_string(width_px) + " x " +
                                std::to_string(height_px) + " pixels, must be 2 x 2 or more");
  }
  return camera;
}

DepthRange SensorRange(const SensorOptions& options) {
  RequireInRange(options, "sensor");
  return RangeOf(options);
}

}  // namespace depthgrid
