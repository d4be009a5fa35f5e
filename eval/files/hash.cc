#include "eval/files/hash.h"

#include <fmt/format.h>

namespace depthgrid {

std::string ContentHash::Hex() const { return fmt::format("{:016x}", state_); }

bool ContentHash::IsHex(std::string_view text) {
  constexpr std::size_t kDigits = 16;
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == text.npos;
}

}  // namespace depthgrid
