#include "mapper/graph/relocation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

// Once round a furnished room; then SLAM is lost for five seconds and comes back, metres off, where
// the path leads in a world.
struct LostRun {
  double final_error_m = 0.0;  // mean since the loss
  int relocated = 0;
  bool guessed = false;  // to the end
  bool ever_guessed = false;
};

using Path = Pose2 (*)(int frame);

Pose2 RoundTheRoom(int frame) {
  const double angle_rad = 2.0 * kPi * frame / 240;
  return {3.0 + 0.7 * std::cos(angle_rad), 1.7 + 0.7 * std::sin(angle_rad),
          WrapAngle(angle_rad + 0.5 * kPi)};
}

// `blind`: frames on either side of the loss that have a pose and no scan.
LostRun Lose(const PlanarWorld& before, const PlanarWorld& after, Path path, Path path_after,
             bool use, MapperMethod method = MapperMethod::kSurfel, int blind = 0,
             double lost_s = 5.0, const Pose2& restart = {1.6, -0.7, 0.9}) {
  constexpr int kBefore = 240, kAfter = 160;
  MapperOptions options;
  options.method = method;
  options.fusion.mode = FusionMode::kKalman;
  options.loops.relocation.use = use;
  IncrementalMapper mapper(options, std::nullopt);
  LostRun run;
  std::vector<Pose2> truths;
  for (int i = 0; i < kBefore + kAfter; ++i) {
    const bool is_after = i >= kBefore;
    const Pose2 truth = is_after ? path_after(i - kBefore) : path(i);
    const Pose2 off = is_after ? restart : Pose2{};
    truths.push_back(truth);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0 + (is_after ? lost_s : 0.0);
    frame.slam_epoch = is_after ? 1 : 0;
    frame.slam_from_camera = CameraOf(off * truth, 1.0);
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    if (i < kBefore - blind || i >= kBefore + blind) {
      frame.scan = std::make_shared<const Scan>(
          ScanOf(is_after ? after : before, truth, laser, 4, static_cast<std::uint32_t>(i)));
    }
    const FrameReport report = mapper.AddFrame(frame);
    run.relocated += report.relocated ? 1 : 0;
    run.guessed = report.guessed;
    run.ever_guessed = run.ever_guessed || report.guessed;
  }
  const MapperResult result = mapper.Finish();
  for (int i = 0; i < kBefore + kAfter; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Pose2 pose = BaseOf(*result.map_from_camera[k]);
    if (i >= kBefore) {
      run.final_error_m += (pose.translation() - truths[k].translation()).norm() / kAfter;
    }
  }
  return run;
}

TEST(Relocation, FindsTheCameraInWhatWasSeen) {
  const PlanarWorld room = FurnishedRoom();
  const Path elsewhere = [](int frame) { return RoundTheRoom(frame + 100); };
  EXPECT_GT(Lose(room, room, RoundTheRoom, elsewhere, false).final_error_m, 0.5);
  const LostRun found = Lose(room, room, RoundTheRoom, elsewhere, true);
  EXPECT_EQ(found.relocated, 1);
  EXPECT_FALSE(found.guessed);
  EXPECT_LT(found.final_error_m, 0.02);
  const LostRun paper = Lose(room, room, RoundTheRoom, elsewhere, true, MapperMethod::kPaper);
  EXPECT_EQ(paper.relocated, 1);
  EXPECT_LT(paper.final_error_m, 0.1);
}

// SLAM that begins anew has its origin where it likes, however short it was lost.
TEST(Relocation, FindsTheCameraAfterARestartOfSlam) {
  const PlanarWorld room = FurnishedRoom();
  const Path goes_on = [](int frame) { return RoundTheRoom(240 + 20 + frame); };
  for (const double lost_s : {0.4, 0.7, 1.5}) {
    const LostRun run = Lose(room, room, RoundTheRoom, goes_on, true, MapperMethod::kSurfel, 0,
                             lost_s, {4.0, 1.0, 0.9});
    EXPECT_LT(run.final_error_m, 0.02) << lost_s;
  }
}

// Recordings have frames without poses, and no word of a new epoch.
TEST(Relocation, FindsTheCameraWhereNobodyTellsOfTheRestart) {
  constexpr int kLost = 240, kBack = 260, kFrames = 420;
  const PlanarWorld room = FurnishedRoom();
  IncrementalMapper mapper({}, std::nullopt);
  for (int i = 0; i < kFrames; ++i) {
    const Pose2 truth = RoundTheRoom(i);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    frame.scan =
        std::make_shared<const Scan>(ScanOf(room, truth, laser, 4, static_cast<std::uint32_t>(i)));
    const Pose2 off = i < kBack ? Pose2{} : Pose2{4.0, 1.0, 0.9};
    if (i < kLost || i >= kBack) frame.slam_from_camera = CameraOf(off * truth, 1.0);
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  for (int i = kBack; i < kFrames; ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[static_cast<std::size_t>(i)]);
    ASSERT_LT((pose.translation() - RoundTheRoom(i).translation()).norm(), 0.03) << i;
  }
}

// A covered camera tells nothing, neither of what is usual nor of the guess.
TEST(Relocation, FramesThatSeeNothingDoNotJudge) {
  const PlanarWorld room = FurnishedRoom();
  const Path elsewhere = [](int frame) { return RoundTheRoom(frame + 100); };
  const LostRun found = Lose(room, room, RoundTheRoom, elsewhere, true, MapperMethod::kSurfel, 40);
  EXPECT_EQ(found.relocated, 1);
  EXPECT_LT(found.final_error_m, 0.02);
  // Nor of a guess that is right.
  const Path goes_on = [](int frame) { return RoundTheRoom(240 + frame); };
  const LostRun right =
      Lose(room, room, RoundTheRoom, goes_on, true, MapperMethod::kSurfel, 40, 5.0, {});
  EXPECT_FALSE(right.ever_guessed);
}

// SLAM comes back a metre off, sees what it has not seen before, and corrects itself twice.
TEST(Relocation, SlamsCorrectionsMoveWhatWasSeenSinceTheLoss) {
  constexpr int kLost = 100, kBack = 101, kFirstCorrection = 115, kSecondCorrection = 130;
  const auto truth_at = [](int i) { return RoundTheRoom(i < kBack ? i : i + 60); };
  IncrementalMapper mapper({}, std::nullopt);
  constexpr int kFrames = 150;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0 + (i < kBack ? 0.0 : 3.0);
    Pose2 off;
    if (i >= kBack) off = {1.0, -0.6, 0.5};
    if (i >= kFirstCorrection) off = {0.3, -0.2, 0.2};
    if (i >= kSecondCorrection) off = {0.02, 0.01, 0.005};
    frame.slam_epoch = (i >= kBack) + (i >= kFirstCorrection) + (i >= kSecondCorrection);
    if (i != kLost) {
      frame.slam_from_camera = CameraOf(off * truth_at(i), 1.0);
      const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
      frame.scan = std::make_shared<const Scan>(
          ScanOf(FurnishedRoom(), truth_at(i), laser, 6, static_cast<std::uint32_t>(i)));
    }
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  for (int i = kBack; i < kFrames; ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[static_cast<std::size_t>(i)]);
    EXPECT_LT(Between(truth_at(i), pose).translation().norm(), 0.1) << i;
  }
}

// SLAM is lost for three seconds and comes back without a word of a new epoch.
TEST(Relocation, MotionOverADoubtedLossIsNotBelieved) {
  constexpr int kLost = 100, kBack = 101, kFrames = 110;
  for (const bool is_right : {true, false}) {
    IncrementalMapper mapper({}, std::nullopt);
    for (int i = 0; i < kFrames; ++i) {
      const Pose2 truth = RoundTheRoom(i);
      Frame frame;
      frame.index = i;
      frame.stamp_s = i / 30.0 + (i < kBack ? 0.0 : 3.0);
      const Pose2 off = i < kBack || is_right ? Pose2{} : Pose2{1.0, -0.6, 0.5};
      const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
      frame.scan = std::make_shared<const Scan>(
          ScanOf(FurnishedRoom(), truth, laser, 7, static_cast<std::uint32_t>(i)));
      if (i != kLost) frame.slam_from_camera = CameraOf(off * truth, 1.0);
      mapper.AddFrame(frame);
    }
    const std::vector<MappedFrame> mapped = mapper.Finish().mapped;
    const auto back = std::find_if(mapped.begin(), mapped.end(),
                                   [](const MappedFrame& f) { return f.frame == kBack; });
    ASSERT_NE(back, mapped.end());
    EXPECT_EQ(back->slam_motion.has_value(), is_right);
    EXPECT_TRUE(std::next(back)->slam_motion.has_value());
  }
}

// Never seen before: nothing is moved.
TEST(Relocation, AnotherRoomIsNotFound) {
  PlanarWorld other = RectangleWorld(0.0, 0.0, 5.2, 4.1);
  AddRectangle(other, 0.0, 0.9, 0.7, 1.9);
  AddRectangle(other, 3.9, 3.4, 5.2, 4.1);
  const Path elsewhere = [](int frame) { return RoundTheRoom(frame + 100); };
  const LostRun run = Lose(FurnishedRoom(), other, RoundTheRoom, elsewhere, true);
  EXPECT_EQ(run.relocated, 0);
  EXPECT_TRUE(run.guessed);
}

// Along a corridor every place looks alike.
TEST(Relocation, ACorridorIsAmbiguous) {
  const PlanarWorld corridor = StraightCorridor();
  const Path along = [](int frame) { return Pose2{0.02 * frame, 0.0, 0.0}; };
  const Path farther = [](int frame) { return Pose2{2.0 + 0.02 * frame, 0.0, 0.0}; };
  EXPECT_EQ(Lose(corridor, corridor, along, farther, true).relocated, 0);
}

// Wheels slip on a step: within a frame odometry is some degrees off, twice.
struct SlippedRun {
  double mean_error_m = 0.0;
  int slips = 0;  // that were found
};
SlippedRun DriveWithSlips(double slip_deg, const MapperOptions& options) {
  constexpr int kFirstSlip = 120, kSecondSlip = 200, kFrames = 280;
  IncrementalMapper mapper(options, std::nullopt);
  SlippedRun run;
  for (int i = 0; i < kFrames; ++i) {
    Pose2 off;
    for (const int at : {kFirstSlip, kSecondSlip}) {
      const Pose2 slip = RoundTheRoom(at) * Pose2{0.0, 0.0, RadFromDeg(slip_deg)};
      if (i >= at) off = off * slip * Inverse(RoundTheRoom(at));
    }
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(off * RoundTheRoom(i), 1.0);
    const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
    frame.scan = std::make_shared<const Scan>(
        ScanOf(FurnishedRoom(), RoundTheRoom(i), laser, 8, static_cast<std::uint32_t>(i)));
    const FrameReport report = mapper.AddFrame(frame);
    const Pose2 error = Between(RoundTheRoom(i), BaseOf(*report.map_from_camera));
    run.mean_error_m += error.translation().norm() / kFrames;
    run.slips += report.slipped ? 1 : 0;
  }
  return run;
}

// What a fixed gain leaves of errors grows, and is no slip; what it does not take is not taken
// back.
TEST(Slip, AFixedGainThatTakesLittleTellsNone) {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  options.fusion.gain = {0.5, 0.5, 0.5};
  EXPECT_EQ(DriveWithSlips(7.0, options).slips, 2);
  options.fusion.gain = {0.5, 0.5, 0.19};
  EXPECT_EQ(DriveWithSlips(7.0, options).slips, 0);
}

TEST(Slip, OfAFewDegreesIsTakenBackAtOnce) {
  MapperOptions unsearched;
  unsearched.loops.relocation.slip_deg = 0.0;
  for (const double slip_deg : {-4.0, 7.0}) {
    EXPECT_LT(DriveWithSlips(slip_deg, {}).mean_error_m, 0.01) << slip_deg;
    EXPECT_GT(DriveWithSlips(slip_deg, unsearched).mean_error_m, 0.015) << slip_deg;
  }
}

// The largest errors, of a run.
struct Worst {
  double online_m = 0.0;
  double final_m = 0.0;  // after the loss
};

// SLAM is lost for 1.5 s and finds itself again, 2 cm off; the camera meanwhile turned to what it
// had not seen.
Worst WorstOfShortLoss(MapperMethod method, std::uint64_t seed) {
  constexpr int kLost = 40, kBack = 85, kFrames = 200;
  const Pose2 off{0.02, -0.01, 0.005};
  MapperOptions options;
  options.method = method;
  IncrementalMapper mapper(options, std::nullopt);
  Worst worst;
  for (int i = 0; i < kFrames; ++i) {
    const bool is_after = i >= kBack;
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_epoch = is_after ? 1 : 0;
    if (i < kLost || is_after) {
      frame.slam_from_camera = CameraOf(RoundTheRoom(i) * (is_after ? off : Pose2{}), 1.0);
      const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
      frame.scan = std::make_shared<const Scan>(
          ScanOf(FurnishedRoom(), RoundTheRoom(i), laser, seed, static_cast<std::uint32_t>(i)));
    }
    const FrameReport report = mapper.AddFrame(frame);
    if (!report.map_from_camera) continue;
    worst.online_m =
        std::max(worst.online_m,
                 Between(RoundTheRoom(i), BaseOf(*report.map_from_camera)).translation().norm());
  }
  const MapperResult result = mapper.Finish();
  for (int i = kBack; i < kFrames; ++i) {
    const Pose2 pose = BaseOf(*result.map_from_camera[static_cast<std::size_t>(i)]);
    worst.final_m = std::max(worst.final_m, Between(RoundTheRoom(i), pose).translation().norm());
  }
  return worst;
}

// Nothing ties what comes after to what came before but SLAM's own word: few walls are seen from
// both sides of the loss. What single runs are off by at worst is .086 m in the mean of 300 seeds,
// with a standard deviation of .03 m, with the paper's method of .07.
TEST(ShortLoss, SlamIsTakenAtItsWordWhereNothingSpeaksAgainstIt) {
  constexpr int kSeeds = 60;
  for (const auto& [method, most_m] :
       {std::pair(MapperMethod::kSurfel, 0.1), std::pair(MapperMethod::kPaper, 0.13)}) {
    Worst mean;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const Worst worst = WorstOfShortLoss(method, seed);
      mean.online_m += worst.online_m / kSeeds;
      mean.final_m += worst.final_m / kSeeds;
    }
    EXPECT_LT(mean.online_m, most_m);
    EXPECT_LT(mean.final_m, most_m);
  }
}

// The recording pauses for two seconds each time ten frames have come; no pose is missing.
double WorstErrorAfterPauses(double field_of_view_deg, const Pose2& error_of_each_pause) {
  constexpr int kTaken = 10, kLeftOut = 60, kParts = 5;
  IncrementalMapper mapper({}, std::nullopt);
  Pose2 off;
  std::vector<int> frames;
  for (int part = 0; part < kParts; ++part) {
    for (int k = 0; k < kTaken; ++k) {
      const int i = part * (kTaken + kLeftOut) + k;
      Frame frame;
      frame.index = static_cast<int>(frames.size());
      frame.stamp_s = i / 30.0;
      frame.slam_from_camera = CameraOf(off * RoundTheRoom(i), 1.0);
      const PlanarLaser laser{
          .beams = 320, .field_of_view_rad = RadFromDeg(field_of_view_deg), .sigma_of_range = 0.01};
      frame.scan = std::make_shared<const Scan>(
          ScanOf(FurnishedRoom(), RoundTheRoom(i), laser, 9, static_cast<std::uint32_t>(i)));
      mapper.AddFrame(frame);
      frames.push_back(i);
    }
    const Pose2 last = RoundTheRoom(frames.back());
    off = off * last * error_of_each_pause * Inverse(last);
  }
  const MapperResult result = mapper.Finish();
  double worst_m = 0.0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Pose2 pose = BaseOf(*result.map_from_camera[k]);
    worst_m = std::max(worst_m, Between(RoundTheRoom(frames[k]), pose).translation().norm());
  }
  return worst_m;
}

// Taken for one it is 35 mm. Exact poses are believed over it no more than over the frames that did
// not come: half a millimetre better if they were (docs/tried.md, "Pauses").
TEST(Pause, OfARecordingIsNoLoss) { EXPECT_LT(WorstErrorAfterPauses(67.0, {}), 0.002); }

// What SLAM drifts by in two seconds is not taken for the error of one frame.
TEST(Pause, SlamErrsOverItAsOverTheFramesThatDidNotCome) {
  EXPECT_LT(WorstErrorAfterPauses(120.0, {0.02, 0.01, 0.005}), 0.01);
}

TEST(Relocation, AnUnknownRoomBeforeTheLossDoesNotMakeAnyGuessRight) {
  Relocation relocation({}, {}, {});
  for (int i = 0; i < 150; ++i) relocation.Explained(0.9);
  for (int i = 0; i < 100; ++i) relocation.Explained(0.0);
  EXPECT_FALSE(relocation.IsUsual(0.2));
  relocation.Lost(5.0, {});
  EXPECT_TRUE(relocation.BeginIfDoubtful(0.2, 250));
}

TEST(Relocation, DoesNotBeginWhereTheGuessIsGood) {
  RelocationOptions options;
  Relocation relocation(options, {}, {});
  for (int i = 0; i < 50; ++i) relocation.Explained(0.9);
  EXPECT_FALSE(relocation.BeginIfDoubtful(0.1, 50));  // not lost at all
  const auto begins = [](Relocation& lost, double lost_s, double share,
                         const std::optional<Pose2>& epoch_step = {}) {
    lost.Lost(lost_s, epoch_step);
    return lost.BeginIfDoubtful(share, 50);
  };
  EXPECT_FALSE(begins(relocation, 1.9, 0.1));         // not lost for long
  EXPECT_FALSE(begins(relocation, 5.0, 0.6));         // two thirds of what is usual
  EXPECT_FALSE(relocation.BeginIfDoubtful(0.1, 50));  // and judged once
  EXPECT_FALSE(begins(relocation, 0.4, 0.1, Pose2{5.0, 0.0, 0.0}));
  EXPECT_TRUE(begins(relocation, 5.0, 0.5));
  EXPECT_TRUE(relocation.active());
  EXPECT_EQ(relocation.first_frame(), 50);
  Relocation anew(options, {}, {});
  anew.Explained(0.9);
  EXPECT_FALSE(begins(anew, 0.6, 0.5, Pose2{0.5, 0.0, 1.0}));
  EXPECT_TRUE(begins(anew, 0.6, 0.5, Pose2{5.0, 0.0, 0.0}));
  options.use = false;
  Relocation off(options, {}, {});
  off.Explained(0.9);
  EXPECT_FALSE(begins(off, 5.0, 0.1));
}

}  // namespace
}  // namespace depthgrid
