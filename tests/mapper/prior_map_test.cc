// Going on in a finished map with poses that drift.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/surfel/surfel_map.h"
#include "tests/mapper/prior_round.h"

namespace depthgrid {
namespace {

struct RoundErrors {
  double worst_online_m = 0.0;
  double worst_m = 0.0;
  double prior_m = 0.0;  // the worst of the prior map's frames
};

// Begun where the first round ended.
RoundErrors ErrorsOfASecondRound(const MapperOptions& options, int frames = kPriorRound) {
  IncrementalMapper mapper(options, std::nullopt);
  mapper.StartFrom(FinishedRound());
  RoundErrors errors;
  const std::vector<Pose2> slam_from_base = DriftedRound();
  EXPECT_GT(PriorErrorM(slam_from_base.back(), PriorTruthAt(kPriorRound - 1)), 0.2);
  for (int i = 0; i < frames; ++i) {
    const FrameReport report =
        mapper.AddFrame(PriorFrameAt(i, slam_from_base[static_cast<std::size_t>(i)]));
    const double online_m = PriorErrorM(BaseOf(*report.map_from_camera), PriorTruthAt(i));
    errors.worst_online_m = std::max(errors.worst_online_m, online_m);
  }
  const MapperResult result = mapper.Finish();
  for (int i = 0; i < frames; ++i) {
    const Pose3& pose = *result.map_from_camera[static_cast<std::size_t>(i)];
    errors.worst_m = std::max(errors.worst_m, PriorErrorM(BaseOf(pose), PriorTruthAt(i)));
  }
  for (int i = 0; i < kPriorRound; ++i) {
    const Pose2& pose = result.mapped[static_cast<std::size_t>(i)].map_from_base;
    errors.prior_m = std::max(errors.prior_m, PriorErrorM(pose, PriorTruthAt(i)));
  }
  return errors;
}

TEST(PriorMap, ASecondRunThatDriftsIsPlacedInItAndHardlyMovesIt) {
  const RoundErrors errors = ErrorsOfASecondRound({});
  EXPECT_LT(errors.worst_online_m, 0.04);
  EXPECT_LT(errors.worst_m, 0.015);
  EXPECT_LT(errors.prior_m, 0.005);
}

TEST(PriorMap, SoIsOneWhoseScansAreNotAllKept) {
  MapperOptions options;
  options.keep.first_frames = 100;
  options.keep.scans_per_place = 10;
  const RoundErrors errors = ErrorsOfASecondRound(options);
  EXPECT_LT(errors.worst_m, 0.03);
}

// Many times as many frames of the prior map, whose motions fit, do not make SLAM a good one.
TEST(PriorMap, AFewNewFramesAreNotPulledToSlamAtTheEnd) {
  EXPECT_LT(ErrorsOfASecondRound({}, 60).worst_m, 0.008);
}

// Begun 36 mm off and hardly matched, near to where the prior map's last frames are.
TEST(PriorMap, ItsLastFramesAreNotOneGroupWithTheFirstNewOnes) {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  options.fusion.gain = {0.01, 0.01, 0.01};
  const RoundErrors errors = ErrorsOfASecondRound(options, 20);
  EXPECT_GT(errors.worst_online_m, 0.03);
  EXPECT_LT(errors.worst_m, 0.005);
  // They move as with new frames that lie where they should.
  const double usual_m = ErrorsOfASecondRound({}, 20).prior_m;
  EXPECT_LT(usual_m, 0.003);
  EXPECT_NEAR(errors.prior_m, usual_m, 0.0005);
}

// With a prior map of more frames than that, and than the last round has.
TEST(PriorMap, TheFirstRoundComesAfterAsManyNewFrames) {
  constexpr int kFirst = 20;
  const std::vector<Pose2> slam_from_base = DriftedRound();
  std::vector<FrameReport> reports[2];
  for (const bool with_rounds : {false, true}) {
    MapperOptions options;
    options.rounds.first_frames = with_rounds ? kFirst : 0;
    options.rounds.last_frames = kFirst;
    IncrementalMapper mapper(options, std::nullopt);
    mapper.StartFrom(FinishedRound());
    for (int i = 0; i <= kFirst; ++i) {
      reports[with_rounds].push_back(
          mapper.AddFrame(PriorFrameAt(i, slam_from_base[static_cast<std::size_t>(i)])));
    }
  }
  for (std::size_t i = 0; i < kFirst; ++i) {
    EXPECT_EQ(reports[0][i].map_from_camera, reports[1][i].map_from_camera) << i;
  }
  EXPECT_NE(reports[0][kFirst].map_from_camera, reports[1][kFirst].map_from_camera);
}

KeptScan WithABeamOf(float range_m) {
  Scan scan = PriorScanAt(6, 1);
  scan.beams[7].hit = true;
  scan.beams[7].range_m = range_m;
  return ScanArchive().Keep(scan);
}

// Of its submaps only the last two are matched against.
TEST(PriorMap, MethodPaperNeedsItInOneSubmap) {
  MapperOptions options;
  options.method = MapperMethod::kPaper;
  options.submap.scans = kPriorRound - 1;
  IncrementalMapper mapper(options, std::nullopt);
  EXPECT_THAT([&] { mapper.StartFrom(FinishedRound()); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("must be at least as many with mapper.method paper")));
  options.submap.scans = kPriorRound;
  IncrementalMapper enough(options, std::nullopt);
  enough.StartFrom(FinishedRound());
}

std::string WhyNotBegun(const PriorMap& prior) {
  IncrementalMapper mapper({}, std::nullopt);
  try {
    mapper.StartFrom(prior);
  } catch (const InputError& error) {
    // As if nothing had been given.
    mapper.StartFrom(FinishedRound());
    return error.what();
  }
  EXPECT_THROW(mapper.StartFrom(prior), InputError);
  return "";
}

TEST(PriorMap, SaysWhatIsWrongWithIt) {
  const PriorMap sound = FinishedRound();
  EXPECT_EQ(WhyNotBegun(sound), "");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::function<void(PriorMap&)>, std::string>> cases = {
      {[](PriorMap& p) { p.frames[2].frame = 2; }, "prior map, entry 2: is frame 2, must be below"},
      {[](PriorMap& p) { p.frames[2].frame = p.frames[1].frame; },
       "entry 2: is frame -297, must come after the one before it, -297"},
      {[](PriorMap& p) { p.frames[3].scan = {}; }, "entry 3: has no scans of its own"},
      {[](PriorMap& p) { p.frames[3].tied_to = 0; }, "entry 3: has no scans of its own"},
      {[&](PriorMap& p) { p.frames[4].stamp_s = nan; }, "entry 4: its stamp is nan"},
      {[](PriorMap& p) {
         p.frames[5].map_from_base = {1e9, 0.0, 0.0};
       },
       "entry 5: its pose is"},
      {[](PriorMap& p) { p.frames[6].scan = WithABeamOf(0.0F); }, "entry 6: its scan has a beam"},
      {[](PriorMap& p) { p.frames[6].obstacles = WithABeamOf(1e30F); },
       "with range 1000000015047466219876688855040.000000"},
      {[&](PriorMap& p) {
         p.map_from_slam = {nan, 0.0, 0.0};
       },
       "prior map: its map_from_slam is"}};
  for (const auto& [spoil, why] : cases) {
    PriorMap prior = sound;
    spoil(prior);
    EXPECT_THAT(WhyNotBegun(prior), testing::HasSubstr(why));
  }
}

// Each of two far places is possible, both together lie beyond what cells can number.
TEST(PriorMap, AFrameBeyondTheMapIsNotMapped) {
  PriorMap prior = FinishedRound();
  prior.map_from_slam = {9e6, 0.0, 0.0};
  IncrementalMapper mapper({}, std::nullopt);
  mapper.StartFrom(prior);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(mapper.AddFrame(PriorFrameAt(i, Pose2{9e6, 0.0, 0.0} * PriorTruthAt(i))).inserted);
  }
  EXPECT_LT(mapper.Finish().map.geometry.width_cells, 400);
}

// What is asked for between two frames does not touch what comes after it.
TEST(PriorMap, AnEndChangesNothingOfTheFramesAfterIt) {
  const std::vector<Pose2> slam_from_base = DriftedRound();
  IncrementalMapper undisturbed({}, std::nullopt), asked({}, std::nullopt);
  for (int i = 0; i < kPriorRound; ++i) {
    const Frame frame = PriorFrameAt(i, slam_from_base[static_cast<std::size_t>(i)]);
    ASSERT_EQ(asked.AddFrame(frame).map_from_camera, undisturbed.AddFrame(frame).map_from_camera)
        << i;
    if (i % 60 == 20) asked.Finish();
  }
  EXPECT_EQ(asked.Finish().map_from_camera, undisturbed.Finish().map_from_camera);
}

TEST(PriorMap, WithoutANewFrameItStaysWhereItWas) {
  IncrementalMapper mapper({}, std::nullopt);
  mapper.StartFrom(FinishedRound());
  const MapperResult result = mapper.Finish();
  ASSERT_EQ(result.mapped.size(), static_cast<std::size_t>(kPriorRound));
  for (int i = 0; i < kPriorRound; ++i) {
    EXPECT_LT(
        PriorErrorM(result.mapped[static_cast<std::size_t>(i)].map_from_base, PriorTruthAt(i)),
        0.005);
  }
}

// SLAM's poses moved into another's frame, with nothing in it yet.
TEST(PriorMap, AFrameWithoutAMapIsKeptToTheEnd) {
  MapperOptions options;
  options.fusion.mode = FusionMode::kFixed;
  options.fusion.gain = {0.0, 0.0, 0.0};
  IncrementalMapper mapper(options, std::nullopt);
  PriorMap prior;
  prior.map_from_slam = {100.0, 0.0, 0.0};
  mapper.StartFrom(prior);
  Frame lost = PriorFrameAt(0, PriorTruthAt(0));
  lost.slam_from_camera.reset();
  EXPECT_EQ(mapper.AddFrame(lost).map_from_slam, prior.map_from_slam);
  for (int i = 1; i < 10; ++i) mapper.AddFrame(PriorFrameAt(i, PriorTruthAt(i)));
  const auto online = mapper.CurrentPoses();
  EXPECT_NEAR(BaseOf(*online[9]).x_m, PriorTruthAt(9).x_m + 100.0, 1e-9);
  EXPECT_EQ(mapper.Finish().map_from_camera, online);
}

// They join frames of which none is mapped yet.
TEST(PriorMap, LoopsOfItsFirstNewFrameAreRejected) {
  IncrementalMapper mapper({}, std::nullopt);
  mapper.StartFrom(FinishedRound());
  Frame frame = PriorFrameAt(3, PriorTruthAt(3));
  frame.loops = {LoopClosure{3, 1, 3, {}}, LoopClosure{3, 2, 3, {}}};
  const FrameReport report = mapper.AddFrame(frame);
  EXPECT_EQ(report.loops_accepted, 0);
  EXPECT_EQ(report.loops_rejected, 2);
}

// Groups of a prior map say nothing of how this run's SLAM errs, and two of its own too little.
TEST(PriorMap, DoesNotTellHowSlamErrs) {
  for (const bool is_prior : {true, false}) {
    SurfelMap map((SurfelOptions()));
    std::vector<MappedFrame> frames;
    for (int i = 0; i < 150; ++i) {
      MappedFrame frame;
      frame.frame = is_prior && i < 140 ? i - kPriorRound : i;
      frame.map_from_base = PriorTruthAt(i);
      if (i > 0) frame.slam_motion = Between(PriorTruthAt(i - 1), PriorTruthAt(i));
      frame.scan = frame.obstacles = ScanArchive().Keep(PriorScanAt(i, 1));
      map.Insert(std::make_shared<const Scan>(*frame.scan), frame.map_from_base,
                 Eigen::Matrix3d::Zero());
      frames.push_back(frame);
    }
    const Adjustment adjusted = map.Adjust(frames, {}, AdjustEffort::kRefine, {});
    EXPECT_EQ(adjusted.motion_spread.has_value(), !is_prior);
  }
}

// Of the prior map's frames SLAM knows nothing: its own, of before a loss, say where it comes back.
TEST(PriorMap, SlamsCorrectionsAfterALossMoveWhatWasSeenSince) {
  constexpr int kBack = 40, kFrames = 110, kAhead = 170;
  PriorMap prior = FinishedRound();
  prior.frames.resize(120);
  prior.map_from_slam = {};
  const auto truth_at = [](int i) { return PriorTruthAt(i < kBack ? i : i + kAhead - kBack); };
  IncrementalMapper mapper({}, std::nullopt);
  mapper.StartFrom(std::move(prior));
  Pose2 last;
  for (int i = 0; i < kFrames; ++i) {
    Pose2 off;
    if (i >= kBack) off = {1.0, -0.6, 0.5};
    if (i >= kBack + 15) off = {0.02, 0.01, 0.005};
    Frame frame = PriorFrameAt(i, off * truth_at(i));
    frame.stamp_s += i < kBack ? 0.0 : 5.0;
    frame.slam_epoch = (i >= kBack) + (i >= kBack + 15);
    frame.scan = std::make_shared<const Scan>(
        ScanOf(FurnishedRoom(), truth_at(i), kPriorLaser, 2, static_cast<std::uint32_t>(i)));
    last = BaseOf(*mapper.AddFrame(frame).map_from_camera);
  }
  EXPECT_LT(PriorErrorM(last, truth_at(kFrames - 1)), 0.1);
}

TEST(PriorMap, IsMadeOfAMapperThatStillRuns) {
  constexpr int kFrames = 100;
  IncrementalMapper mapper(MapperOptions{}, std::nullopt);
  const std::vector<Pose2> slam_from_base = DriftedRound();
  Pose3 last;
  for (int i = 0; i < kFrames; ++i) {
    last = *mapper.AddFrame(PriorFrameAt(i, slam_from_base[static_cast<std::size_t>(i)]))
                .map_from_camera;
  }
  Frame lost;
  lost.index = kFrames;
  lost.stamp_s = kFrames / 30.0;
  mapper.AddFrame(lost);
  const std::vector<std::optional<Pose3>> poses = mapper.CurrentPoses();
  ASSERT_EQ(poses.size(), kFrames + 1U);
  EXPECT_FALSE(poses[kFrames]);
  EXPECT_LT((poses[kFrames - 1]->translation - last.translation).norm(), 1e-9);
  PriorMap prior;
  prior.frames = mapper.CurrentMapped();
  ASSERT_EQ(prior.frames.size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    MappedFrame& frame = prior.frames[static_cast<std::size_t>(i)];
    const Pose2 base = BaseOf(*poses[static_cast<std::size_t>(i)]);
    EXPECT_LT(Separation(frame.map_from_base, base), 1e-9);
    frame.frame = i - kFrames;
  }
  IncrementalMapper second(MapperOptions{}, std::nullopt);
  second.StartFrom(prior);
  EXPECT_EQ(StatesOf(second.CurrentMap()), StatesOf(mapper.CurrentMap()));
  EXPECT_LT(PriorErrorM(BaseOf(*mapper.Finish().map_from_camera[0]), PriorTruthAt(0)), 0.015);
}

}  // namespace
}  // namespace depthgrid
