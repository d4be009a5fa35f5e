#include "eval/run/depth_cache.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

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

// Whom permissions hold for: another user where this one is root, who may read everything. In a
// container of one user there is no other, and its root is denied nothing that is its own.
bool BecomeNobody() {
  constexpr uid_t kNobody = 65534;
  return ::geteuid() != 0 || ::seteuid(kNobody) == 0;
}

bool IsDeniedToNobody(const std::filesystem::path& folder) {
  if (!BecomeNobody()) return false;
  std::error_code denied, hidden;  // hidden: below a folder that is closed to others
  const std::filesystem::directory_iterator inside(folder, denied);
  const bool is_there = std::filesystem::exists(folder, hidden);
  if (::seteuid(::getuid()) != 0) ADD_FAILURE() << "this process stays nobody's";
  return is_there && denied == std::errc::permission_denied;
}

class DepthCacheTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override {
    std::error_code none;
    for (const auto& own : std::filesystem::directory_iterator(folder_, none)) {
      std::filesystem::permissions(own.path(), std::filesystem::perms::owner_all);
    }
    std::filesystem::remove_all(folder_);
  }

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

TEST_F(DepthCacheTest, HalvesOfKilledRunsGoOthersStay) {
  namespace fs = std::filesystem;
  EXPECT_EQ(Run("a", Path(0, 1), 8), 0);
  const fs::path frames = fs::directory_iterator(folder_)->path();
  const fs::path entry = fs::directory_iterator(frames)->path();
  const std::string of_user = (frames / "0123456789abcdef.depth.bak").string();
  const auto half = [&](const char* ending, int minutes) {
    const std::string path = entry.string() + ending;
    WriteFile(path, "half");
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
    return path;
  };
  WriteFile(of_user, "mine");
  fs::last_write_time(of_user, fs::file_time_type::clock::now() - std::chrono::hours(99));
  const std::string old = half(".4711-1234567890123", 61);
  const std::string live = half(".4712-1234567890123", 5);
  EXPECT_EQ(Run("b", Path(0, 1), 8), 0);
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(live));
  EXPECT_TRUE(fs::exists(of_user));
  EXPECT_EQ(Run("a", Path(0, 1), 8), 1);
}

// Entries beside folders that this user may not read count all the same.
TEST_F(DepthCacheTest, FoldersOfOthersDoNotHideEntries) {
  namespace fs = std::filesystem;
  EXPECT_EQ(Run("a", Path(0, 4), 4), 0);
  fs::permissions(folder_, fs::perms::all);
  for (const auto& own : fs::directory_iterator(folder_)) {
    fs::permissions(own.path(), fs::perms::all);
  }
  constexpr int kFoldersOfOthers = 30;  // so that some are listed before the cache's own
  for (int i = 0; i < kFoldersOfOthers; ++i) {
    const fs::path others = folder_ / fmt::format("{:016x}", 77 * i);
    fs::create_directory(others);
    fs::permissions(others, fs::perms::none);
  }
  if (!IsDeniedToNobody(folder_ / fmt::format("{:016x}", 0))) {
    GTEST_SKIP() << "no user here is denied a folder of the test's, or none reaches it";
  }
  const auto run_as_nobody = [&] {
    if (!BecomeNobody()) std::exit(99);
    Run("b", Path(0, 4), 4);  // an entry of "a" has to go for each
    int entries = 0;
    for (const auto& folder : fs::directory_iterator(folder_)) {
      std::error_code denied;
      for (auto it = fs::directory_iterator(folder.path(), denied);
           !denied && it != fs::directory_iterator(); ++it) {
        ++entries;
      }
    }
    std::_Exit(entries);  // no leak check, which a process that changed its user is not allowed
  };
  EXPECT_EXIT(run_as_nobody(), testing::ExitedWithCode(4), "");
}

}  // namespace
}  // namespace depthgrid
