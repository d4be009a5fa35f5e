#include "mapper/io/end_task.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/io/temporary_folder.h"

namespace depthgrid {
namespace {

class EndTaskTest : public TemporaryFolderTest {
 protected:
  // What a task leaves of itself.
  EndTask Noting(const std::string& name) const {
    return EndTask([this, name] { WriteFile(Path(name), ""); });
  }
  bool Noted(const std::string& name) const { return std::filesystem::exists(Path(name)); }
};

TEST_F(EndTaskTest, IsDoneWhenItGoesOutOfScope) {
  {
    const EndTask task = Noting("done");
    EXPECT_FALSE(Noted("done"));
  }
  EXPECT_TRUE(Noted("done"));
}

constexpr int kEndedAtOnce = 7;

TEST_F(EndTaskTest, IsDoneBeforeTheProgramEndsAtOnce) {
  // In a process of its own, which ends. Its other thread gets no further than the end of its task.
  const auto end_at_once = [&] {
    std::atomic<bool> started = false;
    std::thread at_work([&] {
      {
        const EndTask task = Noting("of_the_thread");
        started = true;
        while (!Noted("of_the_end")) std::this_thread::yield();
        WriteFile(Path("begun_after"), "");  // waits for ever
      }
      WriteFile(Path("never"), "");
    });
    while (!started) std::this_thread::yield();
    const EndTask task = Noting("of_the_end");
    DoEndTasks();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::_exit(kEndedAtOnce);
  };
  EXPECT_EXIT(end_at_once(), testing::ExitedWithCode(kEndedAtOnce), "");
  EXPECT_TRUE(Noted("of_the_thread"));
  EXPECT_TRUE(Noted("of_the_end"));
  EXPECT_FALSE(Noted("begun_after"));
  EXPECT_FALSE(Noted("never"));
}

TEST_F(EndTaskTest, ADelayIsWaitedFor) {
  const auto end_at_once = [&] {
    std::atomic<bool> started = false;
    std::thread at_work([&] {
      const EndDelay whole;
      started = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      WriteFile(Path("whole"), "");
    });
    while (!started) std::this_thread::yield();
    DoEndTasks();
    ::_exit(kEndedAtOnce);
  };
  EXPECT_EXIT(end_at_once(), testing::ExitedWithCode(kEndedAtOnce), "");
  EXPECT_TRUE(Noted("whole"));
}

}  // namespace
}  // namespace depthgrid
