// What runs for every frame allocates nothing once its buffers have grown. The counters count all
// of this executable's allocations through new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/match/scan_matcher.h"
#include "tests/mapper/analytic_room.h"
#include "tests/mapper/match_world.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
// As the library's does; a sanitizer's would come from elsewhere than what is freed below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
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

constexpr int kFramesOfARound = 300;

// A walk that goes round and round, seen by a laser.
std::vector<Frame> LaserRound() {
  const PlanarWorld room = FurnishedRoom();
  std::vector<Frame> round(kFramesOfARound);
  for (int k = 0; k < kFramesOfARound; ++k) {
    const double turn_rad = 2.0 * kPi * k / kFramesOfARound;
    const Pose2 pose{3.0 + 0.3 * std::cos(turn_rad), 1.8 + 0.3 * std::sin(turn_rad),
                     WrapAngle(turn_rad)};
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    Frame& frame = round[static_cast<std::size_t>(k)];
    frame.scan =
        std::make_shared<const Scan>(ScanOf(room, pose, laser, 8, static_cast<std::uint32_t>(k)));
    frame.slam_from_camera = CameraOf(pose, 0.0);
  }
  return round;
}

const PinholeCamera kSmallCamera{80, 60, 60.1, 60.0, 39.5, 29.5, {}};

// The same by a depth camera, some of whose pixels are missing.
std::vector<Frame> DepthRound() {
  AnalyticRoom room;
  room.boxes.push_back({{0.9, -1.0, 0.0}, {1.5, -0.3, 0.5}});
  room.cylinders.push_back({{1.4, 0.5}, 0.04, 0.0, 2.5});
  RandomStream random(12, RandomStage::kTest);
  std::vector<Frame> round(kFramesOfARound);
  for (int k = 0; k < kFramesOfARound; ++k) {
    const double turn_rad = 2.0 * kPi * k / kFramesOfARound;
    const Pose2 base{-0.3 * std::cos(turn_rad), 0.3 * std::sin(turn_rad), WrapAngle(turn_rad)};
    Frame& frame = round[static_cast<std::size_t>(k)];
    frame.slam_from_camera = TiltedCamera(base, 1.15, 0.2, 0.05);
    DepthImage image = room.Render(kSmallCamera, *frame.slam_from_camera);
    for (float& z_m : image.z_m) {
      if (random.Uniform() < 0.02) z_m = kInvalidDepth;
      z_m *= static_cast<float>(random.Uniform(0.995, 1.005));
    }
    frame.depth = std::make_shared<const DepthImage>(std::move(image));
  }
  return round;
}

// After some rounds: what is allocated is room for what is kept, in ever larger pieces, and new
// groups of surfels or submaps.
double AllocationsAFrame(const MapperOptions& options, std::vector<Frame> round) {
  constexpr int kWarm = 600, kCounted = 600;
  IncrementalMapper mapper(options, kSmallCamera);
  long before = 0;
  for (int k = 0; k < kWarm + kCounted; ++k) {
    if (k == kWarm) before = allocations;
    Frame& frame = round[static_cast<std::size_t>(k % kFramesOfARound)];
    frame.index = k;
    frame.stamp_s = k / 30.0;
    mapper.AddFrame(frame);
  }
  return static_cast<double>(allocations - before) / kCounted;
}

MapperOptions PaperMethod() {
  MapperOptions options;
  options.method = MapperMethod::kPaper;
  options.fusion.mode = FusionMode::kFixed;  // as it ships
  return options;
}

MapperOptions SurfelMethod() {
  MapperOptions options;
  options.method = MapperMethod::kSurfel;
  options.fusion.mode = FusionMode::kLearned;
  options.rounds.first_frames = 0;  // adjusting everything takes memory
  return options;
}

TEST(Allocation, AScanHasHardlyAnyInSteadyState) {
  EXPECT_LT(AllocationsAFrame(PaperMethod(), LaserRound()), 0.5);
  EXPECT_LT(AllocationsAFrame(SurfelMethod(), LaserRound()), 0.5);
  MapperOptions averaged = PaperMethod();
  averaged.submap.walls = SubmapWalls::kAveraged;
  // Two rectangles more that grow with each submap.
  EXPECT_LT(AllocationsAFrame(averaged, LaserRound()), 1.0);
}

// Those whose scans are not kept (KeepOptions) ask which kept frame they lie by.
TEST(Allocation, AScanThatIsNotKeptHasTwo) {
  MapperOptions options = SurfelMethod();
  options.keep.first_frames = 200;
  options.keep.scans_per_place = 5;
  options.keep.more_each_doubling = 0.0;
  EXPECT_LT(AllocationsAFrame(options, LaserRound()), 2.5);
}

TEST(Allocation, ADepthImageHasHardlyAnyInSteadyState) {
  EXPECT_LT(AllocationsAFrame(PaperMethod(), DepthRound()), 0.9);  // two scans of each are kept
  EXPECT_LT(AllocationsAFrame(SurfelMethod(), DepthRound()), 0.9);
}

}  // namespace
}  // namespace depthgrid
