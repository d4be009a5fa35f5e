// Helpers for the data of report pages.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "eval/files/base64.h"
#include "mapper/core/rgb_image.h"
#include "mapper/io/png.h"

namespace depthgrid {

using ReportJson = nlohmann::ordered_json;

// Rounded to the digits that a picture can show; null if not finite.
inline ReportJson Rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

inline ReportJson RoundedAll(const std::vector<double>& values, int decimals) {
  ReportJson json = ReportJson::array();
  for (const double value : values) json.push_back(Rounded(value, decimals));
  return json;
}

inline std::string PngUri(const std::string& png) { return "data:image/png;base64," + Base64(png); }
inline std::string PngUri(const RgbImage& image) { return PngUri(EncodeRgbPng(image)); }

}  // namespace depthgrid
