// What a loop costs while a run goes on: a short one is adjusted as a whole, a long one bent.
#include <gtest/gtest.h>

#include "mapper/loop_closing.h"
#include "mapper/paper_reference.h"
#include "mapper/surfel/surfel_map.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

constexpr int kLoopFrames = 200;

// Once round a furnished room and on to where it began, at drifting poses.
struct DriftingRound {
  std::vector<MappedFrame> frames;
  std::vector<Pose2> truth;
  SurfelMap map;

  explicit DriftingRound(const SurfelOptions& options = {}) : map(options) {
    const PlanarWorld room = FurnishedRoom();
    ScanArchive archive;
    Pose2 drifted;
    for (int i = 0; i <= kLoopFrames; ++i) {
      const double turn_rad = 2.0 * kPi * i / kLoopFrames;
      truth.push_back({3.0 + 0.8 * std::cos(turn_rad), 1.5 + 0.8 * std::sin(turn_rad),
                       WrapAngle(turn_rad + 0.5 * kPi)});
      const PlanarLaser laser{.beams = 160, .sigma_of_range = 0.005};
      const auto scan = std::make_shared<const Scan>(
          ScanOf(room, truth.back(), laser, 3, static_cast<std::uint32_t>(i)));
      MappedFrame frame;
      frame.frame = i;
      frame.stamp_s = i / 30.0;
      frame.scan = archive.Keep(*scan);
      if (i > 0) {
        frame.slam_motion =
            Between(truth[static_cast<std::size_t>(i) - 1], truth.back()) * Pose2{3e-4, 5e-4, 4e-4};
      }
      drifted = i == 0 ? truth[0] : drifted * *frame.slam_motion;
      frame.map_from_base = drifted;
      frames.push_back(frame);
      map.Insert(scan, drifted, Eigen::Matrix3d::Zero());
    }
  }
  PlanarLoop TrueLoop() const {
    PlanarLoop loop;
    loop.first = 0;
    loop.second = kLoopFrames;
    loop.first_from_second = Between(truth.front(), truth.back());
    return loop;
  }
};

double ErrorAtM(const std::vector<Pose2>& poses, const std::vector<Pose2>& truth, std::size_t i) {
  return Between(truth[i], poses[i]).translation().norm();
}

// How well poses are known is told only where what was seen was looked at.
TEST(LoopEffort, AdjustingTellsWhatIsLeftOfTheErrors) {
  DriftingRound round;
  const std::vector<int> asked = {0, kLoopFrames / 2, kLoopFrames};
  EXPECT_EQ(round.map.Adjust(round.frames, {}, AdjustEffort::kBend, asked).covariance.size(), 0);
  const Eigen::MatrixXd left =
      round.map.Adjust(round.frames, {}, AdjustEffort::kCloseLoops, asked).covariance;
  ASSERT_EQ(left.rows(), 9);
  ASSERT_EQ(left.cols(), 9);
  EXPECT_LT(left.diagonal().head<3>().maxCoeff(), 1e-10);  // the first is held
  EXPECT_GT(left.diagonal().tail<6>().minCoeff(), 1e-10);
  EXPECT_TRUE(left.isApprox(left.transpose(), 1e-12));
}

TEST(LoopEffort, BendingLaysTheEndsOverEachOtherAndSpreadsTheRest) {
  DriftingRound round;
  const auto bent = round.map.Adjust(round.frames, {round.TrueLoop()}, AdjustEffort::kBend, {});
  ASSERT_EQ(bent.map_from_base.size(), round.frames.size());
  EXPECT_EQ(bent.loop_accepted, std::vector<bool>{true});
  const double before_m =
      Between(round.truth.back(), round.frames.back().map_from_base).translation().norm();
  EXPECT_GT(before_m, 0.05);
  EXPECT_LT(ErrorAtM(bent.map_from_base, round.truth, kLoopFrames), 0.02);
  for (std::size_t i = 1; i < round.frames.size(); ++i) {
    const Pose2 was = Between(round.frames[i - 1].map_from_base, round.frames[i].map_from_base);
    const Pose2 is = Between(bent.map_from_base[i - 1], bent.map_from_base[i]);
    EXPECT_LT(Between(was, is).translation().norm(), 0.02) << i;
  }
  // Looking at what was seen as well is better in the middle of the way.
  const auto adjusted =
      round.map.Adjust(round.frames, {round.TrueLoop()}, AdjustEffort::kCloseLoops, {});
  EXPECT_LT(ErrorAtM(adjusted.map_from_base, round.truth, kLoopFrames / 2),
            ErrorAtM(bent.map_from_base, round.truth, kLoopFrames / 2));
}

// A frame whose place was well seen moves with one of the first round: a loop to that one asks for
// nothing that could be done, and says nothing of the other loops.
template <typename Map>
void ExpectLoopsOfTiedFramesLeftOut(DriftingRound& round, Map& map) {
  constexpr int kTied = kLoopFrames - 5, kTiedTo = 5;
  round.frames[kTied].tied_to = kTiedTo;
  PlanarLoop asks_nothing;
  asks_nothing.first = kTiedTo;
  asks_nothing.second = kTied;
  asks_nothing.first_from_second = Between(round.truth[kTiedTo], round.truth[kTied]);
  LoopCloser closer({});
  const LoopCloser::Outcome none =
      closer.Add({asks_nothing}, round.frames, AdjustEffort::kCloseLoops, map, {});
  EXPECT_FALSE(none.adjusted);
  EXPECT_EQ(none.rejected, 1);
  const LoopCloser::Outcome one = closer.Add({asks_nothing, round.TrueLoop()}, round.frames,
                                             AdjustEffort::kCloseLoops, map, {});
  EXPECT_TRUE(one.adjusted);
  EXPECT_EQ(one.accepted, 1);
  EXPECT_EQ(one.rejected, 1);
  EXPECT_EQ(closer.loops().size(), 1U);
}

TEST(LoopEffort, LoopsOfFramesThatMoveAsOneAreLeftOut) {
  DriftingRound round;
  ExpectLoopsOfTiedFramesLeftOut(round, round.map);
  PaperReference paper({}, {}, {}, {});
  for (const MappedFrame& frame : round.frames) {
    paper.Insert(std::make_shared<const Scan>(*frame.scan), frame.map_from_base, {});
  }
  ExpectLoopsOfTiedFramesLeftOut(round, paper);
}

TEST(LoopEffort, ALongRunIsBent) {
  DriftingRound round;
  const auto poses_with = [&](int bend_frames) {
    LoopOptions options;
    options.bend_frames = bend_frames;
    LoopCloser closer(options);
    const LoopCloser::Outcome outcome =
        closer.Add({round.TrueLoop()}, round.frames, AdjustEffort::kCloseLoops, round.map, {});
    EXPECT_TRUE(outcome.adjusted);
    return outcome.map_from_base;
  };
  const auto loop = round.TrueLoop();
  EXPECT_EQ(poses_with(kLoopFrames),
            round.map.Adjust(round.frames, {loop}, AdjustEffort::kBend, {}).map_from_base);
  EXPECT_EQ(poses_with(kLoopFrames + 1),
            round.map.Adjust(round.frames, {loop}, AdjustEffort::kCloseLoops, {}).map_from_base);
}

// Where the map is right already nothing has to be found from half a metre away.
TEST(LoopEffort, LoopsThatMoveLittleAreAdjustedLikeNone) {
  const auto poses_by = [](double little_m, AdjustEffort effort) {
    SurfelOptions options;
    options.joint.little_m = little_m;
    DriftingRound round(options);
    return round.map.Adjust(round.frames, {round.TrueLoop()}, effort, {}).map_from_base;
  };
  const auto refined = poses_by(0.0, AdjustEffort::kRefine);
  const auto closed = poses_by(0.0, AdjustEffort::kCloseLoops);
  EXPECT_NE(refined, closed);
  // The loop moves the last pose by what it drifted.
  DriftingRound round;
  const auto bent = round.map.Adjust(round.frames, {round.TrueLoop()}, AdjustEffort::kBend, {});
  const double moved_m = Between(round.frames.back().map_from_base, bent.map_from_base.back())
                             .vector()
                             .cwiseQuotient(kMotionUnit)
                             .norm();
  EXPECT_EQ(poses_by(0.9 * moved_m, AdjustEffort::kCloseLoops), closed);
  EXPECT_EQ(poses_by(2.0 * moved_m, AdjustEffort::kCloseLoops), refined);
}

}  // namespace
}  // namespace depthgrid
