// A result that is finished is kept, whatever fails after it.
#include <gmock/gmock.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class KeptResults : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
  }
};

TEST_F(KeptResults, AMapWhoseVideoFailsIsThere) {
  Write("ffmpeg", "#!/bin/sh\ncat >/dev/null\nexit 1\n");  // as one without libx264
  ASSERT_EQ(::chmod(Path("ffmpeg").c_str(), 0755), 0);
  const char* path = std::getenv("PATH");
  const std::string before = path == nullptr ? "/usr/bin:/bin" : path;
  ASSERT_EQ(::setenv("PATH", (root_.string() + ":" + before).c_str(), 1), 0);
  const Outcome mapped = Program("map one.log --video one.mp4 -o out");
  const Outcome run = Program("run ./small.yaml --video one.mp4 -o out2");
  ::setenv("PATH", before.c_str(), 1);
  for (const Outcome& outcome : {mapped, run}) {
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.err, HasSubstr("depthgrid: one.mp4: ffmpeg failed; the map is in out"));
  }
  EXPECT_TRUE(fs::exists(Path("out/map.pgm")));
  EXPECT_TRUE(fs::exists(Path("out2/metrics.json")));
  EXPECT_THAT(FilesIn("."), Not(Contains(HasSubstr("mp4"))));
}

// A folder of an old disk, say, in Latin-1.
TEST_F(KeptResults, NamesNeedNotBeUtf8) {
  fs::create_directory(Path("Z\xFCrich"));
  for (const char* file : {"room.yaml", "small.yaml"}) {
    fs::copy_file(Path(file), Path(std::string("Z\xFCrich/") + file));
  }
  Write("Z\xFCrich/s.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1, 2]}\n");
  Succeed("sweep Z\xFCrich/s.yaml -o Z\xFCrich/swept");
  Succeed("ablate Z\xFCrich/small.yaml --set frames=3 --seeds 1 --json -o ablated");
  Succeed("compare Z\xFCrich/swept Z\xFCrich/swept --json");
  EXPECT_THAT(FilesIn("Z\xFCrich/swept"), Contains("report.html"));
  EXPECT_THAT(FilesIn("ablated"), Contains("report.html"));
}

// The one that is too late must not take away what the other has begun.
TEST_F(KeptResults, OfTwoSweepsAtOnceOneIsDone) {
  Write("s.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1, 2]}\n");
  const std::string sweep = std::string("'") + kProgramFile + "' sweep ./s.yaml -o ";
  for (const std::string out : {"a", "b", "c", "d", "e", "f", "g", "h"}) {
    std::string others;  // their exit codes go to files
    for (const std::string who : {"1", "2", "3", "4"}) {
      others += "(" + sweep + out + " >/dev/null 2>err" + who + "; echo $? >code" + who + ") & ";
    }
    Program("--version", "{ " + others + "wait; }; ");
    int done = 0;
    for (const std::string who : {"1", "2", "3", "4"}) {
      if (ReadFile(Path("code" + who)) == "0\n") {
        ++done;
      } else {
        EXPECT_EQ(ReadFile(Path("code" + who)), "2\n");
        EXPECT_EQ(ReadFile(Path("err" + who)),
                  "depthgrid: " + out + ": another program is working on this sweep\n");
      }
    }
    EXPECT_GE(done, 1);
    EXPECT_TRUE(fs::exists(Path(out + "/results.csv")));
  }
}

TEST_F(KeptResults, ACacheOnAFullDiskCostsNothingButTime) {
  fs::create_directory(Path("full"));
  if (::mount("tmpfs", Path("full").c_str(), "tmpfs", 0, "size=200k") != 0) {
    GTEST_SKIP() << "only root may mount";
  }
  // Mesa's shaders too.
  const Outcome cached =
      Program("run ./small.yaml -o out --cache full/cache", "env -u MESA_SHADER_CACHE_DIR ");
  ::umount2(Path("full").c_str(), MNT_DETACH);
  EXPECT_EQ(cached.exit_code, 0) << cached.err;
  Succeed("run ./small.yaml -o out2");
  ExpectSameBytes("out", "out2");
}

// As a full disk is: by one line, and nothing half-written stays.
TEST_F(KeptResults, AFileBeyondTheLimitOfTheShellIsSaid) {
  const Outcome outcome = Program("run ./small.yaml --set frames=3 -o out", "ulimit -f 20 && ");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written: File too large\n"));
  EXPECT_FALSE(fs::exists(Path("out")));
  EXPECT_FALSE(fs::exists(Path(".out.partial")));
}

// "-" begins an option and "file:" a protocol of ffmpeg's.
TEST_F(KeptResults, AVideoHasTheNameItWasGiven) {
  Write("ffmpeg",
        "#!/bin/sh\ncat >/dev/null\nfor last; do :; done\necho video >\"${last#file:}\"\n");
  ASSERT_EQ(::chmod(Path("ffmpeg").c_str(), 0755), 0);
  for (const std::string name : {"-x.mp4", "file:y.mp4"}) {
    const Outcome outcome =
        Program("map one.log --force -o out --video=" + name, "PATH=\"$PWD:$PATH\" ");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(ReadFile(Path(name)), "video\n");
  }
  EXPECT_THAT(FilesIn("."), Not(Contains(HasSubstr(".tmp"))));
}

}  // namespace
}  // namespace depthgrid
