// Whether lower, higher or a target value of a score is better, or none.
#pragma once

#include <optional>
#include <string_view>

#include "eval/statistics/paired_comparison.h"

namespace depthgrid {

// By its path in metrics.json. Higher is better if one of the words (separated by `_`) of the last
// key is precision, recall, f1, iou, mcc, coverage, ssim, success or accuracy. Lower is better for
// all others, such as errors, distances and times, and for scores with a target, whose distance
// from it is compared. Neither for scores that only describe the run: counts, the length of the
// path, figures of the truth, and those that mean something only beside the truth's (thickness of
// walls, corners).
Better BetterOf(std::string_view metric);
// "lower", "higher" or "neither".
const char* NameOf(Better better);

// The value that a score should have, such as 1 for a scale or 0.95 for the share within a 95 %
// bound.
std::optional<double> TargetOf(std::string_view metric);
// Absolute difference, but 0 if it is only rounding: otherwise distances would be compared by
// rounding errors.
double DistanceFrom(double target, double score);

}  // namespace depthgrid
