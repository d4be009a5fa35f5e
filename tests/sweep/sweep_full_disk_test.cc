// A sweep whose own cache fills the disk.
#include <gmock/gmock.h>
#include <sys/mount.h>

#include "mapper/io/file.h"
#include "tests/sweep/sweep_tables.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

// `full` is a disk with room for the results, but not for the cache as well (20 images of 0.3 MB).
// The sweeps that fill it have one job: of two images that are written at the same time neither may
// fit, and what both leave is enough for the results.
class FullDiskSweep : public SweepTableTest {
 protected:
  void SetUp() override {
    SweepTableTest::SetUp();
    Write("sweep.yaml",
          "experiment: ./small.yaml\nset: {frames: 20, sensor.width: 320, sensor.height: 240}\n"
          "axes:\n  mapper.fusion.gain: [0, 0.5]\n  seed: {seeds: 12}\n");
    fs::create_directory(Path("full"));
    if (::mount("tmpfs", Path("full").c_str(), "tmpfs", 0, "size=3m") != 0) {
      GTEST_SKIP() << "only root may mount";
    }
  }
  void TearDown() override {
    ::umount2(Path("full").c_str(), MNT_DETACH);
    SweepTableTest::TearDown();
  }
};

TEST_F(FullDiskSweep, RemovesItsOwnCacheAndGoesOn) {
  const Outcome outcome = Program("sweep ./sweep.yaml -o full/out --jobs 1");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("full/out"), HasSubstr(" cannot be "),
                    HasSubstr("; full/out/cache is removed, and the sweep goes on without it\n")));
  Succeed("sweep ./sweep.yaml -o out");
  ExpectSameTable("full/out", "out");
}

// Other sweeps may use that folder.
TEST_F(FullDiskSweep, NamesTheCacheThatWasChosen) {
  const Outcome outcome = Program("sweep ./sweep.yaml -o full/out --cache full/cache --jobs 1");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr(" cannot be "), HasSubstr("; if its cache full/cache ")));
  fs::remove_all(Path("full/cache"));
  Succeed("sweep ./sweep.yaml -o full/out");
  Succeed("sweep ./sweep.yaml -o out");
  ExpectSameTable("full/out", "out");
}

}  // namespace
}  // namespace depthgrid
