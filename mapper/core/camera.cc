#include "mapper/core/camera.h"

#include <cmath>
#include <string>

#include "mapper/core/error.h"

namespace depthgrid {

void Validate(const PinholeCamera& camera, const std::string& place) {
  constexpr int kMaxSizePx = 16384;
  const auto require = [&](bool holds, const char* key, double value, const char* rule) {
    if (!holds) {
      throw InputError(place,
                       std::string(key) + " is " + std::to_string(value) + ", must be " + rule);
    }
  };
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  require(camera.width_px > 0 && camera.width_px <= kMaxSizePx, "width", camera.width_px,
          "from 1 to 16384 pixels");
  require(camera.height_px > 0 && camera.height_px <= kMaxSizePx, "height", camera.height_px,
          "from 1 to 16384 pixels");
  require(positive(camera.fx_px), "fx", camera.fx_px, "positive");
  require(positive(camera.fy_px), "fy", camera.fy_px,
          "positive (a y-up world is expressed in the poses, see docs/conventions.md)");
  // A cut-out of an image need not hold its principal point; one this far outside is a slip of
  // units or columns: its rays are 84 degrees off the axis and more.
  constexpr double kMostFocalLengths = 10.0;
  const auto near = [](double centre_px, int size_px, double focal_px) {
    const double most_px = kMostFocalLengths * focal_px;
    return centre_px >= -most_px && centre_px <= size_px + most_px;  // false for NaN too
  };
  require(near(camera.cx_px, camera.width_px, camera.fx_px), "cx", camera.cx_px,
          "within ten focal lengths of the image");
  require(near(camera.cy_px, camera.height_px, camera.fy_px), "cy", camera.cy_px,
          "within ten focal lengths of the image");
  for (const double k : camera.distortion) require(std::isfinite(k), "distortion", k, "finite");
}

}  // namespace depthgrid
