#include "eval/experiment/camera_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace depthgrid {
namespace {

// For example, intrinsics for images of another size.
std::optional<std::string> DoubtOfCentre(const PinholeCamera& camera) {
  const auto is_inside = [](double centre_px, int size_px) {
    return centre_px >= -0.5 && centre_px <= size_px - 0.5;
  };
  if (is_inside(camera.cx_px, camera.width_px) && is_inside(camera.cy_px, camera.height_px)) {
    return {};
  }
  return fmt::format(
      "the camera's principal point, sensor.cx {:g} and cy {:g}, lies outside its image of {} x {} "
      "pixels: are they of another size?",
      camera.cx_px, camera.cy_px, camera.width_px, camera.height_px);
}

// For example, if only the width or height was set, which scales only one of the preset's focal
// lengths, or only one focal length.
std::optional<std::string> DoubtOfPixels(const SensorOptions& sensor, const PinholeCamera& camera) {
  constexpr double kMostApart = 1.05;  // the presets have 1.007
  const auto [least_px, most_px] = std::minmax(camera.fx_px, camera.fy_px);
  const bool has_fx = sensor.fx_px > 0.0, has_fy = sensor.fy_px > 0.0;
  if ((has_fx && has_fy) || most_px <= kMostApart * least_px) return {};
  if (has_fx || has_fy) {
    return fmt::format("sensor.fx is {:g} and fy {:g}, of which only {} was set: set both",
                       camera.fx_px, camera.fy_px, has_fx ? "fx" : "fy");
  }
  return fmt::format(
      "sensor.width {} and height {} scale the camera's focal lengths to {:g} and {:g} pixels: "
      "scale both by one factor, or set sensor.hfov_deg, which makes square pixels",
      camera.width_px, camera.height_px, camera.fx_px, camera.fy_px);
}

}  // namespace

std::vector<std::string> DoubtsOfCamera(const SensorOptions& sensor) {
  const PinholeCamera camera = SensorCamera(sensor);
  std::vector<std::string> doubts;
  for (const auto& doubt : {DoubtOfCentre(camera), DoubtOfPixels(sensor, camera)}) {
    if (doubt) doubts.push_back(*doubt);
  }
  return doubts;
}

}  // namespace depthgrid
