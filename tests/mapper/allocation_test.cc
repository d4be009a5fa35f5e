// What runs for every frame allocates nothing once its buffers have grown. The counters count all
// of this executable's allocations through new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
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

// Frames of a walk that goes round and round, after some rounds: what is allocated is room for what
// is kept, in ever larger pieces, and new groups of surfels or submaps.
double AllocationsAFrame(const MapperOptions& options) {
  const PlanarWorld room = FurnishedRoom();
  constexpr int kRound = 300, kWarm = 600, kCounted = 600;
  std::vector<Frame> round(kRound);
  for (int k = 0; k < kRound; ++k) {
    const double turn_rad = 2.0 * kPi * k / kRound;
    const Pose2 pose{3.0 + 0.3 * std::cos(turn_rad), 1.8 + 0.3 * std::sin(turn_rad),
                     WrapAngle(turn_rad)};
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    round[static_cast<std::size_t>(k)].scan =
        std::make_shared<const Scan>(ScanOf(room, pose, laser, 8, static_cast<std::uint32_t>(k)));
    round[static_cast<std::size_t>(k)].slam_from_camera = CameraOf(pose, 0.0);
  }
  IncrementalMapper mapper(options, std::nullopt);
  long before = 0;
  for (int k = 0; k < kWarm + kCounted; ++k) {
    if (k == kWarm) before = allocations;
    Frame& frame = round[static_cast<std::size_t>(k % kRound)];
    frame.index = k;
    frame.stamp_s = k / 30.0;
    mapper.AddFrame(frame);
  }
  return static_cast<double>(allocations - before) / kCounted;
}

TEST(Allocation, AFrameHasHardlyAnyInSteadyState) {
  MapperOptions options;
  options.method = MapperMethod::kPaper;
  EXPECT_LT(AllocationsAFrame(options), 0.5);
  options.method = MapperMethod::kSurfel;
  options.fusion.mode = FusionMode::kLearned;
  options.rounds.first_frames = 0;  // adjusting everything takes memory
  EXPECT_LT(AllocationsAFrame(options), 0.5);
}

}  // namespace
}  // namespace depthgrid
