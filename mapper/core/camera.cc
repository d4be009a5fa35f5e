#include "mapper/core/camera.h"

#include <cmath>
#include <sstream>
#include <string>

#include "mapper/core/error.h"

namespace depthgrid {

void Validate(const PinholeCamera& camera, const std::string& place) {
  const auto require = [&](bool holds, const char* key, double value, const char* rule) {
    if (!holds) {
      std::ostringstream message;
      message << key << " is " << value << ", must be " << rule;
      throw InputError(place, message.str());
    }
  };
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  // Undistortion interpolates between neighbouring pixels.
  const int least_px = camera.HasDistortion() ? 2 : 1;
  const std::string sizes =
      "from " + std::to_string(least_px) + " to " + std::to_string(kMostImageSidePx) + " pixels";
  const auto sized = [&](int side_px) {
    return side_px >= least_px && side_px <= kMostImageSidePx;
  };
  require(sized(camera.width_px), "width", camera.width_px, sizes.c_str());
  require(sized(camera.height_px), "height", camera.height_px, sizes.c_str());
  require(positive(camera.fx_px), "fx", camera.fx_px, "positive");
  require(positive(camera.fy_px), "fy", camera.fy_px,
          "positive (a y-up world is expressed in the poses, see docs/conventions.md)");
  // A cropped image need not contain its principal point, but one this far outside (rays 84 degrees
  // off the axis and more) is a mistake of units or columns.
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
