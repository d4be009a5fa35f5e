// Numbers of files have a plus sign in front at times, which std::from_chars does not read.
#pragma once

#include <string_view>

namespace depthgrid {

// Only one sign leads a number: what "+-5" is called is left as it is, and refused.
inline std::string_view WithoutPlus(std::string_view number) {
  const bool has_plus = number.starts_with('+') && !number.starts_with("+-");
  return number.substr(has_plus ? 1 : 0);
}

}  // namespace depthgrid
