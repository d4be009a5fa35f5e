#include "mapper/place_watch.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

FrameReport Explained(double share) {
  FrameReport report;
  report.map_from_camera = CameraOf({}, 1.0);
  report.beams = 600;
  report.match.found = true;
  report.match.score = share;
  return report;
}

TEST(IsOffMap, OfAFrameThatSaysSomething) {
  EXPECT_EQ(IsOffMap(Explained(0.6)), false);
  EXPECT_EQ(IsOffMap(Explained(0.1)), true);
  FrameReport report = Explained(0.6);
  report.match.found = false;
  EXPECT_EQ(IsOffMap(report), true);
  report = Explained(0.6);  // by what it drew itself, at a guess
  report.guessed = true;
  EXPECT_EQ(IsOffMap(report), true);
  report.beams = 0;
  EXPECT_EQ(IsOffMap(report), std::nullopt);
  report = Explained(0.6);
  report.map_from_camera.reset();
  EXPECT_EQ(IsOffMap(report), std::nullopt);
}

TEST(PlaceWatch, TellsALossAndItsEnd) {
  PlaceWatch watch;
  EXPECT_FALSE(watch.lost());
  for (int i = 0; i < 29; ++i) watch.Add(Explained(0.0));
  EXPECT_FALSE(watch.lost());  // too few to tell
  watch.Add(Explained(0.0));
  EXPECT_TRUE(watch.lost());
  for (int i = 0; i < 3; ++i) watch.Add(Explained(0.8));
  EXPECT_TRUE(watch.lost());  // by chance
  watch.Add(Explained(0.8));
  EXPECT_FALSE(watch.lost());
  EXPECT_NEAR(watch.off_map(), 26.0 / 30.0, 1e-12);
}

TEST(PlaceWatch, AFewFramesAreNoLoss) {
  PlaceWatch watch;
  for (int i = 0; i < 100; ++i) {
    watch.Add(Explained(i % 50 < 20 ? 0.0 : 0.7));
    EXPECT_FALSE(watch.lost()) << i;
  }
  for (int i = 0; i < 60; ++i) {  // nothing is seen: nothing is said
    FrameReport blind = Explained(0.0);
    blind.beams = 0;
    watch.Add(blind);
  }
  EXPECT_FALSE(watch.lost());
}

}  // namespace
}  // namespace depthgrid
