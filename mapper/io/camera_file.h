// camera.yaml: the depth camera of a sequence folder.
#pragma once

#include <string>

#include "mapper/core/camera.h"
#include "mapper/core/options.h"

namespace depthgrid {

// Smallest scale in units per metre, as no unit of depth is longer than a metre. A scale given the
// other way round (metres per unit) is below it.
inline constexpr double kLeastDepthScale = 1.0;

// The data needed to read depth images: the camera and the number of PNG units per metre.
struct CameraFile {
  PinholeCamera camera;
  double depth_scale_per_m = 5000.0;  // TUM RGB-D's convention; millimetre data has 1000

  bool operator==(const CameraFile&) const = default;
  void Visit(OptionsVisitor& v);
};

// Keys width height fx fy cx cy, all required; distortion (k1 k2 p1 p2 k3: four or five numbers, or
// none) and depth_scale. Throws InputError.
CameraFile ParseCameraFile(const std::string& text, const std::string& place);
void WriteCameraFile(const std::string& path, const CameraFile& file);

}  // namespace depthgrid
