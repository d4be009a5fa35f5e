#include "mapper/scan/moving_objects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr double kStepM = 0.02;
constexpr double kAfterM = 0.12;

// A room 8 m long, and a post of .4 m in it.
Scan ScanOfRoom(const Pose2& world_from_base, const Eigen::Vector2d& post_m) {
  PlanarWorld world = RectangleWorld(-1.0, -2.5, 7.0, 2.5);
  const double x = post_m.x(), y = post_m.y();
  for (const Wall& side : RectangleWorld(x - 0.2, y - 0.2, x + 0.2, y + 0.2)) world.push_back(side);
  return ScanOf(world, world_from_base, {});
}

// How many beams of a scan hit the post, and how many of what is left of it do.
struct Seen {
  int beams = 0;
  int left = 0;
};

int HitsNear(const Scan& scan, const Eigen::Vector2d& at_m) {
  int hits = 0;
  for (const Beam& beam : scan.beams) hits += beam.hit && (EndPoint(beam) - at_m).norm() < 0.4;
  return hits;
}

FrameScans After(MovingObjects& moving, const std::shared_ptr<const Scan>& scan,
                 const Pose2& slam_from_base, int epoch, int frame = 0) {
  moving.Follow(frame, *scan, slam_from_base, epoch);
  FrameScans scans{scan, scan};
  moving.TakeOut(scans);
  return scans;
}

Seen Follow(MovingObjects& moving, const Pose2& world_from_base, const Pose2& slam_from_base,
            const Eigen::Vector2d& post_m, int epoch = 0) {
  const auto scan = std::make_shared<const Scan>(ScanOfRoom(world_from_base, post_m));
  const Eigen::Vector2d in_view_m = Inverse(world_from_base) * post_m;
  return {HitsNear(*scan, in_view_m),
          HitsNear(*After(moving, scan, slam_from_base, epoch).matched, in_view_m)};
}

Pose2 At(int step) { return {kStepM * step, 0.0, 0.0}; }

TEST(MovingObjects, WhoWalksOnAheadIsNeverMatched) {
  MovingObjects moving(kAfterM);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = At(i);
    const Seen seen = Follow(moving, pose, pose, pose * Eigen::Vector2d(1.5, 0.0));
    ASSERT_GT(seen.beams, 100);
    EXPECT_EQ(seen.left, 0) << i;
  }
}

// It is known to stand once it came nearer by .12 m.
TEST(MovingObjects, WhatStandsIsMatchedOnceItIsSeenToStand) {
  MovingObjects moving(kAfterM);
  for (int i = 0; i < 60; ++i) {
    const Seen seen = Follow(moving, At(i), At(i), {2.5, 0.1});
    ASSERT_GT(seen.beams, 50);
    EXPECT_EQ(seen.left, i * kStepM < kAfterM - 1e-9 ? 0 : seen.beams) << i;
  }
}

TEST(MovingObjects, ATurnShowsAsWellWhatStands) {
  MovingObjects moving(kAfterM);
  Seen last;
  for (int i = 0; i < 12; ++i) {
    const Pose2 pose{0.0, 0.0, RadFromDeg(1.0) * i};
    last = Follow(moving, pose, pose, {2.0, 0.1});
  }
  EXPECT_GT(last.beams, 50);
  EXPECT_EQ(last.left, last.beams);
}

// It stood, then walks off as fast as the camera comes after.
TEST(MovingObjects, WhoStartsToWalkIsLeftOutFromThenOn) {
  MovingObjects moving(kAfterM);
  int last_left = 0, first_left_out = 0;
  for (int i = 0; i < 100; ++i) {
    const double post_x_m = 2.0 + kStepM * std::max(0, i - 30);
    const Seen seen = Follow(moving, At(i), At(i), {post_x_m, 0.0});
    if (i > 30 && seen.left == 0 && first_left_out == 0) first_left_out = i;
    if (seen.left > 0) last_left = i;
  }
  EXPECT_GT(first_left_out, 30);
  EXPECT_LE(first_left_out, 30 + 2.5 * kAfterM / kStepM);
  EXPECT_LT(last_left, first_left_out);
}

// It is hidden for five scans: too short a time to begin anew.
TEST(MovingObjects, WhatStoodIsKnownAgain) {
  MovingObjects moving(kAfterM);
  for (int i = 0; i < 40; ++i) {
    const bool hidden = i >= 30 && i < 35;
    const Seen seen = Follow(moving, At(i), At(i), {2.5, hidden ? 9.0 : 0.1});
    if (i >= 10 && !hidden) {
      EXPECT_GT(seen.left, 50) << i;
    }
  }
}

// Longer, and it may be another thing.
TEST(MovingObjects, WhatWasHiddenForLongIsJudgedAnew) {
  MovingObjects moving(kAfterM);
  Seen seen;
  for (int i = 0; i < 38; ++i) {
    seen = Follow(moving, At(i), At(i), {2.5, i >= 30 && i < 37 ? 9.0 : 0.1});
  }
  ASSERT_GT(seen.beams, 50);
  EXPECT_EQ(seen.left, 0);
}

TEST(MovingObjects, NothingIsComparedFromOneEpochToAnother) {
  for (const Pose2& elsewhere : {Pose2{40.0, -7.0, 2.0}, Pose2{0.05, 0.03, 0.0}}) {
    MovingObjects moving(kAfterM);
    Seen seen;
    for (int i = 0; i < 20; ++i) seen = Follow(moving, At(i), At(i), {2.5, 0.1});
    EXPECT_EQ(seen.left, seen.beams);
    EXPECT_EQ(Follow(moving, At(20), elsewhere * At(20), {2.5, 0.1}, 1).left, 0);  // not judged yet
    for (int i = 21; i < 40; ++i) seen = Follow(moving, At(i), elsewhere * At(i), {2.5, 0.1}, 1);
    EXPECT_EQ(seen.left, seen.beams);
  }
}

// Nothing tells that it stands, but without it hardly anything is seen.
TEST(MovingObjects, WhatIsHalfOfTheViewIsMatchedUntilItIsJudged) {
  MovingObjects moving(kAfterM);
  const auto scan = [](double ahead_m) {
    Scan seen;
    seen.max_range_m = 6.0;
    for (int i = -50; i < 50; ++i) {
      Beam beam{.bearing_rad = 0.01F * static_cast<float>(i)};
      beam.hit = std::abs(i) < 20 || i < -40;
      beam.range_m = static_cast<float>(std::abs(i) < 20 ? ahead_m : 5.0);
      seen.beams.push_back(beam);
    }
    return std::make_shared<const Scan>(seen);
  };
  const FrameScans first = After(moving, scan(1.0), At(0), 0);
  EXPECT_EQ(HitsNear(*first.matched, {1.0, 0.0}), 39);
  EXPECT_EQ(first.kept(), first.matched);  // it says where the map lies
  for (int i = 1; i < 6; ++i) After(moving, scan(1.0), At(i), 0);
  EXPECT_EQ(HitsNear(*After(moving, scan(1.0), At(7), 0).matched, {1.0, 0.0}), 0);

  MovingObjects later(kAfterM);
  After(later, scan(5.0), At(0), 0);
  const FrameScans second = After(later, scan(1.0), At(1), 0);
  EXPECT_EQ(HitsNear(*second.matched, {1.0, 0.0}), 39);
  EXPECT_EQ(HitsNear(*second.kept(), {1.0, 0.0}), 0);
}

// Of who walks on .5 m ahead the sensor's least range loses the middle, but for a few beams.
TEST(MovingObjects, WhatTheLeastRangeLeavesBesideWhoMovesIsLeftOut) {
  Scan seen;
  seen.max_range_m = 6.0;
  for (int i = -50; i < 50; ++i) {
    Beam beam{.bearing_rad = 0.01F * static_cast<float>(i), .range_m = 5.0F, .hit = true};
    if (std::abs(i) <= 20) beam.range_m = 0.5F;
    if (i > -10 && i <= 20 && i != 4 && i != 5) beam.hit = false;  // says nothing
    seen.beams.push_back(beam);
  }
  const auto scan = std::make_shared<const Scan>(seen);
  MovingObjects moving(kAfterM);
  for (int i = 0; i < 5; ++i) After(moving, scan, At(i), 0);
  EXPECT_EQ(HitsNear(*scan, {0.5, 0.0}), 13);
  const FrameScans after = After(moving, scan, At(8), 0);
  EXPECT_EQ(HitsNear(*after.matched, {0.5, 0.0}), 0);
  EXPECT_EQ(HitsNear(*after.matched, {5.0, 0.0}), HitsNear(*scan, {5.0, 0.0}));
}

TEST(MovingObjects, ZeroFollowsNothing) {
  MovingObjects moving(0.0);
  const auto scan = std::make_shared<const Scan>(ScanOfRoom({}, {1.5, 0.0}));
  const FrameScans scans = After(moving, scan, {}, 0);
  EXPECT_EQ(scans.matched, scan);
  EXPECT_EQ(scans.kept(), scan);
}

// 58 degrees of the room, with a post that the edge of the view cuts.
FrameScans FollowCut(MovingObjects& moving, const Pose2& pose, const Eigen::Vector2d& post_m,
                     Seen* matched, Seen* kept, int frame = 0) {
  Scan scan = ScanOfRoom(pose, post_m);
  std::erase_if(scan.beams, [](const Beam& beam) {
    return std::abs(beam.bearing_rad) > static_cast<float>(RadFromDeg(29.0));
  });
  const auto seen = std::make_shared<const Scan>(scan);
  FrameScans scans = After(moving, seen, pose, 0, frame);
  const Eigen::Vector2d in_view_m = Inverse(pose) * post_m;
  const int beams = HitsNear(*seen, in_view_m);
  *matched = {beams, HitsNear(*scans.matched, in_view_m)};
  *kept = {beams, HitsNear(*scans.kept(), in_view_m)};
  return scans;
}

// Who comes in at the edge and walks on there is never kept, and matched until they are known to
// move, after .12 m.
TEST(MovingObjects, WhoIsCutByTheEdgeOfTheViewIsNeverKept) {
  for (const double side : {-1.0, 1.0}) {
    MovingObjects moving(kAfterM);
    Seen matched, kept;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d at_m =
          i < 10 ? Eigen::Vector2d(0.0, 9.0) : Eigen::Vector2d(1.4, 0.75 * side);
      FollowCut(moving, At(100 + i), At(100 + i) * at_m, &matched, &kept);
      if (i < 10) continue;
      ASSERT_GT(matched.beams, 40);
      EXPECT_EQ(kept.left, 0) << i;
      if (i != 16) {
        EXPECT_EQ(matched.left, i < 16 ? matched.beams : 0) << i;
      }
    }
  }
}

// From the free middle of the view into its edge and back.
TEST(MovingObjects, WhoMovesIsKnownAgainAtTheEdge) {
  MovingObjects moving(kAfterM);
  Seen matched, kept;
  for (int i = 0; i < 120; ++i) {
    const double aside_m = 0.7 * std::sin(0.05 * i);
    FollowCut(moving, At(100 + i), At(100 + i) * Eigen::Vector2d(1.4, aside_m), &matched, &kept);
    ASSERT_GT(matched.beams, 40) << i;
    EXPECT_LE(matched.left, 1) << i;  // of the wall beside
    EXPECT_LE(kept.left, 1) << i;
  }
}

// Who comes so near to a wall that they are one piece with it is left out there too, for a second.
TEST(MovingObjects, WhoMovesIsLeftOutBesideAWallToo) {
  MovingObjects moving(kAfterM);
  Seen matched, kept;
  int beside = 0;
  for (int i = 0; i < 60; ++i) {
    // To the wall on the right and along it.
    const double y_m = std::max(-2.2, -1.0 - 0.03 * i);
    FollowCut(moving, {3.0 + kStepM * i, -1.0, -0.6}, {4.5 + kStepM * i, y_m}, &matched, &kept);
    ASSERT_GT(matched.beams, 20) << i;
    beside += y_m <= -2.2 ? 1 : 0;
    if (i < 10 || beside > 20) continue;
    EXPECT_LT(kept.left, matched.beams / 3) << i;
  }
  EXPECT_GT(beside, 10);
}

// Half of who walks behind a scanner that sees all round is among its first beams, half among its
// last: the scan is not lost for that.
TEST(MovingObjects, WhoMovesBehindHidesNotTheWholeView) {
  MovingObjects moving(kAfterM);
  const PlanarLaser round{.beams = 720, .field_of_view_rad = 2.0 * kPi};
  for (int i = 0; i < 80; ++i) {
    const Pose2 pose{2.0 + kStepM * i, 0.0, 0.0};
    const double aside_m = i < 40 ? 0.5 : std::max(0.0, 0.5 - 0.05 * (i - 40));
    const double x = pose.x_m - 1.0;
    PlanarWorld world = RectangleWorld(-1.0, -2.5, 7.0, 2.5);
    for (const Wall& side : RectangleWorld(x - 0.2, aside_m - 0.2, x + 0.2, aside_m + 0.2)) {
      world.push_back(side);
    }
    const auto scan = std::make_shared<const Scan>(ScanOf(world, pose, round));
    const FrameScans scans = After(moving, scan, pose, 0);
    const auto hits = [](const Scan& of) {
      return std::count_if(of.beams.begin(), of.beams.end(), [](const Beam& b) { return b.hit; });
    };
    EXPECT_GT(hits(*scans.kept()), hits(*scan) / 2) << i;
  }
}

// Most of what the edge cuts is a wall that leaves the view; in the first scan nothing is doubted.
TEST(MovingObjects, WhatStandsAtTheEdgeIsKept) {
  MovingObjects moving(kAfterM);
  Seen matched, kept;
  for (int i = 0; i < 30; ++i) {
    FollowCut(moving, At(100 + i), {3.6, 0.8}, &matched, &kept);
    EXPECT_EQ(matched.left, matched.beams) << i;
    EXPECT_EQ(kept.left, kept.beams) << i;
  }
}

// Those whom the first scan cuts are told once, when they were judged to move five times.
TEST(MovingObjects, WhatWasTakenToStandAndMovesIsTold) {
  for (const bool walks : {true, false}) {
    MovingObjects moving(kAfterM);
    Seen matched, kept;
    int told = 0;
    for (int i = 0; i < 60; ++i) {
      const Pose2 pose = At(100 + i);
      const Eigen::Vector2d at_m(1.4, 0.75);
      FollowCut(moving, pose, walks ? pose * at_m : At(100) * at_m, &matched, &kept, i);
      const auto mistaken = moving.TakeMistaken();
      told += static_cast<int>(mistaken.size());
      if (i == 0) {
        EXPECT_TRUE(moving.MayBeMistaken());
      }
      for (const std::vector<MovingObjects::Sector>& object : mistaken) {
        EXPECT_NEAR(i * kStepM, 5.0 * kAfterM, kStepM + 1e-9);
        ASSERT_EQ(object.size(), static_cast<std::size_t>(i));
        EXPECT_EQ(object.front().frame, 0);
        EXPECT_EQ(object.back().frame, i - 1);
        EXPECT_GT(object.front().last_rad - object.front().first_rad, 0.1F);
      }
    }
    EXPECT_EQ(told, walks ? 1 : 0);
    EXPECT_FALSE(moving.MayBeMistaken());
  }
}

// SLAM's way is 5 % too long. Somebody walks on beside the robot's axis.
double ErrorBehindSomebodyM(const MapperOptions& options, const Eigen::Vector2d& ahead_m,
                            const PlanarLaser& laser) {
  IncrementalMapper mapper(options, {});
  double error_m = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = At(i);
    PlanarWorld world = RectangleWorld(-1.0, -2.5, 5.0, 2.5);
    const Eigen::Vector2d at_m = pose * ahead_m;
    for (const Wall& side :
         RectangleWorld(at_m.x() - 0.2, at_m.y() - 0.3, at_m.x() + 0.2, at_m.y() + 0.3)) {
      world.push_back(side);
    }
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan =
        std::make_shared<const Scan>(ScanOf(world, pose, laser, 3, static_cast<std::uint32_t>(i)));
    frame.slam_from_camera = CameraOf({1.05 * pose.x_m, 0.0, 0.0}, 1.0);
    const FrameReport report = mapper.AddFrame(frame);
    error_m = (BaseOf(*report.map_from_camera).translation() - pose.translation()).norm();
  }
  return error_m;
}

// 1.5 m ahead they take up a third of the view.
TEST(MovingObjects, TheMapIsNotCarriedAlong) {
  const auto error_m = [](double moving_m) {
    MapperOptions options;
    options.surfel.moving_m = moving_m;
    // Which alone keeps most of it (MovingMisfits).
    options.surfel.match.judge_moving = moving_m > 0.0;
    return ErrorBehindSomebodyM(options, {1.5, 0.0}, {.sigma_of_range = 0.01});
  };
  EXPECT_GT(error_m(0.0), 0.5);
  EXPECT_LT(error_m(kAfterM), 0.03);
}

// They are drawn with the first scan, and matched for .12 m. Once they are seen to move for sure
// the first frames are mapped without them, whatever is learnt of SLAM.
TEST(MovingObjects, WhoIsInTheFirstScanIsTakenOutOfTheFirstFrames) {
  const PlanarLaser laser{
      .beams = 320, .field_of_view_rad = RadFromDeg(58.0), .sigma_of_range = 0.01};
  MapperOptions options;
  EXPECT_LT(ErrorBehindSomebodyM(options, {1.2, 0.7}, laser), 0.01);  // else .030
  options.fusion.mode = FusionMode::kFixed;
  EXPECT_LT(ErrorBehindSomebodyM(options, {1.2, 0.7}, laser), 0.015);  // else .020
}

}  // namespace
}  // namespace depthgrid
