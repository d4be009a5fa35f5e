#include "mapper/core/options.h"

#include <charconv>
#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// The shortest decimal that parses to the same number.
std::string Shown(double value) {
  constexpr double kLeastFixed = 1e-4, kMostFixed = 1e16;
  const double size = std::abs(value);
  const bool is_fixed = size == 0.0 || (size >= kLeastFixed && size < kMostFixed);
  char text[64];
  const auto end =
      std::to_chars(std::begin(text), std::end(text), value,
                    is_fixed ? std::chars_format::fixed : std::chars_format::scientific);
  return {text, end.ptr};
}

class RangeCheck final : public OptionsVisitor {
 public:
  RangeCheck(const std::string& path, KeyPlaces places) : path_(path), places_(std::move(places)) {}

  void Number(std::string_view key, double& value, Interval allowed, std::string_view) override {
    Check(key, value, allowed);
  }
  void Number(std::string_view key, int& value, Interval allowed, std::string_view) override {
    Check(key, value, allowed);
  }
  void Seed(std::string_view, std::uint64_t&, std::string_view) override {}
  void Flag(std::string_view, bool&, std::string_view) override {}
  void Text(std::string_view, std::string&, std::string_view) override {}
  void Numbers(std::string_view key, std::vector<double>& values, Interval allowed,
               std::string_view) override {
    CheckAll(key, values, allowed);
  }
  void Tuple(std::string_view key, std::span<double> values, Interval allowed,
             std::string_view) override {
    CheckAll(key, values, allowed);
  }
  void Rows(std::string_view key, std::vector<double>& values, std::size_t, Interval allowed,
            std::string_view) override {
    CheckAll(key, values, allowed);
  }
  void PerAxis(std::string_view key, std::array<double, 3>& values, Interval allowed,
               std::string_view) override {
    CheckAll(key, values, allowed);
  }
  void Less(std::string_view low_key, double low, std::string_view high_key, double high) override {
    CheckPair(low < high, low_key, low, "below", high_key, high);
  }
  void NotMore(std::string_view low_key, double low, std::string_view high_key,
               double high) override {
    CheckPair(low <= high, low_key, low, "at most", high_key, high);
  }

 protected:
  void ChoiceIndex(std::string_view key, int& index, const std::vector<std::string_view>& names,
                   std::string_view) override {
    if (index >= 0) return;
    std::string all;
    for (const std::string_view name : names) all.append(all.empty() ? "" : ", ").append(name);
    Fail(key, "", "is none of its values, " + all);
  }
  bool Begin(std::string_view key, std::string_view) override {
    lengths_.push_back(path_.size());
    path_ = PathOf(key);
    return true;
  }
  void End() override {
    path_.resize(lengths_.back());
    lengths_.pop_back();
  }

 private:
  void Check(std::string_view key, double value, const Interval& allowed) const {
    if (std::isfinite(value) && value >= allowed.low && value <= allowed.high) return;
    Fail(key, "", "is " + Shown(value) + ", must be " + depthgrid::Shown(allowed));
  }
  void CheckPair(bool holds, std::string_view low_key, double low, const char* rule,
                 std::string_view high_key, double high) const {
    if (holds) return;
    Fail(low_key, high_key,
         "is " + Shown(low) + ", must be " + rule + " " + std::string(high_key) + ", " +
             Shown(high));
  }
  void CheckAll(std::string_view key, std::span<const double> values,
                const Interval& allowed) const {
    for (const double value : values) Check(key, value, allowed);
  }

  std::string PathOf(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  }
  std::string PlaceOf(std::string_view key) const {
    return places_ && !key.empty() ? places_(PathOf(key)) : "";
  }
  // Names `other_key`'s place if only that one was given.
  [[noreturn]] void Fail(std::string_view key, std::string_view other_key,
                         const std::string& message) const {
    std::string place = PlaceOf(key);
    if (place.empty()) place = PlaceOf(other_key);
    if (place.empty()) throw InputError(PathOf(key), message);
    throw InputError(place, PathOf(key) + " " + message);
  }

  std::string path_;
  KeyPlaces places_;
  std::vector<std::size_t> lengths_;  // length of the path before each open group
};

}  // namespace

std::string Shown(const Interval& interval) {
  const bool low = std::isfinite(interval.low);
  const bool high = std::isfinite(interval.high);
  if (low && high) return "from " + Shown(interval.low) + " to " + Shown(interval.high);
  if (low) return "at least " + Shown(interval.low);
  if (high) return "at most " + Shown(interval.high);
  return "a finite number";
}

namespace internal {
std::unique_ptr<OptionsVisitor> MakeRangeCheck(const std::string& path, KeyPlaces places) {
  return std::make_unique<RangeCheck>(path, std::move(places));
}
}  // namespace internal

}  // namespace depthgrid
