// A camera that comes back to what it had seen long after SLAM was lost.
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr double kSecondRoomM = 6.0;  // from the middle of the first room to that of the second
constexpr int kOnceRoundFrames = 100;
constexpr double kRoundStepRad = 2.0 * kPi / kOnceRoundFrames;

// Once round the table of a room after `x_m`.
void GoRound(double x_m, std::vector<Pose2>& path) {
  for (int i = 0; i < kOnceRoundFrames; ++i) {
    const double angle_rad = kRoundStepRad * i;
    path.push_back({x_m + 3.0 + 0.7 * std::cos(angle_rad), 1.7 + 0.7 * std::sin(angle_rad),
                    WrapAngle(angle_rad + 0.5 * kPi)});
  }
}

// From where GoRound() ends to where it begins in the other room, through doors that are shut
// behind the camera.
void GoOver(double from_m, double to_m, std::vector<Pose2>& path) {
  const double heading_rad = to_m > from_m ? 0.0 : kPi;
  const double turn_rad = WrapAngle(heading_rad - 0.5 * kPi);
  for (int i = 1; i <= 12; ++i) {
    path.push_back({from_m + 3.7, 1.7, WrapAngle(0.5 * kPi + turn_rad * i / 12)});
  }
  for (int i = 1; i <= kOnceRoundFrames; ++i) {
    path.push_back({from_m + 3.7 + (to_m - from_m) * i / kOnceRoundFrames, 1.7, heading_rad});
  }
  for (int i = 1; i < 12; ++i) {
    path.push_back({to_m + 3.7, 1.7, WrapAngle(heading_rad - turn_rad * i / 12)});
  }
}

PlanarWorld WithSecondRoom(bool as_before) {
  PlanarWorld world = FurnishedRoom();
  const double x_m = kSecondRoomM;
  const PlanarWorld room = as_before ? RectangleWorld(x_m, 0.0, x_m + 6.0, 5.0)
                                     : RectangleWorld(x_m, -1.0, x_m + 5.2, 4.1);
  world.insert(world.end(), room.begin(), room.end());
  AddRectangle(world, x_m, 0.2, x_m + 0.7, 1.2);
  AddRectangle(world, x_m + 3.9, as_before ? 4.3 : 3.4, x_m + 5.0, as_before ? 5.0 : 4.1);
  return world;
}

struct LateRun {
  int relocated_at = -1;  // frame since the loss
  bool guessed = true;    // in all frames since the loss before that
  bool guessed_at_end = false;
  double worst_m = 0.0;  // of the final poses
  std::size_t guessed_parts = 0;
};

LateRun LoseBetween(const std::vector<Pose2>& before, const std::vector<Pose2>& after,
                    const PlanarWorld& world_before, const PlanarWorld& world_after) {
  std::vector<Pose2> truths = before;
  truths.insert(truths.end(), after.begin(), after.end());
  IncrementalMapper mapper({}, std::nullopt);
  LateRun run;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const bool is_after = i >= before.size();
    Frame frame;
    frame.index = static_cast<int>(i);
    frame.stamp_s = static_cast<double>(i) / 12.0 + (is_after ? 5.0 : 0.0);
    frame.slam_epoch = is_after ? 1 : 0;
    const Pose2 off = is_after ? Pose2{1.6, -2.7, 0.9} : Pose2{};
    frame.slam_from_camera = CameraOf(off * truths[i], 1.0);
    const PlanarLaser laser{.beams = 160, .field_of_view_rad = kPi, .sigma_of_range = 0.005};
    frame.scan = std::make_shared<const Scan>(ScanOf(
        is_after ? world_after : world_before, truths[i], laser, 4, static_cast<std::uint32_t>(i)));
    const FrameReport report = mapper.AddFrame(frame);
    if (report.relocated) run.relocated_at = static_cast<int>(i - before.size());
    if (is_after && run.relocated_at < 0) run.guessed = run.guessed && report.guessed;
    run.guessed_at_end = report.guessed;
  }
  const MapperResult result = mapper.Finish();
  run.guessed_parts = result.guessed.size();
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Pose2 error = Between(truths[i], BaseOf(*result.map_from_camera[i]));
    run.worst_m = std::max(run.worst_m, error.translation().norm());
  }
  return run;
}

// Two turns in a room never seen are more than twelve searches.
TEST(RelocationLate, APlaceIsFoundWhenTheCameraComesBackToIt) {
  std::vector<Pose2> before, after;
  GoRound(0.0, before);
  for (int turn = 0; turn < 2; ++turn) GoRound(kSecondRoomM, after);
  GoOver(kSecondRoomM, 0.0, after);
  const int back_at = static_cast<int>(after.size());
  for (int turn = 0; turn < 3; ++turn) GoRound(0.0, after);
  const PlanarWorld world = WithSecondRoom(true);
  const LateRun run = LoseBetween(before, after, world, world);
  EXPECT_GT(run.relocated_at, back_at);
  EXPECT_TRUE(run.guessed);
  EXPECT_FALSE(run.guessed_at_end);
  EXPECT_EQ(run.guessed_parts, 0U);
  EXPECT_LT(run.worst_m, 0.03);
}

// Where the camera now is looks as a room did before the loss; where it came from since does not
// look as what was beside that.
TEST(RelocationLate, ARoomWhoseNeighbourDiffersIsAnother) {
  std::vector<Pose2> before, after;
  GoRound(0.0, before);
  GoOver(0.0, kSecondRoomM, before);
  GoRound(kSecondRoomM, before);
  for (int turn = 0; turn < 2; ++turn) GoRound(kSecondRoomM, after);
  GoOver(kSecondRoomM, 0.0, after);
  for (int turn = 0; turn < 3; ++turn) GoRound(0.0, after);
  const LateRun other = LoseBetween(before, after, WithSecondRoom(true), WithSecondRoom(false));
  EXPECT_EQ(other.relocated_at, -1);
  EXPECT_TRUE(other.guessed_at_end);
  EXPECT_EQ(other.guessed_parts, 1U);
}

// The second loss ends the search for the part that the first one began, which stays where it was
// guessed.
TEST(RelocationLate, APartThatALaterLossEndsRemainsAGuess) {
  std::vector<Pose2> known, elsewhere, truths;
  GoRound(0.0, known);
  for (int turn = 0; turn < 2; ++turn) GoRound(kSecondRoomM, elsewhere);
  for (const auto& part : {known, elsewhere, known, known, known}) {
    truths.insert(truths.end(), part.begin(), part.end());
  }
  const std::size_t first = known.size(), end = first + elsewhere.size();
  const Pose2 off[] = {{}, {1.6, -2.7, 0.9}, {-6.0, 1.0, -1.2}};
  const PlanarLaser laser{.beams = 160, .field_of_view_rad = kPi, .sigma_of_range = 0.005};
  IncrementalMapper mapper({}, std::nullopt);
  bool guessed_at_end = true;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const int losses = i < first ? 0 : i < end ? 1 : 2;
    Frame frame;
    frame.index = static_cast<int>(i);
    frame.stamp_s = static_cast<double>(i) / 12.0 + 5.0 * losses;
    frame.slam_epoch = losses;
    frame.slam_from_camera = CameraOf(off[losses] * truths[i], 1.0);
    frame.scan = std::make_shared<const Scan>(
        ScanOf(WithSecondRoom(false), truths[i], laser, 4, static_cast<std::uint32_t>(i)));
    guessed_at_end = mapper.AddFrame(frame).guessed;
  }
  EXPECT_FALSE(guessed_at_end);
  const MapperResult result = mapper.Finish();
  ASSERT_EQ(result.guessed.size(), 1U);
  EXPECT_EQ(result.guessed[0].first, static_cast<int>(first));
  EXPECT_EQ(result.guessed[0].last, static_cast<int>(end) - 1);
}

}  // namespace
}  // namespace depthgrid
