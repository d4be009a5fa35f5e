// The words in which configuration speaks to people: lists of names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

// "fixed, kalman".
std::string Joined(const std::vector<std::string_view>& names);
// The word, of a very long one its beginning.
std::string Shortened(const std::string& word);

}  // namespace depthgrid
