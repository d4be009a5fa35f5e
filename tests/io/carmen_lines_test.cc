#include "mapper/io/carmen_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/log_text.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

// "number:text" of each line, with "+" behind one that is too long and "!" behind one without end.
std::vector<std::string> LinesOf(CarmenLines& lines) {
  std::vector<std::string> all;
  while (const auto line = lines.Next()) {
    all.push_back(fmt::format("{}:{}{}{}", line->number, line->text, line->is_too_long ? "+" : "",
                              line->has_end ? "" : "!"));
  }
  return all;
}

// A file on which every read fails.
constexpr char kUnreadable[] = "/proc/self/mem";

TEST(CarmenLines, GivesEachLineWithItsNumber) {
  const TextFile file(
      "\xEF\xBB\xBF"
      "one\n\n\xEF\xBB\xBF"
      "three\r\nfour");
  CarmenLines lines(file.path());
  EXPECT_EQ(lines.Number(), 0);
  const auto expected = ::testing::ElementsAre("1:one", "2:",
                                               "3:\xEF\xBB\xBF"
                                               "three\r",
                                               "4:four!");
  EXPECT_THAT(LinesOf(lines), expected);
  EXPECT_EQ(lines.Number(), 4);
  EXPECT_FALSE(lines.Next());
  lines.Rewind();
  EXPECT_EQ(lines.Number(), 0);
  EXPECT_THAT(LinesOf(lines), expected);
}

TEST(CarmenLines, ALineThatIsTooLongIsLeftOut) {
  const std::string fits(kMaxLineBytes - 1, 'a');
  const TextFile file(fits + "\n" + fits + "b\nc\n" + fits + "d");
  CarmenLines lines(file.path());
  EXPECT_THAT(LinesOf(lines), ::testing::ElementsAre("1:" + fits, "2:+", "3:c", "4:+"));
}

TEST(CarmenLines, AnEmptyFileHasNone) {
  const TextFile file("");
  CarmenLines lines(file.path());
  EXPECT_FALSE(lines.Next());
  EXPECT_EQ(lines.Number(), 0);
}

TEST(CarmenLines, WhatCannotBeReadIsNoEnd) {
  CarmenLines lines(kUnreadable);
  EXPECT_EQ(RefusalOf([&] { lines.Next(); }), "/proc/self/mem: cannot be read");
  EXPECT_EQ(RefusalOf([] { OpenCarmenLog(kUnreadable); }), "/proc/self/mem: cannot be read");
}

TEST(CarmenLines, RefusesWhatIsNoText) {
  const TextFile file("\x1F\x8B\x08");
  EXPECT_THAT(RefusalOf([&] { CarmenLines lines(file.path()); }),
              ::testing::HasSubstr("is compressed by gzip"));
  EXPECT_EQ(RefusalOf([] { CarmenLines lines("/nonexistent"); }), "/nonexistent: no such file");
}

TEST(CarmenLine, NumbersMayHaveAPlusSign) {
  const TextFile file("FLASER +3 +1.0 81.83 +2e0 +1 -2 +0.5 +0.9 2 +.5 +11.5 host 0.2\n");
  const auto source = OpenCarmenLog(file.path(), {.fov_deg = 180.0});
  EXPECT_THAT(source->Warnings(), ::testing::IsEmpty());
  const auto frame = source->Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->stamp_s, 11.5);
  EXPECT_EQ(frame->scan->beams[2].range_m, 2.0F);
  EXPECT_THAT(WarningsOf(ScanAt(0, 0, 1) + "FLASER 3 +-1 2 2 1 2 0.5 0.9 2 0.5 12 h 0.2\n"),
              ::testing::HasSubstr("number 1 of 3 is '+-1', must be a number"));
}

}  // namespace
}  // namespace depthgrid
