// A folder in which a command, killed or failed, has replaced a part of a result, and a map whose
// save was killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "eval/files/one_result.h"
#include "eval/output/output_folder.h"
#include "mapper/io/end_task.h"
#include "tests/eval/program.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::Not;

class HalfReplaced : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
    Succeed("render ./small.yaml --no-colour -o seq");
    Succeed("slam seq -o poses");
  }
};

TEST_F(HalfReplaced, NoCommandTakesItForASequence) {
  const std::vector<std::string> says = {"seq: holds files of two results", "killed or failed",
                                         "seq/.depthgrid-replacing"};
  const std::string map = "map seq --poses poses/slam.txt --loops poses/loops.csv --up z -o out";
  MarkAsReplaced(Path("seq"), kMarkOfRender);
  ExpectRefusal("map seq --up z -o out", says);
  ExpectRefusal(map, says);
  ExpectRefusal("slam seq -o out", says);
  ExpectRefusal("slam-fit seq/groundtruth.txt poses/slam.txt", says);
  ExpectRefusal("eval trajectory seq/groundtruth.txt poses/slam.txt", says);
  ExpectRefusal("eval map seq/truth_map.yaml seq/truth_map.yaml", says);
  Succeed("render ./small.yaml --no-colour -o seq --force");
  Succeed("eval map seq/truth_map.yaml seq/truth_map.yaml");
  MarkAsReplaced(Path("poses"), kMarkOfSlam);
  ExpectRefusal(map, {"poses: holds files of two results"});
  Succeed("slam seq -o poses --force");
  Succeed(map);
}

// A map may lie beside the images that it is made of.
TEST_F(HalfReplaced, AMarkIsOfOneOfTheResultsThere) {
  MarkAsReplaced(Path("seq"), kMarkOfRender);
  Succeed("map one.log -o seq --force");  // replaces no image
  ExpectRefusal("map seq --up z -o out", {"seq: holds files of two results"});
  Succeed("render ./small.yaml --no-colour -o seq --force");
  MarkAsReplaced(Path("seq"), "run");
  ExpectRefusal("report seq", {"seq: holds files of two results"});
  Succeed("map seq --up z -o seq --force");  // the images are of one render
  Succeed("report seq");
  EXPECT_FALSE(fs::exists(Path("seq/.depthgrid-replacing")));
}

TEST_F(HalfReplaced, AnEmptyFolderWithAMarkIsEmpty) {
  fs::create_directory(Path("cleared"));
  MarkAsReplaced(Path("cleared"), kMarkOfRender);
  Succeed("map one.log -o cleared");
  Succeed("report cleared");
  EXPECT_THAT(FilesIn("cleared"), Not(Contains(".depthgrid-replacing")));
}

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

class ReplacingFolder : public TemporaryFolderTest {
 protected:
  // Replaces out/a.txt; `meanwhile` happens before anything is replaced.
  void FailReplacing(const std::function<void()>& meanwhile) const {
    bool is_done = false;
    const auto is_old = [&](const fs::path& relative) {
      if (!std::exchange(is_done, true)) meanwhile();
      return relative == "old.txt";
    };
    OutputFolder folder(Path("out"), true, is_old, kMarkOfRender);
    WriteFile(folder.File("a.txt"), "new");
    EXPECT_THROW(folder.Commit(), std::runtime_error);
  }
  bool IsOneResult() const {
    return RefusalOf([&] { RequireOneResult(Path("out")); }) == "no error";
  }
};

TEST_F(ReplacingFolder, AFailureIsMarkedWhereSomethingWasReplaced) {
  const auto a_folder_comes = [&] {
    fs::remove(Path("out/a.txt"));
    fs::create_directories(Path("out/a.txt/mine"));
  };
  Write("out/a.txt", "old");
  FailReplacing(a_folder_comes);
  EXPECT_TRUE(IsOneResult());
  // An earlier mark stays.
  MarkAsReplaced(Path("out"), kMarkOfRender);
  fs::remove_all(Path("out/a.txt"));
  Write("out/a.txt", "old");
  FailReplacing(a_folder_comes);
  EXPECT_FALSE(IsOneResult());
  UnmarkAsReplaced(Path("out"), kMarkOfRender);
  fs::remove_all(Path("out/a.txt"));
  Write("out/a.txt", "old");
  Write("out/old.txt", "is removed first");
  FailReplacing(a_folder_comes);
  EXPECT_FALSE(IsOneResult());
}

// Storing many files takes longer than a user waits. A busy disk may take long for one of them,
// too: then it is enough that the others were not waited for, whose names come when all are stored.
// That they are removed is not timed.
TEST_F(ReplacingFolder, IsEndedWhileFilesAreStored) {
  Write("out/a.txt", "old");
  const auto end_amid = [&] {
    OutputFolder folder(Path("out"), true, {}, kMarkOfRender);
    constexpr int kFiles = 1000;
    for (int i = 0; i < kFiles; ++i) WriteFile(folder.File(std::to_string(i)), "new");
    std::thread([&folder] { folder.Commit(); }).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto start = std::chrono::steady_clock::now();
    const EndTask first_of_all([&] {
      const auto waited = std::chrono::steady_clock::now() - start;
      const bool soon = waited < std::chrono::milliseconds(500);
      ::_exit(soon || !fs::exists(Path("out/0")) ? 0 : 1);
    });
    DoEndTasks();
  };
  EXPECT_EXIT(end_amid(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace depthgrid
