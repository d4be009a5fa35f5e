#include "sim/slam_fit.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "mapper/core/error.h"
#include "sim/error_growth.h"
#include "sim/slam_events.h"

namespace depthgrid {
namespace {

constexpr std::size_t kFewestPoses = 100;
// Correlation times that are tried: half a minute of data does not tell finer ones apart.
constexpr double kBiasTimesS[] = {0.2, 0.5, 1.0, 2.0, 5.0, 10.0};
constexpr double kDriftTimesS[] = {2.0, 5.0, 10.0, 20.0};

struct RunEvents {
  const SlamRun* run = nullptr;
  std::vector<SlamEvent> events;
  std::vector<bool> in_event;  // of the motion that ends at each pose
};

RunEvents EventsOf(const SlamRun& run) {
  RunEvents found{&run, FindEvents(run), std::vector<bool>(run.truth.size(), false)};
  for (const SlamEvent& event : found.events) {
    for (std::size_t to = event.from + 1; to <= event.to; ++to) found.in_event[to] = true;
  }
  return found;
}

double StepS(const SlamRun& run, std::size_t to) {
  return run.truth[to].stamp_s - run.truth[to - 1].stamp_s;
}

// Regression through the origin of the sideways shift on the turn: p - R p of a pivot p = (0, 0, d)
// is d (-w_y, w_x, 0) to first order.
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
  fit.options.pivot_m = std::max(0.0, turn_shift / turn_turn);
  fit.pivot_explains = turn_shift * turn_shift / (turn_turn * shift_shift);
}

Eigen::Vector3d WithoutPivot(const Pose3& error, double pivot_m) {
  const Eigen::Vector3d pivot(0.0, 0.0, pivot_m);
  return error.translation - (pivot - error.rotation * pivot);
}

struct Tracks {
  std::vector<ErrorTrack> rotation;
  std::vector<ErrorTrack> translation;

  void Begin(double stamp_s) {
    rotation.push_back({{stamp_s}, {Eigen::Vector3d::Zero()}});
    translation.push_back({{stamp_s}, {Eigen::Vector3d::Zero()}});
  }
  void Add(double stamp_s, const Pose3& error, double pivot_m) {
    rotation.back().stamps_s.push_back(stamp_s);
    rotation.back().summed.push_back(rotation.back().summed.back() + LogRotation(error.rotation));
    translation.back().stamps_s.push_back(stamp_s);
    translation.back().summed.push_back(translation.back().summed.back() +
                                        WithoutPivot(error, pivot_m));
  }
};

// The errors of all motions summed up. They are errors in camera axes, as the surrogate draws them,
// so that sums of jitter, bias, walk and drift stay apart from what turning does to a path. Jumps
// count with the motion they end in; a loss or a correction begins a new track.
Tracks ErrorTracks(const std::vector<RunEvents>& runs, double pivot_m) {
  Tracks tracks;
  for (const RunEvents& run : runs) {
    std::vector<const SlamEvent*> event_at(run.in_event.size(), nullptr);
    for (const SlamEvent& event : run.events) event_at[event.to] = &event;
    tracks.Begin(run.run->truth[0].stamp_s);
    for (std::size_t to = 1; to < run.in_event.size(); ++to) {
      const double stamp_s = run.run->truth[to].stamp_s;
      const SlamEvent* event = event_at[to];
      if (event && (event->correction || event->lost_s > 0.0)) {
        tracks.Begin(stamp_s);
      } else if (event) {
        tracks.Add(stamp_s, event->error, pivot_m);
      } else {
        tracks.Add(stamp_s, run.in_event[to] ? Pose3{} : MotionError(*run.run, to - 1, to),
                   pivot_m);
      }
    }
  }
  return tracks;
}

void FitNoise(const std::vector<RunEvents>& runs, double frame_s, SlamFit& fit) {
  const Tracks tracks = ErrorTracks(runs, fit.options.pivot_m);
  const std::vector<Growth> rotation = MeasureGrowth(tracks.rotation, frame_s);
  const std::vector<Growth> translation = MeasureGrowth(tracks.translation, frame_s);
  double least = std::numeric_limits<double>::infinity();
  const auto try_times = [&](const CorrelationTimes& times) {
    const GrowthTerms turn = FitGrowth(rotation, times);
    const GrowthTerms shift = FitGrowth(translation, times);
    if (!(turn.misfit + shift.misfit < least)) return;
    least = turn.misfit + shift.misfit;
    fit.options.jitter_translation_m = shift.jitter;
    fit.options.bias_translation_m = shift.bias;
    fit.options.walk_translation_m = shift.walk;
    fit.options.drift_speed_mps = shift.drift;
    fit.options.jitter_rotation_deg = DegFromRad(turn.jitter);
    fit.options.bias_rotation_deg = DegFromRad(turn.bias);
    fit.options.walk_rotation_deg = DegFromRad(turn.walk);
    fit.options.drift_turn_dps = DegFromRad(turn.drift);
    fit.options.bias_time_s = times.bias_s;
    fit.options.drift_time_s = times.drift_s;
  };
  for (const double bias_s : kBiasTimesS) {
    for (const double drift_s : kDriftTimesS) try_times({bias_s, drift_s});
  }
}

// Root mean square per axis of some events.
struct EventSize {
  int count = 0;
  double square_m2 = 0.0;
  double square_rad2 = 0.0;
  void Add(const SlamEvent& event, double pivot_m) {
    ++count;
    square_m2 += WithoutPivot(event.error, pivot_m).squaredNorm();
    square_rad2 += LogRotation(event.error.rotation).squaredNorm();
  }
  double TranslationM() const { return count ? std::sqrt(square_m2 / (3.0 * count)) : 0.0; }
  double RotationDeg() const {
    return count ? DegFromRad(std::sqrt(square_rad2 / (3.0 * count))) : 0.0;
  }
};

// The fitted walk contains the jumps: what they explain of it is taken out. Jumps that undo one
// another explain more than there is; then no walk is left and they are taken to be smaller.
void TakeFromWalk(double rate_hz, double& jump, double& walk) {
  const double explained = rate_hz * jump * jump;
  if (explained > walk * walk) jump *= walk / std::sqrt(explained);
  walk = std::sqrt(std::max(0.0, walk * walk - explained));
}

void FitEvents(const std::vector<RunEvents>& runs, SlamFit& fit) {
  EventSize jumps;
  EventSize relocalisations;
  double lost_s = 0.0;
  for (const RunEvents& run : runs) {
    for (const SlamEvent& event : run.events) {
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
  options.jump_translation_m = jumps.TranslationM();
  options.jump_rotation_deg = jumps.RotationDeg();
  TakeFromWalk(options.jump_rate_hz, options.jump_translation_m, options.walk_translation_m);
  TakeFromWalk(options.jump_rate_hz, options.jump_rotation_deg, options.walk_rotation_deg);
  options.lost_rate_hz = fit.lost_bursts / fit.tracked_s;
  if (fit.lost_bursts > 0) options.lost_mean_s = lost_s / fit.lost_bursts;
  options.relocalisation_translation_m = relocalisations.TranslationM();
  options.relocalisation_rotation_deg = relocalisations.RotationDeg();
}

}  // namespace

SlamFit FitSlamErrors(const std::vector<SlamRun>& runs) {
  std::vector<RunEvents> found;
  std::size_t poses = 0;
  SlamFit fit;
  double least_step_s = std::numeric_limits<double>::infinity();
  for (const SlamRun& run : runs) {
    Require(run.truth.size() == run.estimate.size(), "each estimate belongs to a true pose");
    if (run.truth.size() < 2) continue;
    poses += run.truth.size();
    found.push_back(EventsOf(run));
    fit.tracked_s += run.truth.back().stamp_s - run.truth.front().stamp_s;
    for (const SlamEvent& event : found.back().events) fit.tracked_s -= event.lost_s;
    for (std::size_t to = 1; to < run.truth.size(); ++to) {
      least_step_s = std::min(least_step_s, StepS(run, to));
    }
  }
  if (poses < kFewestPoses) {
    throw InputError("", fmt::format("{} poses have both truth and estimate, must be at least {}",
                                     poses, kFewestPoses));
  }
  FitPivot(found, fit);
  FitNoise(found, least_step_s, fit);
  FitEvents(found, fit);
  return fit;
}

}  // namespace depthgrid
