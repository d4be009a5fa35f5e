#include "sim/slam/slam_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// A revisit interrupted for less than this continues, as the camera may shake at its limit.
constexpr double kEpisodeBreakS = 1.0;
// False closures join views at least this many times farther apart than a revisit.
constexpr double kFalseSeparation = 2.0;
constexpr int kFalseAttempts = 50;
// Graph solvers divide by sigma, so a noise-free loop has one too.
constexpr double kLeastSigma = 1e-4;

// Distances between views in units of the limits of a revisit: at most 1 is the same view.
class Views {
 public:
  Views(const Trajectory& truth, const SlamLoopOptions& options)
      : truth_(truth),
        positions_(static_cast<Eigen::Index>(truth.size()), 3),
        max_angle_rad_(RadFromDeg(options.max_angle_deg)),
        cos_half_max_angle_(std::cos(0.5 * max_angle_rad_)) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      positions_.row(static_cast<Eigen::Index>(i)) =
          truth[i].world_from_camera.translation.transpose() / options.max_distance_m;
    }
  }

  // Squared distances of all earlier views to this one; axis by axis, which vectorises.
  Eigen::ArrayXd SquaredDistancesBefore(int second) const {
    Eigen::ArrayXd squared = Eigen::ArrayXd::Zero(second);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      squared += (positions_.col(axis).head(second).array() - positions_(second, axis)).square();
    }
    return squared;
  }
  double Distance(int a, int b) const { return (positions_.row(a) - positions_.row(b)).norm(); }
  double Angle(int a, int b) const {
    return RotationOf(a).angularDistance(RotationOf(b)) / max_angle_rad_;
  }
  // Whether the angle is above 1, without arccos: |q_a . q_b| is the cosine of half the angle.
  bool TurnedAway(int a, int b) const {
    return std::abs(RotationOf(a).dot(RotationOf(b))) < cos_half_max_angle_;
  }

 private:
  const Eigen::Quaterniond& RotationOf(int frame) const {
    return truth_[static_cast<std::size_t>(frame)].world_from_camera.rotation;
  }
  const Trajectory& truth_;
  Eigen::MatrixX3d positions_;  // in units of max_distance_m
  double max_angle_rad_;
  double cos_half_max_angle_;
};

// The earlier frame with the view most similar to frame `second`'s, if the camera was elsewhere
// since.
std::optional<int> OldView(const Trajectory& truth, const std::vector<bool>& tracked,
                           const Views& views, int second, double min_gap_s) {
  const Eigen::ArrayXd squared_distance = views.SquaredDistancesBefore(second);
  const double latest_s = truth[static_cast<std::size_t>(second)].stamp_s - min_gap_s;
  bool was_elsewhere = false;
  double nearest = 1.0;
  std::optional<int> found;
  for (int first = second - 1; first >= 0; --first) {
    const auto i = static_cast<std::size_t>(first);
    if (squared_distance[first] > 1.0 || views.TurnedAway(first, second)) {
      was_elsewhere = true;
      continue;
    }
    if (!was_elsewhere || !tracked[i] || truth[i].stamp_s > latest_s) continue;
    if (squared_distance[first] > nearest * nearest) continue;
    const double separation =
        std::max(std::sqrt(squared_distance[first]), views.Angle(first, second));
    if (separation > nearest) continue;
    nearest = separation;
    found = first;
  }
  return found;
}

Pose3 DrawMotion(RandomStream& random, double translation_m, double rotation_rad) {
  std::array<double, 6> n{};
  for (double& value : n) value = random.Normal();
  return {ExpRotation(rotation_rad * Eigen::Vector3d(n[0], n[1], n[2])),
          translation_m * Eigen::Vector3d(n[3], n[4], n[5])};
}

// The first tracked frame at or after `frame`.
std::optional<int> ReportFrame(const std::vector<bool>& tracked, std::int64_t frame) {
  for (auto i = static_cast<std::size_t>(frame); i < tracked.size(); ++i) {
    if (tracked[i]) return static_cast<int>(i);
  }
  return std::nullopt;
}

LoopClosure Closure(const SlamLoopOptions& options, const Revisit& frames,
                    const Pose3& first_from_second) {
  return {0,
          frames.first,
          frames.second,
          first_from_second,
          std::max(options.sigma_translation_m, kLeastSigma),
          std::max(RadFromDeg(options.sigma_rotation_deg), kLeastSigma)};
}

// A false closure of two different views; its relative pose is like that of a true closure.
std::optional<LoopClosure> DrawFalse(const Trajectory& truth, const std::vector<bool>& tracked,
                                     const Views& views, const SlamLoopOptions& options,
                                     RandomStream& random) {
  for (int attempt = 0; attempt < kFalseAttempts; ++attempt) {
    const int a = static_cast<int>(random.Below(truth.size()));
    const int b = static_cast<int>(random.Below(truth.size()));
    const Revisit frames = {std::min(a, b), std::max(a, b)};
    const auto first = static_cast<std::size_t>(frames.first);
    const auto second = static_cast<std::size_t>(frames.second);
    if (truth[second].stamp_s - truth[first].stamp_s < options.min_gap_s) continue;
    if (!tracked[first] || !tracked[second]) continue;
    if (std::max(views.Distance(a, b), views.Angle(a, b)) < kFalseSeparation) continue;
    return Closure(
        options, frames,
        DrawMotion(random, options.max_distance_m / 2.0, RadFromDeg(options.max_angle_deg) / 2.0));
  }
  return std::nullopt;  // all views are about the same
}

}  // namespace

std::vector<Revisit> FindRevisits(const Trajectory& truth, const std::vector<bool>& tracked,
                                  const SlamLoopOptions& options) {
  const Views views(truth, options);
  std::vector<Revisit> revisits;
  std::optional<double> last_seen_s;
  double last_offered_s = 0.0;
  for (int second = 0; second < static_cast<int>(truth.size()); ++second) {
    if (!tracked[static_cast<std::size_t>(second)]) continue;
    const std::optional<int> first = OldView(truth, tracked, views, second, options.min_gap_s);
    if (!first) continue;
    const double stamp_s = truth[static_cast<std::size_t>(second)].stamp_s;
    const bool begins = !last_seen_s || stamp_s - *last_seen_s > kEpisodeBreakS;
    if (begins || stamp_s - last_offered_s >= options.repeat_s) {
      revisits.push_back({*first, second});
      last_offered_s = stamp_s;
    }
    last_seen_s = stamp_s;
  }
  return revisits;
}

std::vector<SimulatedLoop> SimulateLoops(const Trajectory& truth, const std::vector<bool>& tracked,
                                         const SlamLoopOptions& options, std::uint64_t seed) {
  std::vector<SimulatedLoop> loops;
  if (options.recall == 0.0) return loops;
  const Views views(truth, options);
  const auto report = [&](const std::optional<LoopClosure>& closure, bool is_true) {
    if (!closure) return;
    const std::int64_t due = std::int64_t{closure->second_frame} + options.delay_frames;
    const std::optional<int> frame = ReportFrame(tracked, due);
    if (!frame) return;
    loops.push_back({*closure, is_true});
    loops.back().closure.reported_at_frame = *frame;
  };
  // False closures per true one at this precision.
  const double false_per_true = (1.0 - options.precision) / options.precision;
  for (const Revisit& revisit : FindRevisits(truth, tracked, options)) {
    RandomStream random(seed, RandomStage::kSlamLoops, static_cast<std::uint32_t>(revisit.second));
    const bool closed = random.Uniform() < options.recall;
    const double false_draw = random.Uniform();
    const Pose3 noise =
        DrawMotion(random, options.sigma_translation_m, RadFromDeg(options.sigma_rotation_deg));
    if (!closed) continue;
    const Pose3& first = truth[static_cast<std::size_t>(revisit.first)].world_from_camera;
    const Pose3& second = truth[static_cast<std::size_t>(revisit.second)].world_from_camera;
    report(Closure(options, revisit, Between(first, second) * noise), true);
    const int false_count = static_cast<int>(std::floor(false_per_true + false_draw));
    for (int i = 0; i < false_count; ++i) {
      report(DrawFalse(truth, tracked, views, options, random), false);
    }
  }
  std::stable_sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) {
    return a.closure.reported_at_frame < b.closure.reported_at_frame;
  });
  return loops;
}

}  // namespace depthgrid
