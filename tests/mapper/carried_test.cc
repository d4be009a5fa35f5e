// A camera that is carried elsewhere, which no pose tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/mapper/localised_run.h"

namespace depthgrid {
namespace {

int CarriedFrames(const std::vector<FrameReport>& reports) {
  return static_cast<int>(std::count_if(reports.begin(), reports.end(),
                                        [](const FrameReport& report) { return report.carried; }));
}

// What the poses after a jump of the camera from frame `from` of the tour to `to` are off by.
Pose2 CarriedOff(int from, int to) { return TourAt(from) * Inverse(TourAt(to)); }

TEST(Carried, InAFinishedMapThePlaceIsFoundAgain) {
  LocalisedRun run;
  run.Drive(0, 100, {}, 0, FurnishedRoom());
  run.Drive(200, 200, CarriedOff(100, 200), 0, FurnishedRoom());
  EXPECT_TRUE(run.reports[100].carried);
  EXPECT_TRUE(run.reports[100].guessed);
  EXPECT_EQ(CarriedFrames(run.reports), 1);
  EXPECT_EQ(run.Relocations(), 1);
  EXPECT_FALSE(run.reports.back().guessed);
  const MapperResult result = run.mapper.Finish();
  EXPECT_LT(run.WorstErrorM(result, 100), 0.03);
  EXPECT_EQ(result.mapped.size(), std::size_t{kTourFrames});
}

TEST(Carried, AWrongStartInAFinishedMapIsFoundOut) {
  const Pose2 wrong{0.3, 0.9, 0.5};
  LocalisedRun run(wrong);
  run.Drive(0, 240, {}, 0, FurnishedRoom());
  EXPECT_EQ(CarriedFrames(run.reports), 1);
  EXPECT_FALSE(run.reports.back().guessed);
  const MapperResult result = run.mapper.Finish();
  // The frames before it was found out stay as they were reported.
  const auto found_out = std::find_if(run.reports.begin(), run.reports.end(),
                                      [](const FrameReport& report) { return report.carried; });
  const auto first = static_cast<std::size_t>(found_out - run.reports.begin());
  EXPECT_LE(first, 60U);
  EXPECT_LT(run.WorstErrorM(result, first), 0.03);
}

// What lies beyond the map contradicts nothing.
TEST(Carried, WhoLeavesAFinishedMapIsNot) {
  LocalisedRun run({}, 80);
  run.Drive(40, 160, {}, 0, FurnishedRoom());
  EXPECT_TRUE(run.watch.lost());
  run.Drive(200, 120, {}, 0, FurnishedRoom());
  EXPECT_FALSE(run.watch.lost());
  EXPECT_EQ(CarriedFrames(run.reports), 0);
  EXPECT_LT(run.WorstErrorM(run.mapper.Finish(), 0), 0.03);
}

struct TourOf {
  std::vector<FrameReport> reports;
  MapperResult result;
};

// A map made on the tour: the camera jumps from frame 240 on, once round.
TourOf MappedTour(const Pose2& slam_off, int camera_ahead, double person_m) {
  IncrementalMapper mapper({}, std::nullopt);
  TourOf tour;
  for (int i = 0; i < 480; ++i) {
    const bool after = i >= kTourFrames;
    const Pose2 truth = TourAt(after ? i + camera_ahead : i);
    PlanarWorld world = FurnishedRoom();
    if (after && i < kTourFrames + 45 && person_m > 0.0) {
      const Eigen::Vector2d at = truth * Eigen::Vector2d(person_m, 0.0);
      AddRectangle(world, at.x() - 0.2, at.y() - 0.2, at.x() + 0.2, at.y() + 0.2);
    }
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(after ? slam_off * truth : truth, 1.0);
    frame.scan = std::make_shared<const Scan>(
        ScanOf(world, truth, kTourLaser, 4, static_cast<std::uint32_t>(i)));
    tour.reports.push_back(mapper.AddFrame(frame));
  }
  tour.result = mapper.Finish();
  return tour;
}

TEST(Carried, WhileMappingThePlaceIsFoundAgain) {
  const TourOf tour = MappedTour(CarriedOff(240, 340), 100, 0.0);
  EXPECT_TRUE(tour.reports[kTourFrames].carried);
  EXPECT_EQ(CarriedFrames(tour.reports), 1);
  EXPECT_FALSE(tour.reports.back().guessed);
  for (int i = kTourFrames; i < 480; ++i) {
    const Pose2 off =
        Between(TourAt(i + 100), BaseOf(*tour.result.map_from_camera[static_cast<std::size_t>(i)]));
    EXPECT_LT(off.translation().norm(), 0.03) << i;
  }
}

// Somebody steps before the camera: what is seen of the room goes on agreeing.
TEST(Carried, NotBySomebodyWhoStepsBeforeTheCamera) {
  const TourOf tour = MappedTour({}, 0, 0.8);
  EXPECT_EQ(CarriedFrames(tour.reports), 0);
}

// Most of what was in view is gone, but nothing is nearer.
TEST(Carried, NotWhereADoorIsOpened) {
  PlanarWorld open = RectangleWorld(0.0, 0.0, 4.0, 3.0);
  open.erase(open.begin() + 1);  // its wall at x = 4, but for a door of 1.4 m
  open.push_back({{4.0, 0.0}, {4.0, 0.8}});
  open.push_back({{4.0, 2.2}, {4.0, 3.0}});
  const PlanarWorld beyond = RectangleWorld(4.0, -1.0, 8.0, 4.0);
  open.insert(open.end(), beyond.begin(), beyond.begin() + 3);
  PlanarWorld shut = open;
  shut.push_back({{4.0, 0.8}, {4.0, 2.2}});
  IncrementalMapper mapper({}, std::nullopt);
  std::vector<FrameReport> reports;
  for (int i = 0; i < 200; ++i) {
    const Pose2 truth{1.5 + 0.01 * i, 1.5, 0.0};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(truth, 1.0);
    frame.scan = std::make_shared<const Scan>(
        ScanOf(i < 120 ? shut : open, truth, kTourLaser, 4, static_cast<std::uint32_t>(i)));
    reports.push_back(mapper.AddFrame(frame));
  }
  EXPECT_LT(ShareExplained(reports[120]), 0.5 * ShareExplained(reports[119]));
  EXPECT_EQ(CarriedFrames(reports), 0);
  for (const FrameReport& report : reports) EXPECT_FALSE(report.guessed) << report.index;
}

}  // namespace
}  // namespace depthgrid
