// Counted nouns for messages.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace depthgrid {

// "1 run", "2 runs".
template <std::integral Count>
std::string Counted(Count count, std::string_view thing) {
  return std::to_string(count) + " " + std::string(thing) + (count == 1 ? "" : "s");
}

}  // namespace depthgrid
