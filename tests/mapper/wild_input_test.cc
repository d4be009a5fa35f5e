// What a live system may bring and nobody means: the map stays what it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "mapper/core/level.h"
#include "mapper/frame_history.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kFrames = 120;
constexpr int kWild = 60;
constexpr PlanarLaser kWildLaser{
    .beams = 180, .field_of_view_rad = RadFromDeg(90), .sigma_of_range = 0.01};

Pose2 WildTruthAt(int i) {
  const double turn_rad = 2.0 * kPi * i / kFrames;
  return {3.0 + 0.8 * std::cos(turn_rad), 1.5 + 0.8 * std::sin(turn_rad),
          WrapAngle(turn_rad + 0.5 * kPi)};
}

// At the true pose with a scan made for this frame alone.
Frame WildFrameAt(int i) {
  Frame frame;
  frame.index = i;
  frame.stamp_s = i / 30.0;
  frame.slam_from_camera = CameraOf(WildTruthAt(i), 0.0);
  frame.scan = std::make_shared<Scan>(
      ScanOf(FurnishedRoom(), WildTruthAt(i), kWildLaser, 1, static_cast<std::uint32_t>(i)));
  return frame;
}

Scan& ScanOfFrame(Frame& frame) {
  const auto scan = std::make_shared<Scan>(*frame.scan);
  frame.scan = scan;
  return *scan;
}

struct WildRun {
  double worst_online_m = 0.0;  // of the frames that were not spoilt
  double worst_m = 0.0;
  MapperResult result;
};

WildRun RunWith(const std::function<void(Frame&)>& spoil) {
  IncrementalMapper mapper({}, std::nullopt);
  WildRun run;
  const auto error_m = [](const Pose3& pose, int i) {
    return Between(WildTruthAt(i), BaseOf(pose)).translation().norm();
  };
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = WildFrameAt(i);
    spoil(frame);
    const FrameReport report = mapper.AddFrame(frame);
    if (i == kWild) continue;
    run.worst_online_m = std::max(run.worst_online_m, error_m(*report.map_from_camera, i));
  }
  run.result = mapper.Finish();
  for (int i = 0; i < kFrames; ++i) {
    if (i == kWild) continue;
    run.worst_m =
        std::max(run.worst_m, error_m(*run.result.map_from_camera[static_cast<std::size_t>(i)], i));
  }
  return run;
}

TEST(FrameHistory, AStepThatNothingDrivesBeginsAnEpochAndSoDoesTheWayBack) {
  FrameHistory history;
  std::vector<int> epochs;
  for (int i = 0; i < 6; ++i) {
    Frame frame = WildFrameAt(i);
    if (i == 2) frame.slam_from_camera->translation.x() = 1e6;
    if (i == 4) frame.slam_from_camera.reset();
    if (i == 5) frame.slam_epoch = 7;
    history.Start(frame);
    epochs.push_back(history.newest().epoch);
  }
  EXPECT_EQ(epochs, (std::vector<int>{0, 0, 1, 2, 2, 3}));
}

TEST(WildInput, OnePoseFarAwayMovesNoOther) {
  for (const double off_m : {15.0, 1e4, 5e6}) {
    const WildRun run = RunWith([&](Frame& frame) {
      if (frame.index == kWild) frame.slam_from_camera->translation.x() += off_m;
    });
    EXPECT_LT(run.worst_online_m, 0.03) << off_m;
    EXPECT_LT(run.worst_m, 0.01) << off_m;
    EXPECT_LT(run.result.map.geometry.width_cells, 400) << off_m;
  }
}

TEST(WildInput, RangesOfZeroAreNoWalls) {
  const WildRun expected = RunWith([](Frame& frame) {
    std::erase_if(ScanOfFrame(frame).beams, [](const Beam& b) { return b.bearing_rad > 0.5F; });
  });
  const WildRun run = RunWith([](Frame& frame) {
    for (Beam& beam : ScanOfFrame(frame).beams) {
      if (beam.bearing_rad > 0.5F) beam = {beam.bearing_rad, 0.0F, 0.0F, 0.0F, true};
    }
  });
  EXPECT_EQ(run.result.map_from_camera, expected.result.map_from_camera);
  EXPECT_EQ(StatesOf(run.result.map).states, StatesOf(expected.result.map).states);
}

TEST(WildInput, TheOrderOfBeamsSaysNothing) {
  const WildRun expected = RunWith([](Frame&) {});
  const WildRun run = RunWith([](Frame& frame) {
    std::vector<Beam>& beams = ScanOfFrame(frame).beams;
    std::reverse(beams.begin(), beams.end());
    std::rotate(beams.begin(), beams.begin() + 40, beams.end());
  });
  EXPECT_EQ(run.result.map_from_camera, expected.result.map_from_camera);
}

TEST(WildInput, AScanMayBeFilledAgain) {
  const WildRun expected = RunWith([](Frame&) {});
  const auto buffer = std::make_shared<Scan>();
  const WildRun run = RunWith([&](Frame& frame) {
    *buffer = *frame.scan;
    frame.scan = buffer;
  });
  EXPECT_EQ(run.result.map_from_camera, expected.result.map_from_camera);
  EXPECT_EQ(StatesOf(run.result.map).states, StatesOf(expected.result.map).states);
}

TEST(WildInput, OneBeamThatHitsFarAwayDoesNotGrowTheMap) {
  const WildRun run = RunWith([](Frame& frame) {
    if (frame.index == kWild) ScanOfFrame(frame).beams[20].range_m = 1e5F;
  });
  EXPECT_LT(run.result.map.geometry.width_cells, 400);
}

}  // namespace
}  // namespace depthgrid
