// A map saved and opened again to go on in.
#include "mapper/io/mapped_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "mapper/io/scan_file.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

class MappedFilesTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string File(const char* name) const { return folder_ + "/" + name; }
  bool Has(const char* name) const { return std::filesystem::exists(File(name)); }
  std::vector<int> NumbersRead() const {
    std::vector<int> numbers;
    for (const MappedFrame& frame : ReadMapped(folder_)) numbers.push_back(frame.frame);
    return numbers;
  }

  std::string folder_ = ScratchPath();
};

KeptScan ScanOfRange(float range_m) {
  Scan scan{.beams = {}, .max_range_m = 8.0};
  scan.beams.push_back({0.1F, range_m, 0.0F, range_m, true});
  return ScanArchive().Keep(scan);
}

std::vector<MappedFrame> FramesOf(const std::vector<int>& numbers) {
  std::vector<MappedFrame> frames;
  for (const int number : numbers) {
    MappedFrame frame;
    frame.frame = number;
    frame.stamp_s = 100.0 + number;
    frame.map_from_base = {0.1 * number, 2.0, -0.5};
    frame.scan = frame.obstacles = ScanOfRange(2.0F);
    frames.push_back(frame);
  }
  return frames;
}

TEST_F(MappedFilesTest, GiveBackWhatAMapNeeds) {
  std::vector<MappedFrame> frames = FramesOf({0, 4, 5});
  frames[1].scan = ScanOfRange(3.0F);
  WriteMapped(folder_, frames);
  const std::vector<MappedFrame> read = ReadMapped(folder_);
  ASSERT_EQ(read.size(), 3U);
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_s, frames[i].stamp_s);
    EXPECT_EQ(read[i].map_from_base, frames[i].map_from_base);
    EXPECT_EQ(read[i].scan, frames[i].scan);
    EXPECT_EQ(read[i].obstacles, frames[i].obstacles);
    EXPECT_TRUE(read[i].kept());
  }
  EXPECT_THAT(NumbersRead(), ElementsAre(-3, -2, -1));
}

// Gone on in once, and again: what a later drive saw counts more.
TEST_F(MappedFilesTest, NumbersLeaveOneOutBetweenDrives) {
  WriteMapped(folder_, FramesOf({-3, -2, -1, 0, 7}));
  EXPECT_THAT(NumbersRead(), ElementsAre(-6, -5, -4, -2, -1));
  WriteMapped(folder_, FramesOf({-6, -5, -4, -2, -1, 3, 4}));
  EXPECT_THAT(NumbersRead(), ElementsAre(-9, -8, -7, -5, -4, -2, -1));
}

TEST_F(MappedFilesTest, OneScanForBothIsOneFile) {
  std::vector<MappedFrame> frames = FramesOf({0, 1});
  frames[0].scan = ScanOfRange(3.0F);
  WriteMapped(folder_, frames);
  EXPECT_TRUE(Has("matched.bin"));
  WriteMapped(folder_, FramesOf({0, 1, 2}));  // a later save
  EXPECT_FALSE(Has("matched.bin"));
  EXPECT_EQ(NumbersRead().size(), 3U);
}

TEST_F(MappedFilesTest, FilesOfTwoMapsAreRefused) {
  WriteMapped(folder_, FramesOf({0, 1}));
  for (const std::vector<int>& numbers : {std::vector{0}, std::vector{0, 2}}) {
    std::vector<StoredScan> other;
    for (const int number : numbers) other.push_back({number, 1.0, {}, ScanOfRange(1.0F)});
    WriteScans(File("matched.bin"), other);
    EXPECT_EQ(RefusalOf([&] { ReadMapped(folder_); }),
              File("matched.bin") +
                  ": does not belong to the scans.bin beside it, which can be read without it: "
                  "move it away");
  }
  // Scans of the same frames, as before an adjustment moved them.
  std::vector<StoredScan> moved = ReadScans(File("scans.bin"));
  for (StoredScan& scan : moved) scan.map_from_base.x_m += 0.01;
  WriteScans(File("matched.bin"), moved);
  EXPECT_NE(RefusalOf([&] { ReadMapped(folder_); }), "no error");
  std::filesystem::remove(File("matched.bin"));
  WriteMapped(folder_, {});
  EXPECT_EQ(RefusalOf([&] { ReadMapped(folder_); }), File("scans.bin") + ": holds no scan");
}

// What a map says: the ranges that are matched, or nothing for a map that cannot be read.
std::vector<float> MatchedRangesOf(const std::string& folder) {
  std::vector<float> ranges_m;
  for (const MappedFrame& frame : ReadMapped(folder)) {
    ranges_m.push_back(Unpacked(frame.scan.packed()).beams.at(0).range_m);
  }
  return ranges_m;
}

std::vector<MappedFrame> FramesMatchedAt(const std::vector<int>& numbers, float range_m) {
  std::vector<MappedFrame> frames = FramesOf(numbers);
  for (MappedFrame& frame : frames) frame.scan = ScanOfRange(range_m);
  return frames;
}

constexpr rlim_t kMostBytes = 1000;  // of a file, where a save is to end

// Makes scans.bin larger than that, and than matched.bin.
std::vector<MappedFrame> WithManyBeams(std::vector<MappedFrame> frames) {
  Scan wide{.beams = {}, .max_range_m = 8.0};
  for (int i = 0; i < 1000; ++i) {
    wide.beams.push_back({0.001F * static_cast<float>(i), 2.0F, 0.0F, 2.0F, true});
  }
  for (MappedFrame& frame : frames) frame.obstacles = ScanArchive().Keep(wide);
  return frames;
}

// Ends a program that saves a map while it writes scans.bin.
TEST_F(MappedFilesTest, AKilledSaveLeavesTheEarlierMapWhole) {
  const std::vector<MappedFrame> earlier = FramesMatchedAt({0, 1}, 3.0F);
  WriteMapped(folder_, earlier);
  const std::vector<MappedFrame> later = WithManyBeams(FramesMatchedAt({0, 1, 2}, 4.0F));
  const auto save_and_be_killed = [&] {
    const rlimit limit{kMostBytes, kMostBytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);  // the signal SIGXFSZ comes beyond it
    WriteMapped(folder_, later);
  };
  EXPECT_EXIT(save_and_be_killed(), testing::KilledBySignal(SIGXFSZ), "");
  EXPECT_TRUE(Has("matched.next.bin"));  // it was killed at the drawn scans
  EXPECT_EQ(MatchedRangesOf(folder_), (std::vector<float>{3.0F, 3.0F}));
  WriteMapped(folder_, later);
  EXPECT_EQ(MatchedRangesOf(folder_), (std::vector<float>{4.0F, 4.0F, 4.0F}));
}

// As a full disk does: the earlier map stays, and no half of the new one takes up what room there
// is.
TEST_F(MappedFilesTest, ASaveThatFailsLeavesTheEarlierMapAlone) {
  WriteMapped(folder_, FramesMatchedAt({0, 1}, 3.0F));
  const auto files = [&] {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      names.push_back(entry.path().filename());
    }
    return names;
  };
  const auto fail_to_save = [&] {
    const std::vector<MappedFrame> later = WithManyBeams(FramesMatchedAt({0, 1, 2}, 4.0F));
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{kMostBytes, kMostBytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      WriteMapped(folder_, later);
    } catch (const std::runtime_error& error) {
      const bool says = error.what() == File("scans.bin") + ": cannot be written: File too large";
      std::_Exit(says ? 0 : 1);
    }
    std::_Exit(2);
  };
  EXPECT_EXIT(fail_to_save(), testing::ExitedWithCode(0), "");
  EXPECT_THAT(files(), UnorderedElementsAre("scans.bin", "matched.bin"));
  EXPECT_EQ(MatchedRangesOf(folder_), (std::vector<float>{3.0F, 3.0F}));
}

TEST_F(MappedFilesTest, AFolderThatCannotBeWrittenIsNamed) {
  if (::mount("tmpfs", folder_.c_str(), "tmpfs", MS_RDONLY, "") != 0) {
    GTEST_SKIP() << "only root may mount";
  }
  std::string said;
  try {
    WriteMapped(folder_, FramesOf({0}));
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  ::umount2(folder_.c_str(), MNT_DETACH);
  EXPECT_EQ(said, File("scans.bin") + ": cannot be written: Read-only file system");
}

// The states between the steps of a save, each the files of two maps mixed.
TEST_F(MappedFilesTest, EveryStepOfASaveLeavesOneOfTheMaps) {
  namespace fs = std::filesystem;
  const std::string of_new = folder_ + "/new";
  fs::create_directories(of_new);
  const auto copy_new = [&](const char* from, const char* to) {
    fs::copy_file(fs::path(of_new) / from, File(to), fs::copy_options::overwrite_existing);
  };
  const std::vector<float> old_ranges(2, 3.0F), new_ranges(3, 4.0F);
  WriteMapped(of_new, FramesMatchedAt({0, 1, 2}, 4.0F));
  WriteMapped(folder_, FramesMatchedAt({0, 1}, 3.0F));
  copy_new("matched.bin", "matched.next.bin");
  EXPECT_EQ(MatchedRangesOf(folder_), old_ranges);
  copy_new("scans.bin", "scans.bin");
  EXPECT_EQ(MatchedRangesOf(folder_), new_ranges);
  // Killed here, and killed again in the next save: its matched scans, not yet its drawn ones.
  WriteMapped(of_new, FramesMatchedAt({0, 1, 2, 3}, 5.0F));
  WriteMapped(folder_, FramesMatchedAt({0, 1, 2}, 4.0F));
  EXPECT_FALSE(Has("matched.next.bin"));
  copy_new("matched.bin", "matched.next.bin");
  EXPECT_EQ(MatchedRangesOf(folder_), new_ranges);
  // A map whose drawn scans are matched replaces one with two files.
  WriteMapped(folder_, FramesOf({0, 1}));
  EXPECT_FALSE(Has("matched.bin"));
  EXPECT_FALSE(Has("matched.next.bin"));
  EXPECT_EQ(MatchedRangesOf(folder_), (std::vector<float>{2.0F, 2.0F}));
}

// Damage to one of the two files of matched scans does not hide the other, which is the map's.
TEST_F(MappedFilesTest, ADamagedFileOfMatchedScansHidesNoWholeOne) {
  namespace fs = std::filesystem;
  const auto damage = [&](const char* name) {
    fs::resize_file(File(name), fs::file_size(File(name)) - 1);
  };
  const std::vector<float> ranges_m(2, 3.0F);
  const auto killed_at_the_last_step = [&] {
    WriteMapped(folder_, FramesMatchedAt({0, 1}, 3.0F));
    fs::copy_file(File("matched.bin"), File("matched.next.bin"));
  };
  killed_at_the_last_step();
  damage("matched.next.bin");
  EXPECT_EQ(MatchedRangesOf(folder_), ranges_m);
  fs::remove(File("matched.next.bin"));
  killed_at_the_last_step();
  damage("matched.bin");
  EXPECT_EQ(MatchedRangesOf(folder_), ranges_m);
  damage("matched.next.bin");
  EXPECT_EQ(RefusalOf([&] { ReadMapped(folder_); }), File("matched.bin") + ": is truncated");
  fs::remove(File("matched.bin"));
  EXPECT_EQ(RefusalOf([&] { ReadMapped(folder_); }), File("matched.next.bin") + ": is truncated");
}

}  // namespace
}  // namespace depthgrid
