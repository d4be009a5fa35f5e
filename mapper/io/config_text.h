// The words in which configuration speaks to people: rules and lists of names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mapper/core/options.h"

namespace depthgrid {

// "from 0 to 1", "at least 0", "a finite number".
std::string Shown(const Interval& interval);

// "fixed, kalman".
std::string Joined(const std::vector<std::string_view>& names);

}  // namespace depthgrid
