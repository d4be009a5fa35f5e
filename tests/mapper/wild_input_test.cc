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

WildRun RunWith(const std::function<void(Frame&)>& spoil, const MapperOptions& options = {}) {
  IncrementalMapper mapper(options, std::nullopt);
  WildRun run;
  const auto error_m = [](const Pose3& pose, int i) {
    return Between(WildTruthAt(i), BaseOf(pose)).translation().norm();
  };
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = WildFrameAt(i);
    spoil(frame);
    const FrameReport report = mapper.AddFrame(frame);
    if (i == kWild) continue;
    EXPECT_TRUE(IsOnAMap(BaseOf(*report.map_from_camera))) << i;
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

// Epochs of a camera on a straight way, at 30 Hz; `x_m(i)` is where SLAM has it.
std::vector<int> EpochsOnAWay(int frames, const std::function<double(int)>& x_m,
                              const std::function<double(int)>& stamp_s) {
  FrameHistory history;
  std::vector<int> epochs;
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = stamp_s(i);
    frame.slam_from_camera = CameraOf({x_m(i), 0.0, 0.0}, 0.0);
    history.Start(frame);
    epochs.push_back(history.newest().epoch);
  }
  return epochs;
}

TEST(FrameHistory, ACorrectionThatSlamDoesNotTellBeginsOneEpoch) {
  const auto at_30_hz = [](int i) { return i / 30.0; };
  for (const double jump_m : {0.2, -0.6, 3.0}) {
    const auto corrected = [&](int i) { return 0.02 * i + (i < 20 ? 0.0 : jump_m); };
    const std::vector<int> epochs = EpochsOnAWay(40, corrected, at_30_hz);
    EXPECT_EQ(epochs[19], 0) << jump_m;
    EXPECT_EQ(epochs[20], 1) << jump_m;
    EXPECT_EQ(epochs.back(), 1) << jump_m;
  }
}

TEST(FrameHistory, WhatAHandOrRobotDoesIsMotion) {
  const auto at_30_hz = [](int i) { return i / 30.0; };
  const auto starts_to_run = [](int i) { return std::max(0, i - 20) * 3.0 / 30.0; };
  EXPECT_EQ(EpochsOnAWay(60, starts_to_run, at_30_hz).back(), 0);
  const auto shaken = [](int i) { return 0.05 * (i % 2); };
  EXPECT_EQ(EpochsOnAWay(60, shaken, at_30_hz).back(), 0);
  // Lost for two seconds on the way.
  const auto goes_on = [](int i) { return 0.5 * (i / 30.0 + (i < 20 ? 0.0 : 2.0)); };
  const auto with_gap = [](int i) { return i / 30.0 + (i < 20 ? 0.0 : 2.0); };
  EXPECT_EQ(EpochsOnAWay(60, goes_on, with_gap).back(), 0);
  // At 2 m/s and 10 Hz, stamps in bunches.
  const auto fast = [](int i) { return 0.2 * i; };
  const auto bunched = [](int i) { return 0.1 * i + (i % 3 == 1 ? -0.09 : 0.0); };
  EXPECT_EQ(EpochsOnAWay(60, fast, bunched).back(), 0);
  // Faster than any hand from one frame to the next: taken for a correction, but only once.
  const auto thrown = [](int i) { return std::max(0, i - 20) * 6.0 / 30.0; };
  EXPECT_EQ(EpochsOnAWay(60, thrown, at_30_hz).back(), 1);
}

// A driver or a SLAM that was started again while the camera stood counts from its origin.
TEST(FrameHistory, APoseAtTheOriginAfterAPauseBeginsAnEpoch) {
  for (const double pause_s : {2.0, 60.0}) {
    const auto stamp_s = [&](int i) { return i / 30.0 + (i < 60 ? 0.0 : pause_s); };
    for (const double origin_m : {0.0, 4.0}) {  // where it counts from is where it began, or 0
      const auto anew = [&](int i) { return i < 60 ? origin_m + 0.02 * i : 0.02 * (i - 60); };
      const auto as_at_first = [&](int i) { return origin_m + 0.02 * (i < 60 ? i : i - 60); };
      EXPECT_EQ(EpochsOnAWay(80, anew, stamp_s).back(), 1) << pause_s << " " << origin_m;
      EXPECT_EQ(EpochsOnAWay(80, as_at_first, stamp_s).back(), 1) << pause_s << " " << origin_m;
    }
    const auto goes_on = [&](int i) { return 4.0 + 0.02 * i + (i < 60 ? 0.0 : 1.5); };
    EXPECT_EQ(EpochsOnAWay(80, goes_on, stamp_s).back(), 0) << pause_s;
    const auto never_left = [&](int i) { return 0.002 * (i < 60 ? i : i - 60); };
    EXPECT_EQ(EpochsOnAWay(80, never_left, stamp_s).back(), 0) << pause_s;
  }
}

// SLAM is wrong for a few frames and comes back.
TEST(FrameHistory, AGlitchOfSlamBeginsAnEpochAndSoDoesTheWayBack) {
  for (const double rate_hz : {30.0, 10.0}) {
    const auto stamp_s = [&](int i) { return i / rate_hz; };
    for (const int frames : {1, 2, 3, 5, 8}) {
      for (const double jump_m : {0.25, 3.0}) {
        const auto off = [&](int i) {
          return 0.02 * i + (i >= 20 && i < 20 + frames ? jump_m : 0.0);
        };
        const std::vector<int> epochs = EpochsOnAWay(60, off, stamp_s);
        EXPECT_EQ(epochs[19], 0);
        EXPECT_EQ(epochs[20], 1);
        EXPECT_EQ(epochs.back(), 2) << frames << " frames off by " << jump_m << " m";
      }
    }
  }
}

// Few frames after the start, or after a loss, the usual motion is not known yet.
TEST(FrameHistory, LargeCorrectionsAreSeenFromTheStart) {
  for (const double lost_s : {0.0, 1.0, 3.0}) {
    const auto stamp_s = [&](int i) { return i / 30.0 + (i < 20 ? 0.0 : lost_s); };
    for (const int frame : {1, 2, 3, 6, 21, 22, 25}) {
      const auto corrected = [&](int i) { return 0.03 * i + (i < frame ? 0.0 : -0.5); };
      const std::vector<int> epochs = EpochsOnAWay(60, corrected, stamp_s);
      EXPECT_EQ(epochs[static_cast<std::size_t>(frame) - 1], 0);
      EXPECT_EQ(epochs[static_cast<std::size_t>(frame)], 1) << frame;
      EXPECT_EQ(epochs.back(), 1) << frame;
    }
  }
  // A robot may set off at once, and is seen first on its way.
  const auto at_10_hz = [](int i) { return i / 10.0; };
  EXPECT_EQ(EpochsOnAWay(
                60, [](int i) { return 0.4 * i; }, at_10_hz)
                .back(),
            0);
}

// Or where a frame did not come in time, or few come.
TEST(FrameHistory, OverALongStepOnlyLargeCorrectionsAreSeen) {
  const auto corrected_by = [](double jump_m, double rate_hz) {
    const auto way = [=](int i) { return 0.6 * i / rate_hz + (i < 20 ? 0.0 : jump_m); };
    return EpochsOnAWay(40, way, [=](int i) { return i / rate_hz; }).back();
  };
  EXPECT_EQ(corrected_by(1.0, 4.0), 1);
  EXPECT_EQ(corrected_by(0.6, 4.0), 0);
  EXPECT_EQ(corrected_by(3.0, 2.0), 1);
  const auto late = [](int i) { return i / 30.0 + (i < 20 ? 0.0 : 0.25); };
  EXPECT_EQ(EpochsOnAWay(
                40, [](int i) { return i < 20 ? 0.0 : 1.0; }, late)
                .back(),
            1);
}

TEST(WildInput, ACorrectionThatSlamDoesNotTellBendsNothing) {
  const auto correct = [](const Pose2& old_from_new, int epoch) {
    return RunWith([=](Frame& frame) {
      if (frame.index < kWild) return;
      frame.slam_from_camera = ApplyPlanar(old_from_new, *frame.slam_from_camera);
      frame.slam_epoch = epoch;
    });
  };
  for (const Pose2& moved : {Pose2{0.3, -0.2, 0.0}, Pose2{-0.5, 0.4, 0.2}}) {
    const WildRun told = correct(moved, 1), untold = correct(moved, 0);
    EXPECT_LT(untold.worst_online_m, 0.03);
    EXPECT_LT(untold.worst_m, 0.01);
    EXPECT_EQ(untold.worst_online_m, told.worst_online_m);
    EXPECT_EQ(untold.worst_m, told.worst_m);
  }
}

TEST(WildInput, NoStampIsFartherAwayThanADay) {
  for (const FusionMode mode : {FusionMode::kKalman, FusionMode::kFixed, FusionMode::kAdaptive}) {
    MapperOptions options;
    options.fusion.mode = mode;
    const auto run_with = [&](double stamp_s) {
      const auto spoil = [&](Frame& frame) {
        if (frame.index == kWild) frame.stamp_s = stamp_s;
      };
      return RunWith(spoil, options);
    };
    const WildRun days = run_with(1e6), ever = run_with(1e300);
    EXPECT_EQ(ever.worst_online_m, days.worst_online_m);
    EXPECT_EQ(ever.worst_m, days.worst_m);
    EXPECT_LT(ever.worst_m, 0.02);
  }
}

TEST(WildInput, OnePoseFarAwayMovesNoOther) {
  for (const double off_m : {0.3, 3.0, 15.0, 1e4, 5e6}) {
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

// Twelve beams straight ahead tell where something is and nothing of how it lies.
TEST(WildInput, BeamsOfOneBearingMoveNothing) {
  const WildRun run = RunWith([](Frame& frame) {
    if (frame.index != kWild && frame.index != kWild - 1) return;
    Scan& scan = ScanOfFrame(frame);
    Beam ahead = scan.beams[scan.beams.size() / 2];
    ahead.bearing_rad = 0.0F;
    scan.beams.assign(12, ahead);
  });
  EXPECT_LT(run.worst_online_m, 0.03);
  for (int i = 0; i < kFrames; ++i) {
    const Pose3& pose = *run.result.map_from_camera[static_cast<std::size_t>(i)];
    EXPECT_LT(Between(WildTruthAt(i), BaseOf(pose)).translation().norm(), 0.02) << i;
  }
}

// After a second without a pose SLAM is taken at its word, in one submap with what was before.
TEST(WildInput, APoseFarAwayDoesNotMakeASubmapOfTheWayToIt) {
  MapperOptions options;
  options.method = MapperMethod::kPaper;
  options.fusion.mode = FusionMode::kFixed;
  IncrementalMapper mapper(options, std::nullopt);
  for (int i = 0; i < kWild + 3; ++i) {
    Frame frame = WildFrameAt(i);
    if (i >= kWild) {
      frame.stamp_s += 1.0;
      frame.slam_from_camera->translation += Eigen::Vector3d(1e5, 1e5, 0.0);
      for (Beam& beam : ScanOfFrame(frame).beams) beam.range_m *= 0.5F;  // seen nowhere before
    }
    const FrameReport report = mapper.AddFrame(frame);
    EXPECT_TRUE(report.inserted);
    EXPECT_EQ(report.map_from_camera->translation.norm() > 1e5, i >= kWild);
  }
}

// SLAM corrects itself while nothing is seen, and a loop of earlier frames moves the map.
TEST(WildInput, ALoopWhileNothingIsSeenDoesNotForgetACorrection) {
  const Pose2 moved{1.0, 0.4, 0.3};
  IncrementalMapper mapper({}, std::nullopt);
  double worst_m = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = WildFrameAt(i);
    if (i >= kWild) {
      frame.slam_epoch = 1;
      frame.slam_from_camera = ApplyPlanar(moved, *frame.slam_from_camera);
      frame.scan.reset();
    }
    if (i == kWild + 2) {
      LoopClosure loop;
      loop.first_frame = 5;
      loop.second_frame = 30;
      loop.first_from_second =
          Between(CameraOf(WildTruthAt(5), 0.0), CameraOf(WildTruthAt(30), 0.0));
      frame.loops.push_back(loop);
    }
    const FrameReport report = mapper.AddFrame(frame);
    EXPECT_EQ(report.loops_accepted, i == kWild + 2 ? 1 : 0);
    const Pose2 estimate = BaseOf(*report.map_from_camera);
    worst_m = std::max(worst_m, Between(WildTruthAt(i), estimate).translation().norm());
  }
  EXPECT_LT(worst_m, 0.1);
}

TEST(WildInput, ALoopToAPlaceThatIsSeenEnoughEndsAtAKeptFrame) {
  MapperOptions options;
  options.keep.first_frames = 10;
  options.keep.scans_per_place = 2;
  options.keep.more_each_doubling = 0.0;
  options.keep.min_explained = 0.0;
  IncrementalMapper mapper(options, std::nullopt);
  constexpr int kAtLoop = kFrames + 7;
  bool tied_before = false;
  for (int i = 0; i < kFrames + 20; ++i) {
    Frame frame = WildFrameAt(i % kFrames);
    frame.index = i;
    frame.stamp_s = i / 30.0;
    if (i == kAtLoop) {
      LoopClosure loop;
      loop.first_frame = 5;
      loop.second_frame = i;
      loop.first_from_second =
          Between(CameraOf(WildTruthAt(5), 0.0), CameraOf(WildTruthAt(7), 0.0));
      frame.loops.push_back(loop);
    }
    const FrameReport report = mapper.AddFrame(frame);
    EXPECT_EQ(report.loops_accepted, i == kAtLoop ? 1 : 0);
    if (i == kAtLoop - 1) tied_before = report.well_seen;
  }
  EXPECT_TRUE(tied_before);
  const MapperResult result = mapper.Finish();
  ASSERT_EQ(result.loops.size(), 1U);
  const auto second = static_cast<std::size_t>(result.loops.front().second);
  ASSERT_LT(second, result.mapped.size());
  EXPECT_EQ(result.mapped[second].frame, kAtLoop);
}

}  // namespace
}  // namespace depthgrid
