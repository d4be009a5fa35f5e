// Ctrl-C, `kill` and a closed terminal: nothing half-written stays.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

class ProgramSignals : public ProgramTest {
 protected:
  // Starts a run; no shell in between, whose background jobs ignore Ctrl-C.
  pid_t Start(const char* frames, bool ignores_hangup, const char* video = nullptr) const {
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (ignores_hangup) std::signal(SIGHUP, SIG_IGN);
    if (video != nullptr) ::setenv("PATH", (root_.string() + ":/usr/bin:/bin").c_str(), 1);
    const bool ready = ::chdir(root_.c_str()) == 0 &&
                       std::freopen("/dev/null", "w", stdout) != nullptr &&
                       std::freopen("err.txt", "w", stderr) != nullptr;
    if (ready) {
      ::execl(kProgramFile, kProgramFile, "run", "./small.yaml", "--set", frames, "-o", "out",
              video == nullptr ? nullptr : "--video", video, nullptr);
    }
    ::_exit(99);
  }
  bool HasUnfinishedFolder() const {
    for (const auto& entry : std::filesystem::directory_iterator(root_)) {
      if (entry.path().filename().string().starts_with(".out.partial")) return true;
    }
    return false;
  }
  // The exit code of a run that gets these signals once it has made its folder.
  int ExitCodeAfter(const std::vector<int>& signals, const char* frames,
                    bool ignores_hangup = false) const {
    const pid_t child = Start(frames, ignores_hangup);
    int status = 0;
    while (!HasUnfinishedFolder() && ::waitpid(child, &status, WNOHANG) == 0) ::usleep(1000);
    for (const int signal : signals) ::kill(child, signal);
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(ProgramSignals, LeaveNothing) {
  // `timeout` and a terminal's group may send one twice.
  const std::vector<std::vector<int>> requests = {
      {SIGINT}, {SIGTERM, SIGTERM}, {SIGHUP}, {SIGINT, SIGHUP}};
  for (const std::vector<int>& signals : requests) {
    // Of two at once the system chooses which comes first.
    std::vector<int> codes;
    for (const int signal : signals) codes.push_back(128 + signal);
    EXPECT_THAT(codes, testing::Contains(ExitCodeAfter(signals, "frames=3000")));
    EXPECT_EQ(ReadFile(Path("err.txt")), "depthgrid: interrupted\n");
    EXPECT_FALSE(HasUnfinishedFolder());
    EXPECT_FALSE(std::filesystem::exists(Path("out")));
  }
}

// Soon, and whether or not somebody takes note of it.
bool HasEnded(pid_t process) {
  for (int tries = 0; tries < 10000; ++tries) {
    if (::kill(process, 0) != 0) return true;
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state;
    stat >> number >> name >> state;
    if (state == "Z") return true;
    ::usleep(1000);
  }
  return false;
}

// A step that reports nothing and does not end: ffmpeg takes no pictures. It ends with the program;
// the map, finished before, stays.
TEST_F(ProgramSignals, EndAStepThatDoesNotEnd) {
  Write("ffmpeg", "#!/bin/sh\necho $$ > started.part\nmv started.part started\nexec sleep 600\n");
  ASSERT_EQ(::chmod(Path("ffmpeg").c_str(), 0755), 0);
  const pid_t child = Start("frames=12", false, "map.mp4");
  int status = 0;
  while (!std::filesystem::exists(Path("started")) && ::waitpid(child, &status, WNOHANG) == 0) {
    ::usleep(1000);
  }
  ::kill(child, SIGTERM);
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
  EXPECT_EQ(ReadFile(Path("err.txt")), "depthgrid: interrupted; the run is in out\n");
  EXPECT_FALSE(HasUnfinishedFolder());
  EXPECT_TRUE(std::filesystem::exists(Path("out/report.html")));
  EXPECT_THAT(FilesIn("."), testing::Not(testing::Contains(testing::HasSubstr(".mp4"))));
  EXPECT_TRUE(HasEnded(std::stoi(ReadFile(Path("started")))));
}

TEST_F(ProgramSignals, WhatTheCallerIgnoresStaysIgnored) {
  EXPECT_EQ(ExitCodeAfter({SIGHUP}, "frames=100", true), 0);
  EXPECT_EQ(ReadFile(Path("err.txt")), "");
  EXPECT_TRUE(std::filesystem::exists(Path("out/report.html")));
}

}  // namespace
}  // namespace depthgrid
