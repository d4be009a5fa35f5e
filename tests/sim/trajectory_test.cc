#include "sim/path/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHandheld = R"(
kind: handheld
speed_mps: 0.5
turn_rate_dps: 40
closed: true
waypoints:
  - {at: [1, 1, 1.2], look_at: [4, 2, 0.5]}
  - {at: [3, 1, 1.1], look_at: [3, 5, 0.8]}
  - {at: [3, 3, 1.3], look_at: [0, 3, 1.0]}
  - {at: [1, 3, 1.2], look_at: [1, 0, 0.9]}
)";
constexpr const char* kPlanar = R"(
kind: planar
height_m: 0.6
pitch_deg: -10
waypoints: [{at: [0, 0]}, {at: [3, 0]}, {at: [3, 3]}, {at: [0, 4]}]
)";

TrajectoryOptions Options(const std::string& text) {
  return ReadTrajectoryOptions(Config::FromText(text, "scene.yaml"));
}

Trajectory AtTheBounds(const TrajectoryOptions& options, std::uint64_t seed = 1) {
  return MakeTrajectory(options, MinimumFrames(options), kFrameRateHz, seed);
}

std::string TrajectoryRefusal(const std::string& text, int frames = 5000) {
  return RefusalOf([&] { MakeTrajectory(Options(text), frames, kFrameRateHz, 1); });
}

TEST(Trajectory, KeepsWithinItsBoundsAndReachesThem) {
  for (const char* text : {kHandheld, kPlanar}) {
    const TrajectoryOptions options = Options(text);
    const Trajectory trajectory = AtTheBounds(options);
    double highest_share = 0.0;
    for (std::size_t i = 1; i < trajectory.size(); ++i) {
      const Pose3 motion =
          Between(trajectory[i - 1].world_from_camera, trajectory[i].world_from_camera);
      const double speed_mps = motion.translation.norm() * kFrameRateHz;
      const double turn_dps = DegFromRad(LogRotation(motion.rotation).norm()) * kFrameRateHz;
      EXPECT_LE(speed_mps, options.speed_mps) << text << i;
      EXPECT_LE(turn_dps, options.turn_rate_dps) << text << i;
      highest_share = std::max(
          {highest_share, speed_mps / options.speed_mps, turn_dps / options.turn_rate_dps});
    }
    EXPECT_GT(highest_share, 0.9) << text;
  }
}

// Third differences of a C2 curve shrink with the cube of the step; where its acceleration jumps,
// only with the square.
TEST(Trajectory, IsTwiceDifferentiable) {
  const TrajectoryOptions options = Options(kHandheld);
  const auto roughness = [&](int frames) {
    const Trajectory trajectory = MakeTrajectory(options, frames, kFrameRateHz, 1);
    double highest = 0.0;
    for (std::size_t i = 3; i < trajectory.size(); ++i) {
      const auto position = [&](std::size_t k) {
        return trajectory[k].world_from_camera.translation;
      };
      const auto axis = [&](std::size_t k) -> Eigen::Vector3d {
        return trajectory[k].world_from_camera.rotation * Eigen::Vector3d::UnitZ();
      };
      const auto third = [&](const auto& f) -> double {
        return (f(i) - 3.0 * f(i - 1) + 3.0 * f(i - 2) - f(i - 3)).norm();
      };
      highest = std::max({highest, third(position), third(axis)});
    }
    return highest;
  };
  EXPECT_NEAR(roughness(4001) / roughness(8001), 8.0, 1.0);
  EXPECT_NEAR(roughness(8001) / roughness(16001), 8.0, 1.0);
}

// Where a slow stretch (a tight turn) meets a fast one, speed changes over the smoothing's 0.4 s.
TEST(Trajectory, SlowsDownForTurnsWithoutJerks) {
  const TrajectoryOptions options = Options(
      "kind: planar\nspeed_mps: 0.5\nturn_rate_dps: 40\n"
      "waypoints: [{at: [0, 0]}, {at: [1, 0]}, {at: [1.2, 0.2]}, {at: [1.2, 1.2]}, {at: [1, 1.4]},"
      " {at: [0, 1.4]}]");
  const Trajectory trajectory = AtTheBounds(options);
  for (std::size_t i = 2; i < trajectory.size(); ++i) {
    const Eigen::Vector3d bend = trajectory[i].world_from_camera.translation -
                                 2.0 * trajectory[i - 1].world_from_camera.translation +
                                 trajectory[i - 2].world_from_camera.translation;
    EXPECT_LT(bend.norm() * kFrameRateHz * kFrameRateHz, 0.45) << i;  // m/s^2
  }
}

TEST(Trajectory, PassesItsWaypointsLookingWhereToldAndReturns) {
  const TrajectoryOptions options = Options(kHandheld);
  const Trajectory trajectory = AtTheBounds(options);
  for (const Waypoint& waypoint : options.waypoints) {
    const Eigen::Vector3d at(waypoint.at[0], waypoint.at[1], waypoint.at[2]);
    const Eigen::Vector3d target(waypoint.look_at[0], waypoint.look_at[1], waypoint.look_at[2]);
    double nearest_m = 1e9;
    double angle_rad = 1e9;
    for (const StampedPose& pose : trajectory) {
      const double distance_m = (pose.world_from_camera.translation - at).norm();
      if (distance_m > nearest_m) continue;
      nearest_m = distance_m;
      const Eigen::Vector3d axis = pose.world_from_camera.rotation * Eigen::Vector3d::UnitZ();
      angle_rad = std::acos(std::min(1.0, axis.dot((target - at).normalized())));
    }
    EXPECT_LT(nearest_m, 0.01);
    EXPECT_LT(DegFromRad(angle_rad), 1.0);
  }
  const Pose3 gap =
      Between(trajectory.front().world_from_camera, trajectory.back().world_from_camera);
  EXPECT_LT(gap.translation.norm(), 0.005);
  EXPECT_LT(DegFromRad(LogRotation(gap.rotation).norm()), 0.5);
}

TEST(Trajectory, APlanarCameraStaysLevelAtItsHeightAndLooksAhead) {
  const Trajectory trajectory = AtTheBounds(Options(kPlanar));
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose3& pose = trajectory[i].world_from_camera;
    EXPECT_NEAR(pose.translation.z(), 0.6, 1e-12);
    const Eigen::Vector3d right = pose.rotation * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d axis = pose.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(right.z(), 0.0, 1e-12);
    EXPECT_NEAR(axis.z(), std::sin(RadFromDeg(-10.0)), 1e-12);
    const Eigen::Vector3d step = pose.translation - trajectory[i - 1].world_from_camera.translation;
    const Pose2 base = BaseOf(pose);
    EXPECT_NEAR(WrapAngle(base.yaw_rad - std::atan2(step.y(), step.x())), 0.0, 0.03);
  }
}

TEST(Trajectory, ShakesByTheStatedAmountAndOnlyWithTheSeed) {
  TrajectoryOptions options = Options(kHandheld);
  const int frames = 3000;
  const Trajectory still = MakeTrajectory(options, frames, kFrameRateHz, 1);
  options.shake_deg = 1.0;
  options.shake_m = 0.01;
  Eigen::Vector3d rotation_square = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_square = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Trajectory shaken = MakeTrajectory(options, frames, kFrameRateHz, seed);
    for (std::size_t i = 0; i < shaken.size(); ++i) {
      const Pose3 offset = Between(still[i].world_from_camera, shaken[i].world_from_camera);
      rotation_square += LogRotation(offset.rotation).cwiseAbs2() / (8.0 * frames);
      shift_square += offset.translation.cwiseAbs2() / (8.0 * frames);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(DegFromRad(std::sqrt(rotation_square[axis])), 1.0, 0.05);
    EXPECT_NEAR(std::sqrt(shift_square[axis]), 0.01, 0.0005);
  }
  EXPECT_EQ(MakeTrajectory(options, frames, 30, 5), MakeTrajectory(options, frames, 30, 5));
  EXPECT_NE(MakeTrajectory(options, frames, 30, 5), MakeTrajectory(options, frames, 30, 6));
}

TEST(Trajectory, StampsAreWhatFilesCarry) {
  const Trajectory trajectory = MakeTrajectory(Options(kHandheld), 2000, 30.0, 1);
  EXPECT_EQ(trajectory[0].stamp_s, 0.0);
  EXPECT_EQ(trajectory[1].stamp_s, 0.033333);
  EXPECT_EQ(trajectory[29].stamp_s, 0.966667);
  EXPECT_EQ(trajectory[30].stamp_s, 1.0);
}

TEST(Trajectory, LapsOverlap) {
  const std::string text = std::string(kHandheld) + "laps: 1.25\n";
  const Trajectory trajectory = AtTheBounds(Options(text));
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < trajectory.size() / 3; ++i) {
    nearest_m = std::min(nearest_m, (trajectory[i].world_from_camera.translation -
                                     trajectory.back().world_from_camera.translation)
                                        .norm());
  }
  EXPECT_LT(nearest_m, 0.02);
}

// A closed planar path through places of a circle of 2 m about the origin.
std::string CirclePath(const std::vector<double>& angles_deg, double laps) {
  std::string text = "kind: planar\nclosed: true\nlaps: " + std::to_string(laps) + "\nwaypoints:\n";
  for (const double angle_deg : angles_deg) {
    const Pose2 at = {2.0 * std::cos(RadFromDeg(angle_deg)), 2.0 * std::sin(RadFromDeg(angle_deg)),
                      0.0};
    text += "  - {at: [" + std::to_string(at.x_m) + ", " + std::to_string(at.y_m) + "]}\n";
  }
  return text;
}

TEST(Trajectory, APartOfALapOrSeveralLapsStayOnTheirWay) {
  std::vector<double> even, uneven;
  for (int i = 0; i < 20; ++i) even.push_back(18.0 * i);
  // Most of them within the first 30 degrees.
  for (int i = 0; i < 30; ++i) uneven.push_back(i);
  for (int i = 1; i < 12; ++i) uneven.push_back(30.0 * i);
  for (const auto& angles_deg : {even, uneven}) {
    for (const double laps : {0.25, 0.5, 0.9, 1.0, 1.5, 2.0, 2.75}) {
      const Trajectory trajectory = AtTheBounds(Options(CirclePath(angles_deg, laps)));
      double turned_rad = 0.0;
      for (std::size_t i = 0; i < trajectory.size(); ++i) {
        const auto at = [&](std::size_t k) -> Eigen::Vector2d {
          return trajectory[k].world_from_camera.translation.head<2>();
        };
        ASSERT_NEAR(at(i).norm(), 2.0, 0.01) << laps << " laps, frame " << i;
        if (i == 0) continue;
        turned_rad +=
            WrapAngle(std::atan2(at(i).y(), at(i).x()) - std::atan2(at(i - 1).y(), at(i - 1).x()));
      }
      // Chords, which count as the way, are shorter than their arcs by 1.1 % where 30 degrees
      // apart.
      EXPECT_NEAR(DegFromRad(turned_rad), 360.0 * laps, 2.0) << laps;
    }
  }
}

TEST(Trajectory, RefusesWhatItCannotDo) {
  EXPECT_THAT(TrajectoryRefusal(kHandheld, 100),
              HasSubstr("scene.yaml:2: frames is 100, must be at least "));
  EXPECT_THAT(TrajectoryRefusal("kind: planar\nwaypoints: [{at: [0, 0]}]"),
              HasSubstr("has 1 waypoint, must have at least 2"));
  EXPECT_THAT(TrajectoryRefusal("kind: planar\nwaypoints: [{at: [0, 0]}, {at: [0, 0]}]"),
              HasSubstr("are the same, at (0.00, 0.00, 0.60)"));
  EXPECT_THAT(TrajectoryRefusal("kind: planar\nwaypoints:\n  - {at: [0, 0]}\n  - {at: [0, 0, 1]}"),
              HasSubstr("scene.yaml:4: at has 3 numbers, must have 2"));
  EXPECT_THAT(
      TrajectoryRefusal("kind: planar\nwaypoints: [{at: [0, 0]}, {at: [2, 0]}, {at: [0, 0]}]"),
      HasSubstr("turns on the spot near (2"));
  EXPECT_THAT(
      TrajectoryRefusal("waypoints: [{at: [0, 0, 1], look_at: [0, 0, 0]}, {at: [1, 0, 1], look_at: "
                        "[5, 0, 1]}]"),
      HasSubstr("must look less than 80 degrees"));
  for (const char* far : {"65536", "1e300"}) {
    EXPECT_THAT(TrajectoryRefusal(std::string("kind: planar\nwaypoints: [{at: [0, 0]}, {at: [2, ") +
                                  far + "]}]"),
                HasSubstr("the path takes more than 33333 s to the waypoint at (2.00, "));
  }
  const std::string hand_held =
      "waypoints: [{at: [0, 0, 1], look_at: [3, 0, 1]}, {at: [0, 1, 1], "
      "look_at: [3, 0, 1]}]\n";
  for (const std::string key : {"height_m", "pitch_deg"}) {
    EXPECT_EQ(TrajectoryRefusal(hand_held + key + ": 0.6"),
              "scene.yaml:2: " + key + " is for planar paths only: kind is 'handheld'");
  }
  EXPECT_THAT(TrajectoryRefusal("speed_mp: 3\nwaypoints: []"),
              HasSubstr("did you mean 'speed_mps'?"));
}

Trajectory Line(std::initializer_list<double> xs) {
  Trajectory trajectory;
  for (const double x : xs) {
    const double stamp_s = static_cast<double>(trajectory.size());
    trajectory.push_back({stamp_s, CameraOf({x, 1.0, 0.0}, 1.2)});
  }
  return trajectory;
}

TEST(CheckClearance, NamesTheFirstPlaceAndCountsThem) {
  const auto to_wall = [](const Eigen::Vector3d& p) { return 3.25 - p.x(); };
  const auto error = [&](std::initializer_list<double> xs) {
    return RefusalOf([&] { CheckClearance(Line(xs), to_wall, 0.25, "path"); });
  };
  EXPECT_EQ(error({0.0, 2.0, 3.0}), "no error");
  const std::string first =
      "path: frame 3 at (3.12, 1.00, 1.20) is 0.125 m from geometry, must be at least 0.250 m "
      "(clearance_m)";
  EXPECT_EQ(error({0.0, 2.0, 3.0, 3.125}), first);
  EXPECT_EQ(error({0.0, 2.0, 3.0, 3.125, 3.2, 2.0}), first);  // one place
  EXPECT_EQ(error({0.0, 2.0, 3.0, 3.125, 3.2, 2.0, 3.1, 1.0, 3.1}),
            first + "; the first of 3 places that are too near");
}

TEST(DoubtOfPath, IsOfTheFirstFrameAtOrBehindASurface) {
  // A thin wall at x = 3.25, lower than the camera is high.
  const Eigen::AlignedBox3d room(Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(6, 5, 1));
  const auto to_wall = [](const Eigen::Vector3d& p) { return std::abs(3.25 - p.x()); };
  const auto occluded = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (from.x() < 3.25) != (to.x() < 3.25);
  };
  const auto doubt = [&](std::initializer_list<double> xs) {
    return DoubtOfPath(Line(xs), {{room, true}, to_wall, occluded}, 0.1).value_or("");
  };
  EXPECT_EQ(doubt({0.0, 2.0, 3.0}), "");
  EXPECT_EQ(doubt({5.0, 5.5, 6.0, 6.5}),
            "frame 3 at (6.50, 1.00, 1.20) is outside the scene, which spans (-1.00, -1.00, 0.00) "
            "to (6.00, 5.00, 1.00)");
  EXPECT_EQ(doubt({0.0, 3.125, 3.1875, 3.25}),
            "frame 2 at (3.19, 1.00, 1.20) is 0.062 m from geometry, nearer than a camera can be");
  EXPECT_EQ(doubt({2.0, 3.0, 3.5, 3.25}),
            "frame 2 at (3.50, 1.00, 1.20) is 0.250 m from geometry, behind a surface as seen from "
            "the frame before: the path goes through it");
}

TEST(CheckWay, RefusesWhatGoesThroughASurfaceBetweenFrames) {
  const auto occluded = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (from.x() < 3.25) != (to.x() < 3.25);
  };
  const auto error = [&](std::initializer_list<double> xs) {
    return RefusalOf([&] { CheckWay(Line(xs), occluded, "path"); });
  };
  EXPECT_EQ(error({0.0, 2.0, 3.0, 1.0}), "no error");
  EXPECT_EQ(error({4.0, 5.0}), "no error");
  EXPECT_EQ(error({0.0, 2.0, 5.0, 1.0}),
            "path: frame 2 at (5.00, 1.00, 1.20) is behind a surface as seen from the frame "
            "before: the path goes through it");
}

TEST(CameraSpace, EndsAtTheFloorAndAtACeiling) {
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(2, 5, 0.4));
  const CameraSpace room{bounds, false}, arena{bounds, true};
  const auto at = [](double z_m) { return Eigen::Vector3d(1, 1, z_m); };
  EXPECT_TRUE(room.Contains(at(0.3)) && arena.Contains(at(0.3)));
  EXPECT_FALSE(room.Contains(at(0.6)));
  EXPECT_TRUE(arena.Contains(at(0.6)));
  EXPECT_FALSE(room.Contains(at(-0.1)) || arena.Contains(at(-0.1)));
  EXPECT_FALSE(arena.Contains({2.5, 1, 0.6}));
}

TEST(CheckInside, NamesThePlace) {
  const CameraSpace room{{Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(2, 5, 2)}, false};
  CheckInside(Line({0.0, 2.0}), room, "path");
  try {
    CheckInside(Line({0.0, 2.5}), room, "path");
    FAIL() << "accepted a path that leaves the scene";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "path: frame 1 at (2.50, 1.00, 1.20) is outside the scene, which spans (-1.00, "
                 "-1.00, 0.00) to (2.00, 5.00, 2.00)");
  }
}

}  // namespace
}  // namespace depthgrid
