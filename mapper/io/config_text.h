// The words in which configuration speaks to people: lists of names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

// "fixed, kalman".
std::string Joined(const std::vector<std::string_view>& names);

}  // namespace depthgrid
