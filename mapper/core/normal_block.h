// Standard normal draws in bulk: four for each of many consecutive items, independent of how items
// are divided into blocks. Uses only + - * / and square roots, so the bits do not depend on a maths
// library.
#pragma once

#include <array>
#include <cstdint>

#include "mapper/core/rng.h"

namespace depthgrid {

constexpr int kNormalBlockItems = 256;

struct NormalBlock {
  // normals[k][i]: the k-th normal of item first_item + i; independent of each other.
  alignas(64) std::array<std::array<float, kNormalBlockItems>, 4> normals;
};

// Box-Muller on the words RandomWords gives for each item. The uniforms have 2^23 steps, so no
// normal lies beyond 5.8.
void FillNormals(std::uint64_t seed, RandomStage stage, std::uint32_t frame,
                 std::uint32_t first_item, NormalBlock& block);

}  // namespace depthgrid
