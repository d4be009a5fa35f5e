#include "mapper/core/normal_block.h"

#include <bit>
#include <cmath>

namespace depthgrid {
namespace {

// Philox4x32-10 (Salmon et al. 2011, section 4.2) for one counter, written so that compilers
// vectorise over counters. The constants are the paper's; normal_block_test compares it with
// Random123.
struct Words {
  std::uint32_t w0, w1, w2, w3;
};

inline Words Philox(std::uint32_t key0, std::uint32_t key1, Words w) {
  constexpr std::uint64_t kMultiplier0 = 0xD2511F53, kMultiplier1 = 0xCD9E8D57;
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9, kWeyl1 = 0xBB67AE85;
#pragma GCC unroll 10
  for (std::uint32_t round = 0; round < 10; ++round) {
    const std::uint64_t product0 = kMultiplier0 * w.w0;
    const std::uint64_t product1 = kMultiplier1 * w.w2;
    w = {static_cast<std::uint32_t>(product1 >> 32) ^ w.w1 ^ (key0 + round * kWeyl0),
         static_cast<std::uint32_t>(product1),
         static_cast<std::uint32_t>(product0 >> 32) ^ w.w3 ^ (key1 + round * kWeyl1),
         static_cast<std::uint32_t>(product0)};
  }
  return w;
}

// The natural logarithm of a positive normal number, to 2 ulp (Cephes, logf).
inline float Log(float x) {
  constexpr std::uint32_t kMantissa = 0x007FFFFF, kHalf = 0x3F000000, kSqrtHalfBits = 0x3F3504F3;
  const auto bits = std::bit_cast<std::uint32_t>(x);
  std::uint32_t mantissa = (bits & kMantissa) | kHalf;  // in [0.5, 1)
  std::int32_t exponent = static_cast<std::int32_t>(bits >> 23) - 126;
  const std::int32_t below = mantissa < kSqrtHalfBits ? 1 : 0;
  exponent -= below;
  mantissa += static_cast<std::uint32_t>(below) << 23;  // in [sqrt(1/2), sqrt(2))
  const float m = std::bit_cast<float>(mantissa) - 1.0F;
  const float e = static_cast<float>(exponent);
  float p = 7.0376836292e-2F;
  p = p * m - 1.1514610310e-1F;
  p = p * m + 1.1676998740e-1F;
  p = p * m - 1.2420140846e-1F;
  p = p * m + 1.4249322787e-1F;
  p = p * m - 1.6668057665e-1F;
  p = p * m + 2.0000714765e-1F;
  p = p * m - 2.4999993993e-1F;
  p = p * m + 3.3333331174e-1F;
  const float square = m * m;
  // log 2 as the sum of a part with few bits, so that its product with e is exact, and a remainder.
  return (m + (p * m * square - 2.12194440e-4F * e - 0.5F * square)) + 0.693359375F * e;
}

// Two normals from two words: the radius from the first, the direction from the second. The angle
// is within an eighth of a turn of an axis; the top bits choose the quadrant.
inline void BoxMuller(std::uint32_t radius_word, std::uint32_t angle_word, float& first,
                      float& second) {
  const float uniform =
      (static_cast<float>(static_cast<std::int32_t>(radius_word >> 9)) + 0.5F) * 0x1.0p-23F;
  const float radius = std::sqrt(-2.0F * Log(uniform));
  constexpr float kQuarterTurn = 1.57079632679F;
  const float angle =
      (static_cast<float>(static_cast<std::int32_t>((angle_word >> 8) & 0x3FFFFF)) + 0.5F) *
          (kQuarterTurn * 0x1.0p-22F) -
      0.5F * kQuarterTurn;
  const float a2 = angle * angle;  // Taylor series, below 4e-7 in |angle| <= pi/4
  const float sine = angle * (1.0F + a2 * (-1.0F / 6 + a2 * (1.0F / 120 + a2 * (-1.0F / 5040))));
  const float cosine =
      1.0F + a2 * (-0.5F + a2 * (1.0F / 24 + a2 * (-1.0F / 720 + a2 * (1.0F / 40320))));
  const auto x = std::bit_cast<std::uint32_t>(radius * cosine);
  const auto y = std::bit_cast<std::uint32_t>(radius * sine);
  const std::uint32_t sign = angle_word & 0x80000000U;
  const std::uint32_t swapped_bits = (x ^ y) & (0U - (angle_word >> 30 & 1U));
  first = std::bit_cast<float>(x ^ swapped_bits ^ sign);
  second = std::bit_cast<float>(y ^ swapped_bits ^ sign);
}

}  // namespace

void FillNormals(std::uint64_t seed, RandomStage stage, std::uint32_t frame,
                 std::uint32_t first_item, NormalBlock& block) {
  alignas(64) std::uint32_t words[4][kNormalBlockItems];
  const auto key0 = static_cast<std::uint32_t>(seed);
  const auto key1 = static_cast<std::uint32_t>(seed >> 32);
  for (std::uint32_t i = 0; i < kNormalBlockItems; ++i) {
    const Words w =
        Philox(key0, key1, {first_item + i, frame, static_cast<std::uint32_t>(stage), 0});
    words[0][i] = w.w0;
    words[1][i] = w.w1;
    words[2][i] = w.w2;
    words[3][i] = w.w3;
  }
  for (std::size_t pair = 0; pair < 4; pair += 2) {
    float* const first = block.normals[pair].data();
    float* const second = block.normals[pair + 1].data();
    for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
      BoxMuller(words[pair][i], words[pair + 1][i], first[i], second[i]);
    }
  }
}

}  // namespace depthgrid
