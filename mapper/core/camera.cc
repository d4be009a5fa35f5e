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
  // A cut-out of an image may not hold its principal point; one far outside is a slip of units or
  // columns, and leaves no usable rays.
  const auto near = [](double centre_px, int size_px) {
    return centre_px >= -size_px && centre_px <= 2.0 * size_px;  // false for NaN too
  };
  require(near(camera.cx_px, camera.width_px), "cx", camera.cx_px,
          "at most an image's width outside the image");
  require(near(camera.cy_px, camera.height_px), "cy", camera.cy_px,
          "at most an image's height outside the image");
  for (const double k : camera.distortion) require(std::isfinite(k), "distortion", k, "finite");
}

}  // namespace depthgrid
