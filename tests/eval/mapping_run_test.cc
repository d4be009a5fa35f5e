#include "eval/run/mapping_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/output/run_tables.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MappingRun, SaysWherePosesWereMended) {
  std::vector<FrameReport> reports(9);
  for (std::size_t i = 0; i < reports.size(); ++i) reports[i].index = 10 * static_cast<int>(i);
  EXPECT_THAT(MendedPoses(reports), IsEmpty());
  reports[2].slipped = true;
  EXPECT_THAT(MendedPoses(reports),
              ElementsAre("poses: a sudden turn that the scans do not show was taken out at frame "
                          "20"));
  for (FrameReport& report : reports) report.slipped = true;
  reports[4].relocated = true;
  EXPECT_THAT(MendedPoses(reports),
              ElementsAre("poses: a sudden turn that the scans do not show was taken out at frames "
                          "0, 10, 20, 30, 40 and 4 more",
                          "poses: what was seen since they were lost was moved to its place at "
                          "frame 40"));
}

TEST(MappingRun, SaysWhereAGuessWasNeverConfirmed) {
  EXPECT_THAT(
      GuessWarnings({{50, 80}, {90, {}}}),
      ElementsAre(
          "poses: SLAM was lost before frame 50 and again after frame 80; where the map has "
          "what lies between is a guess that nothing seen since confirms",
          "poses: SLAM was lost before frame 90; where the map goes on from there is a "
          "guess that nothing seen since confirms"));
}

TEST(MappingRun, TimesAreThoseOfFramesWithAPose) {
  MappingRun run;
  run.reports.resize(3);
  run.reports[0].slam_from_camera = Pose3{};
  run.reports[0].times.total_us = 500.0;
  run.reports[1].times.total_us = 9.0;  // lost
  run.reports[2].slam_from_camera = Pose3{};
  run.reports[2].times.total_us = 600.0;
  EXPECT_THAT(TimesOfMappedFrames(run), ElementsAre(500.0, 600.0));
}

TEST(MappingRun, TimesOfARunAreToldToAThousandth) {
  MappingRun run;
  run.reports.resize(4);
  for (const double total_us : {81.78199999999742, 100.0, 1000.1234567}) {
    FrameReport& report = run.reports[total_us < 90.0 ? 0 : total_us < 200.0 ? 1 : 2];
    report.slam_from_camera = Pose3{};
    report.times.total_us = total_us;
  }
  run.cpu_s = 0.1234567;
  const std::string text = TimingJson(run, 2.00049, 1.0);
  EXPECT_THAT(text, HasSubstr("{\n"
                              "  \"frames\": 4,\n"
                              "  \"cpu_us_per_frame_mean\": 393.968,\n"
                              "  \"cpu_us_per_frame_median\": 100.0,\n"
                              "  \"cpu_us_per_frame_p95\": "));
  EXPECT_THAT(text, HasSubstr("  \"cpu_us_per_frame_max\": 1000.123,\n"
                              "  \"mapper_cpu_s\": 0.123,\n"
                              "  \"cpu_s_total\": 1.0,\n"
                              "  \"wall_s_total\": 2.0,\n"));
  EXPECT_THAT(TimingJson({}, 0.0, 0.0), HasSubstr("\"cpu_us_per_frame_max\": 0.0"));
}

TEST(MappingRun, StagesOfAFrameAndTheRestAreTheWholeFrame) {
  MappingRun run;
  run.reports.resize(2);
  run.reports[0].times = {1.0, 2.0, 3.0, 4.0, 5.0, 25.5};
  run.reports[1].index = 7;
  run.reports[1].times = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0 - 1e-9};  // of rounding
  EXPECT_EQ(TimingCsv(run),
            "frame,scan_us,match_us,fuse_us,insert_us,loops_us,rest_us,total_us\n"
            "0,1.0,2.0,3.0,4.0,5.0,10.5,25.5\n"
            "7,1.0,0.0,0.0,0.0,0.0,0.0,1.0\n");
}

}  // namespace
}  // namespace depthgrid
