// What runs for every frame allocates nothing once its buffers have grown. The counters count all
// of this executable's allocations through new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "mapper/match/scan_matcher.h"
#include "tests/mapper/match_world.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace depthgrid {
namespace {

TEST(Allocation, IsCounted) {
  const long before = allocations;
  const std::vector<int> values(100);
  EXPECT_EQ(allocations - before, 1) << values.size();
}

TEST(Allocation, MatchingHasNoneInSteadyState) {
  const PlanarWorld room = FurnishedRoom();
  const OccupancyMap map = SmoothMap(room, {-0.5, -0.5}, {6.5, 5.5}, 0.05);
  const ProbabilityView view = ViewOf(map);
  PlanarLaser laser;
  laser.beams = 320;
  laser.sigma_of_range = 0.01;
  std::vector<Scan> scans;
  std::vector<Pose2> poses;
  for (int k = 0; k < 40; ++k) {
    poses.push_back({2.0 + 0.03 * k, 1.2 + 0.01 * k, 0.15 * k});
    scans.push_back(ScanOf(room, poses.back(), laser, 8, static_cast<std::uint32_t>(k)));
  }
  ScanMatcher matcher({});
  long counted = 0;
  for (int round = 0; round < 2; ++round) {
    const long before = allocations;
    for (std::size_t k = 0; k < scans.size(); ++k) {
      matcher.Match(scans[k], view, poses[k] * Pose2{0.02, 0.01, 0.01});
    }
    counted = allocations - before;
  }
  EXPECT_EQ(counted, 0);
}

}  // namespace
}  // namespace depthgrid
