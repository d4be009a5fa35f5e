#include "eval/output/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <csignal>

#include "eval/files/one_result.h"
#include "eval/files/run_files.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = ScratchPath();
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  std::string Path(const std::string& name) const { return (root_ / name).string(); }
  // Names of everything below the root, so that leftovers show.
  std::vector<std::string> Everything() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(root_)) {
      names.push_back(fs::relative(entry.path(), root_).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  fs::path root_;
};

using Names = std::vector<std::string>;

TEST_F(OutputFolderTest, AppearsOnCommitOnly) {
  {
    OutputFolder folder(Path("out"), false);
    WriteFile(folder.File("a.txt"), "1");
    EXPECT_FALSE(fs::exists(Path("out")));
    folder.Commit();
  }
  EXPECT_EQ(Everything(), (Names{"out", "out/a.txt"}));
}

TEST_F(OutputFolderTest, LeavesNothingWithoutCommit) {
  {
    OutputFolder folder(Path("deep/er/out"), false);
    WriteFile(folder.File("a.txt"), "1");
  }
  EXPECT_EQ(Everything(), Names{});
}

TEST_F(OutputFolderTest, KeepsAnEmptyFolderThatWasThere) {
  fs::create_directory(Path("out"));
  { OutputFolder folder(Path("out"), false); }
  EXPECT_EQ(Everything(), Names{"out"});
  OutputFolder folder(Path("out/"), false);
  WriteFile(folder.File("a.txt"), "1");
  folder.Commit();
  EXPECT_TRUE(fs::exists(Path("out/a.txt")));
}

TEST_F(OutputFolderTest, RefusesWhatIsNotEmptyOrAFile) {
  fs::create_directory(Path("out"));
  WriteFile(Path("out/mine.txt"), "precious");
  EXPECT_THROW(OutputFolder(Path("out"), false), InputError);
  EXPECT_THROW(OutputFolder(Path("out/mine.txt"), true), InputError);
  EXPECT_THROW(OutputFolder(Path("out/mine.txt/below"), true), InputError);
  EXPECT_THROW(OutputFolder("", true), InputError);
  EXPECT_EQ(Everything(), (Names{"out", "out/mine.txt"}));
}

TEST_F(OutputFolderTest, ForceReplacesItsOwnNamesAndKeepsOthers) {
  fs::create_directories(Path("out/rgb"));
  WriteFile(Path("out/mine.txt"), "precious");
  WriteFile(Path("out/a.txt"), "old");
  WriteFile(Path("out/rgb/0.png"), "old");
  WriteFile(Path("out/rgb/9.png"), "precious");
  {
    OutputFolder failing(Path("out"), true);
    WriteFile(failing.File("a.txt"), "half");
  }
  EXPECT_EQ(ReadFile(Path("out/a.txt")), "old");
  OutputFolder folder(Path("out"), true);
  WriteFile(folder.File("a.txt"), "new");
  fs::create_directory(folder.work() / "rgb");
  WriteFile(folder.File("rgb/0.png"), "new");
  folder.Commit();
  EXPECT_EQ(ReadFile(Path("out/a.txt")), "new");
  EXPECT_EQ(ReadFile(Path("out/rgb/0.png")), "new");
  EXPECT_EQ(ReadFile(Path("out/rgb/9.png")), "precious");
  EXPECT_EQ(ReadFile(Path("out/mine.txt")), "precious");
}

// Killed between two files, it leaves those of two runs: no command may take them for one.
TEST_F(OutputFolderTest, WhatWasReplacedInPartIsNoResult) {
  const auto write = [&](const FileRule& superseded) {
    OutputFolder folder(Path("out"), true, superseded);
    WriteFile(folder.File("run.yaml"), "new");
    folder.Commit();
  };
  fs::create_directory(Path("out"));
  WriteFile(Path("out/run.yaml"), "old");
  RequireRunFolder(Path("out"));
  const auto replace_and_be_killed = [&] {
    write([](const fs::path&) { return std::raise(SIGKILL) != 0; });
  };
  EXPECT_EXIT(replace_and_be_killed(), testing::KilledBySignal(SIGKILL), "");
  EXPECT_THAT(RefusalOf([&] { RequireRunFolder(Path("out")); }),
              testing::HasSubstr("files of two results: a command that replaced one was killed"));
  write({});
  RequireRunFolder(Path("out"));
  EXPECT_EQ(Everything(), (Names{"out", "out/run.yaml"}));
}

TEST_F(OutputFolderTest, AMarkOfAStudyIsOneOfItsCases) {
  fs::create_directories(Path("study/case/frames"));
  MarkAsReplaced(Path("study"), kMarkOfStudy);
  for (const char* of_study : {"study", "study/", "study/case", "study/case/"}) {
    EXPECT_THAT(RefusalOf([&] { RequireOneResult(Path(of_study)); }),
                testing::HasSubstr("files of two results"))
        << of_study;
  }
  RequireOneResult(Path("study/case/frames"));
  UnmarkAsReplaced(Path("study"), kMarkOfStudy);
  RequireOneResult(Path("study/case"));
}

TEST_F(OutputFolderTest, WhatCannotTakeItsPlaceIsKept) {
  fs::create_directories(Path("out/b.txt"));
  WriteFile(Path("out/a.txt"), "old");
  WriteFile(Path("out/rgb"), "precious");
  const auto commit = [&](const std::string& name) -> std::string {
    OutputFolder folder(Path("out"), true, [](const fs::path&) { return true; });
    fs::create_directories(fs::path(folder.File(name)).parent_path());
    WriteFile(folder.File("a.txt"), "new");
    WriteFile(folder.File(name), "new");
    try {
      folder.Commit();
    } catch (const InputError&) {
      return "no failure of the program, an error of the user";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string rest = "; what was to be written is in " + Path(".out.partial") +
                           " until the next command that writes " + Path("out");
  EXPECT_EQ(commit("b.txt"), Path("out/b.txt") + ": is a folder, must be a file" + rest);
  EXPECT_EQ(Everything(), (Names{".out.partial", ".out.partial/a.txt", ".out.partial/b.txt", "out",
                                 "out/a.txt", "out/b.txt", "out/rgb"}));
  EXPECT_EQ(ReadFile(Path("out/a.txt")), "old");
  EXPECT_EQ(commit("rgb/0.png"), Path("out/rgb") + ": is a file, must be a folder" + rest);
  EXPECT_EQ(ReadFile(Path("out/rgb")), "precious");
  EXPECT_EQ(ReadFile(Path(".out.partial/rgb/0.png")), "new");
}

TEST_F(OutputFolderTest, WhatCameMeanwhileIsKeptWithoutForce) {
  const auto commit = [&](bool force, const auto& meanwhile) -> std::string {
    fs::remove_all(Path("out"));
    OutputFolder folder(Path("out"), force);
    WriteFile(folder.File("a.txt"), "new");
    meanwhile();
    try {
      folder.Commit();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string rest = "; what was to be written is in " + Path(".out.partial") +
                           " until the next command that writes " + Path("out");
  const auto user_writes = [&] {
    fs::create_directory(Path("out"));
    WriteFile(Path("out/a.txt"), "mine");
  };
  EXPECT_EQ(commit(false, user_writes), Path("out") + ": is not empty any more" + rest);
  EXPECT_EQ(ReadFile(Path("out/a.txt")), "mine");
  EXPECT_EQ(ReadFile(Path(".out.partial/a.txt")), "new");
  EXPECT_EQ(commit(true, user_writes), "");
  EXPECT_EQ(ReadFile(Path("out/a.txt")), "new");
  fs::create_directory(Path("old"));
  WriteFile(Path("old/a.txt"), "mine");
  for (const bool force : {false, true}) {
    const std::string said =
        commit(force, [&] { fs::create_directory_symlink(Path("old"), Path("out")); });
    EXPECT_EQ(said, Path("out") + ": Not a directory" + rest);
    EXPECT_EQ(ReadFile(Path("old/a.txt")), "mine");
  }
  // An empty folder is as good as none.
  EXPECT_EQ(commit(false, [&] { fs::create_directory(Path("out")); }), "");
}

TEST_F(OutputFolderTest, WhatIsNoFolderToWorkInIsNamed) {
  const auto says = [&](const char* what) {
    try {
      OutputFolder(Path("out"), false);
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), Path(".out.partial") + ": is a " + what +
                                  ", must be a folder or not be there: it is written first");
      return;
    }
    ADD_FAILURE() << "a " << what << " was taken";
  };
  WriteFile(Path(".out.partial"), "mine");
  says("file");
  EXPECT_EQ(ReadFile(Path(".out.partial")), "mine");
  fs::remove(Path(".out.partial"));
  fs::create_directory(Path("mine"));
  for (const char* target : {"mine", "nowhere"}) {
    fs::create_directory_symlink(Path(target), Path(".out.partial"));
    says("link");
    fs::remove(Path(".out.partial"));
  }
}

TEST_F(OutputFolderTest, NothingIsWrittenThroughALink) {
  fs::create_directory(Path("elsewhere"));
  WriteFile(Path("elsewhere/0.png"), "precious");
  fs::create_directory(Path("out"));
  fs::create_directory_symlink(Path("elsewhere"), Path("out/rgb"));
  OutputFolder folder(Path("out"), true, [](const fs::path&) { return true; });
  fs::create_directory(folder.work() / "rgb");
  WriteFile(folder.File("rgb/0.png"), "new");
  EXPECT_THROW(folder.Commit(), std::runtime_error);
  EXPECT_EQ(ReadFile(Path("elsewhere/0.png")), "precious");
  EXPECT_TRUE(fs::is_symlink(Path("out/rgb")));
}

TEST_F(OutputFolderTest, AFolderGoesWithTheLastOfItsSupersededFiles) {
  fs::create_directories(Path("out/frames"));
  fs::create_directories(Path("out/kept"));
  for (const char* file : {"out/run.yaml", "out/frames/0.png", "out/kept/0.png", "out/kept/mine"}) {
    WriteFile(Path(file), "old");
  }
  {
    OutputFolder folder(Path("out"), true,
                        [](const fs::path& file) { return file.extension() == ".png"; });
    WriteFile(folder.File("run.yaml"), "new");
    folder.Commit();
  }
  EXPECT_EQ(Everything(), (Names{"out", "out/kept", "out/kept/mine", "out/run.yaml"}));
}

TEST_F(OutputFolderTest, FollowsALinkToAFolder) {
  fs::create_directory(Path("real"));
  fs::create_directory_symlink(Path("real"), Path("link"));
  OutputFolder folder(Path("link"), false);
  WriteFile(folder.File("a.txt"), "1");
  folder.Commit();
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_TRUE(fs::exists(Path("real/a.txt")));
}

TEST_F(OutputFolderTest, IsOneWritersAtATime) {
  {
    OutputFolder first(Path("out"), false);
    WriteFile(first.File("a.txt"), "first");
    EXPECT_THROW(OutputFolder(Path("out"), false), InputError);
    EXPECT_THROW(OutputFolder(Path("out/"), true), InputError);
    OutputFolder other(Path("other"), false);
    first.Commit();
    // The name is free again, and what is then written under it is not the first one's to remove.
    OutputFolder second(Path("out"), true);
    WriteFile(second.File("b.txt"), "second");
    { const OutputFolder gone(Path("gone"), false); }
    second.Commit();
  }
  EXPECT_EQ(Everything(), (Names{"out", "out/a.txt", "out/b.txt"}));
}

TEST_F(OutputFolderTest, TakesOverWhatAKilledProgramLeft) {
  fs::create_directories(Path(".out.partial/half"));
  WriteFile(Path(".out.partial/half/a.txt"), "half");
  {
    OutputFolder folder(Path("out"), false);
    WriteFile(folder.File("b.txt"), "1");
    folder.Commit();
  }
  EXPECT_EQ(Everything(), (Names{"out", "out/b.txt"}));
}

// A folder shared with a container is a mount point: nothing beside it can be renamed into it,
// whether it is of another file system or a folder of the same one.
class OutputMountTest : public OutputFolderTest, public ::testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    OutputFolderTest::SetUp();
    fs::create_directory(Path("out"));
    const bool is_bound = GetParam();
    if (is_bound) fs::create_directory(Path("real"));
    const int failed = is_bound
                           ? ::mount(Path("real").c_str(), Path("out").c_str(), "", MS_BIND, "")
                           : ::mount("tmpfs", Path("out").c_str(), "tmpfs", 0, "size=1m");
    if (failed != 0) GTEST_SKIP() << "only root may mount";
  }
  void TearDown() override {
    ::umount2(Path("out").c_str(), MNT_DETACH);
    OutputFolderTest::TearDown();
  }
  Names InFolder() const {
    Names names = Everything();
    std::erase_if(names, [](const std::string& name) { return !name.starts_with("out/"); });
    return names;
  }
};

TEST_P(OutputMountTest, IsWrittenInside) {
  {
    OutputFolder folder(Path("out"), false);
    fs::create_directory(folder.work() / "frames");
    WriteFile(folder.File("frames/0.png"), "1");
    EXPECT_THROW(OutputFolder(Path("out"), false), InputError);  // one writer at a time
    folder.Commit();
  }
  EXPECT_EQ(InFolder(), (Names{"out/frames", "out/frames/0.png"}));
  EXPECT_THROW(OutputFolder(Path("out"), false), InputError);
  {
    OutputFolder folder(Path("out"), true,
                        [](const fs::path& file) { return file.filename() != "mine.txt"; });
    WriteFile(Path("out/mine.txt"), "precious");
    WriteFile(folder.File("run.yaml"), "2");
    folder.Commit();
  }
  EXPECT_EQ(InFolder(), (Names{"out/mine.txt", "out/run.yaml"}));
  for (const char* name : {"out/mine.txt", "out/run.yaml"}) fs::remove(Path(name));
  OutputFolder folder(Path("out"), false);
  WriteFile(folder.File("run.yaml"), "3");
  WriteFile(Path("out/run.yaml"), "precious");  // meanwhile
  EXPECT_THROW(folder.Commit(), std::runtime_error);
  EXPECT_EQ(ReadFile(Path("out/run.yaml")), "precious");
}

TEST_P(OutputMountTest, IsLeftAsItWas) {
  { OutputFolder(Path("out"), false); }
  EXPECT_EQ(InFolder(), Names{});
  fs::create_directories(Path("out/.out.partial/half"));  // of a program that was killed
  { OutputFolder(Path("out"), false); }
  EXPECT_EQ(InFolder(), Names{});
}

INSTANTIATE_TEST_SUITE_P(FileSystems, OutputMountTest, ::testing::Bool(),
                         [](const auto& of) { return of.param ? "Same" : "Other"; });

}  // namespace
}  // namespace depthgrid
