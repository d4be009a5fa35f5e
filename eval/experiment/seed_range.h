// Ranges of consecutive seeds.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "mapper/core/error.h"

namespace depthgrid {

// Throws InputError, with `place`, if the last of `count` seeds (1 or more) would be out of range.
inline void RequireSeeds(const std::string& place, std::uint64_t first, int count) {
  if (first <= UINT64_MAX - static_cast<std::uint64_t>(count - 1)) return;
  throw InputError(place, fmt::format("{} seeds from {} on go beyond {}, the largest there is",
                                      count, first, UINT64_MAX));
}

}  // namespace depthgrid
