// Settings put back to their defaults, by the paths of their keys.
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
// Sets those of these keys to the values of the same order; paths begin with `group`.
std::unique_ptr<OptionsVisitor> MakeValueSetter(const std::vector<SettingValue>& values,
                                                const std::string& group, IsOneOfKeys keys);
}  // namespace internal

// `group` is the path of the options, "slam"; empty where they are the whole. A choice that
// presets others (slam.profile) must be at its default already.
template <typename Options>
Options WithDefaults(Options options, const std::string& group, const IsOneOfKeys& keys) {
  std::vector<internal::SettingValue> values;
  Options defaults;
  defaults.Visit(*internal::MakeValueReader(values));
  options.Visit(*internal::MakeValueSetter(values, group, keys));
  return options;
}

}  // namespace depthgrid
