// Counter-based random numbers (Philox4x32-10, Salmon et al. 2011, Random123): every draw is a pure
// function of its key and counter, so results do not depend on the order in which frames, pixels or
// threads are processed.
#pragma once

#include <array>
#include <cstdint>

namespace depthgrid {

// One value a consumer of randomness, so that no two stages ever share draws. Append only.
enum class RandomStage : std::uint32_t {
  kDepthNoise = 1,
  kTrajectory = 2,
  kSlamJitter = 3,
  kSlamWalk = 4,
  kSlamBias = 5,
  kSlamLost = 6,
  kSlamLoops = 7,
  kBootstrap = 8,
  kNavigability = 9,
  kSweep = 10,
  kTest = 11,
  kLaserRange = 12,
  kOdometry = 13,
  kSlamJumps = 14,
  kFlyingPixels = 15,
  kSlamDrift = 16,
};

// Four independent 32-bit words for (seed, stage, frame, item).
std::array<std::uint32_t, 4> RandomWords(std::uint64_t seed, RandomStage stage, std::uint32_t frame,
                                         std::uint32_t item);

// A sequence of draws for one (seed, stage, frame): item counts up from 0.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, RandomStage stage, std::uint32_t frame = 0)
      : seed_(seed), stage_(stage), frame_(frame) {}

  double Uniform();  // in (0, 1)
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  double Normal();                           // mean 0, standard deviation 1 (Box-Muller)
  std::uint64_t Below(std::uint64_t bound);  // uniform in [0, bound), bound > 0

 private:
  std::uint32_t NextWord();

  std::uint64_t seed_;
  RandomStage stage_;
  std::uint32_t frame_;
  std::uint32_t item_ = 0;
  int word_ = 4;
  std::array<std::uint32_t, 4> words_{};
  bool has_spare_normal_ = false;
  double spare_normal_ = 0.0;
};

}  // namespace depthgrid
