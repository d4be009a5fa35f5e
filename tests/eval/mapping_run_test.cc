#include "eval/mapping_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
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
                          "poses: what was mapped since they were lost was moved to its place at "
                          "frame 40"));
}

}  // namespace
}  // namespace depthgrid
