// What the scan cache gives back is what was put in, or nothing; and what it is asked for.
#include "eval/sweep/scan_cache.h"

#include <gtest/gtest.h>

#include <chrono>

#include "eval/sweep/scan_maker.h"
#include "eval/sweep/scan_set.h"
#include "tests/io/temporary_folder.h"

namespace depthgrid {
namespace {

class ScanCacheTest : public TemporaryFolderTest {};

std::shared_ptr<const Scan> ScanOf(float range_m) {
  auto scan = std::make_shared<Scan>();
  scan->max_range_m = 6.0;
  scan->beams = {{-0.1F, range_m, 0.4F, range_m, true}, {0.1F, 0.0F, 0.5F, 6.0F, false}};
  return scan;
}

std::vector<FrameScans> Frames() {
  const auto one = ScanOf(1.5F);
  const CameraStand stand{Eigen::Quaterniond(0.6, 0.0, 0.8, 0.0), 1.3};
  return {{one, one}, {}, {ScanOf(2.0F), ScanOf(3.0F), stand}};
}

void ExpectSame(const std::vector<FrameScans>& a, const std::vector<FrameScans>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].obstacles == nullptr, b[i].obstacles == nullptr);
    if (!a[i].obstacles) continue;
    EXPECT_EQ(*a[i].obstacles, *b[i].obstacles);
    EXPECT_EQ(*a[i].matched, *b[i].matched);
    EXPECT_EQ(a[i].obstacles == a[i].matched, b[i].obstacles == b[i].matched);
    ASSERT_EQ(a[i].stand.has_value(), b[i].stand.has_value());
    if (!a[i].stand) continue;
    EXPECT_EQ(a[i].stand->level_from_camera.coeffs(), b[i].stand->level_from_camera.coeffs());
    EXPECT_EQ(a[i].stand->height_m, b[i].stand->height_m);
  }
}

TEST_F(ScanCacheTest, GivesBackWhatWasStored) {
  const ScanCache cache(Path("cache"));
  EXPECT_FALSE(cache.Load("a").has_value());
  cache.Store("a", Frames());
  const auto loaded = ScanCache(Path("cache")).Load("a");
  ASSERT_TRUE(loaded.has_value());
  ExpectSame(Frames(), *loaded);
  EXPECT_FALSE(cache.Load("b").has_value());
}

TEST_F(ScanCacheTest, HalvesOfKilledProgramsGoOthersStay) {
  namespace fs = std::filesystem;
  const auto is_left = [&](const std::string& name, int minutes) {
    Write(name, "half");
    fs::last_write_time(Path(name),
                        fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
    const ScanCache cache(Path("cache"));
    return fs::exists(Path(name));
  };
  EXPECT_FALSE(is_left("cache/0123456789abcdef.scans.4711.0.tmp", 61));
  EXPECT_TRUE(is_left("cache/0123456789abcdef.scans.4711.1.tmp", 59));
  EXPECT_TRUE(is_left("cache/mine.scans.4711.0.tmp", 9999));
}

TEST_F(ScanCacheTest, DamageIsNoEntry) {
  const ScanCache cache(Path("cache"));
  cache.Store("a", Frames());
  const std::string whole = ReadFile(Path("cache/a.scans"));
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{5}, whole.size() / 2, whole.size() - 1}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    Write("cache/a.scans", damaged);
    EXPECT_FALSE(cache.Load("a").has_value()) << at;
  }
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    Write("cache/a.scans", whole.substr(0, size));
    EXPECT_FALSE(cache.Load("a").has_value()) << size;
  }
}

TEST_F(ScanCacheTest, TheLimitIsThatOfWritingAndOfReading) {
  ScanCache(Path("cache")).Store("a", Frames());
  const auto size = std::filesystem::file_size(Path("cache/a.scans"));
  EXPECT_TRUE(ScanCache(Path("cache"), size).Load("a").has_value());
  EXPECT_FALSE(ScanCache(Path("cache"), size - 1).Load("a").has_value());
  ScanCache(Path("cache"), size - 1).Store("b", Frames());
  EXPECT_FALSE(std::filesystem::exists(Path("cache/b.scans")));
}

TEST_F(ScanCacheTest, KeepsToItsSizeAndDropsTheLongestUnused) {
  const std::string a = "000000000000000a", b = "000000000000000b", c = "000000000000000c";
  ScanCache(Path("cache")).Store("measure", Frames());
  const auto size = std::filesystem::file_size(Path("cache/measure.scans"));
  const ScanCache cache(Path("cache"), 2 * size);
  const auto age = [&](const std::string& key, int minutes) {
    std::filesystem::last_write_time(
        Path("cache/" + key + ".scans"),
        std::filesystem::file_time_type::clock::now() - std::chrono::minutes(minutes));
  };
  age("measure", 3);  // by its name the user's own: it neither counts nor goes
  cache.Store(a, Frames());
  cache.Store(b, Frames());
  age(a, 2);
  age(b, 1);
  EXPECT_TRUE(cache.Load(a).has_value());  // used: younger than b now
  cache.Store(c, Frames());
  EXPECT_TRUE(cache.Load(a).has_value());
  EXPECT_FALSE(cache.Load(b).has_value());
  EXPECT_TRUE(cache.Load(c).has_value());
  EXPECT_TRUE(std::filesystem::exists(Path("cache/measure.scans")));
  ScanCache(Path("tiny"), size - 1).Store(a, Frames());
  EXPECT_TRUE(std::filesystem::is_empty(Path("tiny")));
}

// Somebody crosses the view of a camera that looks around.
constexpr const char* kPeopledRoom = R"(
name: test_room
shapes:
  - {shape: box, size: [3, 4, 0.1], at: [1.5, 2, -0.1]}
  - {shape: wall, from: [3, 4], to: [0, 4], side: right}
trajectories:
  look_around:
    kind: handheld
    waypoints:
      - {at: [1.5, 1.0, 1.1], look_at: [1.5, 4.0, 1.0]}
      - {at: [1.9, 2.0, 1.1], look_at: [1.0, 4.0, 1.0]}
movers:
  visitor:
    shapes: [{shape: cylinder, radius_m: 0.2, height_m: 1.7}]
    there_and_back: true
    waypoints: [{at: [0.4, 3.4]}, {at: [2.6, 3.4]}]
)";

// Where they are is a matter of the stamps: the same poses, walked in half the time.
TEST_F(ScanCacheTest, OtherStampsAreOtherScans) {
  Write("room.yaml", kPeopledRoom);
  ExperimentOptions options;
  options.scene = Path("room.yaml");
  options.movers = "all";
  options.frames = 8;
  options.sensor.width_px = 40;
  options.sensor.height_px = 30;
  const auto set_of = [&](double times) {
    World world = LoadWorld(options, 1);
    for (StampedPose& pose : world.trajectory) pose.stamp_s *= times;
    return MakeSet(options, std::make_shared<const World>(std::move(world)));
  };
  ScanSet slow = set_of(20.0), fast = set_of(10.0), alone = set_of(10.0);
  EXPECT_EQ(DepthKey(fast), DepthKey(alone));
  EXPECT_EQ(ContentKey(fast), ContentKey(alone));
  EXPECT_NE(DepthKey(fast), DepthKey(slow));
  EXPECT_NE(ContentKey(fast), ContentKey(slow));
  MakeScans({&slow, &fast}, {1, Path("cache"), [] {}});
  MakeScans({&alone}, {1, "", [] {}});
  ASSERT_EQ(alone.failure, "");
  ExpectSame(fast.scans, alone.scans);
  EXPECT_NE(*fast.scans.back().obstacles, *slow.scans.back().obstacles);
  // What SLAM says when is of the scans as well, whatever the true stamps are.
  alone.slam.live.back().stamp_s += 0.001;
  EXPECT_EQ(DepthKey(fast), DepthKey(alone));
  EXPECT_NE(ContentKey(fast), ContentKey(alone));
}

// One set's scanner throws: its camera is not the one of the depth images it is given.
TEST_F(ScanCacheTest, ASetWhoseScannerFailsFailsAlone) {
  Write("room.yaml", kPeopledRoom);
  ExperimentOptions options;
  options.scene = Path("room.yaml");
  options.frames = 20;  // several blocks of images
  options.sensor.width_px = 40;
  options.sensor.height_px = 30;
  const World world = LoadWorld(options, 1);
  World other = LoadWorld(options, 1);
  other.camera.width_px = 20;
  ScanSet first = MakeSet(options, std::make_shared<const World>(world));
  ScanSet broken = MakeSet(options, std::make_shared<const World>(std::move(other)));
  ScanSet last = first, alone = first;
  last.options.mapper.scan.beams = 99;
  ASSERT_EQ(DepthKey(broken), DepthKey(first));
  MakeScans({&first, &broken, &last}, {1, "", [] {}});
  MakeScans({&alone}, {1, "", [] {}});
  EXPECT_NE(broken.failure, "");
  EXPECT_EQ(first.failure, "");
  EXPECT_EQ(last.failure, "");
  ExpectSame(first.scans, alone.scans);
  EXPECT_NE(last.scans.back().obstacles, nullptr);
}

}  // namespace
}  // namespace depthgrid
