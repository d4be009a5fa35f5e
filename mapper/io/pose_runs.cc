#include "mapper/io/pose_runs.h"

#include <algorithm>
#include <utility>

#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// The runs after which the sensor moved on at once.
std::vector<PoseRun> MovingOf(const std::vector<PoseRun>& runs,
                              const std::vector<std::optional<Pose3>>& poses) {
  constexpr double kMovesM = 0.005, kMovesRad = 0.005;  // chosen: above what a tracker jitters by
  std::vector<PoseRun> moving;
  for (std::size_t r = 0; r + 1 < runs.size(); ++r) {
    if (runs[r].end != runs[r + 1].begin) continue;
    const Pose3 step = Between(*poses[runs[r].begin], *poses[runs[r + 1].begin]);
    if (step.translation.norm() > kMovesM || AngleOf(step.rotation) > kMovesRad) {
      moving.push_back(runs[r]);
    }
  }
  return moving;
}

// How many frames have each pose, 1 where most have their own.
std::size_t TimesRepeated(const std::vector<PoseRun>& moving) {
  // Chosen, not measured.
  constexpr std::size_t kLeastRuns = 20;
  constexpr double kMostShare = 0.8;
  if (moving.size() < kLeastRuns) return 1;
  std::vector<double> sizes;
  for (const PoseRun& run : moving) sizes.push_back(static_cast<double>(run.size()));
  const auto repeated =
      std::count_if(sizes.begin(), sizes.end(), [](double size) { return size > 1.0; });
  const double least = kMostShare * static_cast<double>(moving.size());
  if (static_cast<double>(repeated) < least) return 1;
  return static_cast<std::size_t>(UpperMedian(std::move(sizes)));
}

}  // namespace

std::vector<PoseRun> PoseRunsOf(const std::vector<std::optional<Pose3>>& poses) {
  std::vector<PoseRun> runs;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    const bool goes_on = !runs.empty() && runs.back().end == i && poses[i] == poses[i - 1];
    if (!goes_on) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

RepeatedPoses FindRepeated(const std::vector<PoseRun>& runs,
                           const std::vector<std::optional<Pose3>>& poses) {
  const std::vector<PoseRun> moving = MovingOf(runs, poses);
  RepeatedPoses found{TimesRepeated(moving), std::vector<bool>(poses.size(), false)};
  if (found.times == 1) return found;
  for (const PoseRun& run : moving) {
    // A pose given longer than twice as often is that of a stand.
    const std::size_t first = run.size() > 2 * found.times ? run.end - found.times : run.begin;
    for (std::size_t i = first + 1; i < run.end; ++i) found.held[i] = true;
  }
  const PoseRun& last = runs.back();
  if (moving.back().end != last.begin || last.size() > found.times) return found;
  for (std::size_t i = last.begin + 1; i < last.end; ++i) found.held[i] = true;
  return found;
}

}  // namespace depthgrid
