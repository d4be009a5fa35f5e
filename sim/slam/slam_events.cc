#include "sim/slam/slam_events.h"

#include <algorithm>

#include "mapper/core/median.h"

namespace depthgrid {
namespace {

constexpr double kGapSteps = 1.5;     // a step longer than this many median steps is a gap
constexpr double kJumpMedians = 5.0;  // a jump is larger than this many median errors
// Where most motions have no error, as of a SLAM that mostly stands or of a file that repeats the
// truth, five medians are nothing too, and the rounding of the others would be jumps. A TUM file's
// last decimal is 0.1 mm.
constexpr double kLeastJumpM = 1e-3;
constexpr double kOneJumpS = 0.2;        // jumps that are nearer in time are one
constexpr double kCorrectedShare = 0.5;  // a correction leaves less than this share of the error

}  // namespace

std::vector<RunEvent> FindEvents(const SlamRun& run) {
  std::vector<RunEvent> events;
  if (run.truth.size() < 2) return events;
  std::vector<double> steps_s;
  std::vector<double> errors_m;
  for (std::size_t to = 1; to < run.truth.size(); ++to) {
    steps_s.push_back(run.StepS(to));
    errors_m.push_back(MotionError(run, to - 1, to).translation.norm());
  }
  const double gap_s = kGapSteps * UpperMedian(steps_s);
  const double jump_m = std::max(kJumpMedians * UpperMedian(errors_m), kLeastJumpM);
  for (std::size_t to = 1; to < run.truth.size(); ++to) {
    const bool gap = steps_s[to - 1] > gap_s;
    if (!gap && errors_m[to - 1] <= jump_m) continue;
    const double since_s =
        events.empty() ? 0.0 : run.truth[to - 1].stamp_s - run.truth[events.back().to].stamp_s;
    if (events.empty() || since_s > kOneJumpS) events.push_back({to - 1, to, 0.0, false, {}});
    events.back().to = to;
    if (gap) events.back().lost_s += steps_s[to - 1];
  }
  for (RunEvent& event : events) {
    event.error = MotionError(run, event.from, event.to);
    const double before_m = MotionError(run, 0, event.from).translation.norm();
    const double after_m = MotionError(run, 0, event.to).translation.norm();
    event.correction = before_m > jump_m && after_m < kCorrectedShare * before_m;
  }
  return events;
}

std::vector<SlamRun> BetweenCorrections(const SlamRun& run) {
  std::vector<SlamRun> stretches;
  std::size_t begin = 0;
  const auto add_until = [&](std::size_t end) {
    const auto part = [&](const Trajectory& whole) {
      return Trajectory(whole.begin() + static_cast<std::ptrdiff_t>(begin),
                        whole.begin() + static_cast<std::ptrdiff_t>(end));
    };
    stretches.push_back({part(run.truth), part(run.estimate)});
  };
  for (const RunEvent& event : FindEvents(run)) {
    if (!event.correction) continue;
    add_until(event.from + 1);
    begin = event.to;
  }
  add_until(run.truth.size());
  return stretches;
}

}  // namespace depthgrid
