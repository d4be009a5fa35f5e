#include "mapper/io/carmen_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/io/carmen_line.h"
#include "tests/io/log_text.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

constexpr char kRobotLaser[] =
    "ROBOTLASER1 0 -0.5 1.0 0.5 6.000 0.01 0 3 2.5 6.0 0 2 7 8 "
    "1.5 -2 0.25 1.4 -2 0.25 0 0 0 0 0 10.5 host 10.6\n";
constexpr char kFlaser[] = "FLASER 3 1.0 81.83 2.0 1 2 0.5 0.9 2 0.5 11.5 host 0.2\n";

TEST(CarmenLog, ReadsRobotLaserByHand) {
  const TextFile file(std::string("# comment\nPARAM robot_x 3\nODOM 1 2 3 0 0 0 1 h 1\n\n") +
                      kRobotLaser);
  const auto source = OpenCarmenLog(file.path());
  EXPECT_EQ(source->FrameCount(), 1);
  EXPECT_TRUE(source->Warnings().empty());
  EXPECT_FALSE(source->Camera());
  const auto frame = source->Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(std::pair(frame->index, frame->slam_epoch), std::pair(0, 0));
  EXPECT_EQ(frame->stamp_s, 10.5);
  const Pose2 base = BaseOf(*frame->slam_from_camera);  // the laser's pose, not the robot's
  EXPECT_NEAR(base.x_m, 1.5, 1e-15);
  EXPECT_NEAR(base.y_m, -2.0, 1e-15);
  EXPECT_NEAR(base.yaw_rad, 0.25, 1e-15);
  const Scan& scan = *frame->scan;
  EXPECT_EQ(scan.max_range_m, 6.0);
  ASSERT_EQ(scan.beams.size(), 3U);
  EXPECT_EQ(scan.beams[0], (Beam{-0.5F, 2.5F, 0.0F, 2.5F, true}));
  EXPECT_EQ(scan.beams[1], (Beam{0.0F, 0.0F, 0.0F, 5.0F, false}));  // free, to the set distance
  EXPECT_EQ(scan.beams[2], (Beam{0.5F, 0.0F, 0.0F, 0.0F, false}));  // no data
  EXPECT_FALSE(source->Next());
}

TEST(CarmenLog, ReadsFlaserAsHalfCircle) {
  const TextFile file(kFlaser);
  const auto frames = ReadAll(*OpenCarmenLog(file.path()));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].stamp_s, 11.5);
  EXPECT_NEAR(BaseOf(*frames[0].slam_from_camera).x_m, 1.0, 1e-15);
  const auto& beams = frames[0].scan->beams;
  ASSERT_EQ(beams.size(), 3U);
  EXPECT_FLOAT_EQ(beams[0].bearing_rad, static_cast<float>(-kPi / 2));
  EXPECT_NEAR(beams[1].bearing_rad, 0.0, 1e-7);
  EXPECT_FLOAT_EQ(beams[2].bearing_rad, static_cast<float>(kPi / 2));
  EXPECT_TRUE(beams[0].hit);
  EXPECT_FALSE(beams[1].hit);
  EXPECT_GT(beams[1].clear_to_m, 0.0F);
}

TEST(CarmenLog, EvenFlaserCountsHaveWholeDegrees) {
  std::string line = "FLASER 180";
  for (int i = 0; i < 180; ++i) line += " 1.5";
  const auto scan = ParseCarmenLine(line + " 0 0 0 0 0 0 1 h 1");
  EXPECT_NEAR(std::get<CarmenScan>(scan).bearing_step_rad, RadFromDeg(1.0), 1e-15);
}

TEST(CarmenLog, OptionsLimitRanges) {
  const TextFile file(std::string(kRobotLaser) + kFlaser);
  CarmenLogOptions options;
  options.max_range_m = 2.0;
  options.min_range_m = 1.5;
  options.no_return_clear_m = 1.0;
  const auto frames = ReadAll(*OpenCarmenLog(file.path(), options));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].scan->max_range_m, 2.0);  // the smaller of line and option
  for (const Frame& frame : frames) {
    for (const Beam& beam : frame.scan->beams) EXPECT_FALSE(beam.hit);
  }
  EXPECT_EQ(frames[1].scan->beams[0].clear_to_m, 0.0F);  // nearer than 1.5: no data
  EXPECT_EQ(frames[1].scan->beams[2].clear_to_m, 1.0F);  // exactly the maximum: no return
}

TEST(CarmenLog, ALaserUpsideDownIsReadFromLeftToRight) {
  CarmenScan line;
  line.first_bearing_rad = -0.1;
  line.bearing_step_rad = 0.1;
  line.range_m = {1, 2, 3, 4};
  CarmenLogOptions options;
  options.upside_down = true;
  const Scan scan = ScanOf(line, options);
  ASSERT_EQ(scan.beams.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const Beam& beam = scan.beams[static_cast<std::size_t>(i)];
    EXPECT_FLOAT_EQ(beam.range_m, static_cast<float>(4 - i));
    EXPECT_NEAR(beam.bearing_rad, -0.2 + 0.1 * i, 1e-6);
  }
}

TEST(CarmenLog, CountsDamagedLinesAndGoesOn) {
  const std::string good = kRobotLaser;
  std::string text = good;
  text += good;                       // same stamp
  text += good.substr(0, 40) + "\n";  // cut in the header or readings
  text += good.substr(0, 60) + "\n";  // cut in the readings
  text += "ROBOTLASER1 0 -0.5 1 0.5 6 0.01 0 3 2.5 x 3 0 0 0 0 0 0 0 0 0 0 0 0 12 h 12\n";
  text += "\x01\x02 binary rubbish\n";
  text += "FLASER 2 1 1 nan 0 0 0 0 0 13 h 13\n";  // a pose that is no number
  text += "FLASER 99999999 1 1\n";                 // an absurd count
  text += std::string(2U << 20U, '7') + "\n";      // an endless line
  text += kFlaser;
  text += "FLASER 2 1 nan 0 0 0 0 0 0 14 h 14\r\n";  // a reading that is no number: no data
  text += good.substr(0, good.size() / 2);           // the log ends in the middle of a line
  const TextFile file(text);
  const auto source = OpenCarmenLog(file.path());
  EXPECT_EQ(source->FrameCount(), 3);
  const auto frames = ReadAll(*source);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].scan->beams[1], (Beam{frames[2].scan->beams[1].bearing_rad, 0, 0, 0, false}));
  using testing::AllOf;
  using testing::Contains;
  using testing::HasSubstr;
  const auto warnings = source->Warnings();
  EXPECT_THAT(warnings, Contains(HasSubstr("log:2: a scan that is not later")));
  EXPECT_THAT(warnings,
              Contains(AllOf(HasSubstr(":3: "), HasSubstr("readings"), HasSubstr("such lines"))));
  EXPECT_THAT(warnings, Contains(HasSubstr(":6: a line that begins with no message name")));
  EXPECT_THAT(warnings, Contains(HasSubstr(":7: FLASER with a damaged pose")));
  EXPECT_THAT(warnings, Contains(HasSubstr(":9: a line longer than")));
}

TEST(CarmenLog, PosesAreNoLogWhateverTheirStamps) {
  for (const char* stamp : {"1", "1.5"}) {
    const TextFile file(std::string(stamp) + " 0 0 0 0 0 0 1\n");
    EXPECT_THAT([&] { OpenCarmenLog(file.path()); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("and poses by --poses")));
  }
}

TEST(CarmenLog, AByteOrderMarkHidesNoScan) {
  const TextFile file("\xEF\xBB\xBF" + std::string(kRobotLaser));
  const auto source = OpenCarmenLog(file.path());
  EXPECT_EQ(source->FrameCount(), 1);
  EXPECT_TRUE(source->Warnings().empty());
}

// Events name scans by their lines: damaged ones count, doubled ones do not.
TEST(CarmenLog, ScansKeepTheirNumbers) {
  const auto at = [](int stamp_s) {
    return "FLASER 2 1 1 0 0 0 0 0 0 " + std::to_string(stamp_s) + " h 1\n";
  };
  const TextFile file("# log\n" + at(1) + at(1) + "FLASER 2 1 x\nODOM 1\n\x01\n" + at(5) + at(4) +
                      at(6));
  const FrameNames names = CarmenFrames(file.path());
  EXPECT_EQ(names.stamps_s, (std::vector<double>{1, 5, 6}));
  EXPECT_EQ(names.numbers, (std::vector<std::int64_t>{0, 2, 4}));
}

TEST(CarmenLog, MotionIsNotTakenAcrossAJumpOfThePose) {
  const auto scan_at = [](const std::string& x_m, const std::string& stamp_s) {
    return "FLASER 3 1.0 2.0 2.0 " + x_m + " 2 0.5 0.9 2 0.5 " + stamp_s + " host 0.2\n";
  };
  // 14 km and back within a tenth of a second; then 90 m, in which two seconds may have passed.
  const TextFile file(scan_at("1", "0") + scan_at("1.1", "0.1") + scan_at("14000", "0.2") +
                      scan_at("1.2", "0.3") + scan_at("91.2", "2.3") + scan_at("101.3", "2.4") +
                      scan_at("101.3", "2.5") + scan_at("101.3", "2.6") + scan_at("101.3", "2.7"));
  const auto source = OpenCarmenLog(file.path());
  std::vector<int> epochs;
  for (const Frame& frame : ReadAll(*source)) epochs.push_back(frame.slam_epoch);
  EXPECT_EQ(epochs, (std::vector<int>{0, 0, 1, 2, 2, 3, 3, 3, 3}));
  ASSERT_FALSE(source->Warnings().empty());
  EXPECT_THAT(source->Warnings()[0], testing::HasSubstr(":3: the pose jumps"));
  EXPECT_THAT(source->Warnings()[0], testing::HasSubstr("(3 such lines)"));
}

TEST(CarmenLog, EveryTruncationOfALineIsSurvived) {
  const std::string good = kRobotLaser;
  for (std::size_t length = 0; length < good.size(); ++length) {
    const auto line = ParseCarmenLine(std::string_view(good).substr(0, length));
    const auto* scan = std::get_if<CarmenScan>(&line);
    if (scan == nullptr) continue;
    EXPECT_EQ(scan->stamp_s, 10.5);  // only what is not used may be missing
    EXPECT_EQ(scan->odom_from_laser, (Pose2{1.5, -2.0, 0.25}));
  }
}

TEST(CarmenLog, ADamagedLineIsSaidWithItsFieldValueAndRule) {
  const auto fault_of = [](const std::string& line) {
    const auto parsed = ParseCarmenLine(line);
    const auto* damage = std::get_if<CarmenDamage>(&parsed);
    return damage == nullptr ? "" : damage->reason + ": " + damage->fault;
  };
  const auto robot_laser = [&](const std::string& angles) {
    return fault_of("ROBOTLASER1 0 " + angles +
                    " 6 0.01 0 3 2.5 6.0 0 0 0 0 0 0 0 0 0 0 0 0 0 10.5 host 10.6");
  };
  EXPECT_EQ(robot_laser("-0.5 1.0 0.5"), "");
  EXPECT_EQ(robot_laser("-0.5 1.0 0"), "");  // the readings are spread over the field of view
  EXPECT_EQ(robot_laser("-0,5 1.0 0.5"),
            "ROBOTLASER1 with a damaged header: the start angle is '-0,5', must be a number");
  const std::string angles = "ROBOTLASER1 with impossible angles: the ";
  EXPECT_EQ(robot_laser("-0.5 1.0 -0.5"), angles + "resolution is -0.5, must be above 0");
  EXPECT_EQ(robot_laser("-0.5 0 0"),
            angles + "field of view is 0 and the resolution 0, one must be above 0");
  EXPECT_EQ(
      robot_laser("-29 58 29"),
      angles + "resolution is 29, must be at most 3.142 (radians) for 3 readings: a whole turn");
  EXPECT_EQ(robot_laser("-29 58 0"),
            angles + "field of view is 58, must be at most 6.283 (radians)");
  EXPECT_EQ(robot_laser("-29 1 0.5"),
            angles + "start angle is -29, must be from -6.283 to 6.283 (radians)");
  const std::string readings = "FLASER with damaged readings: ";
  EXPECT_EQ(fault_of("FLASER -5 1 1"),
            readings + "their count is '-5', must be a whole number from 2 to 20000");
  EXPECT_EQ(fault_of("FLASER 99999999999999999999 1"),
            readings +
                "their count is '99999999999999999999', must be a whole number from 2 to "
                "20000");
  EXPECT_EQ(fault_of("FLASER 3 1 2"), readings + "number 3 of 3 is missing, must be a number");
  EXPECT_EQ(fault_of("FLASER 2 1 1 0 0 0 0 0 0 noon h 1"),
            "FLASER without a time: it is 'noon', must be a number of seconds");
  EXPECT_EQ(fault_of("FLASER 2 1 1 0 0 0 0 0 0 1"),
            "FLASER without a time: the line ends with '1', must go on with the host");
}

TEST(CarmenLog, RefusesFilesWithoutScan) {
  const TextFile file("PARAM a b\nFLASER 3 1 2\n");
  try {
    OpenCarmenLog(file.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no usable FLASER, ROBOTLASER1 or RAWLASER1"));
    EXPECT_THAT(error.what(), testing::HasSubstr(":2: FLASER with damaged readings"));
  }
  EXPECT_THROW(OpenCarmenLog("/nonexistent/file.log"), InputError);
  const TextFile empty("");
  EXPECT_THROW(OpenCarmenLog(empty.path()), InputError);
}

using testing::HasSubstr;

std::string LogRefusal(const std::string& text) {
  const TextFile file(text);
  return RefusalOf([&] { OpenCarmenLog(file.path()); });
}

TEST(CarmenLog, TakesCoordinatesOfAMapGrid) {
  const TextFile utm(ScanAt(400000.5, 5300000.25, 1));
  const auto frame = OpenCarmenLog(utm.path())->Next();
  EXPECT_EQ(BaseOf(*frame->slam_from_camera).translation(), Eigen::Vector2d(400000.5, 5300000.25));
  EXPECT_THAT(LogRefusal(ScanAt(2e7, 0, 1)),
              testing::HasSubstr("damaged pose (no numbers, or beyond 10,000 km)"));
}

TEST(CarmenLog, ALineThatLostItsEndIsCounted) {
  const std::string whole = ScanAt(0, 0, 1);
  const std::string joined = whole.substr(0, whole.size() - 1) + " " + ScanAt(0, 0, 2);
  EXPECT_THAT(WarningsOf(joined + ScanAt(0, 0, 3)),
              testing::HasSubstr("FLASER with more columns than it states (a lost line end?)"));
  EXPECT_THAT(LogRefusal("FLASER 2 1 1 0 0 0 0 0 0 1.7e18 h 1\n"),
              testing::HasSubstr("FLASER with a time that is not in seconds"));
  // What some loggers add is not read.
  const TextFile more(whole.substr(0, whole.size() - 1) + " a 2 b 3\n");
  EXPECT_EQ(OpenCarmenLog(more.path())->Next()->stamp_s, 1.0);
}

// One reading more than stated moves each column after them by one: the time is found in the host's
// place or after it.
TEST(CarmenLog, ALineWithMoreReadingsThanItStatesIsCounted) {
  const std::string good = ScanAt(0, 0, 1);
  constexpr const char* kReason = ":2: FLASER with other columns than its count of readings says";
  EXPECT_THAT(WarningsOf(good + "FLASER 2 1 1 1 5 6 0 5 6 0 2 h 2\n"), HasSubstr(kReason));
  EXPECT_THAT(WarningsOf(good + "FLASER 2 1 1 1 1 5 6 0 5 6 0 2 h 2\n"), HasSubstr(kReason));
  EXPECT_THAT(WarningsOf(good + "FLASER 2 1 5 6 0 5 6 0 2 h 2\n"),
              HasSubstr(":2: FLASER without a time"));
  EXPECT_THAT(WarningsOf(std::string(kRobotLaser) +
                         "ROBOTLASER1 0 -0.5 1.0 0.5 6.000 0.01 0 3 2.5 6.0 2 0 0 "
                         "1.5 -2 0.25 1.4 -2 0.25 0 0 0 0 0 11.5 host 11.6\n"),
              HasSubstr(":2: ROBOTLASER1 with other columns than"));
  // The host is a number.
  EXPECT_THAT(WarningsOf(good + "FLASER 2 1 1 1 5 6 0 5 6 0 2 7 2\n"), HasSubstr(kReason));
  // A host may be a number, with the logger's time after it or without.
  const TextFile hosts("FLASER 2 1 1 0 0 0 0 0 0 1 7 1\nFLASER 2 1 1 0 0 0 0 0 0 2 7\n");
  EXPECT_EQ(OpenCarmenLog(hosts.path())->FrameCount(), 2);
}

TEST(CarmenLog, NearestReadingIsNearerThanTheFarthest) {
  const TextFile file(ScanAt(0, 0, 1));
  CarmenLogOptions options;
  options.min_range_m = 6.0;
  options.max_range_m = 5.0;
  EXPECT_THAT(RefusalOf([&] { OpenCarmenLog(file.path(), options); }),
              testing::HasSubstr("sequence.laser.min_range_m: is 6, must be below"));
}

TEST(CarmenLog, MostScansOutOfOrderAreSaidWithTheirCause) {
  std::string backwards, doubled;
  for (int i = 9; i >= 0; --i) backwards += ScanAt(0, 0, i);
  for (int i = 0; i < 9; ++i) doubled += ScanAt(0, 0, i) + ScanAt(0, 0, i) + ScanAt(0, 0, i);
  EXPECT_THAT(WarningsOf(backwards),
              testing::HasSubstr("9 of 10 scans are earlier than one before them"));
  // Several messages of one scan are usual.
  EXPECT_THAT(WarningsOf(doubled), testing::Not(testing::HasSubstr("order of time")));
}

TEST(CarmenLog, OdometryFasterThanACarIsSaid) {
  std::string metres, centimetres;
  for (int i = 0; i < 9; ++i) {
    metres += ScanAt(0.6 * i, 0, i);
    centimetres += ScanAt(60.0 * i, 0, i);
  }
  EXPECT_THAT(WarningsOf(metres), testing::Not(HasSubstr("moves at")));
  EXPECT_THAT(WarningsOf(centimetres), testing::HasSubstr("the laser moves at 60 m/s"));
}

TEST(CarmenLog, SaysThatAFileIsNoText) {
  EXPECT_THAT(LogRefusal("\x1F\x8B\x08 packed"),
              testing::HasSubstr("is compressed by gzip: gunzip it first"));
  EXPECT_THAT(LogRefusal(std::string("#BAG\n\0\1\n", 8)),
              testing::HasSubstr("holds bytes that are zero (UTF-16, or no text?)"));
  // Those that a crash left at the end do no harm.
  const TextFile crashed(std::string(kFlaser) + std::string(100, '\0'));
  EXPECT_EQ(OpenCarmenLog(crashed.path())->FrameCount(), 1);
}

TEST(CarmenLine, IsReadAsItWasWritten) {
  CarmenScan scan;
  scan.stamp_s = 3.033333;
  scan.first_bearing_rad = -0.7;
  scan.bearing_step_rad = 0.1;
  scan.max_range_m = 6.0;
  scan.range_m = {1.2345, 6.0, 0.0};
  scan.odom_from_laser = {1.25, -3.5, 2.0};
  const auto line = ParseCarmenLine(RobotLaserLine(scan));
  const auto& read = std::get<CarmenScan>(line);
  EXPECT_EQ(read.stamp_s, scan.stamp_s);
  EXPECT_EQ(read.first_bearing_rad, scan.first_bearing_rad);
  EXPECT_EQ(read.bearing_step_rad, scan.bearing_step_rad);
  EXPECT_EQ(read.max_range_m, scan.max_range_m);
  EXPECT_EQ(read.range_m, scan.range_m);
  EXPECT_EQ(read.odom_from_laser, scan.odom_from_laser);
}

TEST(CarmenLog, ReadsTheSharedLogs) {
  const char* data = std::getenv("DEPTHGRID_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "DEPTHGRID_TEST_DATA is not set";
  const auto source = OpenCarmenLog(std::string(data) + "/laser/living_s1.log");
  EXPECT_EQ(source->FrameCount(), 900);
  EXPECT_TRUE(source->Warnings().empty());
  const auto frame = source->Next();
  EXPECT_EQ(frame->scan->beams.size(), 640U);
}

}  // namespace
}  // namespace depthgrid
