#include "mapper/io/camera_file.h"

#include <algorithm>

#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"

namespace depthgrid {

void CameraFile::Visit(OptionsVisitor& v) {
  constexpr Interval kSizePx{1, kMostImageSidePx};
  constexpr Interval kFocalPx{1e-3, 1e6};
  constexpr Interval kCentrePx{-1e6, 1e6};
  v.Number("width", camera.width_px, kSizePx, "image width, pixels");
  v.Number("height", camera.height_px, kSizePx, "image height, pixels");
  v.Number("fx", camera.fx_px, kFocalPx, "focal length along x, pixels");
  v.Number("fy", camera.fy_px, kFocalPx, "focal length along y, pixels");
  v.Number("cx", camera.cx_px, kCentrePx, "principal point, pixels; the first pixel's centre is 0");
  v.Number("cy", camera.cy_px, kCentrePx, "principal point, pixels; the first pixel's centre is 0");
  std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
  v.Numbers("distortion", distortion, {-1e3, 1e3}, "plumb-bob coefficients k1 k2 p1 p2 k3");
  distortion.resize(camera.distortion.size(), 0.0);
  std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
  v.Number("depth_scale", depth_scale_per_m, {kLeastDepthScale, 1e6},
           "depth image units a metre: 1000 of millimetres");
}

CameraFile ParseCameraFile(const std::string& text, const std::string& place) {
  const Config config = Config::FromText(text, place);
  for (const char* key : {"width", "height", "fx", "fy", "cx", "cy"}) {
    if (!config.Has(key)) throw InputError(place, std::string("key '") + key + "' is missing");
  }
  CameraFile file;
  const std::size_t numbers = config.Has("distortion") ? config.List("distortion").size() : 0;
  if (numbers != 0 && numbers != 4 && numbers != file.camera.distortion.size()) {
    throw InputError(place, "distortion has " + std::to_string(numbers) +
                                " numbers, must have the four or five k1 k2 p1 p2 k3");
  }
  config.Read(file);
  Validate(file.camera, place);
  return file;
}

void WriteCameraFile(const std::string& path, const CameraFile& file) {
  WriteFile(path, ToYaml(file));
}

}  // namespace depthgrid
