#include "mapper/io/scan_clock.h"

#include <fmt/format.h>

#include <algorithm>

namespace depthgrid {
namespace {

constexpr std::size_t kMostNamed = 10;

}  // namespace

std::optional<double> ScanClock::Take(double stated_s, int line) {
  ++next_;
  if (!mended_) {
    falls_ = falls_ || (!stated_s_.empty() && stated_s < stated_s_.back());
    stated_s_.push_back(stated_s);
    lines_.push_back(line);
  }
  return order_.stamps_s.empty() ? std::optional(stated_s) : order_.stamps_s[next_ - 1];
}

bool ScanClock::Mend() {
  mended_ = true;
  if (falls_) order_ = OrderOf(stated_s_);
  stated_s_ = {};
  return falls_;
}

bool ScanClock::IsSetBack() const {
  const auto& all = order_.set_back;
  const auto last = std::lower_bound(
      all.begin(), all.end(), next_,
      [](const StampOrder::SetBack& set_back, std::size_t next) { return set_back.at + 1 < next; });
  return last != all.end() && last->at + 1 == next_;
}

std::vector<std::string> ScanClock::Warnings(const std::string& path, double end_s) const {
  std::vector<std::string> warnings;
  for (const auto& [at, by_s] : order_.set_back) {
    if (*order_.stamps_s[at] >= end_s) break;
    if (warnings.size() == kMostNamed) {
      warnings.push_back(fmt::format("{}: the clock was set back {} times: is it one recording?",
                                     path, order_.set_back.size()));
      break;
    }
    warnings.push_back(
        fmt::format("{}:{}: the clock was set back, by about {:.3f} s: so much is added to the "
                    "stamps of this scan and all after it",
                    path, lines_[at], by_s));
  }
  return warnings;
}

}  // namespace depthgrid
