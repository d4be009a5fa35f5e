#include "mapper/io/scan_file.h"

#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

std::vector<StoredScan> SomeScans() {
  RandomStream random(31, RandomStage::kTest);
  ScanArchive archive;
  std::vector<StoredScan> scans;
  for (int i = 0; i < 5; ++i) {
    StoredScan stored;
    stored.frame = 3 * i;
    stored.stamp_s = random.Uniform(0, 100);
    stored.map_from_base = {random.Uniform(-5, 5), random.Uniform(-5, 5), random.Uniform(-3, 3)};
    Scan scan;
    scan.max_range_m = 6.0;
    for (int b = 0; b < 10 * i; ++b) {
      scan.beams.push_back({static_cast<float>(random.Uniform(-1, 1)),
                            static_cast<float>(random.Uniform(0, 6)), 0.4F,
                            static_cast<float>(random.Uniform(0, 6)), b % 3 == 0});
    }
    stored.scan = archive.Keep(scan);
    scans.push_back(stored);
  }
  return scans;
}

class ScanFileTest : public ::testing::Test {
 protected:
  std::string path_ = ScratchPath() + ".bin";
  void TearDown() override { std::remove(path_.c_str()); }
};

TEST_F(ScanFileTest, ReadsBackWhatWasWritten) {
  WriteScans(path_, SomeScans());
  EXPECT_EQ(ReadScans(path_), SomeScans());
  WriteScans(path_, {});
  EXPECT_TRUE(ReadScans(path_).empty());
}

TEST_F(ScanFileTest, EveryTruncationIsAnError) {
  WriteScans(path_, SomeScans());
  const std::string whole = ReadFile(path_);
  int cases = 0;
  for (std::size_t size = 0; size < whole.size(); size += 7, ++cases) {
    WriteFile(path_, whole.substr(0, size));
    EXPECT_THROW(ReadScans(path_), InputError);
  }
  EXPECT_GT(cases, 200);
  WriteFile(path_, whole + "x");
  EXPECT_THROW(ReadScans(path_), InputError);
  EXPECT_THROW(ReadScans(path_ + ".missing"), InputError);
}

TEST_F(ScanFileTest, DamagedBytesAreAnErrorOrAnotherScan) {
  WriteScans(path_, SomeScans());
  const std::string whole = ReadFile(path_);
  int errors = 0;
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ '\xff');
    WriteFile(path_, bytes);
    try {
      ReadScans(path_);
    } catch (const InputError&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 30);
}

TEST_F(ScanFileTest, AnAbsurdCountTakesNoMemory) {
  WriteScans(path_, SomeScans());
  std::string bytes = ReadFile(path_);
  for (std::size_t i = 8; i < 12; ++i) bytes[i] = '\xff';
  WriteFile(path_, bytes);
  EXPECT_THROW(ReadScans(path_), InputError);
}

}  // namespace
}  // namespace depthgrid
