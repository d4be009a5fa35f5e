// The words in which configuration speaks to people: lists of names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

// What a text is that is no YAML, and what takes it: a laser log or a trajectory by its first row.
// Empty of all else.
std::string OtherTextThanKeys(std::string_view text);
// "fixed, kalman".
std::string Joined(const std::vector<std::string_view>& names);
// The word, of a very long one its beginning.
std::string Shortened(const std::string& word);

}  // namespace depthgrid
