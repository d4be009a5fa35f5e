#include "mapper/scan/floor_tracker.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "mapper/scan/frame_scans.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

// Small, so that rendering is quick; the field of view of ICL-NUIM's.
PinholeCamera SmallCamera() { return {160, 120, 120.3, 120.0, 79.5, 59.5, {}}; }

AnalyticRoom RoomWithTable() {
  AnalyticRoom room;
  room.walls = {{-3.0, -6.0, 0.0}, {4.0, 6.0, 2.5}};
  room.boxes = {{{1.5, -1.0, 0.0}, {2.5, -0.2, 0.45}}};
  return room;
}

// The same with one that hides all of the floor.
AnalyticRoom RoomUnderTable() {
  AnalyticRoom room = RoomWithTable();
  room.boxes = {{{-3.0, -6.0, 0.0}, {3.9, 6.0, 0.45}}};
  return room;
}

DepthImage WithFloorNoise(DepthImage image, RandomStream& random, double sigma_at_1_m = 0.002) {
  for (float& z_m : image.z_m) {
    z_m += static_cast<float>(sigma_at_1_m * z_m * z_m * random.Normal());
  }
  return image;
}

double TiltErrorDeg(const CameraStand& stand, const Pose3& truth) {
  const Eigen::Vector3d up =
      stand.level_from_camera * (LevelFromCamera(truth).conjugate() * Eigen::Vector3d::UnitZ());
  return DegFromRad(std::acos(std::min(1.0, up.z())));
}

TEST(FloorTracker, HeightAndTiltOfTheFloorOutweighSlamsDrift) {
  const PinholeCamera camera = SmallCamera();
  RandomStream random(5, RandomStage::kTest);
  for (const double pitch_deg : {5.0, 15.0, 30.0}) {
    FloorTracker tracker(camera, {});
    const Pose3 truth = TiltedCamera({}, kCameraHeightM, RadFromDeg(pitch_deg), RadFromDeg(4.0));
    const DepthImage image = WithFloorNoise(RoomWithTable().Render(camera, truth), random);
    // 40 cm of height and 4 degrees of tilt, a little more each frame.
    for (int frame = 0; frame <= 40; ++frame) {
      Pose3 drifted = truth;
      drifted.translation.z() += 0.01 * frame;
      drifted.rotation =
          ExpRotation(RadFromDeg(0.1 * frame) * Eigen::Vector3d(0.6, 0.8, 0.0)) * drifted.rotation;
      const CameraStand stand = tracker.Follow(image, drifted, 0);
      EXPECT_NEAR(stand.height_m, kCameraHeightM, 0.01) << pitch_deg << " " << frame;
      EXPECT_LT(TiltErrorDeg(stand, truth), 0.5) << pitch_deg << " " << frame;
    }
  }
}

TEST(FloorTracker, WhereNoFloorIsSeenThePoseCounts) {
  const PinholeCamera camera = SmallCamera();
  // Walls and ceiling only: nothing level lies below the camera.
  for (const double pitch_deg : {-15.0, -25.0, -40.0}) {
    const Pose3 pose = TiltedCamera({-1.5, 0.3, 0.1}, kCameraHeightM, RadFromDeg(pitch_deg), 0.1);
    const DepthImage image = AnalyticRoom{}.Render(camera, pose);
    const CameraStand stand = FloorTracker(camera, {}).Follow(image, pose, 0);
    EXPECT_EQ(stand.height_m, kCameraHeightM) << pitch_deg;
    EXPECT_NEAR(TiltErrorDeg(stand, pose), 0.0, 1e-5) << pitch_deg;
  }
  // A wall that ends at the image's edge, 17 cm above the floor.
  AnalyticRoom near_wall;
  near_wall.walls = {{-3.0, -6.0, 0.0}, {2.5, 6.0, 2.5}};
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(-5.0), 0.0);
  const CameraStand stand =
      FloorTracker(camera, {}).Follow(near_wall.Render(camera, pose), pose, 0);
  EXPECT_EQ(stand.height_m, kCameraHeightM);
}

TEST(FloorTracker, AFloorThatIsLostFromViewIsCarriedOn) {
  const PinholeCamera camera = SmallCamera();
  FloorTracker tracker(camera, {});
  const Pose3 down = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  const Pose3 up = TiltedCamera({}, kCameraHeightM + 0.05, RadFromDeg(-20.0), 0.0);
  // SLAM's z is off by 30 cm all along.
  const auto off = [](Pose3 pose) {
    pose.translation.z() += 0.3;
    return pose;
  };
  tracker.Follow(RoomWithTable().Render(camera, down), off(down), 0);
  const CameraStand stand = tracker.Follow(RoomWithTable().Render(camera, up), off(up), 0);
  EXPECT_NEAR(stand.height_m, kCameraHeightM + 0.05, 0.005);
  // In a new epoch SLAM has corrected itself; the camera did not move for that.
  EXPECT_NEAR(tracker.Follow(RoomWithTable().Render(camera, up), up, 1).height_m,
              kCameraHeightM + 0.05, 0.005);
}

// A second in which the camera looks up and SLAM, which was seen to drift in height or tilt, goes
// on to by more than a surface may be off to be the floor: when the floor comes back, it is not an
// obstacle for the next two seconds.
TEST(FloorTracker, WhatSlamDriftsMeanwhileIsMadeGoodAtOnce) {
  const PinholeCamera camera = SmallCamera();
  const Pose3 down = TiltedCamera({}, kCameraHeightM, RadFromDeg(5.0), 0.0);
  const Pose3 up = TiltedCamera({}, kCameraHeightM, RadFromDeg(-30.0), 0.0);
  const DepthImage floor = RoomWithTable().Render(camera, down);
  const DepthImage ceiling = RoomWithTable().Render(camera, up);
  struct Drift {
    double height_m, tilt_deg;
  };
  for (const Drift& drift : {Drift{0.25, 0.0}, {-0.25, 0.0}, {0.02, 4.0}, {0.02, -3.0}}) {
    FloorTracker tracker(camera, {});
    const auto drifted = [&](Pose3 pose, double share) {
      pose.translation.z() += drift.height_m * share;
      const Eigen::Vector3d turn(0.0, RadFromDeg(drift.tilt_deg) * share, 0.0);
      pose.rotation = ExpRotation(turn) * pose.rotation;
      return pose;
    };
    for (int frame = 0; frame <= 60; ++frame) tracker.Follow(floor, drifted(down, frame / 30.0), 0);
    for (int frame = 61; frame <= 90; ++frame)
      tracker.Follow(ceiling, drifted(up, frame / 30.0), 0);
    // It is also looked for anew in every fourth frame.
    for (int frame = 0; frame < 3; ++frame) tracker.Follow(floor, drifted(down, 3.0), 0);
    const CameraStand stand = tracker.Follow(floor, drifted(down, 3.0), 0);
    EXPECT_NEAR(stand.height_m, kCameraHeightM, 0.02) << drift.height_m << " " << drift.tilt_deg;
    EXPECT_LT(TiltErrorDeg(stand, down), 1.0) << drift.height_m << " " << drift.tilt_deg;
  }
}

// SLAM is right, and what is in view after a second of looking up is a bench as high as the camera
// was lifted by meanwhile.
TEST(FloorTracker, ABenchIsNotTheFloorOfALiftedCamera) {
  const PinholeCamera camera = SmallCamera();
  constexpr double kBenchM = 0.35;
  FloorTracker tracker(camera, {});
  AnalyticRoom benches = RoomWithTable();
  benches.boxes = {{{-3.0, -6.0, 0.0}, {3.9, 6.0, kBenchM}}};
  const auto pose = [](double lifted_m, double pitch_deg) {
    return TiltedCamera({}, kCameraHeightM + lifted_m, RadFromDeg(pitch_deg), 0.0);
  };
  const DepthImage floor = RoomWithTable().Render(camera, pose(0.0, 15.0));
  for (int frame = 0; frame < 90; ++frame) tracker.Follow(floor, pose(0.0, 15.0), 0);
  const DepthImage ceiling = RoomWithTable().Render(camera, pose(kBenchM, -30.0));
  for (int frame = 1; frame <= 30; ++frame) {
    tracker.Follow(ceiling, pose(kBenchM * frame / 30.0, -30.0), 0);
  }
  const DepthImage bench = benches.Render(camera, pose(kBenchM, 15.0));
  for (int frame = 0; frame < 50; ++frame) {
    const double height_m = tracker.Follow(bench, pose(kBenchM, 15.0), 0).height_m;
    ASSERT_NEAR(height_m, kCameraHeightM + kBenchM, 0.01) << frame;
  }
}

// Whether the way to it is in view or not: a robot at the top of a step stays on its own floor.
TEST(FloorTracker, ALowerFloorAheadIsNotTheFloor) {
  const PinholeCamera camera = SmallCamera();
  constexpr double kEdgeM = 1.5;
  for (const double lower_m : {0.16, 0.32, 0.6}) {
    AnalyticRoom room;
    room.walls = {{-3.0, -6.0, -lower_m}, {6.0, 6.0, 2.5}};
    room.boxes = {{{-3.0, -6.0, -lower_m}, {kEdgeM, 6.0, 0.0}}};
    FloorTracker tracker(camera, {});
    for (int frame = 0; frame < 160; ++frame) {
      const double x_m = std::min(-2.5 + 0.03 * frame, kEdgeM - 0.3);
      const Pose3 pose = TiltedCamera({x_m, 0.0, 0.0}, kCameraHeightM, RadFromDeg(15.0), 0.0);
      const CameraStand stand = tracker.Follow(room.Render(camera, pose), pose, 0);
      ASSERT_NEAR(stand.height_m, kCameraHeightM, 0.01) << lower_m << " " << frame;
      ASSERT_LT(TiltErrorDeg(stand, pose), 0.3) << lower_m << " " << frame;
    }
  }
}

// A plane from the top of a rug that fills half of the view to the floor behind it has points of
// both near it.
TEST(FloorTracker, NoPlaneLeadsFromARugToTheFloorBehindIt) {
  const PinholeCamera camera = SmallCamera();
  RandomStream random(11, RandomStage::kTest);
  for (const double thick_m : {0.08, 0.12}) {
    AnalyticRoom room = RoomWithTable();
    room.boxes = {{{0.5, -2.0, 0.0}, {2.6, 1.0, thick_m}}};
    const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
    const DepthImage exact = room.Render(camera, pose);
    FloorTracker tracker(camera, {});
    for (int frame = 0; frame < 60; ++frame) {
      const CameraStand stand = tracker.Follow(WithFloorNoise(exact, random), pose, 0);
      ASSERT_NEAR(stand.height_m, kCameraHeightM, 0.015) << thick_m << " " << frame;
      ASSERT_LT(TiltErrorDeg(stand, pose), 0.4) << thick_m << " " << frame;
    }
  }
}

TEST(FloorTracker, ATableThatHidesTheFloorIsNotTheFloor) {
  const PinholeCamera camera = SmallCamera();
  FloorTracker tracker(camera, {});
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  const DepthImage hidden = RoomUnderTable().Render(camera, pose);
  // Neither at the first sight, as the pose says how high the camera is, nor later.
  EXPECT_EQ(tracker.Follow(hidden, pose, 0).height_m, kCameraHeightM);
  const DepthImage seen = RoomWithTable().Render(camera, pose);
  EXPECT_NEAR(tracker.Follow(seen, pose, 0).height_m, kCameraHeightM, 0.005);
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_NEAR(tracker.Follow(hidden, pose, 0).height_m, kCameraHeightM, 0.005) << frame;
  }
  // A pose whose z says nothing of heights leaves only the image.
  Pose3 from_zero = pose;
  from_zero.translation.z() = 0.0;
  EXPECT_NEAR(FloorTracker(camera, {}).Follow(seen, from_zero, 0).height_m, kCameraHeightM, 0.005);
}

// Ten seconds in front of it; after twenty it is believed, since the floor may have been mistaken.
TEST(FloorTracker, ATableThatStaysInViewIsNotTheFloor) {
  const PinholeCamera camera = SmallCamera();
  FloorTracker tracker(camera, {});
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  const DepthImage hidden = RoomUnderTable().Render(camera, pose);
  tracker.Follow(RoomWithTable().Render(camera, pose), pose, 0);
  for (int frame = 0; frame < 300; ++frame) {
    ASSERT_NEAR(tracker.Follow(hidden, pose, 0).height_m, kCameraHeightM, 0.005) << frame;
  }
  double height_m = 0.0;
  for (int frame = 0; frame < 300; ++frame) height_m = tracker.Follow(hidden, pose, 0).height_m;
  EXPECT_NEAR(height_m, kCameraHeightM - 0.45, 0.005);
}

// The plane along the edges of steps has more points than the rest of the floor, but the camera is
// not as high above it as SLAM, right for three seconds, says.
TEST(FloorTracker, NoPlaneLeadsFromTheFloorUpSteps) {
  const PinholeCamera camera = SmallCamera();
  RandomStream random(12, RandomStage::kTest);
  AnalyticRoom room;
  room.walls = {{-3.0, -6.0, 0.0}, {2.7, 6.0, 2.5}};
  AnalyticRoom steps = room;  // three that rise towards the camera
  steps.boxes = {{{1.6, -6.0, 0.0}, {2.2, 6.0, 0.05}},
                 {{1.1, -6.0, 0.0}, {1.6, 6.0, 0.1}},
                 {{0.5, -6.0, 0.0}, {1.1, 6.0, 0.15}}};
  FloorTracker tracker(camera, {});
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(20.0), 0.0);
  const DepthImage floor = room.Render(camera, pose), stepped = steps.Render(camera, pose);
  for (int frame = 0; frame < 90; ++frame) {
    tracker.Follow(WithFloorNoise(floor, random), pose, 0);
  }
  for (int frame = 0; frame < 60; ++frame) {
    const CameraStand stand = tracker.Follow(WithFloorNoise(stepped, random), pose, 0);
    ASSERT_NEAR(stand.height_m, kCameraHeightM, 0.03) << frame;
  }
}

// It was the floor until the floor was seen; in view alone again it is not.
TEST(FloorTracker, ATableIsNotGoneBackTo) {
  const PinholeCamera camera = SmallCamera();
  FloorTracker tracker(camera, {});
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  const Pose3 lower = TiltedCamera({}, kCameraHeightM - 0.3, RadFromDeg(15.0), 0.0);  // as told
  const DepthImage hidden = RoomUnderTable().Render(camera, pose);
  const DepthImage seen = RoomWithTable().Render(camera, pose);
  for (int frame = 0; frame < 90; ++frame) tracker.Follow(hidden, lower, 0);
  ASSERT_NEAR(tracker.Follow(hidden, lower, 0).height_m, kCameraHeightM - 0.45, 0.005);
  for (int frame = 0; frame < 90; ++frame) tracker.Follow(seen, lower, 0);
  for (int frame = 0; frame < 90; ++frame) {
    ASSERT_NEAR(tracker.Follow(hidden, lower, 0).height_m, kCameraHeightM, 0.005) << frame;
  }
}

TEST(FloorTracker, SlamsJumpsAreFollowedAtLast) {
  const PinholeCamera camera = SmallCamera();
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  const DepthImage image = RoomWithTable().Render(camera, pose);
  for (const double jump_m : {-0.3, 0.3}) {
    FloorTracker tracker(camera, {});
    tracker.Follow(image, pose, 0);
    Pose3 jumped = pose;
    jumped.translation.z() += jump_m;
    double height_m = 0.0;
    for (int frame = 0; frame < 70; ++frame) height_m = tracker.Follow(image, jumped, 0).height_m;
    EXPECT_NEAR(height_m, kCameraHeightM, 0.005) << jump_m;
  }
}

// In a new epoch SLAM's heights mean something else: what was seen before them does not keep the
// floor from being found where it is, within a few frames.
TEST(FloorTracker, ANewEpochBeginsAnew) {
  const PinholeCamera camera = SmallCamera();
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  FloorTracker tracker(camera, {});
  tracker.Follow(RoomWithTable().Render(camera, pose), pose, 0);
  Pose3 raised = pose;
  raised.translation.z() += 0.3;
  const DepthImage higher_up = RoomWithTable().Render(camera, raised);
  Pose3 in_new_epoch = raised;
  in_new_epoch.translation.z() += 7.0;
  for (int frame = 0; frame < 4; ++frame) tracker.Follow(higher_up, in_new_epoch, 1);
  EXPECT_NEAR(tracker.Follow(higher_up, in_new_epoch, 1).height_m, kCameraHeightM + 0.3, 0.01);
}

// Only floor farther off than 3 m is seen, of which noise leaves little, and height and tilt run
// away together: what agrees with the last frame's plane is less and less of it.
TEST(FloorTracker, ATiltThatRunsAwayIsCaught) {
  const PinholeCamera camera = SmallCamera();
  for (const double pitch_deg : {0.0, 2.0}) {
    RandomStream random(7, RandomStage::kTest);
    FloorTracker tracker(camera, {});
    const Pose3 truth = TiltedCamera({}, kCameraHeightM, RadFromDeg(pitch_deg), RadFromDeg(4.0));
    const DepthImage exact = RoomWithTable().Render(camera, truth);
    double worst_deg = 0.0;
    for (int frame = 0; frame < 120; ++frame) {
      Pose3 drifted = truth;
      drifted.translation.z() += 0.03 * frame;
      drifted.rotation =
          ExpRotation(RadFromDeg(0.1 * frame) * Eigen::Vector3d(0.6, 0.8, 0.0)) * drifted.rotation;
      const CameraStand stand = tracker.Follow(WithFloorNoise(exact, random, 0.006), drifted, 0);
      worst_deg = std::max(worst_deg, TiltErrorDeg(stand, truth));
    }
    EXPECT_LT(worst_deg, 4.0) << pitch_deg;  // of the 12 that SLAM's tilt changed by
  }
}

TEST(FloorTracker, WithHeightsFromThePoseTheImageIsNotLookedAt) {
  const PinholeCamera camera = SmallCamera();
  ScanOptions options;
  options.floor = FloorSource::kPose;
  options.floor_z_m = 0.2;
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  const CameraStand stand = FloorTracker(camera, options).Follow({}, pose, 0);
  EXPECT_DOUBLE_EQ(stand.height_m, kCameraHeightM - 0.2);
}

// Of a camera that stands still while SLAM's height and tilt drift off.
Frame DriftingFrame(int index) {
  const Pose3 truth = TiltedCamera({}, kCameraHeightM, RadFromDeg(15.0), 0.0);
  Frame frame;
  frame.index = index;
  frame.stamp_s = index / 30.0;
  frame.depth = std::make_shared<DepthImage>(RoomWithTable().Render(SmallCamera(), truth));
  frame.slam_from_camera = truth;
  frame.slam_from_camera->translation.z() += 0.01 * index;
  frame.slam_from_camera->rotation =
      ExpRotation(RadFromDeg(0.1 * index) * Eigen::Vector3d(0.6, 0.8, 0.0)) *
      frame.slam_from_camera->rotation;
  return frame;
}

// What was scanned before is mapped as its images are, height and tilt with it.
TEST(FloorTracker, ScansBringTheirStandAlong) {
  MapperOptions options;
  options.scan.floor = FloorSource::kImage;
  IncrementalMapper of_images(options, SmallCamera()), of_scans(options, SmallCamera());
  FrameScanner scanner(SmallCamera(), options.scan);
  for (int i = 0; i < 30; ++i) {
    Frame frame = DriftingFrame(i);
    of_images.AddFrame(frame);
    const FrameScans scans = scanner.ScansOf(frame);
    frame.depth.reset();
    frame.scan = std::make_shared<Scan>(*scans.obstacles);
    frame.matched_scan = std::make_shared<Scan>(*scans.matched);
    frame.stand = scans.stand;
    of_scans.AddFrame(frame);
  }
  const auto images = of_images.Finish({}).map_from_camera;
  const auto scans = of_scans.Finish({}).map_from_camera;
  EXPECT_EQ(images, scans);
  EXPECT_NEAR(images.back()->translation.z(), kCameraHeightM, 0.03);
  // A scan needs no pose, with a stand or without.
  Frame lost;
  lost.index = 30;
  lost.stamp_s = 1.0;
  lost.scan = std::make_shared<Scan>();
  lost.stand = CameraStand{};
  EXPECT_FALSE(of_scans.AddFrame(lost).map_from_camera.has_value());
}

}  // namespace
}  // namespace depthgrid
