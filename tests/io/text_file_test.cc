// What begins as a compressed file is refused by every reader of text.
#include <gmock/gmock.h>

#include "mapper/core/error.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/config.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using TextFileTest = TemporaryFolderTest;

TEST_F(TextFileTest, EveryReaderSaysHowToUnpack) {
  WriteFile(Path("depth.txt"), "\x1F\x8B\x08 packed");
  const std::string path = Path("depth.txt");
  std::vector<std::string> warnings;
  const std::vector<std::function<void()>> readers = {
      [&] { ReadTextFile(path); },
      [&] { ReadTrajectory(path); },
      [&] { ReadMatrixPoses(path, warnings); },
      [&] { ReadLoops(path, {{0.0}}, 0.02); },
      [&] {
        ReadSlamFiles({path, "", ""}, {{0.0}}, {});
      },
      [&] { ReadCameraDescription(path, warnings); },
      [&] { Config::FromFile(path); },
      [&] { ListTumFolder(Path("")); },
  };
  for (std::size_t i = 0; i < readers.size(); ++i) {
    try {
      readers[i]();
      ADD_FAILURE() << i;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()), path + ": is compressed by gzip: gunzip it first") << i;
    }
  }
}

TEST_F(TextFileTest, KnowsWhatElseCompresses) {
  const std::pair<const char*, const char*> kinds[] = {{"BZh91AY", "bunzip2"},
                                                       {"\xFD\x37zXZ", "unxz"},
                                                       {"\x28\xB5\x2F\xFD.", "unzstd"},
                                                       {"PK\x03\x04...", "unzip"}};
  for (const auto& [bytes, remedy] : kinds) {
    WriteFile(Path("packed"), bytes);
    try {
      RequireUncompressed(Path("packed"));
      ADD_FAILURE() << remedy;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(std::string(": ") + remedy + " it first"));
    }
  }
  for (const char* text : {"", "B", "PK 1", "0 1 2"}) {
    WriteFile(Path("text"), text);
    EXPECT_EQ(ReadTextFile(Path("text")), text);
  }
}

TEST_F(TextFileTest, WhyAFileCannotBeReadIsSaid) {
  EXPECT_EQ(Short(RefusalOf([&] { ReadFile(Path("nix.txt")); })), "~/nix.txt: no such file");
  std::filesystem::create_symlink("loop.txt", Path("loop.txt"));
  EXPECT_EQ(Short(RefusalOf([&] { ReadFile(Path("loop.txt")); })),
            "~/loop.txt: cannot be read: Too many levels of symbolic links");
}

}  // namespace
}  // namespace depthgrid
