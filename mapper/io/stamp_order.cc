#include "mapper/io/stamp_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/median.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// At most this many scans are dropped to keep the others' stamps: late messages, a wrong stamp or
// two. A clock set back by less loses no more.
constexpr std::size_t kFewStamps = 3;
// Number of steps before the clock was set back that define the usual step.
constexpr std::size_t kStepsLookedAt = 1000;
// The usual step if it is unknown.
constexpr double kAnyStepS = 0.1;

// Whether the next few stamps from `begin` on increase.
bool RisesFrom(const std::vector<double>& stamps_s, std::size_t begin) {
  const std::size_t end = std::min(begin + kFewStamps + 2, stamps_s.size());
  return std::is_sorted(stamps_s.begin() + static_cast<std::ptrdiff_t>(begin),
                        stamps_s.begin() + static_cast<std::ptrdiff_t>(end));
}

class Ordering {
 public:
  explicit Ordering(const std::vector<double>& stamps_s) : stamps_s_(stamps_s) {
    order_.stamps_s.resize(stamps_s.size());
  }

  StampOrder Order() {
    for (std::size_t i = 0; i < stamps_s_.size(); ++i) {
      order_.stamps_s[i] = At(i);
      if (!kept_.empty() && At(i) < Last() && !IsSameStamp(At(i), Last())) Mend(i);
      if (kept_.empty() || *order_.stamps_s[i] > Last()) kept_.push_back(i);
    }
    return std::move(order_);
  }

 private:
  double At(std::size_t i) const { return stamps_s_[i] + behind_s_; }
  double Last() const { return *order_.stamps_s[kept_.back()]; }

  // Handles a stamp that is earlier than the last.
  void Mend(std::size_t i) {
    if (!RisesFrom(stamps_s_, i)) return;
    std::size_t early = 0;  // number of stamps from i on that are earlier than the last
    while (early <= kFewStamps && i + early < stamps_s_.size() && At(i + early) <= Last()) ++early;
    if (early <= kFewStamps) return;
    std::size_t late = 0;  // number of kept stamps that are later
    while (late <= kFewStamps && late < kept_.size() &&
           *order_.stamps_s[kept_[kept_.size() - 1 - late]] >= At(i)) {
      ++late;
    }
    if (late > kFewStamps) {
      SetBack(i);
      return;
    }
    for (; late > 0; --late) {
      order_.stamps_s[kept_.back()].reset();
      kept_.pop_back();
    }
  }

  void SetBack(std::size_t i) {
    std::vector<double> steps_s;
    for (std::size_t k = kept_.size() - std::min(kept_.size() - 1, kStepsLookedAt);
         k < kept_.size(); ++k) {
      steps_s.push_back(*order_.stamps_s[kept_[k]] - *order_.stamps_s[kept_[k - 1]]);
    }
    const double usual_s = steps_s.empty() ? kAnyStepS : UpperMedian(std::move(steps_s));
    // Rounded to a millisecond, so that users can subtract it again.
    const double by_s = std::ceil(1e3 * (Last() - At(i) + usual_s) - 1e-3) * 1e-3;
    behind_s_ += by_s;
    order_.set_back.push_back({i, by_s});
    order_.stamps_s[i] = At(i);
  }

  const std::vector<double>& stamps_s_;
  StampOrder order_;
  std::vector<std::size_t> kept_;  // indices with increasing stamps
  double behind_s_ = 0.0;
};

}  // namespace

StampOrder OrderOf(const std::vector<double>& stamps_s) { return Ordering(stamps_s).Order(); }

std::optional<std::string> DoubtOfSorted(const std::vector<double>& stamps_s,
                                         const std::vector<int>& lines, const std::string& place) {
  const StampOrder order = OrderOf(stamps_s);
  if (order.set_back.empty()) return {};
  const StampOrder::SetBack& first = order.set_back.front();
  return fmt::format(
      "{}:{}: the clock was set back here, by about {:.3f} s{}: sorted by stamp, what was recorded "
      "later comes first, and mixed with what it overlaps; split the file before "
      "this line and use the parts one by one",
      place, lines[first.at], first.by_s,
      order.set_back.size() == 1 ? "" : fmt::format(" ({} such lines)", order.set_back.size()));
}

}  // namespace depthgrid
