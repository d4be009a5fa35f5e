// A folder in which a result is replaced, and a map whose save was killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "eval/output/output_folder.h"
#include "mapper/io/end_task.h"
#include "tests/eval/program.h"
#include "tests/io/temporary_folder.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::Not;

class HalfReplaced : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Succeed("render ./small.yaml --no-colour -o seq");
  }
};

// A map that a robot saved itself, killed before the last step of it: its matched scans are in
// matched.next.bin, beside those of the map before.
TEST_F(HalfReplaced, AMapOfAKilledSaveIsHandedOnWhole) {
  Succeed("map seq --up z -o m");
  Succeed("map seq --up z --set sequence.to_s=0.2 -o before");
  const auto localise = [&](const std::string& in) {
    Succeed("map seq --up z --map m --localise --start 1.5,1,90 -o " + in);
    const std::string settings = ReadFile(Path(in + "/run.yaml"));
    const std::size_t at = settings.find("map_hash");
    return settings.substr(at, settings.find('\n', at) - at);
  };
  const std::string hash = localise("whole");
  fs::rename(Path("m/matched.bin"), Path("m/matched.next.bin"));
  fs::copy_file(Path("before/matched.bin"), Path("m/matched.bin"));
  EXPECT_EQ(localise("kept"), hash);
  for (const char* name : {"/scans.bin", "/matched.bin"}) {
    EXPECT_TRUE(SameFile(std::string("kept") + name, std::string("whole") + name)) << name;
  }
  Succeed("map seq --up z -o m --force");
  EXPECT_THAT(FilesIn("m"), Not(Contains("matched.next.bin")));
}

class ReplacingFolder : public TemporaryFolderTest {};

// Storing many files takes longer than a user waits. That they are removed is not timed: a busy
// disk takes long for this, too.
TEST_F(ReplacingFolder, IsEndedWhileFilesAreStored) {
  Write("out/a.txt", "old");
  const auto end_amid = [&] {
    OutputFolder folder(Path("out"), true);
    constexpr int kFiles = 1000;
    for (int i = 0; i < kFiles; ++i) WriteFile(folder.File(std::to_string(i)), "new");
    std::thread([&folder] { folder.Commit(); }).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto start = std::chrono::steady_clock::now();
    const EndTask first_of_all([&] {
      const auto waited = std::chrono::steady_clock::now() - start;
      ::_exit(waited < std::chrono::milliseconds(500) ? 0 : 1);
    });
    DoEndTasks();
  };
  EXPECT_EXIT(end_amid(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace depthgrid
