#include "eval/mapping_run.h"

#include <chrono>
#include <ctime>

#include "eval/metrics/association.h"
#include "mapper/core/level.h"
#include "mapper/io/pose_track.h"

namespace depthgrid {
namespace {

// How many frames are kept whole for the report, evenly spread.
constexpr int kSampleFrames = 5;

double ThreadCpuUs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

bool IsSample(int position, int count) {
  if (count <= kSampleFrames) return true;
  // The middles of kSampleFrames equal parts.
  for (int i = 0; i < kSampleFrames; ++i) {
    if (position == count * (2 * i + 1) / (2 * kSampleFrames)) return true;
  }
  return false;
}

template <typename PoseOf>
Trajectory Collect(const MappingRun& run, PoseOf pose_of) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    const std::optional<Pose3> pose = pose_of(i);
    if (!pose) continue;
    trajectory.push_back({run.reports[i].stamp_s, run.camera ? *pose : Lift(BaseOf(*pose))});
  }
  return trajectory;
}

// SLAM's final pose of each frame, by stamp; empty if there are none.
std::vector<std::optional<Pose3>> FinalPosesOf(const std::vector<FrameReport>& reports,
                                               const Trajectory& final_poses) {
  if (final_poses.empty()) return {};
  std::vector<double> stamps_s;
  for (const StampedPose& pose : final_poses) stamps_s.push_back(pose.stamp_s);
  std::vector<std::optional<Pose3>> found;
  for (const FrameReport& report : reports) {
    const auto entry = NearestStamp(stamps_s, report.stamp_s, kMaxStampDifferenceS);
    found.push_back(entry ? std::optional(final_poses[*entry].world_from_camera) : std::nullopt);
  }
  return found;
}

}  // namespace

MappingRun MapFrames(FrameSource& source, const MapperOptions& options,
                     const Trajectory& final_poses, const Progress& progress,
                     const GainOracle& oracle, const MatchOracle& match_oracle) {
  MappingRun run;
  run.camera = source.Camera();
  const auto start = std::chrono::steady_clock::now();
  IncrementalMapper mapper(options, run.camera, ThreadCpuUs, oracle);
  mapper.SetMatchOracle(match_oracle);
  const int count = source.FrameCount();
  while (const std::optional<Frame> frame = source.Next()) {
    const double before_us = ThreadCpuUs();
    run.reports.push_back(mapper.AddFrame(*frame));
    run.cpu_s += (ThreadCpuUs() - before_us) * 1e-6;
    run.loops.insert(run.loops.end(), frame->loops.begin(), frame->loops.end());
    const int done = static_cast<int>(run.reports.size());
    if (frame->depth && IsSample(done - 1, count)) {
      run.samples.push_back({frame->index, frame->depth});
    }
    if (progress) progress(done, count);
  }
  const double before_us = ThreadCpuUs();
  run.result = mapper.Finish(FinalPosesOf(run.reports, final_poses));
  run.cpu_s += (ThreadCpuUs() - before_us) * 1e-6;
  run.warnings = source.Warnings();
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

Trajectory SlamTrajectory(const MappingRun& run) {
  return Collect(run, [&](std::size_t i) { return run.reports[i].slam_from_camera; });
}

Trajectory OnlineTrajectory(const MappingRun& run) {
  return Collect(run, [&](std::size_t i) { return run.reports[i].map_from_camera; });
}

Trajectory FinalTrajectory(const MappingRun& run) {
  return Collect(run, [&](std::size_t i) { return run.result.map_from_camera[i]; });
}

}  // namespace depthgrid
