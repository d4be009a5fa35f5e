// Drives the depthgrid program as a user would: arguments in; exit code, output and files out.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "mapper/io/file.h"
#include "tests/paths.h"
#include "tests/scratch.h"

namespace depthgrid {

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

// A test with its own folder, which contains a tiny room and an experiment, and with the program.
class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = ScratchPath();
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
    Write("room.yaml", kRoom);
    Write("small.yaml", kExperiment);
    built_ = BuildTime();
  }
  void TearDown() override {
    std::filesystem::remove_all(root_);
    if (HasFailure() && BuildTime() != built_) {
      ADD_FAILURE() << "the program was built anew meanwhile: build first, then test";
    }
  }

  std::string Path(const std::string& name) const { return (root_ / name).string(); }
  void Write(const std::string& name, const std::string& text) const {
    WriteFile(Path(name), text);
  }

  // `arguments` as in a shell whose working folder is the test's; `as`: what starts the program.
  Outcome Program(const std::string& arguments, const std::string& as = "") const {
    const std::string out = Path(".stdout");
    const std::string err = Path(".stderr");
    const std::string command = "cd '" + root_.string() + "' && " + as + "'" + kProgramFile + "' " +
                                arguments + " >'" + out + "' 2>'" + err + "'";
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadFile(out), ReadFile(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
  }
  void Succeed(const std::string& arguments) const {
    const Outcome outcome = Program(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  }
  // Expects one line on standard error that contains all of `says`, and no change of files.
  void ExpectRefusal(const std::string& arguments, const std::vector<std::string>& says) const {
    SCOPED_TRACE(arguments);
    const auto before = FilesIn("");
    const Outcome outcome = Program(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, testing::StartsWith("depthgrid: "));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& text : says) EXPECT_THAT(outcome.err, testing::HasSubstr(text));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(FilesIn(""), before);
    EXPECT_FALSE(std::filesystem::exists(Path("out")));
  }

  // Every file below a folder, by relative name.
  std::vector<std::string> FilesIn(const std::string& name) const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root_ / name)) {
      if (entry.is_regular_file()) {
        files.push_back(std::filesystem::relative(entry.path(), root_ / name).string());
      }
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  // Where two long texts begin to differ, with an excerpt of both; empty when they are equal.
  static std::string Difference(const std::string& a, const std::string& b) {
    if (a == b) return "";
    const auto at = static_cast<std::size_t>(
        std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
    constexpr std::size_t kShown = 80;
    const std::size_t from = at < kShown ? 0 : at - kShown;
    return "of " + std::to_string(a.size()) + " and " + std::to_string(b.size()) +
           " bytes, they part at " + std::to_string(at) + ":\n" + a.substr(from, 2 * kShown) +
           "\n" + b.substr(std::min(from, b.size()), 2 * kShown);
  }
  // Not EXPECT_EQ of the contents: a failure would print them.
  bool SameFile(const std::string& a, const std::string& b) const {
    return ReadFile(Path(a)) == ReadFile(Path(b));
  }
  // The same files with the same bytes, timing files aside.
  void ExpectSameBytes(const std::string& a, const std::string& b) const {
    ASSERT_EQ(FilesIn(a), FilesIn(b));
    int compared = 0;
    for (const std::string& file : FilesIn(a)) {
      if (std::filesystem::path(file).filename().string().starts_with("timing")) continue;
      EXPECT_EQ(Difference(ReadFile(Path(a + "/" + file)), ReadFile(Path(b + "/" + file))), "")
          << file;
      ++compared;
    }
    EXPECT_GT(compared, 10);
  }

  // 3 x 4 m with a cupboard, and a path around it; the camera is small for speed.
  static constexpr const char* kRoom = R"(
name: test_room
floor_z_m: 0
shapes:
  - {shape: box, size: [3, 4, 0.1], at: [1.5, 2, -0.1]}
  - {shape: wall, from: [0, 0], to: [3, 0], side: right}
  - {shape: wall, from: [3, 0], to: [3, 4], side: right}
  - {shape: wall, from: [3, 4], to: [0, 4], side: right}
  - {shape: wall, from: [0, 4], to: [0, 0], side: right}
  - {shape: box, size: [0.5, 0.5, 1.5], at: [0.4, 2.0, 0]}
trajectories:
  look_around:
    kind: handheld
    waypoints:
      - {at: [1.5, 1.0, 1.1], look_at: [1.5, 4.0, 1.0]}
      - {at: [1.9, 2.0, 1.1], look_at: [0.0, 3.0, 1.0]}
      - {at: [1.5, 2.6, 1.1], look_at: [0.0, 2.0, 1.0]}
)";
  static constexpr const char* kExperiment = R"(
scene: ./room.yaml
frames: 12
sensor: {width: 80, height: 60, noise: handa}
slam: {profile: orb_slam2}
mapper: {fusion: {mode: fixed, gain: 0.5}}
)";

  std::filesystem::path root_;

 private:
  // The program's time stamp; the minimum while it is being linked.
  static std::filesystem::file_time_type BuildTime() {
    std::error_code missing;
    return std::filesystem::last_write_time(kProgramFile, missing);
  }
  std::filesystem::file_time_type built_;
};

}  // namespace depthgrid
