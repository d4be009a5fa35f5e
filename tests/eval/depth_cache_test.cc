#include "eval/run/depth_cache.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/io/file.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

constexpr PinholeCamera kCamera{8, 4, 10.0, 10.0, 3.5, 1.5};
constexpr std::uint64_t kEntryBytes = 32 + 8 * 4 * sizeof(float);

Trajectory Path(double first_x_m, int frames) {
  Trajectory path;
  for (int i = 0; i < frames; ++i) path.push_back({0.1 * i, CameraOf({first_x_m + i, 0, 0}, 1.0)});
  return path;
}

class DepthCacheTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // As a program's run does it; how many frames it found.
  int Run(const std::string& scene, const Trajectory& path, std::uint64_t entries) const {
    DepthCache cache(folder_.string(), scene, kCamera, RayIsa::kAvx2, entries * kEntryBytes);
    cache.MakeRoomFor(path, false);
    int found = 0;
    for (const StampedPose& pose : path) {
      if (cache.Load(pose.world_from_camera, false)) {
        ++found;
      } else {
        cache.Store(pose.world_from_camera, {DepthImage(8, 4), {}});
      }
    }
    return found;
  }

  const std::filesystem::path folder_ = ScratchPath();
};

TEST_F(DepthCacheTest, ASecondRunFindsWhatTheFirstStored) {
  EXPECT_EQ(Run("a", Path(0, 6), 8), 0);
  EXPECT_EQ(Run("a", Path(0, 6), 8), 6);  // though twice as many would not fit
  EXPECT_EQ(Run("b", Path(0, 2), 8), 0);
  EXPECT_EQ(Run("a", Path(0, 6), 8), 6);  // nor did the other scene ask for their room
  EXPECT_EQ(Run("a", Path(0, 9), 6), 6);  // more than fit at all
}

TEST_F(DepthCacheTest, OldEntriesMakeRoomOthersFirst) {
  EXPECT_EQ(Run("a", Path(0, 3), 8), 0);
  EXPECT_EQ(Run("b", Path(0, 3), 8), 0);
  EXPECT_EQ(Run("a", Path(2, 5), 8), 1);  // one is there
  EXPECT_EQ(Run("a", Path(0, 7), 8), 7);
  EXPECT_EQ(Run("b", Path(0, 3), 8), 1);
}

TEST_F(DepthCacheTest, FilesOfTheUsersAreNoEntries) {
  EXPECT_EQ(Run("a", Path(0, 1), 8), 0);
  const std::string frames =
      std::filesystem::directory_iterator(folder_)->path().filename().string();
  // An ICL-NUIM sequence beside and below, and one laid among the cache's own by mistake.
  const std::vector<std::string> own = {
      "scene_00_0000.depth", "0123456789abcdef.depth", "living_room/scene_00_0000.depth",
      "living_room/0123456789abcdef/0123456789abcdef.depth", frames + "/scene_00_0000.depth"};
  for (const std::string& name : own) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    WriteFile((folder_ / name).string(), std::string(2 * kEntryBytes, '1'));
  }
  EXPECT_EQ(Run("b", Path(0, 2), 2), 0);
  EXPECT_EQ(Run("b", Path(0, 2), 2), 2);  // nor do they take any room
  EXPECT_EQ(Run("a", Path(0, 1), 2), 0);  // whose entry had to go
  for (const std::string& name : own) EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
}

}  // namespace
}  // namespace depthgrid
