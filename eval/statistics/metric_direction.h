// Whether more of a score is better.
#pragma once

#include <string_view>

#include "eval/statistics/paired_comparison.h"

namespace depthgrid {

// By the last part of its path in metrics.json: shares of success are better when higher, errors,
// distances and times when lower.
Better BetterOf(std::string_view metric);

}  // namespace depthgrid
