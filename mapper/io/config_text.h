// Texts for configuration messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

// For a text that is not YAML but, by its first row, a laser log or a trajectory: what it is and
// which option takes it. Else empty.
std::string OtherTextThanKeys(std::string_view text);
// "fixed, kalman".
std::string Joined(const std::vector<std::string_view>& names);
// The word, truncated if very long.
std::string Shortened(const std::string& word);

}  // namespace depthgrid
