// Vectors that get one entry a frame.
#pragma once

#include <algorithm>
#include <vector>

namespace depthgrid {

// Before adding to it: room for a quarter more. Doubling would leave up to half of it empty.
template <typename T>
void GrowGently(std::vector<T>& values) {
  constexpr std::size_t kLeast = 256;
  if (values.size() == values.capacity()) {
    values.reserve(values.size() + std::max(kLeast, values.size() / 4));
  }
}

}  // namespace depthgrid
