// Resets settings to their defaults, by the paths of their keys.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "mapper/core/options.h"

namespace depthgrid {

using IsOneOfKeys = std::function<bool(const std::string& key_path)>;

namespace internal {
using SettingValue = std::variant<double, int, std::uint64_t, bool, std::string,
                                  std::vector<double>, std::array<double, 3>>;
// The values in the order they are visited.
std::unique_ptr<OptionsVisitor> MakeValueReader(std::vector<SettingValue>& values);
// Sets the settings for which `keys` is true to `values`, which are in order of visits; paths begin
// with `group`.
std::unique_ptr<OptionsVisitor> MakeValueSetter(const std::vector<SettingValue>& values,
                                                const std::string& group, IsOneOfKeys keys);
}  // namespace internal

// `group`: the path of the options, such as "slam"; empty for all. A setting that presets others
// (slam.profile) must already have its default.
template <typename Options>
Options WithDefaults(Options options, const std::string& group, const IsOneOfKeys& keys) {
  std::vector<internal::SettingValue> values;
  Options defaults;
  defaults.Visit(*internal::MakeValueReader(values));
  options.Visit(*internal::MakeValueSetter(values, group, keys));
  return options;
}

}  // namespace depthgrid
