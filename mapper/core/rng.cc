#include "mapper/core/rng.h"

#include <Random123/philox.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {

std::array<std::uint32_t, 4> RandomWords(std::uint64_t seed, RandomStage stage, std::uint32_t frame,
                                         std::uint32_t item) {
  const r123::Philox4x32::key_type key = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const r123::Philox4x32::ctr_type counter = {{item, frame, static_cast<std::uint32_t>(stage), 0}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

std::uint32_t RandomStream::NextWord() {
  if (word_ == 4) {
    words_ = RandomWords(seed_, stage_, frame_, item_++);
    word_ = 0;
  }
  return words_[static_cast<std::size_t>(word_++)];
}

double RandomStream::Uniform() {
  // 52 bits plus half a step, so the result is never 0 or 1.
  const std::uint64_t high = NextWord() >> 6;
  const std::uint64_t low = NextWord() >> 6;
  return (static_cast<double>((high << 26) | low) + 0.5) * 0x1.0p-52;
}

double RandomStream::Normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2.0 * std::log(Uniform()));
  const double angle_rad = 2.0 * kPi * Uniform();
  spare_normal_ = radius * std::sin(angle_rad);
  has_spare_normal_ = true;
  return radius * std::cos(angle_rad);
}

std::uint64_t RandomStream::Below(std::uint64_t bound) {
  Require(bound > 0, "the bound of a uniform draw is positive");
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % bound;  // reject the tail: no modulo bias
  while (true) {
    const std::uint64_t high = NextWord();
    const std::uint64_t draw = (high << 32) | NextWord();
    if (draw < limit) return draw % bound;
  }
}

}  // namespace depthgrid
