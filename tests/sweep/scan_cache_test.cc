// What the scan cache gives back is what was put in, or nothing.
#include "eval/sweep/scan_cache.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace depthgrid
