#include "mapper/io/images_ahead.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "mapper/core/error.h"
#include "mapper/core/usable_threads.h"
#include "mapper/io/recording.h"

namespace depthgrid {
namespace {

using internal::ImagesAhead;
using internal::ReadImage;
using std::chrono::milliseconds;

constexpr std::size_t kImages = 40;

// Of differing durations, so that images are done in another order than they are begun.
ReadImage Slowly(std::size_t i) {
  std::this_thread::sleep_for(milliseconds((7 * i) % 5));
  ReadImage read;
  if (i % 10 == 3) {
    read.unreadable = fmt::format("{} is damaged", i);
  } else {
    DepthImage image(1, 1);
    image.z_m[0] = static_cast<float>(i);
    read.depth = std::make_shared<DepthImage>(image);
  }
  return read;
}

// Whether it is so within some seconds.
template <typename Condition>
bool Comes(const Condition& condition) {
  for (int i = 0; i < 5000 && !condition(); ++i) std::this_thread::sleep_for(milliseconds(1));
  return condition();
}

TEST(ImagesAhead, GivesEachImageOnceAndInOrder) {
  for (const std::size_t most : {0U, 1U, 2U, 4U, 100U}) {
    std::atomic<int> calls = 0;
    ImagesAhead images(2, kImages, most, [&](std::size_t i) {
      ++calls;
      return Slowly(i);
    });
    for (std::size_t i = 2; i < kImages; ++i) {
      const ReadImage read = images.Next();
      EXPECT_EQ(read.unreadable, Slowly(i).unreadable) << most;
      ASSERT_EQ(read.depth == nullptr, i % 10 == 3) << most;
      EXPECT_EQ(read.depth ? read.depth->At(0, 0) : static_cast<float>(i), static_cast<float>(i));
    }
    EXPECT_EQ(calls, kImages - 2) << most;
  }
}

TEST(ImagesAhead, NoMoreThanAskedForAreReadAndNoneBeforeTheFirstIsAskedFor) {
  std::atomic<int> begun = 0;
  ImagesAhead images(0, kImages, 3, [&](std::size_t i) {
    ++begun;
    return Slowly(i);
  });
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(begun, 0);
  for (int taken = 1; taken <= 4; ++taken) {
    images.Next();
    EXPECT_TRUE(Comes([&] { return begun == taken + 3; })) << taken;
    std::this_thread::sleep_for(milliseconds(20));
    EXPECT_EQ(begun, taken + 3);
  }
}

TEST(ImagesAhead, LeavesNoThreadBehind) {
  std::atomic<int> at_work = 0;
  {
    ImagesAhead images(0, kImages, 4, [&](std::size_t i) {
      ++at_work;
      std::this_thread::sleep_for(milliseconds(i == 0 ? 0 : 50));
      --at_work;
      return Slowly(i);
    });
    images.Next();
    EXPECT_TRUE(Comes([&] { return at_work > 0; }));
  }
  EXPECT_EQ(at_work, 0);
}

TEST(ImagesAhead, ThrowsWhatWasThrownForThatImage) {
  ImagesAhead images(0, 4, 2, [](std::size_t i) {
    if (i == 1) throw std::runtime_error("no memory");
    return Slowly(i);
  });
  EXPECT_TRUE(images.Next().depth);
  EXPECT_THROW(images.Next(), std::runtime_error);
  EXPECT_TRUE(images.Next().depth);
  EXPECT_FALSE(images.Next().depth);
}

// Of ten images those with a number that ends on 4 or 5 are damaged, the earlier one slowly; 7 is
// of another size.
class RecordingAheadTest : public ::testing::Test {
 protected:
  std::unique_ptr<FrameSource> Open() {
    Recording recording;
    recording.name = "rec";
    SlamOutput slam;
    for (int i = 0; i < 10; ++i) {
      recording.images.push_back({0.1 * i, std::to_string(i), i});
      slam.live.push_back({0.1 * i, Pose3{Eigen::Quaterniond::Identity(), {0.1 * i, 0.0, 0.0}}, 0});
    }
    recording.camera.camera = PinholeCamera{4, 3, 5.0, 5.0, 1.5, 1.0, {}};
    return OpenRecording(recording, slam, {}, [this](const std::string& path) {
      const int number = std::stoi(path);
      ++calls_;
      if (number == 4) std::this_thread::sleep_for(milliseconds(30));
      if (number == 4 || number == 5) throw InputError(path, "is damaged");
      DepthImage image(number == 7 ? 5 : 4, 3);
      std::fill(image.z_m.begin(), image.z_m.end(), 1.0F + static_cast<float>(number));
      return image;
    });
  }
  std::atomic<int> calls_ = 0;
};

TEST(ImagesAhead, NoneIsReadAheadOnTheOneCoreThatIsAllowed) {
  cpu_set_t before, one;
  ASSERT_EQ(::sched_getaffinity(::getpid(), sizeof(before), &before), 0);
  int core = 0;
  while (!CPU_ISSET(core, &before)) ++core;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  ASSERT_EQ(::sched_setaffinity(::getpid(), sizeof(one), &one), 0);
  const int threads = UsableThreads();
  const std::size_t ahead = internal::UsualImagesAhead();
  EXPECT_EQ(::sched_setaffinity(::getpid(), sizeof(before), &before), 0);
  EXPECT_EQ(threads, 1);
  EXPECT_EQ(ahead, 0U);
  EXPECT_EQ(UsableThreads(), CPU_COUNT(&before));
}

TEST_F(RecordingAheadTest, DamageIsToldInTheImagesOrder) {
  const auto source = Open();
  for (int i = 0; i < 10; ++i) {
    const auto frame = source->Next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    ASSERT_EQ(frame->depth == nullptr, i == 4 || i == 5 || i == 7);
    const float expected_m = 1.0F + static_cast<float>(i);
    EXPECT_EQ(frame->depth ? frame->depth->At(0, 0) : expected_m, expected_m);
  }
  EXPECT_FALSE(source->Next());
  EXPECT_THAT(source->Warnings(),
              ::testing::ElementsAre(
                  "rec: 2 depth images missing or damaged (first: 4: is damaged)",
                  "rec: 1 depth image of another size than the camera (first: 7: is 5x3 pixels, "
                  "must be 4x3 as the camera's)"));
}

TEST_F(RecordingAheadTest, TheNextImagesAreReadWhileAFrameIsAtWork) {
  if (UsableThreads() < 2) GTEST_SKIP() << "one core";
  const auto source = Open();
  const int before = calls_;  // whether there is a readable image at all
  source->Next();
  EXPECT_TRUE(Comes([&] { return calls_ >= before + 2; }));
}

}  // namespace
}  // namespace depthgrid
