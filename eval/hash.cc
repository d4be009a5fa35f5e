#include "eval/hash.h"

#include <fmt/format.h>

namespace depthgrid {

std::string ContentHash::Hex() const { return fmt::format("{:016x}", state_); }

}  // namespace depthgrid
