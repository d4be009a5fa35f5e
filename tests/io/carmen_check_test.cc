#include "mapper/io/carmen_check.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "mapper/core/angle.h"
#include "mapper/io/carmen_log.h"
#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;

// The distance of each beam that hits, 0 of the others.
std::vector<float> HitsOf(const std::string& text, const CarmenLogOptions& options = {}) {
  const TextFile file(text);
  std::vector<float> hits;
  for (const Frame& frame : ReadAll(*OpenCarmenLog(file.path(), options))) {
    for (const Beam& beam : frame.scan->beams) hits.push_back(beam.hit ? beam.range_m : 0.0F);
  }
  return hits;
}

TEST(CarmenCheck, TheLogsOwnMaximumIsNoHit) {
  const std::string scan = "FLASER 3 8.17 8.185 8.19 0 0 0 0 0 0 1 h 1\n";
  const std::string stated = "PARAM robot_front_laser_max 8.19 0 h 0\n";
  EXPECT_EQ(HitsOf(scan), (std::vector<float>{8.17F, 8.185F, 8.19F}));
  EXPECT_EQ(HitsOf(stated + scan), (std::vector<float>{8.17F, 0, 0}));
  // A maximum that is no number, or another laser's, states nothing.
  EXPECT_EQ(HitsOf("PARAM robot_front_laser_max x 0 h 0\n" + scan).back(), 8.19F);
  EXPECT_EQ(HitsOf("PARAM robot_rear_laser_max 8.19 0 h 0\n" + scan).back(), 8.19F);
  CarmenLogOptions options;
  options.max_range_m = 8.187;
  EXPECT_EQ(HitsOf(stated + scan, options), (std::vector<float>{8.17F, 8.185F, 0}));
  options.max_range_m = 50.0;
  EXPECT_EQ(HitsOf(stated + scan, options).back(), 8.19F);
  // The SICK states 81.92 and writes 81.83.
  EXPECT_EQ(HitsOf("PARAM robot_front_laser_max 81.92\nFLASER 2 79.9 81.83 0 0 0 0 0 0 1 h 1\n"),
            (std::vector<float>{79.9F, 0}));
}

TEST(CarmenCheck, ReadingsALittleBelowTheStatedMaximumAreNoHit) {
  const auto line = [](const std::string& max_m, const std::string& readings) {
    return "ROBOTLASER1 0 -0.5 1 0.5 " + max_m + " 0.01 0 3 " + readings +
           " 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1\n";
  };
  EXPECT_EQ(HitsOf(line("30.00", "29.96 29.98 29.99")), (std::vector<float>{29.96F, 0, 0}));
  EXPECT_EQ(HitsOf(line("6.0", "5.98 5.995 6.0")), (std::vector<float>{5.98F, 0, 0}));
}

// 20 scans of 50 readings that differ, of which `count` are as far as no other one.
std::string LogOfLargest(int count) {
  std::ostringstream log;
  for (int scan = 0; scan < 20; ++scan) {
    log << "FLASER 50";
    for (int i = 0; i < 50; ++i) {
      const int reading = 50 * scan + i;
      log << " " << (reading < count ? 8.19 : 1.0 + 0.005 * reading);
    }
    log << " 0 0 0 0 0 0 " << scan << " h 1\n";
  }
  return log.str();
}

TEST(CarmenCheck, ALargestReadingThatComesOftenIsSaid) {
  EXPECT_THAT(WarningsOf(LogOfLargest(20)),
              HasSubstr(":1: 20 of 1000 readings are 8.19 m, the largest"));
  EXPECT_THAT(WarningsOf(LogOfLargest(20)), HasSubstr("sequence.laser.max_range_m=8.189"));
  EXPECT_THAT(WarningsOf(LogOfLargest(18)), testing::Not(HasSubstr("the largest")));
  // Where it is known to be no return there is nothing to say.
  EXPECT_THAT(WarningsOf("PARAM robot_front_laser_max 8.19\n" + LogOfLargest(20)),
              testing::Not(HasSubstr("the largest")));
}

// Readings that rise by less than a millimetre from scan to scan are not all the largest.
TEST(CarmenCheck, RisingReadingsAreNotAllTheLargest) {
  std::string log;
  for (int i = 0; i < 100; ++i)
    log += fmt::format("FLASER 2 {0} {0} 0 0 0 0 0 0 {1} h 1\n", 8.0 + 0.0007 * i, i);
  EXPECT_THAT(WarningsOf(log), testing::Not(HasSubstr("the largest")));
  // Those within a millimetre of the last one are, and the first line with one is named.
  for (int i = 100; i < 120; ++i) log += fmt::format("FLASER 2 8.0695 1 0 0 0 0 0 0 {} h 1\n", i);
  EXPECT_THAT(WarningsOf(log), HasSubstr(":99: 24 of 240 readings are 8.0695 m, the largest"));
}

// No data, or so near that no setting could take them for no return.
TEST(CarmenCheck, ReadingsThatDrawNoWallAreNotTakenForNoReturns) {
  for (const char* reading : {" 0", " -1", " 0.05", " 0.1"}) {
    std::string log = "FLASER 180";
    for (int i = 0; i < 180; ++i) log += reading;
    EXPECT_EQ(WarningsOf(log + " 0 0 0 0 0 0 1 h 1\n"), "") << reading;
  }
}

// Turning at `rate` a scan, ten scans a second.
std::string LogOfTurn(double rate, double wrap_at) {
  std::ostringstream log;
  for (int i = 0; i < 200; ++i) {
    const double yaw = std::fmod(rate * i, wrap_at);
    log << "FLASER 2 1 1.5 0 0 " << yaw << " 0 0 " << yaw << " " << 0.1 * i << " h 1\n";
  }
  return log.str();
}

TEST(CarmenCheck, RangesThatAreNoMetresAreSaid) {
  EXPECT_THAT(WarningsOf("FLASER 3 2340 2350 0 0 0 0 0 0 0 1 h 1\n"
                         "FLASER 3 2140 3350 8190 0 0 0 0 0 0 2 h 2\n"),
              HasSubstr(":2: the shortest of 6 readings is 2140, and from 80 m on a reading is no "
                        "return (sequence.laser.max_range_m): are they in metres?"));
  // Nothing within reach, or one return.
  const char* said = "are they in metres?";
  EXPECT_THAT(WarningsOf("FLASER 3 81.83 81.91 0 0 0 0 0 0 0 1 h 1\n"),
              testing::Not(HasSubstr(said)));
  EXPECT_THAT(WarningsOf("FLASER 3 2340 79 0 0 0 0 0 0 0 1 h 1\n"), testing::Not(HasSubstr(said)));
}

// A near one among them is no reason to believe the others.
TEST(CarmenCheck, HitsBeyondTheMaximumAreSaid) {
  constexpr const char* kDoubt = "and differ as hits do: are they in metres, and is that as far";
  const auto log = [](double unit, double least, const char* maximum) {
    std::string text;
    for (int i = 0; i < 40; ++i) {
      text += fmt::format("ROBOTLASER1 0 -1.57 3.14 0.785 {} 0.01 0 5", maximum);
      for (int k = 0; k < 5; ++k) text += fmt::format(" {}", unit * (least + 0.1 * k + 0.05 * i));
      text += fmt::format(" 0 0 0 0 0 0 0 0 0 0 0 0 {0} h {0}\n", i);
    }
    return text;
  };
  EXPECT_THAT(WarningsOf(log(100.0, 0.5, "600")),
              HasSubstr(":1: 188 of 200 readings are 80 m or more, which is taken for no return"));
  EXPECT_THAT(WarningsOf(log(100.0, 0.5, "600")), HasSubstr(kDoubt));
  EXPECT_THAT(WarningsOf(log(1.0, 2.0, "3")), HasSubstr(kDoubt));
  EXPECT_THAT(WarningsOf(log(1.0, 2.0, "6")), testing::Not(HasSubstr(kDoubt)));
  // What has no return, in the codes that a laser has for it.
  std::string codes;
  for (int i = 0; i < 40; ++i) {
    codes += fmt::format("FLASER 5 2.5 81.83 81.91 65.53 {0} 0 0 0 0 0 0 {0} h {0}\n", i);
  }
  EXPECT_THAT(WarningsOf(codes), testing::Not(HasSubstr(kDoubt)));
}

TEST(CarmenCheck, StampsThatAreNoSecondsAreSaid) {
  const auto log = [](double step_s) {
    std::string text;
    for (int i = 0; i < 20; ++i) {
      text += fmt::format("FLASER 2 1 1.5 0 0 0 0 0 0 {0} h {0}\n", step_s * i);
    }
    return text;
  };
  EXPECT_THAT(WarningsOf(log(33.0)),
              HasSubstr(":2: scans come 33 s after each other: are the stamps in seconds?"));
  EXPECT_THAT(WarningsOf(log(1.0)), testing::Not(HasSubstr("are the stamps in seconds?")));
}

TEST(CarmenCheck, StampsWithoutFractionsAreAskedFor) {
  const auto log = [](const char* second) {
    return "FLASER 2 1 1.5 0 0 0 0 0 0 7 h 7\n" +
           fmt::format("FLASER 2 1 1.5 0 0 0 0 0 0 {0} h {0}\n", second);
  };
  constexpr const char* kAsk = "the one before it: both at 7 s, are stamps whole seconds?";
  EXPECT_THAT(WarningsOf(log("7")), HasSubstr(kAsk));
  EXPECT_THAT(WarningsOf(log("6.9")), testing::Not(HasSubstr("whole seconds?")));
}

TEST(CarmenCheck, AWidthWithoutEffectIsSaid) {
  CarmenLogOptions options;
  options.fov_deg = 270.0;
  const std::string stating =
      "ROBOTLASER1 0 -1.57 3.14 1.57 8 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1\n";
  const std::string plain = "FLASER 3 1 2 3 0 0 0 0 0 0 1 h 1\n";
  constexpr const char* kIdle =
      "sequence.laser.fov_deg: has no effect because all lines of the log state their angles";
  EXPECT_THAT(WarningsOf(stating, options), HasSubstr(kIdle));
  EXPECT_THAT(WarningsOf(plain, options), testing::Not(HasSubstr(kIdle)));
  EXPECT_THAT(WarningsOf(stating), testing::Not(HasSubstr(kIdle)));
}

TEST(CarmenCheck, HeadingsInDegreesAreSaid) {
  constexpr const char* kDoubt = "are they in degrees?";
  for (const double rate_deg : {1.0, 3.0, 6.0, 10.0}) {
    for (const double wrap_deg : {360.0, 1e6}) {
      EXPECT_THAT(WarningsOf(LogOfTurn(rate_deg, wrap_deg)), HasSubstr(kDoubt)) << rate_deg;
    }
  }
  EXPECT_THAT(WarningsOf(LogOfTurn(3.0, 360.0)), HasSubstr(":4: the heading is 9, and"));
  // Radians, wrapped at a turn, later than a turn, or not at all.
  for (const double wrap_rad : {2 * kPi, 2 * kPi + 0.1, 1e6}) {
    for (const double rate_rad : {0.05, 0.2, 0.4}) {
      EXPECT_THAT(WarningsOf(LogOfTurn(rate_rad, wrap_rad)), testing::Not(HasSubstr(kDoubt)))
          << rate_rad;
    }
  }
}

TEST(CarmenCheck, AFlaserThatIsNoHalfCircleIsSaidAndSettled) {
  const auto log = [](int n) {
    std::string line = "FLASER " + std::to_string(n);
    for (int i = 0; i < n; ++i) line += " " + std::to_string(1.0 + 0.002 * i);
    return line + " 0 0 0 0 0 0 1 h 1\n";
  };
  EXPECT_THAT(
      WarningsOf(log(1081)),
      HasSubstr(":1: FLASER with 1081 readings states no angles and is taken as 180 degrees "
                "wide (1 such line): --set sequence.laser.fov_deg"));
  for (const int n : {180, 181, 360, 361}) EXPECT_EQ(WarningsOf(log(n)), "") << n;
  const TextFile file(log(1081));
  CarmenLogOptions options;
  options.fov_deg = 270.0;
  const auto source = OpenCarmenLog(file.path(), options);
  EXPECT_THAT(source->Warnings(), testing::IsEmpty());
  const auto frame = source->Next();
  EXPECT_NEAR(frame->scan->beams.front().bearing_rad, RadFromDeg(-135.0), 1e-6);
  EXPECT_NEAR(frame->scan->beams[1].bearing_rad, RadFromDeg(-134.75), 1e-6);
  EXPECT_NEAR(frame->scan->beams.back().bearing_rad, RadFromDeg(135.0), 1e-6);
  // A line that states its angles keeps them.
  CarmenScan stated;
  stated.first_bearing_rad = -0.5;
  stated.bearing_step_rad = 0.5;
  stated.range_m = {1.0, 2.0};
  EXPECT_EQ(ScanOf(stated, options).beams[0].bearing_rad, -0.5F);
}

TEST(CarmenCheck, AHeaderThatContradictsItselfIsSaidOnce) {
  const auto log = [](double fov_rad, double resolution_rad) {
    std::ostringstream lines;
    for (int scan = 0; scan < 2; ++scan) {
      lines << "ROBOTLASER1 0 -1.57 " << fov_rad << " " << resolution_rad << " 80 0.01 0 181";
      for (int i = 0; i < 181; ++i) lines << " " << 1.0 + 0.002 * i;
      lines << " 0 0 0 0 0 0 0 0 0 0 0 0 " << scan << " h 1\n";
    }
    return lines.str();
  };
  EXPECT_EQ(WarningsOf(log(3.1416, 0.0349)).substr(WarningsOf(log(3.1416, 0.0349)).find(":1: ")),
            ":1: ROBOTLASER1 states a field of view of 3.142 rad and 181 readings 0.0349 rad "
            "apart, which span 6.282 rad; the resolution is taken (2 such lines): one of the two "
            "is wrong\n");
  for (const double fov_rad : {6.2832, 0.0, 1.5, -3.1416}) {
    EXPECT_THAT(WarningsOf(log(fov_rad, 0.0174533)), HasSubstr("the resolution is taken"))
        << fov_rad;
  }
  // From the first to the last reading or a step more, in few decimals, or by the field alone.
  EXPECT_EQ(WarningsOf(log(3.1416, 0.0174533)), "");
  EXPECT_EQ(WarningsOf(log(181 * 0.0174533, 0.0174533)), "");
  EXPECT_EQ(WarningsOf(log(3.1416, 0.017)), "");
  EXPECT_EQ(WarningsOf(log(3.1416, 0.0)), "");
}

}  // namespace
}  // namespace depthgrid
