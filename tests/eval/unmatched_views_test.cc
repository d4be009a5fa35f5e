#include "eval/run/unmatched_views.h"

#include <gtest/gtest.h>

#include "mapper/core/angle.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

const PinholeCamera kViewCamera{80, 60, 60.2, 60.0, 39.5, 29.5, {}};
constexpr double kViewHeightM = 1.2;

// Looking down by this much, 4 m from the wall ahead.
Pose3 ViewFrom(double down_deg) {
  return TiltedCamera({-1.0, 0.0, 0.0}, kViewHeightM, RadFromDeg(down_deg), 0.0);
}

ShownView ShownFrom(double down_deg, const ScanOptions& options = {}, float reach_m = 100.0F) {
  const AnalyticRoom room;
  DepthImage image = room.Render(kViewCamera, ViewFrom(down_deg));
  for (float& z_m : image.z_m) z_m = z_m > reach_m ? kInvalidDepth : z_m;
  return ShownIn(image, kViewCamera, StandOf(ViewFrom(down_deg), 0.0), options);
}

TEST(ShownView, IsNamedByWhatIsMissing) {
  EXPECT_EQ(ShownFrom(0.0), ShownView::kOther);
  EXPECT_EQ(ShownFrom(80.0), ShownView::kFloor);
  EXPECT_EQ(ShownFrom(-80.0), ShownView::kCeiling);
  EXPECT_EQ(ShownFrom(0.0, {}, 0.1F), ShownView::kNoDepth);
  EXPECT_EQ(ShownFrom(10.0, {}, 3.0F), ShownView::kNoDepthAhead);
  ScanOptions near;
  near.max_range_m = 2.0;
  EXPECT_EQ(ShownFrom(0.0, near), ShownView::kBeyondRange);
  EXPECT_EQ(ShownFrom(80.0, near), ShownView::kFloor);  // nothing of the camera's height in view
  ScanOptions far;
  far.min_range_m = 5.5;
  EXPECT_EQ(ShownFrom(0.0, far), ShownView::kBelowRange);
  ScanOptions thin;  // a band that lies between what the image shows
  thin.band_low_m = 1.15;
  thin.band_high_m = 1.19;
  EXPECT_EQ(ShownFrom(0.0, thin), ShownView::kFloorAndCeiling);
}

TEST(UnmatchedViews, CountsFramesThatShowTooLittleFromTheFirstMappedOneOn) {
  const AnalyticRoom room;
  const ScanOptions options;
  const DepthImage down = room.Render(kViewCamera, ViewFrom(80.0));
  UnmatchedViews views;
  const auto add = [&](int index, bool inserted, bool matched, int beams) {
    FrameReport report;
    report.index = index;
    report.slam_from_camera = ViewFrom(80.0);
    report.stand = StandOf(ViewFrom(80.0), 0.0);
    report.inserted = inserted;
    report.match.found = matched;
    report.beams = beams;
    views.Add(report, down, kViewCamera, options);
  };
  add(3, false, false, 0);  // nothing to match against yet
  add(4, true, false, 600);
  add(5, true, true, 600);
  add(6, true, false, 600);  // saw enough
  add(7, true, false, 100);
  add(8, false, false, 0);
  EXPECT_EQ(views.frames(), 2);
  EXPECT_EQ(views.Count(ShownView::kFloor), 2);
  EXPECT_EQ(views.First(ShownView::kFloor), 7);
  EXPECT_EQ(views.Count(ShownView::kCeiling), 0);
}

}  // namespace
}  // namespace depthgrid
