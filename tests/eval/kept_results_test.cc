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

  // A program of that name in the test's folder, which reads all that it is given first.
  void WriteFfmpeg(const std::string& script) const {
    Write("ffmpeg", "#!/bin/sh\ncat >/dev/null\n" + script);
    ASSERT_EQ(::chmod(Path("ffmpeg").c_str(), 0755), 0);
  }
  // The least that is a whole video: an index of nothing.
  void WriteQuickFfmpeg() const {
    WriteFfmpeg("for last; do :; done\nprintf '\\000\\000\\000\\010moov' >\"${last#file:}\"\n");
  }
};

TEST_F(KeptResults, AMapWhoseVideoFailsIsThere) {
  WriteFfmpeg("exit 1\n");  // as one without libx264
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

// ffmpeg says that all is well when the disk is full at the end of the file.
TEST_F(KeptResults, AVideoThatIsNotWholeReplacesNone) {
  Write("one.mp4", "an earlier one");
  const auto map_with = [&](const std::string& video) {
    WriteFfmpeg("for last; do :; done\nprintf '" + video +
                "' >\"${last#file:}\"\necho 'x: No space left on device' >&2\n");
    return Program("map one.log --force -o out --video one.mp4", "PATH=\"$PWD:$PATH\" ");
  };
  const std::string empty_box = "\\000\\000\\000\\010";
  const std::string ten_bytes = "\\000\\000\\000\\012mdat";
  // No index, a box that ends beyond the file, no box, nothing.
  for (const std::string& video :
       {empty_box + "ftyp" + ten_bytes + "12", empty_box + "moov" + ten_bytes, std::string("moov"),
        std::string()}) {
    const Outcome outcome = map_with(video);
    EXPECT_EQ(outcome.exit_code, 1) << video;
    EXPECT_EQ(outcome.err,
              "depthgrid: one.mp4: cannot be written by ffmpeg (x: No space left on device); the "
              "map is in out\n");
    EXPECT_EQ(ReadFile(Path("one.mp4")), "an earlier one");
  }
  EXPECT_EQ(map_with(empty_box + "moov" + ten_bytes + "12").exit_code, 0);
  EXPECT_EQ(ReadFile(Path("one.mp4")).size(), 18U);
  EXPECT_THAT(FilesIn("."), Not(Contains(HasSubstr(".tmp"))));
}

// Its page is written twice, the second time with the pictures in colour.
TEST_F(KeptResults, ARunWhoseLargerPageHasNoRoomIsThere) {
  Succeed("run ./small.yaml --set frames=3 --no-cache -o whole");
  constexpr std::uintmax_t kBlock = 512;  // of the shell's ulimit
  const auto blocks = (fs::file_size(Path("whole/report.html")) - 1) / kBlock;
  const Outcome outcome = Program("run ./small.yaml --set frames=3 --no-cache -o out",
                                  "ulimit -f " + std::to_string(blocks) + " && ");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err,
            "depthgrid: warning: the page is without the pictures in colour: out/report.html: "
            "cannot be written: File too large\n");
  EXPECT_THAT(outcome.out, HasSubstr("look at out/report.html"));
  EXPECT_EQ(FilesIn("out"), FilesIn("whole"));
}

TEST_F(KeptResults, AMapThatCannotBeHandedOnIsNoMistakeOfTheUser) {
  Succeed("map one.log -o m");
  Write("m/map.pgm", ReadFile(Path("m/map.pgm")) + std::string(1 << 20, ' '));
  const Outcome outcome =
      Program("map one.log --map m --localise --start 0,0,0 -o out", "ulimit -f 1000 && ");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("/map.pgm: cannot be written: "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("depthgrid: m/map.pgm")));
  EXPECT_FALSE(fs::exists(Path("out")));
}

// The program that reads the output is gone, as ever.
TEST_F(KeptResults, AVideoLeavesABrokenPipeWhatItIs) {
  WriteQuickFfmpeg();
  const std::string command = "PATH=\"$PWD:$PATH\" '" + std::string(kProgramFile) +
                              "' run ./small.yaml --set frames=2 -o out --video v.mp4; echo $? "
                              ">code";
  Program("--version", "(" + command + ") 2>err | true; ");
  EXPECT_EQ(ReadFile(Path("code")), "141\n");
  EXPECT_EQ(ReadFile(Path("err")), "");
  EXPECT_TRUE(fs::exists(Path("v.mp4")));
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

TEST_F(KeptResults, ASweepWhoseFolderIsRemovedHasFailed) {
  Write("s.yaml", "experiment: ./small.yaml\naxes: {seed: [1, 2, 3]}\n");
  Program("--version", "{ '" + std::string(kProgramFile) +
                           "' sweep ./s.yaml --no-cache -o s >/dev/null 2>err & "
                           "until [ -e s/results.sqlite ]; do sleep 0.01; done; "
                           "while [ -e s ]; do rm -rf s; done; wait $!; echo $? >code; }; ");
  EXPECT_EQ(ReadFile(Path("code")), "1\n");
  EXPECT_EQ(ReadFile(Path("err")), "depthgrid: s: was removed while the sweep was at work in it\n");
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
  WriteQuickFfmpeg();
  for (const std::string name : {"-x.mp4", "file:y.mp4"}) {
    const Outcome outcome =
        Program("map one.log --force -o out --video=" + name, "PATH=\"$PWD:$PATH\" ");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(ReadFile(Path(name)), std::string("\0\0\0\10moov", 8));
  }
  EXPECT_THAT(FilesIn("."), Not(Contains(HasSubstr(".tmp"))));
}

}  // namespace
}  // namespace depthgrid
