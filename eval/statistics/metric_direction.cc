#include "eval/statistics/metric_direction.h"

#include <algorithm>
#include <array>

namespace depthgrid {

Better BetterOf(std::string_view metric) {
  constexpr std::array<std::string_view, 10> kHigher = {"precision", "recall",   "f1",   "iou",
                                                        "mcc",       "coverage", "ssim", "success",
                                                        "accuracy",  "within"};
  const std::string_view last = metric.substr(metric.rfind('.') + 1);
  const bool higher = std::any_of(kHigher.begin(), kHigher.end(), [&](std::string_view name) {
    return last.find(name) != std::string_view::npos;
  });
  return higher ? Better::kHigher : Better::kLower;
}

}  // namespace depthgrid
