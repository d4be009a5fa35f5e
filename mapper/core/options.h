// How a component's options describe themselves. Each component has one plain struct with defaults
// and a
//   void Visit(OptionsVisitor& v);
// that names every field once, with its allowed interval and its meaning. Reading from a file,
// writing the effective values and listing the keys are visitors; no component knows a file format.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {

struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

// "from 0 to 1", "at least 0", "a finite number".
std::string Shown(const Interval& interval);

// An enum value and its name in files.
template <typename Enum>
using ChoiceName = std::pair<Enum, std::string_view>;

class OptionsVisitor {
 public:
  virtual ~OptionsVisitor() = default;

  virtual void Number(std::string_view key, double& value, Interval allowed,
                      std::string_view meaning) = 0;
  virtual void Number(std::string_view key, int& value, Interval allowed,
                      std::string_view meaning) = 0;
  virtual void Seed(std::string_view key, std::uint64_t& value, std::string_view meaning) = 0;
  virtual void Flag(std::string_view key, bool& value, std::string_view meaning) = 0;
  virtual void Text(std::string_view key, std::string& value, std::string_view meaning) = 0;
  virtual void Numbers(std::string_view key, std::vector<double>& values, Interval allowed,
                       std::string_view meaning) = 0;
  // Exactly values.size() numbers, such as a point.
  virtual void Tuple(std::string_view key, std::span<double> values, Interval allowed,
                     std::string_view meaning) = 0;
  // A list of lists of `width` numbers each, such as an outline; stored row after row in `values`.
  virtual void Rows(std::string_view key, std::vector<double>& values, std::size_t width,
                    Interval allowed, std::string_view meaning) = 0;
  // One number for all axes, or [forward, left, yaw].
  virtual void PerAxis(std::string_view key, std::array<double, 3>& values, Interval allowed,
                       std::string_view meaning) = 0;

  // Requires that the first of two keys of this group is less than (or not more than) the second.
  // Only RequireInRange checks it: the two may be set in different files.
  virtual void Less(std::string_view /*low_key*/, double /*low*/, std::string_view /*high_key*/,
                    double /*high*/) {}
  virtual void NotMore(std::string_view /*low_key*/, double /*low*/, std::string_view /*high_key*/,
                       double /*high*/) {}

  // One of a fixed set of names.
  template <typename Enum>
  void Choice(std::string_view key, Enum& value, std::span<const ChoiceName<Enum>> allowed,
              std::string_view meaning) {
    std::vector<std::string_view> names;
    int index = -1;  // no name has this value
    for (const auto& [candidate, name] : allowed) {
      if (candidate == value) index = static_cast<int>(names.size());
      names.push_back(name);
    }
    ChoiceIndex(key, index, names, meaning);
    if (index >= 0) value = allowed[static_cast<std::size_t>(index)].first;
  }
  template <typename Enum>
  void Choice(std::string_view key, Enum& value, std::initializer_list<ChoiceName<Enum>> allowed,
              std::string_view meaning) {
    Choice(key, value, std::span<const ChoiceName<Enum>>(allowed.begin(), allowed.size()), meaning);
  }
  // From a table that is also used elsewhere.
  template <typename Enum, std::size_t kCount>
  void Choice(std::string_view key, Enum& value,
              const std::array<ChoiceName<Enum>, kCount>& allowed, std::string_view meaning) {
    Choice(key, value, std::span<const ChoiceName<Enum>>(allowed), meaning);
  }

  // A nested struct with a Visit of its own.
  template <typename Options>
  void Group(std::string_view key, Options& options, std::string_view meaning) {
    if (!Begin(key, meaning)) return;
    options.Visit(*this);
    End();
  }

 protected:
  // `index` is -1 for a value that has no name.
  virtual void ChoiceIndex(std::string_view key, int& index,
                           const std::vector<std::string_view>& names,
                           std::string_view meaning) = 0;
  // False skips the group, as nothing in the input mentions it.
  virtual bool Begin(std::string_view key, std::string_view meaning) = 0;
  virtual void End() = 0;
};

// The place (file and line) where a key such as "mapper.scan.beams" was set; empty where it was
// not.
using KeyPlaces = std::function<std::string(const std::string& key_path)>;

namespace internal {
std::unique_ptr<OptionsVisitor> MakeRangeCheck(const std::string& path, KeyPlaces places);
}  // namespace internal

// For options that were set in code or in several places: throws InputError for the first value
// outside its interval, "PATH.group.key: is 2, must be from 0 to 1", or beyond another's, "must be
// below max_range_m, 1"; the place of the key comes first, where known.
template <typename Options>
void RequireInRange(Options options, const std::string& path, KeyPlaces places = {}) {
  options.Visit(*internal::MakeRangeCheck(path, std::move(places)));
}

// Calls `work` and rethrows its SettingError as an InputError naming the place where the key was
// set.
template <typename Work>
void NamingPlaces(const KeyPlaces& places, const Work& work) {
  try {
    work();
  } catch (const SettingError& error) {
    const std::string place = places(error.key());
    if (place.empty()) throw;
    throw InputError(place, error.key() + " " + error.message());
  }
}

}  // namespace depthgrid
