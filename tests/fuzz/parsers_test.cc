// The fuzzers' seeds (tiny samples of each format, and what once broke a parser) as tests: every
// sample is read; every truncation of it and many damaged bytes are read or refused, never a crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "tests/fuzz/targets.h"
#include "tests/paths.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Longer seeds are truncated and damaged at so many places.
constexpr std::size_t kPlaces = 400;

struct Seed {
  std::string name;
  std::string bytes;
};

std::vector<Seed> SeedsOf(const FuzzTarget& target) {
  std::vector<Seed> seeds;
  const fs::path folder = fs::path(kSourceFolder) / "tests/fuzz/seeds" / target.name;
  for (const auto& entry : fs::directory_iterator(folder)) {
    seeds.push_back({entry.path().filename().string(), ReadFile(entry.path().string())});
  }
  std::sort(seeds.begin(), seeds.end(),
            [](const Seed& a, const Seed& b) { return a.name < b.name; });
  return seeds;
}

bool IsCrash(const Seed& seed) {
  for (const char* prefix : {"crash-", "timeout-", "oom-", "slow-unit-", "leak-"}) {
    if (seed.name.starts_with(prefix)) return true;
  }
  return false;
}

class Parsers : public ::testing::TestWithParam<FuzzTarget> {};

TEST_P(Parsers, ReadTheSamplesAndSurviveWhatOnceBrokeThem) {
  int samples = 0;
  for (const Seed& seed : SeedsOf(GetParam())) {
    SCOPED_TRACE(seed.name);
    const bool accepted = GetParam().accepts(seed.bytes);
    if (IsCrash(seed)) continue;
    EXPECT_TRUE(accepted);
    ++samples;
  }
  EXPECT_GT(samples, 0);
}

TEST_P(Parsers, SurviveEveryTruncation) {
  for (const Seed& seed : SeedsOf(GetParam())) {
    if (IsCrash(seed)) continue;
    SCOPED_TRACE(seed.name);
    const std::size_t step = seed.bytes.size() / kPlaces + 1;
    for (std::size_t size = 0; size < seed.bytes.size(); size += step) {
      GetParam().accepts(std::string_view(seed.bytes).substr(0, size));
    }
  }
}

TEST_P(Parsers, SurviveFlippedBits) {
  RandomStream random(7, RandomStage::kTest);
  for (const Seed& seed : SeedsOf(GetParam())) {
    if (IsCrash(seed)) continue;
    SCOPED_TRACE(seed.name);
    const std::size_t step = seed.bytes.size() / kPlaces + 1;
    for (std::size_t place = 0; place < seed.bytes.size(); place += step) {
      std::string damaged = seed.bytes;
      damaged[place] = static_cast<char>(damaged[place] ^ (1U << random.Below(8)));
      GetParam().accepts(damaged);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Parsers, ::testing::ValuesIn(FuzzTargets()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace depthgrid
