#include "sim/slam/slam_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/error.h"
#include "sim/slam/error_growth.h"
#include "sim/slam/slam_events.h"

namespace depthgrid {
namespace {

constexpr std::size_t kFewestPoses = 100;
constexpr double kShortestTiltLagS = 1.0;  // at shorter lags jitter dominates
// Correlation times to try; half a minute of data cannot resolve finer steps.
constexpr double kBiasTimesS[] = {0.2, 0.5, 1.0, 2.0, 5.0, 10.0};
constexpr double kDriftTimesS[] = {2.0, 5.0, 10.0, 20.0};

struct RunEvents {
  const SlamRun* run = nullptr;
  std::vector<RunEvent> events;
  std::vector<bool> in_event;  // of the motion that ends at each pose
};

// Sets the flags of the motions of an event.
void Mark(const RunEvent& event, std::vector<bool>& motions) {
  for (std::size_t to = event.from + 1; to <= event.to; ++to) motions[to] = true;
}

RunEvents EventsOf(const SlamRun& run) {
  RunEvents found{&run, FindEvents(run), std::vector<bool>(run.truth.size(), false)};
  for (const RunEvent& event : found.events) Mark(event, found.in_event);
  return found;
}

// Regression through the origin of the sideways translation on the rotation w: to first order a
// pivot p = (0, 0, d) gives p - R p = d (-w_y, w_x, 0).
void FitPivot(const std::vector<RunEvents>& runs, SlamFit& fit) {
  double turn_turn = 0.0;
  double turn_shift = 0.0;
  double shift_shift = 0.0;
  for (const RunEvents& run : runs) {
    for (std::size_t to = 1; to < run.in_event.size(); ++to) {
      if (run.in_event[to]) continue;
      const Pose3 error = MotionError(*run.run, to - 1, to);
      const Eigen::Vector3d turn = LogRotation(error.rotation);
      turn_turn += turn.head<2>().squaredNorm();
      turn_shift += turn.x() * error.translation.y() - turn.y() * error.translation.x();
      shift_shift += error.translation.head<2>().squaredNorm();
    }
  }
  if (turn_turn == 0.0 || shift_shift == 0.0) return;
  // Rotations that are only rounding of the file's quaternions give an impossible pivot.
  const double pivot_m = turn_shift / turn_turn;
  if (!(pivot_m > 0.0 && pivot_m <= kMostPivotM)) return;
  fit.options.pivot_m = pivot_m;
  fit.pivot_explains = turn_shift * turn_shift / (turn_turn * shift_shift);
}

Eigen::Vector3d WithoutPivot(const Pose3& error, double pivot_m) {
  const Eigen::Vector3d pivot(0.0, 0.0, pivot_m);
  return error.translation - (pivot - error.rotation * pivot);
}

struct Tracks {
  std::vector<ErrorTrack> yaw;
  std::vector<ErrorTrack> tilt;  // about x and y of the world
  std::vector<ErrorTrack> translation;

  void Begin(double stamp_s) {
    for (auto* tracks : {&yaw, &tilt, &translation}) {
      tracks->push_back({{stamp_s, Eigen::Vector3d::Zero()}});
    }
  }
  // The error of the motion that ends at this true pose.
  void Add(const Pose3& error, const StampedPose& truth, double pivot_m) {
    const Eigen::Vector3d turn = truth.world_from_camera.rotation * LogRotation(error.rotation);
    Extend(yaw.back(), truth.stamp_s, {0.0, 0.0, turn.z()});
    Extend(tilt.back(), truth.stamp_s, {turn.x(), turn.y(), 0.0});
    Extend(translation.back(), truth.stamp_s, WithoutPivot(error, pivot_m));
  }

 private:
  static void Extend(ErrorTrack& track, double stamp_s, const Eigen::Vector3d& error) {
    track.push_back({stamp_s, track.back().error + error});
  }
};

// The accumulated errors of all motions, each in the axes in which the surrogate draws it (rotation
// in world axes, translation in camera axes), so that rotation errors do not leak into the
// translation terms. Jumps are included with their oscillations; what cancels out by their end
// counts as noise. A loss or a correction begins a new track.
Tracks ErrorTracks(const std::vector<RunEvents>& runs, double pivot_m) {
  Tracks tracks;
  for (const RunEvents& run : runs) {
    std::vector<bool> is_left_out(run.in_event.size(), false);
    for (const RunEvent& event : run.events) {
      if (event.correction || event.lost_s > 0.0) Mark(event, is_left_out);
    }
    const Trajectory& truth = run.run->truth;
    tracks.Begin(truth.front().stamp_s);
    for (std::size_t to = 1; to < run.in_event.size(); ++to) {
      if (is_left_out[to]) {
        tracks.Begin(truth[to].stamp_s);
      } else {
        tracks.Add(MotionError(*run.run, to - 1, to), truth[to], pivot_m);
      }
    }
  }
  return tracks;
}

// Root of the mean squared ratio of tilt (per axis) to yaw over the longer lags; 1 if unknown.
double TiltShare(const std::vector<Growth>& tilt, const std::vector<Growth>& yaw) {
  if (tilt.empty() && !yaw.empty()) return 0.0;
  double ratio = 0.0;
  double weights = 0.0;
  for (const Growth& turned : yaw) {
    if (turned.lag_s < kShortestTiltLagS) continue;
    // The same lag, if present: lags without any error are omitted.
    const auto tilted = std::ranges::find(tilt, turned.lag_s, &Growth::lag_s);
    const double tilt_square = tilted == tilt.end() ? 0.0 : tilted->mean_square;
    ratio += turned.weight * tilt_square / turned.mean_square;
    weights += turned.weight;
  }
  return weights > 0.0 ? std::min(1.0, std::sqrt(ratio / weights)) : 1.0;
}

struct ErrorGrowth {
  std::vector<Growth> yaw;
  std::vector<Growth> tilt;
  std::vector<Growth> translation;
};

ErrorGrowth GrowthOf(const std::vector<RunEvents>& runs, double pivot_m) {
  const Tracks tracks = ErrorTracks(runs, pivot_m);
  return {MeasureGrowth(tracks.yaw, 1), MeasureGrowth(tracks.tilt, 2),
          MeasureGrowth(tracks.translation, 3)};
}

void FitNoise(const ErrorGrowth& growth, SlamFit& fit) {
  SlamOptions& options = fit.options;
  const auto walk_of_jumps = [&](double jump) { return options.jump_rate_hz * jump * jump; };
  const double turn_by_jumps = walk_of_jumps(RadFromDeg(options.jump_rotation_deg));
  const double shift_by_jumps = walk_of_jumps(options.jump_translation_m);
  double least = std::numeric_limits<double>::infinity();
  const auto try_times = [&](const CorrelationTimes& times) {
    const GrowthTerms turn = FitGrowth(growth.yaw, times, turn_by_jumps);
    const GrowthTerms shift = FitGrowth(growth.translation, times, shift_by_jumps);
    if (!(turn.misfit + shift.misfit < least)) return;
    least = turn.misfit + shift.misfit;
    options.jitter_translation_m = shift.jitter;
    options.bias_translation_m = shift.bias;
    options.walk_translation_m = shift.walk;
    options.drift_speed_mps = shift.drift;
    options.jitter_rotation_deg = DegFromRad(turn.jitter);
    options.bias_rotation_deg = DegFromRad(turn.bias);
    options.walk_rotation_deg = DegFromRad(turn.walk);
    options.drift_turn_dps = DegFromRad(turn.drift);
    options.bias_time_s = times.bias_s;
    options.drift_time_s = times.drift_s;
  };
  for (const double bias_s : kBiasTimesS) {
    for (const double drift_s : kDriftTimesS) try_times({bias_s, drift_s});
  }
}

// Root mean square per axis over events.
struct EventSize {
  int count = 0;
  double square_m2 = 0.0;
  double square_rad2 = 0.0;
  void Add(const RunEvent& event, double pivot_m) {
    ++count;
    square_m2 += WithoutPivot(event.error, pivot_m).squaredNorm();
    square_rad2 += LogRotation(event.error.rotation).squaredNorm();
  }
  double TranslationM() const { return count ? std::sqrt(square_m2 / (3.0 * count)) : 0.0; }
  // About the vertical; the other axes have `tilt_share` of it.
  double RotationRad(double tilt_share) const {
    const double axes = 1.0 + 2.0 * tilt_share * tilt_share;
    return count ? std::sqrt(square_rad2 / (axes * count)) : 0.0;
  }
};

// Limits the jumps' size to what the growth allows at every lag: jumps that cancel each other would
// explain more growth than was measured.
double Capped(double jump, double rate_hz, const std::vector<Growth>& growth) {
  for (const Growth& point : growth) {
    jump = std::min(jump, std::sqrt(point.mean_square / (rate_hz * point.lag_s)));
  }
  return jump;
}

void FitEvents(const std::vector<RunEvents>& runs, const ErrorGrowth& growth, SlamFit& fit) {
  EventSize jumps;
  EventSize relocalisations;
  double lost_s = 0.0;
  for (const RunEvents& run : runs) {
    for (const RunEvent& event : run.events) {
      const bool lost = event.lost_s > 0.0;
      fit.corrections += event.correction ? 1 : 0;
      fit.lost_bursts += lost ? 1 : 0;
      lost_s += event.lost_s;
      if (event.correction) continue;
      (lost ? relocalisations : jumps).Add(event, fit.options.pivot_m);
    }
  }
  fit.jumps = jumps.count;
  SlamOptions& options = fit.options;
  options.jump_rate_hz = jumps.count / fit.tracked_s;
  options.jump_translation_m =
      Capped(jumps.TranslationM(), options.jump_rate_hz, growth.translation);
  options.jump_rotation_deg =
      DegFromRad(Capped(jumps.RotationRad(options.tilt_share), options.jump_rate_hz, growth.yaw));
  options.lost_rate_hz = fit.lost_bursts / fit.tracked_s;
  if (fit.lost_bursts > 0) options.lost_mean_s = lost_s / fit.lost_bursts;
  options.relocalisation_translation_m = relocalisations.TranslationM();
  options.relocalisation_rotation_deg = DegFromRad(relocalisations.RotationRad(options.tilt_share));
}

}  // namespace

SlamFit FitSlamErrors(const std::vector<SlamRun>& runs, const std::string& place) {
  std::vector<RunEvents> found;
  std::size_t poses = 0;
  SlamFit fit;
  for (const SlamRun& run : runs) {
    Require(run.truth.size() == run.estimate.size(), "each estimate belongs to a true pose");
    if (run.truth.size() < 2) continue;
    poses += run.truth.size();
    found.push_back(EventsOf(run));
    fit.tracked_s += run.truth.back().stamp_s - run.truth.front().stamp_s;
    for (const RunEvent& event : found.back().events) fit.tracked_s -= event.lost_s;
  }
  if (poses < kFewestPoses) {
    throw InputError(
        place, fmt::format("{} poses have both truth and estimate, must be at least {}", poses,
                           kFewestPoses));
  }
  FitPivot(found, fit);
  const ErrorGrowth growth = GrowthOf(found, fit.options.pivot_m);
  fit.options.tilt_share = TiltShare(growth.tilt, growth.yaw);
  FitEvents(found, growth, fit);
  FitNoise(growth, fit);
  return fit;
}

}  // namespace depthgrid
