// People who walk in a simulated laser world while the robot drives.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/pose2.h"
#include "sim/laser/laser_world.h"

namespace depthgrid {

enum class People {
  kNone,
  kCrossing,  // three, one after the other, walk through the view
  kAhead,     // one walks on before the robot, for three quarters of the time
  kSwaying,   // the same, now nearer, now farther, and from foot to foot
  kAside,     // the same, 1 m ahead and .5 m aside: the edge of a view of 58 degrees cuts them
  kClose,     // the same, .75 m ahead: they fill 34 of 58 degrees
  kWeaving,   // the same, 1.2 m ahead and now more on this side, now on that, into the edges
};

constexpr double kPersonRadiusM = 0.22;
constexpr double kWalkMps = 1.2;
constexpr double kFrameRateHz = 30.0;
constexpr double kPersonAheadM = 1.5;  // ahead of the robot; the three crossing ones are .8 m apart

inline void AddPerson(const Eigen::Vector2d& at_m, LaserWorld& world) {
  constexpr int kSides = 12;
  const auto corner = [&](int i) -> Eigen::Vector2d {
    const double angle_rad = 2.0 * kPi * i / kSides;
    return at_m + kPersonRadiusM * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  };
  for (int i = 0; i < kSides; ++i) world.walls.push_back({corner(i), corner(i + 1)});
}

// Position, in robot axes, of a person who stays ahead of the robot; empty if there is none.
inline std::optional<Eigen::Vector2d> BeforeRobotM(People people, double at_s) {
  switch (people) {
    case People::kAhead:
      return Eigen::Vector2d(kPersonAheadM, 0.0);
    case People::kSwaying:
      return Eigen::Vector2d(kPersonAheadM + 0.25 * std::sin(2.0 * kPi * 0.3 * at_s),
                             0.08 * std::sin(2.0 * kPi * 0.9 * at_s));
    case People::kAside:
      return Eigen::Vector2d(1.0, 0.5);
    case People::kClose:
      return Eigen::Vector2d(0.75, 0.05);
    case People::kWeaving:
      return Eigen::Vector2d(1.2, 0.6 * std::sin(2.0 * kPi * 0.15 * at_s));
    case People::kNone:
    case People::kCrossing:
      break;
  }
  return {};
}

// The world with the people at a frame of this path.
inline LaserWorld WithPeople(const LaserWorld& world, People people,
                             const std::vector<Pose2>& world_from_base, std::size_t frame) {
  LaserWorld peopled = world;
  const std::size_t count = world_from_base.size();
  if (people == People::kCrossing) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t met = count * (2 * i + 1) / 6;
      const double since_s = (static_cast<double>(frame) - static_cast<double>(met)) / kFrameRateHz;
      const double ahead_m = kPersonAheadM + 0.8 * (static_cast<double>(i) - 1.0);
      if (std::abs(since_s) > 3.0) continue;
      AddPerson(world_from_base[met] * Eigen::Vector2d(ahead_m, -kWalkMps * since_s), peopled);
    }
  }
  constexpr std::size_t kRound = 400, kAheadFrames = 300;
  const auto before_m = BeforeRobotM(people, static_cast<double>(frame) / kFrameRateHz);
  if (before_m && frame % kRound < kAheadFrames) {
    AddPerson(world_from_base[frame] * *before_m, peopled);
  }
  return peopled;
}

}  // namespace depthgrid
