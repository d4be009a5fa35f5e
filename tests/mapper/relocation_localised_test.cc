// SLAM that is lost in a finished map in which the camera is only localised.
#include <gtest/gtest.h>

#include <vector>

#include "tests/mapper/localised_run.h"

namespace depthgrid {
namespace {

const Pose2 kTourRestart{1.6, -0.7, 0.9};

TEST(LocalisedRelocation, FindsTheCameraAndLeavesTheMapAsItWas) {
  LocalisedRun run;
  run.Drive(0, 100, {}, 0, FurnishedRoom());
  run.Lose(90);
  const std::size_t back = run.reports.size();
  run.Drive(190, 20, kTourRestart, 1, FurnishedRoom());
  EXPECT_TRUE(run.reports.back().guessed);
  EXPECT_EQ(run.mapper.CurrentMapped().size(), std::size_t{kTourFrames});
  run.Drive(210, 180, kTourRestart, 1, FurnishedRoom());
  EXPECT_FALSE(run.reports.back().guessed);
  EXPECT_EQ(run.Relocations(), 1);
  EXPECT_FALSE(run.watch.lost());
  const MapperResult result = run.mapper.Finish();
  EXPECT_LT(run.WorstErrorM(result, back), 0.03);  // also before it was found
  EXPECT_TRUE(result.guessed.empty());
  const std::vector<MappedFrame> prior = TourMap().frames;
  ASSERT_EQ(result.mapped.size(), prior.size());
  for (std::size_t i = 0; i < prior.size(); ++i) {
    EXPECT_EQ(result.mapped[i].map_from_base.vector(), prior[i].map_from_base.vector());
  }
  for (const FrameReport& report : run.reports) {
    EXPECT_FALSE(report.map_corrected || report.inserted || report.well_seen);
  }
}

// A guess in another room is told, and does not hide another loss.
TEST(LocalisedRelocation, AGuessStaysOneUntilItIsFoundAfterAnotherLoss) {
  LocalisedRun run;
  PlanarWorld other = RectangleWorld(0.0, 0.0, 5.2, 4.1);
  AddRectangle(other, 1.0, 3.0, 2.2, 3.5);
  run.Drive(0, 100, {}, 0, FurnishedRoom());
  run.Lose(90);
  const int first = static_cast<int>(run.reports.size());
  run.Drive(0, 480, kTourRestart, 1, other);
  EXPECT_TRUE(run.reports.back().guessed);
  EXPECT_TRUE(run.watch.lost());
  const int last = run.reports.back().index;
  run.Lose(90);
  const std::size_t back = run.reports.size();
  run.Drive(40, 300, {-0.4, 1.1, -2.0}, 2, FurnishedRoom());
  EXPECT_FALSE(run.reports.back().guessed);
  const MapperResult result = run.mapper.Finish();
  EXPECT_LT(run.WorstErrorM(result, back), 0.03);
  ASSERT_EQ(result.guessed.size(), 1U);
  EXPECT_EQ(result.guessed[0].first, first);
  EXPECT_EQ(result.guessed[0].last, last);
  EXPECT_EQ(result.mapped.size(), std::size_t{kTourFrames});
}

TEST(LocalisedRelocation, AGoodGuessIsNone) {
  LocalisedRun run;
  run.Drive(0, 100, {}, 0, FurnishedRoom());
  run.Lose(90);
  run.Drive(190, 100, {0.02, 0.01, 0.01}, 1, FurnishedRoom());
  for (const FrameReport& report : run.reports) EXPECT_FALSE(report.guessed);
  EXPECT_EQ(run.Relocations(), 0);
}

}  // namespace
}  // namespace depthgrid
