// A map saved and opened again to go on in.
#include "mapper/io/mapped_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/io/scan_file.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

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
  std::filesystem::remove(File("matched.bin"));
  WriteMapped(folder_, {});
  EXPECT_EQ(RefusalOf([&] { ReadMapped(folder_); }), File("scans.bin") + ": holds no scan");
}

}  // namespace
}  // namespace depthgrid
