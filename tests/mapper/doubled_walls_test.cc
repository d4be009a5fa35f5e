// Maps that show a place twice, because poses went wrong in between.
#include "mapper/doubled_walls.h"

#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr PlanarLaser kDoublingLaser{
    .beams = 160, .field_of_view_rad = RadFromDeg(70), .sigma_of_range = 0.01};

PlanarWorld DoublingRoom() {
  PlanarWorld world = RectangleWorld(0.0, 0.0, 7.0, 5.0);
  AddRectangle(world, 5.6, 0.3, 6.3, 1.2);
  AddRectangle(world, 6.2, 3.0, 7.0, 3.6);
  AddRectangle(world, 4.0, 4.4, 5.2, 5.0);
  AddRectangle(world, 2.0, 0.0, 2.6, 0.4);
  return world;
}

// To and fro in the room, twice, looking ahead along x; the second time `error` away.
std::vector<MappedFrame> TwiceThere(const Pose2& error) {
  const PlanarWorld room = DoublingRoom();
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 160; ++i) {
    const int phase = i % 80;
    const double x_m = 1.0 + 0.05 * std::min(phase, 80 - phase);
    const Pose2 truth{x_m, 2.5, 0.1 * std::sin(0.1 * i)};
    frames.push_back(MappedFrameAt(room, kDoublingLaser, truth, i < 80 ? truth : error * truth, i));
  }
  return frames;
}

OccupancyMap MapOf(const std::vector<MappedFrame>& frames) {
  MapDrawing drawing{GridOptions{}};
  for (const MappedFrame& frame : frames) {
    drawing.Add(frame.frame, *frame.obstacles, frame.map_from_base);
  }
  return drawing.Map();
}

TEST(DoubledWalls, ALoopTellsHowFarTheSecondOnesAreOff) {
  for (const Pose2& error : {Pose2{0.5, -0.4, 0.02}, Pose2{-0.3, 0.6, -0.05}}) {
    const std::vector<MappedFrame> frames = TwiceThere(error);
    const std::vector<CrossedWalls> crossed = WallsCrossed(frames, MapOf(frames), kDoubledSample);
    EXPECT_GT(CrossingShare(crossed), 2.0 * kDoubledShare);
    const auto loop = LoopOfDoubledWalls(frames, crossed, {}, {});
    ASSERT_TRUE(loop.has_value());
    EXPECT_LT(loop->first, 80);
    EXPECT_GE(loop->second, 80);
    const Pose2 second_truth = Inverse(error) * FrameAt(frames, loop->second).map_from_base;
    const Pose2 truth = Between(FrameAt(frames, loop->first).map_from_base, second_truth);
    const Pose2 off = Between(truth, loop->first_from_second);
    EXPECT_LT(off.translation().norm(), 0.03);
    EXPECT_LT(std::abs(off.yaw_rad), RadFromDeg(0.5));
  }
}

// After a loss of SLAM whose place was not found the second walls may be anywhere.
TEST(DoubledWalls, AreNotJoinedWithAPartWhosePlaceIsAGuess) {
  const std::vector<MappedFrame> frames = TwiceThere({0.5, -0.4, 0.02});
  const std::vector<CrossedWalls> crossed = WallsCrossed(frames, MapOf(frames), kDoubledSample);
  const int count = static_cast<int>(frames.size());
  EXPECT_FALSE(LoopOfDoubledWalls(frames, crossed, {}, {}, {{80, count}}).has_value());
  EXPECT_FALSE(LoopOfDoubledWalls(frames, crossed, {}, {}, {{0, 80}}).has_value());
  EXPECT_TRUE(LoopOfDoubledWalls(frames, crossed, {}, {}, {{0, count}}).has_value());
}

TEST(DoubledWalls, OfRightPosesThereAreNone) {
  const std::vector<MappedFrame> frames = TwiceThere({});
  const std::vector<CrossedWalls> crossed = WallsCrossed(frames, MapOf(frames), kDoubledSample);
  EXPECT_LT(CrossingShare(crossed), 0.5 * kDoubledShare);
  EXPECT_FALSE(LoopOfDoubledWalls(frames, crossed, {}, {}).has_value());
  EXPECT_FALSE(LoopOfDoubledWalls({}, {}, {}, {}).has_value());
}

struct DoublingOutcome {
  double error_m = 0.0;  // mean, of the final poses
  std::size_t loops = 0;
};

// A run whose odometry slides along a bare wall, by `slide_m` in each of 60 frames: by more than
// the joint adjustment looks for.
DoublingOutcome AtTheEnd(double slide_m, bool join) {
  const PlanarWorld room = DoublingRoom();
  MapperOptions options;
  options.fusion.mode = FusionMode::kKalman;
  options.fusion.slam_noise = {.jitter_m = 0.001,
                               .jitter_rad = 0.001,
                               .walk_m_per_sqrt_s = 0.2,
                               .walk_rad_per_sqrt_s = 0.005};
  options.rounds.first_frames = 0;
  options.loops.slide.use = false;
  options.loops.join_doubled = join;
  options.surfel.joint.max_loop_sigmas = 50.0;  // the odometry hides how it errs along the wall
  IncrementalMapper mapper(options, std::nullopt);
  constexpr int kRound = 120, kAlong = 60;
  std::vector<Pose2> truths;
  for (int i = 0; i < 3 * kRound + kAlong; ++i) {
    const int along = std::clamp(i - kRound, 0, kAlong);
    const int turned = i - along;
    const Pose2 truth{1.6 + 0.5 * std::sin(0.1 * turned), 2.9 - 0.01 * along,
                      WrapAngle(kPi + 2.0 * kPi / kRound * turned)};
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan = std::make_shared<Scan>(
        ScanOf(room, truth, kDoublingLaser, 5, static_cast<std::uint32_t>(i)));
    frame.slam_from_camera = CameraOf({truth.x_m, truth.y_m - slide_m * along, truth.yaw_rad}, 0.5);
    mapper.AddFrame(frame);
    truths.push_back(truth);
  }
  const MapperResult result = mapper.Finish();
  DoublingOutcome outcome;
  outcome.loops = result.loops.size();
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Pose2 estimate = BaseOf(*result.map_from_camera[i]);
    const double error_m = (estimate.translation() - truths[i].translation()).norm();
    outcome.error_m += error_m / static_cast<double>(truths.size());
  }
  return outcome;
}

TEST(DoubledWalls, AreJoinedAtTheEnd) {
  const DoublingOutcome without = AtTheEnd(0.012, false), with = AtTheEnd(0.012, true);
  EXPECT_GT(without.error_m, 0.1);
  EXPECT_EQ(without.loops, 0U);
  EXPECT_LT(with.error_m, 0.03);
  EXPECT_EQ(with.loops, 1U);
}

// Two places a few metres wide are ambiguous here, or an adjustment from the poses of the run does
// not bring them together. The whole parts of the map do.
TEST(DoubledWalls, AreJoinedByWholePartsOfTheMap) {
  for (const double slide_m : {0.015, 0.025}) {
    const DoublingOutcome without = AtTheEnd(slide_m, false), with = AtTheEnd(slide_m, true);
    EXPECT_GT(without.error_m, 0.5) << slide_m;
    EXPECT_LT(with.error_m, 0.03) << slide_m;
    EXPECT_GE(with.loops, 1U) << slide_m;
  }
}

// Farther off than is looked for.
TEST(DoubledWalls, AreLeftAsTheyAreWhereNothingJoinsThem) {
  const DoublingOutcome without = AtTheEnd(0.05, false), with = AtTheEnd(0.05, true);
  EXPECT_GT(without.error_m, 1.0);
  EXPECT_EQ(with.error_m, without.error_m);
  EXPECT_EQ(with.loops, 0U);
}

}  // namespace
}  // namespace depthgrid
