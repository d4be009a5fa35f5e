#include "mapper/io/loop_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<double> kStamps = {10.0, 10.1, 10.2, 10.3, 10.4};

SlamEvents Parse(const std::string& text) {
  return ParseSlamEvents(text, "e.txt", {kStamps}, 0.02);
}

std::string EventsRefusal(const std::string& text) {
  return RefusalOf([&] { Parse(text); });
}

// Tcm carries points of the matched camera into the current one: a camera that went 0.5 m along its
// z sees the old one 0.5 m behind itself.
TEST(LoopEvents, OrbSlamsEventsByHand) {
  const SlamEvents events = Parse(
      "RELOC frame 99 t 10.105\n"
      "GBA_DONE kf 21\n"
      "LOOP 88 10.3 5 10.0 jump_m 0.2 nmatch 1003 Tcm 1 0 0 0 0 1 0 0 0 0 1 -0.5\n");
  EXPECT_EQ(events.kind, "ORB-SLAM2 events");
  EXPECT_TRUE(events.warnings.empty());
  ASSERT_EQ(events.events.size(), 2U);
  EXPECT_EQ(events.events[0].frame, 1);
  EXPECT_TRUE(events.events[0].new_epoch);
  EXPECT_FALSE(events.events[0].loop);
  EXPECT_EQ(events.events[1].frame, 3);
  EXPECT_FALSE(events.events[1].new_epoch);  // the poses jump frames later; FindJumps says when
  const LoopClosure& loop = *events.events[1].loop;
  EXPECT_EQ(loop.reported_at_frame, 3);
  EXPECT_EQ(loop.first_frame, 0);
  EXPECT_EQ(loop.second_frame, 3);
  EXPECT_TRUE(loop.first_from_second.translation.isApprox(Eigen::Vector3d(0.0, 0.0, 0.5)));
}

// The camera that is named first may be the older one: the loop is known once both are.
TEST(LoopEvents, ALoopComesWithTheLaterOfItsFrames) {
  const SlamEvents events = Parse("LOOP 5 10.1 88 10.3 Tcm 1 0 0 0 0 1 0 0 0 0 1 -0.5\n");
  ASSERT_EQ(events.events.size(), 1U);
  EXPECT_EQ(events.events[0].frame, 3);
  EXPECT_EQ(events.events[0].loop->reported_at_frame, 3);
  EXPECT_EQ(events.events[0].loop->second_frame, 1);
}

// Spreadsheets put one before what they save.
TEST(LoopEvents, AByteOrderMarkIsNoPartOfTheFirstWord) {
  const std::string header = "kind,frame,epoch,x,sigma_rotation_rad\n";
  const SlamEvents events = Parse("\xef\xbb\xbf" + header);
  EXPECT_EQ(events.kind, Parse(header).kind);
  EXPECT_TRUE(events.warnings.empty());
}

TEST(LoopEvents, StampedLoopsWithAndWithoutSigmas) {
  const SlamEvents events = Parse(
      "# first second pose\n"
      "10.1 10.4 1 2 3 0 0 0 1 0.5 0.25\n"
      "10.0 10.2 0 0 0 0 0 1 0\n"
      "10.0 17.0 0 0 0 0 0 0 1\n");
  EXPECT_EQ(events.kind, "stamped loops");
  EXPECT_THAT(events.warnings, ElementsAre(HasSubstr("e.txt: 1 event of frames that the")));
  ASSERT_EQ(events.events.size(), 2U);
  EXPECT_EQ(events.events[0].frame, 2);  // ordered by the frame that reports
  EXPECT_EQ(events.events[1].loop->first_frame, 1);
  EXPECT_EQ(events.events[1].loop->first_from_second.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(events.events[1].loop->sigma_translation_m, 0.5);
  EXPECT_EQ(events.events[1].loop->sigma_rotation_rad, 0.25);
  EXPECT_EQ(events.events[0].loop->sigma_translation_m, LoopClosure{}.sigma_translation_m);
}

TEST(LoopEvents, RotationsOfFewDigitsAreRotations) {
  const auto events = Parse("10.0 10.1 1 2 3 0 0 0.70 0.70\n");
  EXPECT_NEAR(events.events.at(0).loop->first_from_second.rotation.norm(), 1.0, 1e-12);
}

TEST(LoopEvents, OneClearLineForEachFault) {
  EXPECT_THAT(EventsRefusal("LOOP 1 10.0 0 10.1 Tcm 1 0 0\n"),
              HasSubstr("e.txt:1: a LOOP must end with"));
  EXPECT_THAT(EventsRefusal("GBA_DONE kf 1\nLOST 3\n"), HasSubstr("e.txt:2: 'LOST' must be LOOP"));
  EXPECT_THAT(EventsRefusal("RELOC frame 3\n"), HasSubstr("field 5 must be a finite number"));
  EXPECT_THAT(EventsRefusal("LOOP 1 10.0 0 10.1 Tcm 2 0 0 0 0 1 0 0 0 0 1 0\n"),
              HasSubstr("rotation"));
  EXPECT_THAT(EventsRefusal("10.0 10.1 0 0 0 0 0 0 1 0.1\n"), HasSubstr("10 columns, must have 9"));
  EXPECT_THAT(EventsRefusal("10.0 10.1 0 0 0 0 0 0 3\n"), HasSubstr("norm 3, must be 1"));
  EXPECT_THAT(EventsRefusal("10.0 nan 0 0 0 0 0 0 1\n"), HasSubstr("finite"));
  EXPECT_THAT(EventsRefusal("10.0 10.1 0 2e7 0 0 0 0 1\n"), HasSubstr("must lie within 10,000 km"));
  EXPECT_THAT(EventsRefusal("leap,1\n"),
              HasSubstr("e.txt:1: begins with 'leap', must be SLAM's events"));
  EXPECT_THAT(EventsRefusal("loop,1\n"), HasSubstr("e.txt:1: has 2 columns, must have 14 or 17"));
  EXPECT_THAT(EventsRefusal("1.0 0 0 0 0 0 0 1\n"), HasSubstr("e.txt:1: has 8 columns as a traj"));
}

}  // namespace
}  // namespace depthgrid
