#include "mapper/io/scan_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "tests/refusal.h"
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

// The message for the second scan with something changed, without the file's name.
template <typename Change>
std::string RefusalAfter(const std::string& path, Change change) {
  std::vector<StoredScan> scans = SomeScans();
  Scan scan = *scans[1].scan;
  change(scans[1], scan);
  ScanArchive archive;
  scans[1].scan = archive.Keep(scan);
  WriteScans(path, scans);
  const std::string refusal = RefusalOf([&] { ReadScans(path); });
  return refusal == "no error" ? refusal : refusal.substr(path.size() + 2);
}

TEST_F(ScanFileTest, WhatNoMapperCanHaveKeptIsRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](auto change) { return RefusalAfter(path_, change); };
  EXPECT_EQ(refusal([](StoredScan&, Scan&) {}), "no error");
  for (const double bad : {kNan, 1e300, -1e300, -kNan}) {
    const auto bad_float = static_cast<float>(bad);
    EXPECT_EQ(refusal([&](StoredScan& stored, Scan&) { stored.stamp_s = bad; }),
              "the scan of frame 3 has a stamp that is no time in seconds");
    const std::string pose =
        "the scan of frame 3 has a pose that is not finite or beyond 10,500 km";
    EXPECT_EQ(refusal([&](StoredScan& stored, Scan&) { stored.map_from_base.x_m = bad; }), pose);
    EXPECT_EQ(refusal([&](StoredScan& stored, Scan&) { stored.map_from_base.y_m = bad; }), pose);
    const std::string beam = "the scan of frame 3 has a beam that is not finite or beyond 1 km";
    EXPECT_EQ(refusal([&](StoredScan&, Scan& s) { s.beams[3].bearing_rad = bad_float; }), beam);
    EXPECT_EQ(refusal([&](StoredScan&, Scan& s) { s.beams[3].range_m = bad_float; }), beam);
    EXPECT_EQ(refusal([&](StoredScan&, Scan& s) { s.beams[3].clear_from_m = bad_float; }), beam);
  }
  EXPECT_NE(refusal([&](StoredScan& stored, Scan&) { stored.map_from_base.yaw_rad = kNan; }),
            "no error");
  EXPECT_NE(refusal([](StoredScan&, Scan& s) { s.beams[3].clear_to_m = 1e6F; }), "no error");
  EXPECT_NE(refusal([](StoredScan&, Scan& s) { s.max_range_m = kNan; }), "no error");
  EXPECT_NE(refusal([](StoredScan&, Scan& s) { s.max_range_m = -1.0; }), "no error");
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
