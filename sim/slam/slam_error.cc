#include "sim/slam/slam_error.h"

#include <cmath>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// A twist: rotation vector and translation, in camera axes.
struct Twist {
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
};

Twist operator+(const Twist& a, const Twist& b) {
  return {a.rotation_rad + b.rotation_rad, a.translation_m + b.translation_m};
}
Twist operator*(double factor, const Twist& twist) {
  return {factor * twist.rotation_rad, factor * twist.translation_m};
}

Eigen::Vector3d Normals(RandomStream& random) {
  const double x = random.Normal();
  const double y = random.Normal();
  const double z = random.Normal();
  return {x, y, z};
}

Twist Draw(RandomStream& random, double translation_m, double rotation_deg) {
  if (translation_m == 0.0 && rotation_deg == 0.0) return {};  // the stream has no later draws
  const Eigen::Vector3d rotation = Normals(random);
  const Eigen::Vector3d translation = Normals(random);
  return {RadFromDeg(rotation_deg) * rotation, translation_m * translation};
}

// The probability of at least one event within a time (Poisson process).
double EventProbability(double rate_hz, double time_s) { return -std::expm1(-rate_hz * time_s); }

// An Ornstein-Uhlenbeck process with exact updates for any time step.
class SlowProcess {
 public:
  // Stationary sigma and correlation time. The value is a pose (m, degrees), or for the drift a
  // rate (m, degrees per second).
  struct Parameters {
    double translation = 0.0;
    double rotation = 0.0;
    double time_s = 1.0;
  };
  SlowProcess(const Parameters& parameters, std::uint64_t seed, RandomStage stage,
              const Twist& start)
      : parameters_(parameters), seed_(seed), stage_(stage), value_(start) {}

  Twist Next(std::uint32_t frame, double time_s) {
    const double kept = std::exp(-time_s / parameters_.time_s);
    value_ =
        kept * value_ + std::sqrt(1.0 - kept * kept) * Fresh(parameters_, seed_, stage_, frame);
    return value_;
  }
  // A draw from the stationary distribution.
  static Twist Fresh(const Parameters& parameters, std::uint64_t seed, RandomStage stage,
                     std::uint32_t frame) {
    RandomStream random(seed, stage, frame);
    return Draw(random, parameters.translation, parameters.rotation);
  }

 private:
  Parameters parameters_;
  std::uint64_t seed_;
  RandomStage stage_;
  Twist value_;
};

// Starts at 0, as the first pose is exact.
SlowProcess BiasProcess(const SlamOptions& options, std::uint64_t seed) {
  return {{options.bias_translation_m, options.bias_rotation_deg, options.bias_time_s},
          seed,
          RandomStage::kSlamBias,
          {}};
}

// Starts in its stationary distribution.
SlowProcess DriftProcess(const SlamOptions& options, std::uint64_t seed) {
  const SlowProcess::Parameters parameters = {options.drift_speed_mps, options.drift_turn_dps,
                                              options.drift_time_s};
  return {parameters, seed, RandomStage::kSlamDrift,
          SlowProcess::Fresh(parameters, seed, RandomStage::kSlamDrift, 0)};
}

class LostProcess {
 public:
  LostProcess(const SlamOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  struct Step {
    bool lost = false;
    bool relocalised = false;
    Twist jump;
  };
  Step Next(std::uint32_t frame, double stamp_s, double time_s) {
    if (lost_) {
      if (stamp_s < found_at_s_) return {true, false, {}};
      lost_ = false;
      return {false, true, jump_};
    }
    RandomStream random(seed_, RandomStage::kSlamLost, frame);
    if (random.Uniform() >= EventProbability(options_.lost_rate_hz, time_s)) return {};
    lost_ = true;
    found_at_s_ = stamp_s - options_.lost_mean_s * std::log(random.Uniform());
    jump_ =
        Draw(random, options_.relocalisation_translation_m, options_.relocalisation_rotation_deg);
    return {true, false, {}};
  }

 private:
  const SlamOptions& options_;
  std::uint64_t seed_;
  bool lost_ = false;
  double found_at_s_ = 0.0;
  Twist jump_;
};

Twist DrawWalk(const SlamOptions& options, std::uint64_t seed, std::uint32_t frame, double time_s) {
  RandomStream random(seed, RandomStage::kSlamWalk, frame);
  return std::sqrt(time_s) * Draw(random, options.walk_translation_m, options.walk_rotation_deg);
}

Twist DrawJump(const SlamOptions& options, std::uint64_t seed, std::uint32_t frame, double time_s) {
  RandomStream random(seed, RandomStage::kSlamJumps, frame);
  if (random.Uniform() >= EventProbability(options.jump_rate_hz, time_s)) return {};
  return Draw(random, options.jump_translation_m, options.jump_rotation_deg);
}

Twist DrawJitter(const SlamOptions& options, std::uint64_t seed, std::uint32_t frame) {
  RandomStream random(seed, RandomStage::kSlamJitter, frame);
  return Draw(random, options.jitter_translation_m, options.jitter_rotation_deg);
}

// Scales the rotation about horizontal world axes by `share`.
Twist Levelled(const Twist& twist, const Pose3& world_from_camera, double share) {
  if (share == 1.0) return twist;
  const Eigen::Vector3d up_in_camera =
      world_from_camera.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d yaw = twist.rotation_rad.dot(up_in_camera) * up_in_camera;
  return {yaw + share * (twist.rotation_rad - yaw), twist.translation_m};
}

}  // namespace

Pose3 PivotedMotion(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m,
                    double pivot_m) {
  if (rotation_rad.isZero(0.0)) return {Eigen::Quaterniond::Identity(), translation_m};
  const Eigen::Quaterniond rotation = ExpRotation(rotation_rad);
  const Eigen::Vector3d pivot(0.0, 0.0, pivot_m);
  return {rotation, translation_m + pivot - rotation * pivot};
}

std::vector<FrameErrors> DrawFrameErrors(const Trajectory& truth, const SlamOptions& options,
                                         std::uint64_t seed) {
  const auto motion_of = [&](const Twist& twist) {
    return PivotedMotion(twist.rotation_rad, twist.translation_m, options.pivot_m);
  };
  const auto levelled = [&](const Twist& twist, std::size_t i) {
    return Levelled(twist, truth[i].world_from_camera, options.tilt_share);
  };
  SlowProcess bias = BiasProcess(options, seed);
  SlowProcess drift_rate = DriftProcess(options, seed);
  LostProcess lost(options, seed);
  std::vector<FrameErrors> errors(truth.size());
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const auto frame = static_cast<std::uint32_t>(i);
    const double time_s = truth[i].stamp_s - truth[i - 1].stamp_s;
    const LostProcess::Step tracking = lost.Next(frame, truth[i].stamp_s, time_s);
    const Twist drift =
        DrawWalk(options, seed, frame, time_s) + time_s * drift_rate.Next(frame, time_s);
    const Twist jump = DrawJump(options, seed, frame, time_s) + tracking.jump;
    errors[i].motion = motion_of(levelled(options.drift_scale * drift + jump, i));
    errors[i].offset =
        motion_of(DrawJitter(options, seed, frame) + levelled(bias.Next(frame, time_s), i));
    errors[i].lost = tracking.lost;
    errors[i].relocalised = tracking.relocalised;
  }
  return errors;
}

}  // namespace depthgrid
