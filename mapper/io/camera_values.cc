#include "mapper/io/camera_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {

Config ConfigOfOthers(const std::string& text, const std::string& place) {
  // Without its line end the directive leaves the lines' numbers as they are.
  const bool directive = text.starts_with("%YAML");
  return Config::FromText(directive ? text.substr(std::min(text.find('\n'), text.size())) : text,
                          place);
}

bool BeginsWithNumber(const std::string& text) {
  const std::vector<TextRow> rows = SplitRows(std::string_view(text).substr(0, 4096));
  return !rows.empty() && ParseNumber(rows.front().fields.front()).has_value();
}

double NumberAt(const Config& config, const std::string& key) {
  const auto values = config.List(key);
  const auto number = values.size() == 1 ? ParseNumber(values.front()) : std::nullopt;
  if (!number || !std::isfinite(*number)) {
    throw InputError(config.PlaceOfKey(key), "'" + key + "' must be a number");
  }
  return *number;
}

std::vector<double> NumbersOf(const std::vector<std::string>& items, const std::string& key,
                              const std::string& place) {
  std::vector<double> numbers;
  for (const std::string& item : items) {
    const auto number = ParseNumber(item);
    if (!number || !std::isfinite(*number)) {
      throw InputError(place, fmt::format("'{}' holds {}, must be a list of numbers", key, item));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<double> NumbersAt(const Config& config, const std::string& key) {
  return NumbersOf(config.List(key), key, config.PlaceOfKey(key));
}

int PixelsOf(double number, std::string_view key, const std::string& place) {
  if (number != std::floor(number) || std::abs(number) > 1e6) {
    throw InputError(place,
                     fmt::format("'{}' is {}, must be a whole number of pixels", key, number));
  }
  return static_cast<int>(number);
}

int WholeAt(const Config& config, const std::string& key) {
  return PixelsOf(NumberAt(config, key), key, config.PlaceOfKey(key));
}

std::string FirstOf(const Config& config, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    if (config.Has(key)) return key;
  }
  return "";
}

std::string NeededOf(const Config& config, const std::vector<std::string>& keys) {
  std::string key = FirstOf(config, keys);
  if (key.empty()) {
    throw InputError(config.Place(), fmt::format("key '{}' is missing", keys.front()));
  }
  return key;
}

void SetMatrix(const std::vector<double>& row_major, std::size_t columns, const std::string& place,
               PinholeCamera& camera) {
  if (row_major.size() < 3 * columns || columns < 3) {
    throw InputError(place, "the camera matrix must have three rows of three numbers");
  }
  const auto at = [&](std::size_t row, std::size_t column) {
    return row_major[row * columns + column];
  };
  if (at(1, 0) != 0.0 || at(2, 0) != 0.0 || at(2, 1) != 0.0 || at(2, 2) != 1.0) {
    throw InputError(place, "the camera matrix must be [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  camera.fx_px = at(0, 0);
  camera.cx_px = at(0, 2);
  camera.fy_px = at(1, 1);
  camera.cy_px = at(1, 2);
}

void SetDistortion(const std::vector<double>& coefficients, const std::string& place,
                   PinholeCamera& camera) {
  camera.distortion.fill(0.0);
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (i < camera.distortion.size()) {
      camera.distortion[i] = coefficients[i];
    } else if (coefficients[i] != 0.0) {
      throw InputError(place, "only the plumb-bob distortion k1 k2 p1 p2 k3 is known");
    }
  }
}

}  // namespace depthgrid
