#include "eval/run/ordered_frames.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>

namespace depthgrid {
namespace {

TEST(OrderedFrames, GivesEveryItemInOrderAtAnyThreadCount) {
  for (const int threads : {1, 2, 3, 8}) {
    for (const int count : {0, 1, 2, 7, 500}) {
      OrderedFrames<int> frames(count, threads, [](int i) { return i * i; });
      for (int i = 0; i < count; ++i) {
        const auto item = frames.Next();
        ASSERT_TRUE(item);
        ASSERT_EQ(*item, i * i);
      }
      EXPECT_FALSE(frames.Next());
      EXPECT_FALSE(frames.Next());
    }
  }
}

TEST(OrderedFrames, OneThreadMakesEachItemWhenAsked) {
  int made = 0;
  OrderedFrames<int> frames(10, 1, [&](int i) {
    ++made;
    return i;
  });
  EXPECT_EQ(made, 0);
  frames.Next();
  EXPECT_EQ(made, 1);
}

TEST(OrderedFrames, RunsAheadOnlyAsFarAsItsWindow) {
  std::atomic<int> made = 0;
  OrderedFrames<int> frames(100000, 2, [&](int i) {
    ++made;
    return i;
  });
  frames.Next();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_LT(made, 20);
}

TEST(OrderedFrames, AnErrorComesWithItsItem) {
  for (const int threads : {1, 4}) {
    OrderedFrames<int> frames(10, threads, [](int i) {
      if (i == 3) throw std::runtime_error("three");
      return i;
    });
    for (int i = 0; i < 3; ++i) EXPECT_EQ(frames.Next(), i);
    EXPECT_THROW(frames.Next(), std::runtime_error);
    EXPECT_EQ(frames.Next(), 4);
  }
}

TEST(OrderedFrames, MayBeAbandoned) {
  for (int i = 0; i < 50; ++i) {
    OrderedFrames<int> frames(1000, 4, [](int frame) { return frame; });
    frames.Next();
  }
}

}  // namespace
}  // namespace depthgrid
