// SLAM that was perfect for long and then drifts: all that was learnt of it is wrong from there on.
// And SLAM that does not drift, but jitters.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kPerfect = 600;
constexpr int kOnsetFrames = 1000;
constexpr PlanarLaser kOnsetLaser{.beams = 320, .sigma_of_range = 0.01};

// Round and round in a furnished room.
struct OnsetDrive {
  double room_scale = 1.0;
  double creep_m = 0.0;  // a frame, along the way, once SLAM is no longer perfect
  std::uint64_t seed = 0;

  Pose2 TruthAt(int i) const {
    const double turn_rad = 2.0 * kPi * i / 240;
    return {room_scale * (3.0 + 0.8 * std::cos(turn_rad)),
            room_scale * (1.5 + 0.8 * std::sin(turn_rad)), WrapAngle(turn_rad + 0.5 * kPi)};
  }
};

struct OnsetErrors {
  std::vector<double> online_m;
  double mean_m = 0.0;  // at the end
};

OnsetErrors ErrorsOf(const OnsetDrive& drive, const MapperOptions& options = {}) {
  PlanarWorld room = FurnishedRoom();
  for (Wall& wall : room) wall = {drive.room_scale * wall.from, drive.room_scale * wall.to};
  const auto error_m = [&](const Pose3& pose, int i) {
    return Between(drive.TruthAt(i), BaseOf(pose)).translation().norm();
  };
  IncrementalMapper mapper(options, std::nullopt);
  OnsetErrors errors;
  Pose2 slam = drive.TruthAt(0);
  for (int i = 0; i < kOnsetFrames; ++i) {
    const Pose2 truth = drive.TruthAt(i);
    if (i > 0) slam = slam * Between(drive.TruthAt(i - 1), truth);
    if (i >= kPerfect) slam = slam * Pose2{drive.creep_m, 0.0, 0.0};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(slam, 0.0);
    frame.scan = std::make_shared<Scan>(
        ScanOf(room, truth, kOnsetLaser, drive.seed, static_cast<std::uint32_t>(i)));
    errors.online_m.push_back(error_m(*mapper.AddFrame(frame).map_from_camera, i));
  }
  const MapperResult result = mapper.Finish();
  for (int i = 0; i < kOnsetFrames; ++i) {
    errors.mean_m +=
        error_m(*result.map_from_camera[static_cast<std::size_t>(i)], i) / kOnsetFrames;
  }
  return errors;
}

// Believed as before it would be 16 cm off.
TEST(DriftOnset, IsNoticedWithinAFewSeconds) {
  for (const std::uint64_t seed : {1, 2}) {
    const OnsetErrors errors = ErrorsOf({.room_scale = 1.5, .creep_m = 0.003, .seed = seed});
    const double worst_after_m =
        *std::max_element(errors.online_m.begin() + kPerfect + 100, errors.online_m.end());
    EXPECT_LT(worst_after_m, 0.05) << seed;
  }
}

// By a third of a metre a second, which nothing online sees soon enough: at the end most of SLAM's
// motions are right, and those that are not lie together.
TEST(DriftOnset, IsUndoneAtTheEnd) {
  const OnsetDrive drive{.room_scale = 1.0, .creep_m = 0.01, .seed = 1};
  EXPECT_LT(ErrorsOf(drive).mean_m, 0.02);
  MapperOptions believing;
  believing.surfel.joint.judge_stretches = false;
  EXPECT_GT(ErrorsOf(drive, believing).mean_m, 0.1);
}

// The innovations of a jittering SLAM are larger than corrections that move what was seen just
// before. Moved by each, groups wandered by centimetres, and standing frames with them.
TEST(Jitter, MovesNothingThatWasSeen) {
  constexpr PlanarLaser kAround{
      .beams = 180, .field_of_view_rad = RadFromDeg(359), .sigma_of_range = 0.005};
  constexpr int kStands = 120;
  constexpr int kGoesOn = 420;
  const OnsetDrive drive;
  RandomStream jitter(3, RandomStage::kTest, 0);
  IncrementalMapper mapper({}, std::nullopt);
  std::vector<Pose2> truths;
  for (int i = 0; i < kGoesOn + kStands; ++i) {
    truths.push_back(drive.TruthAt(i < kGoesOn ? std::min(i, kStands) : i - kGoesOn + kStands));
    const Pose2 error{0.01 * jitter.Normal(), 0.01 * jitter.Normal(), 0.005 * jitter.Normal()};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(i == 0 ? truths[0] : truths.back() * error, 0.0);
    frame.scan = std::make_shared<Scan>(
        ScanOf(FurnishedRoom(), truths.back(), kAround, 1, static_cast<std::uint32_t>(i)));
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  double worst_m = 0.0;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    worst_m = std::max(worst_m,
                       Between(truths[i], BaseOf(*result.map_from_camera[i])).translation().norm());
  }
  EXPECT_LT(worst_m, 0.015);
}

}  // namespace
}  // namespace depthgrid
