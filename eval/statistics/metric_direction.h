// What is wanted of a score: less, more, a value of its own, or nothing.
#pragma once

#include <optional>
#include <string_view>

#include "eval/statistics/paired_comparison.h"

namespace depthgrid {

// By its path in metrics.json: shares of success, whose last key has a word for it (between `_`:
// precision, recall, f1, iou, mcc, coverage, ssim, success, accuracy), are better when higher, all
// else, such as errors, distances and times, when lower. Of a score with a target this is said of
// its distance from it: lower. Neither is what only describes the run: counts, the length of the
// path, the truth's own figures and those that must be held beside them (thickness of walls,
// corners).
Better BetterOf(std::string_view metric);
// "lower", "higher" or "neither".
const char* NameOf(Better better);

// The value that a score should have, such as 1 of a scale or .95 of the share within a 95 % bound.
std::optional<double> TargetOf(std::string_view metric);
// 0 where they differ by rounding alone, of which a distance would keep nothing else.
double DistanceFrom(double target, double score);

}  // namespace depthgrid
