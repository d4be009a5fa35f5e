// SLAM that is lost in a finished map in which the camera is only localised.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/place_watch.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kTourFrames = 240;
constexpr PlanarLaser kTourLaser{.beams = 320, .sigma_of_range = 0.01};

// Once round a furnished room.
Pose2 TourAt(int i) {
  const double turn_rad = 2.0 * kPi * i / kTourFrames;
  return {3.0 + 0.7 * std::cos(turn_rad), 1.7 + 0.7 * std::sin(turn_rad),
          WrapAngle(turn_rad + 0.5 * kPi)};
}

PriorMap TourMap() {
  PriorMap prior;
  for (int i = 0; i < kTourFrames; ++i) {
    MappedFrame frame = MappedFrameAt(FurnishedRoom(), kTourLaser, TourAt(i), TourAt(i), i);
    frame.frame -= kTourFrames;
    prior.frames.push_back(frame);
  }
  prior.map_from_slam = Pose2{};
  prior.fixed = true;
  return prior;
}

// A localised run, frame by frame.
struct LocalisedRun {
  IncrementalMapper mapper{MapperOptions(), std::nullopt};
  PlaceWatch watch;
  std::vector<FrameReport> reports;
  std::vector<Pose2> truths;

  LocalisedRun() { mapper.StartFrom(TourMap()); }

  // `count` frames at the true poses from `first` on, in SLAM's world moved by `off`.
  void Drive(int first, int count, const Pose2& off, int epoch, const PlanarWorld& world) {
    for (int i = 0; i < count; ++i) {
      truths.push_back(TourAt(first + i));
      Add(CameraOf(off * truths.back(), 1.0), epoch,
          std::make_shared<const Scan>(ScanOf(world, truths.back(), kTourLaser, 4,
                                              static_cast<std::uint32_t>(reports.size()))));
    }
  }
  void Lose(int count) {
    for (int i = 0; i < count; ++i) {
      truths.push_back({});
      Add({}, 0, {});
    }
  }
  void Add(const std::optional<Pose3>& pose, int epoch, std::shared_ptr<const Scan> scan) {
    Frame frame;
    frame.index = static_cast<int>(reports.size());
    frame.stamp_s = frame.index / 30.0;
    frame.slam_epoch = epoch;
    frame.slam_from_camera = pose;
    frame.scan = std::move(scan);
    reports.push_back(mapper.AddFrame(frame));
    watch.Add(reports.back());
  }
  // The largest error of the result from this frame on.
  double WorstErrorM(const MapperResult& result, std::size_t first) const {
    double worst_m = 0.0;
    for (std::size_t i = first; i < truths.size(); ++i) {
      const Pose2 pose = BaseOf(*result.map_from_camera[i]);
      worst_m = std::max(worst_m, (pose.translation() - truths[i].translation()).norm());
    }
    return worst_m;
  }
  int Relocations() const {
    int count = 0;
    for (const FrameReport& report : reports) count += report.relocated ? 1 : 0;
    return count;
  }
};

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
