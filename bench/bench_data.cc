#include "bench/bench_data.h"

#include <map>
#include <utility>

#include "bench/bench_table.h"
#include "mapper/core/level.h"
#include "sim/depth/depth_noise.h"
#include "tests/mapper/analytic_room.h"
#include "tests/mapper/match_world.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid::bench {
namespace {

constexpr int kTriangles = 100'000;
constexpr int kDepthFrames = 12;
constexpr int kStrollFrames = 60;
constexpr int kLaserFrames = 600;

// The images from these poses; if `clean`, also those without noise.
DepthWalk SeenFrom(const std::vector<Pose3>& poses, int width_px, int height_px, bool clean) {
  static const RayScene room(test::ClutteredRoom(kTriangles));
  DepthWalk walk;
  SensorOptions sensor;
  sensor.noise = DepthNoiseModel::kHanda;
  sensor.width_px = width_px;
  sensor.height_px = height_px;
  walk.camera = SensorCamera(sensor);
  walk.poses = poses;
  const DepthCamera camera(room, walk.camera);
  const DepthNoise noise(sensor);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    DepthFrame frame = camera.RenderWithIncidence(poses[k]);
    walk.noisy.push_back(noise.Apply(frame, 1, static_cast<std::uint32_t>(k)));
    if (clean) walk.clean.push_back(std::move(frame));
  }
  return walk;
}

std::vector<Pose3> PosesAllAround() {
  std::vector<Pose3> poses;
  for (int k = 0; k < kDepthFrames; ++k) {
    const double turn_rad = 2.0 * kPi * k / kDepthFrames;
    const Pose2 base{2.45 + 0.4 * std::cos(turn_rad), 2.5 + 0.4 * std::sin(turn_rad), turn_rad};
    poses.push_back(TiltedCamera(base, 1.15, RadFromDeg(8.0 + 4.0 * std::sin(3.0 * turn_rad)),
                                 RadFromDeg(4.0 * std::cos(2.0 * turn_rad))));
  }
  return poses;
}

// Forward along a quarter of a circle.
std::vector<Pose3> PosesOfAStroll() {
  constexpr double kStepM = 0.025;
  const double turn_a_frame_rad = RadFromDeg(1.5);
  const double radius_m = kStepM / turn_a_frame_rad;
  std::vector<Pose3> poses;
  for (int k = 0; k < kStrollFrames; ++k) {
    const double turn_rad = turn_a_frame_rad * k;
    const Pose2 base{2.45 + radius_m * std::cos(turn_rad), 2.5 + radius_m * std::sin(turn_rad),
                     turn_rad + 0.5 * kPi};
    const double swing_rad = 2.0 * kPi * k / kStrollFrames;
    poses.push_back(TiltedCamera(base, 1.15, RadFromDeg(8.0 + 4.0 * std::sin(swing_rad)),
                                 RadFromDeg(4.0 * std::cos(swing_rad))));
  }
  return poses;
}

using WalkOfSize = std::map<std::pair<int, int>, DepthWalk>;

LaserWalk MakeLaserWalk(int beams) {
  const PlanarWorld room = FurnishedRoom();
  PlanarLaser laser;
  laser.beams = beams;
  laser.field_of_view_rad = RadFromDeg(58.0);
  laser.sigma_of_range = 0.01;
  LaserWalk walk;
  for (int k = 0; k < kLaserFrames; ++k) {
    const double turn_rad = 2.0 * kPi * k / kLaserFrames;
    walk.truth.push_back({3.0 + 0.8 * std::cos(turn_rad), 1.9 + 0.6 * std::sin(turn_rad),
                          WrapAngle(turn_rad + 0.5 * kPi)});
    walk.scans.push_back(std::make_shared<const Scan>(
        ScanOf(room, walk.truth.back(), laser, 1, static_cast<std::uint32_t>(k))));
  }
  return walk;
}

}  // namespace

const DepthWalk& DepthWalkOf(int width_px, int height_px) {
  static WalkOfSize walks;
  const auto [walk, is_new] = walks.try_emplace({width_px, height_px});
  if (is_new) walk->second = SeenFrom(PosesAllAround(), width_px, height_px, true);
  return walk->second;
}

const DepthWalk& DepthStrollOf(int width_px, int height_px) {
  static WalkOfSize walks;
  const auto [walk, is_new] = walks.try_emplace({width_px, height_px});
  if (is_new) walk->second = SeenFrom(PosesOfAStroll(), width_px, height_px, false);
  return walk->second;
}

const LaserWalk& LaserWalkOf(int beams) {
  static std::map<int, LaserWalk> walks;
  const auto [walk, is_new] = walks.try_emplace(beams);
  if (is_new) walk->second = MakeLaserWalk(beams);
  return walk->second;
}

std::string AddCopyFloor(int width_px) {
  const std::string name =
      std::to_string(width_px) + "x" + std::to_string(width_px * 3 / 4) + " image copied";
  AddFloor(name, [=](benchmark::State& state) {
    const DepthWalk& walk = DepthWalkOf(width_px, width_px * 3 / 4);
    std::size_t k = 0;
    DepthImage copy = walk.noisy[0];
    for (auto _ : state) {
      copy.z_m = walk.noisy[k++ % walk.noisy.size()].z_m;
      benchmark::ClobberMemory();
    }
  });
  return name;
}

}  // namespace depthgrid::bench
