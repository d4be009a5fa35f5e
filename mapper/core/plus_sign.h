// Removes the leading plus sign that numbers in files may have and std::from_chars rejects.
#pragma once

#include <string_view>

namespace depthgrid {

// "+-5" is left as it is, so that std::from_chars rejects it.
inline std::string_view WithoutPlus(std::string_view number) {
  const bool has_plus = number.starts_with('+') && !number.starts_with("+-");
  return number.substr(has_plus ? 1 : 0);
}

}  // namespace depthgrid
