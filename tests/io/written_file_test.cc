// What is left beside a file that is written.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>

#include "tests/io/temporary_folder.h"

namespace depthgrid {
namespace {

using WrittenFileTest = TemporaryFolderTest;

// Whether the process of such a number lives, here or on another machine, is not known: only age
// tells.
TEST_F(WrittenFileTest, HalvesOfKilledProgramsGoWithTheNextWrite) {
  namespace fs = std::filesystem;
  const auto half = [&](const std::string& name, int minutes) {
    Write(name, "half");
    const auto now = fs::file_time_type::clock::now();
    fs::last_write_time(Path(name), now - std::chrono::minutes(minutes));
  };
  std::vector<std::string> stay = {"b.bin.4711.0.tmp", "a.bin.tmp",       "a.bin.4711.tmp",
                                   "a.bin.x.0.tmp",    "a.bin.4711..tmp", "aXbin.4711.0.tmp"};
  for (const std::string& name : stay) half(name, 9999);
  half("a.bin.4711.0.tmp", 61);
  half("a.bin.4712.3.tmp", 59);
  WriteFileToDisk(Path("a.bin"), "whole");
  stay.insert(stay.end(), {"a.bin.4712.3.tmp", "a.bin"});
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(folder_)) {
    names.push_back(file.path().filename().string());
  }
  EXPECT_THAT(names, testing::UnorderedElementsAreArray(stay));
}

}  // namespace
}  // namespace depthgrid
