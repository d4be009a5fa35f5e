#include "eval/run/mapping_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "eval/metrics/association.h"
#include "eval/run/saturation_check.h"
#include "mapper/core/counted.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/level.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {
namespace {

// Number of frames whose images are kept for the report, evenly spread.
constexpr int kSampleFrames = 5;

bool IsSample(int position, int count) {
  if (count <= kSampleFrames) return true;
  // The middles of kSampleFrames equal parts.
  for (int i = 0; i < kSampleFrames; ++i) {
    if (position == count * (2 * i + 1) / (2 * kSampleFrames)) return true;
  }
  return false;
}

// The planar pose of the base as the source gave it.
Pose3 PlanarBase(const Pose3& map_from_camera, const Pose2& base_from_laser) {
  const Pose2 map_from_laser = BaseOf(map_from_camera);
  if (base_from_laser == Pose2{}) return Lift(map_from_laser);
  return Lift(map_from_laser * Inverse(base_from_laser));
}

template <typename PoseOf>
Trajectory Collect(const MappingRun& run, PoseOf pose_of) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    const std::optional<Pose3> pose = pose_of(i);
    if (!pose) continue;
    trajectory.push_back(
        {run.reports[i].stamp_s, run.camera ? *pose : PlanarBase(*pose, run.base_from_laser)});
  }
  return trajectory;
}

// SLAM's final pose of each frame, by stamp; empty if there are none.
std::vector<std::optional<Pose3>> FinalPosesOf(const std::vector<FrameReport>& reports,
                                               const Trajectory& final_poses) {
  if (final_poses.empty()) return {};
  const std::vector<double> stamps_s = StampsOf(final_poses);
  std::vector<std::optional<Pose3>> found;
  for (const FrameReport& report : reports) {
    const auto entry = NearestStamp(stamps_s, report.stamp_s, kMaxStampDifferenceS);
    found.push_back(entry ? std::optional(final_poses[*entry].world_from_camera) : std::nullopt);
  }
  return found;
}

}  // namespace

FrameRecorder::FrameRecorder(const MapperOptions& options,
                             const std::optional<PinholeCamera>& camera, int frame_count,
                             const GainOracle& oracle, const MatchOracle& match_oracle)
    : start_(std::chrono::steady_clock::now()),
      frame_count_(frame_count),
      scan_(options.scan),
      mapper_(options, camera, {ThreadCpuUs, SteadyUs}, oracle) {
  mapper_.SetMatchOracle(match_oracle);
  run_.camera = camera;
}

void FrameRecorder::Add(const Frame& frame) {
  run_.reports.push_back(mapper_.AddFrame(frame));
  run_.cpu_s += run_.reports.back().times.total_us * 1e-6;
  run_.loops.insert(run_.loops.end(), frame.loops.begin(), frame.loops.end());
  const int position = static_cast<int>(run_.reports.size()) - 1;
  if (frame.depth && IsSample(position, frame_count_)) {
    run_.samples.push_back({frame.index, frame.depth});
  }
  if (frame.depth && run_.camera) {
    run_.unmatched.Add(run_.reports.back(), *frame.depth, *run_.camera, scan_);
  }
  if (frame.depth && frame.slam_from_camera) {
    saturation_.Add(*frame.depth, *frame.slam_from_camera);
  }
}

MappingRun FrameRecorder::Finish(const Trajectory& final_poses) {
  const double before_us = ThreadCpuUs();
  run_.result = mapper_.Finish(FinalPosesOf(run_.reports, final_poses));
  run_.cpu_s += (ThreadCpuUs() - before_us) * 1e-6;
  run_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  run_.warnings = Warnings();
  return std::move(run_);
}

std::vector<double> TimesOfMappedFrames(const MappingRun& run) {
  std::vector<double> frames_us;
  for (const FrameReport& report : run.reports) {
    if (report.slam_from_camera) frames_us.push_back(report.times.total_us);
  }
  return frames_us;
}

std::vector<std::string> MendedPoses(const std::vector<FrameReport>& reports) {
  const auto add = [&](bool FrameReport::*happened, const char* what,
                       std::vector<std::string>& lines) {
    constexpr std::size_t kMostNamed = 5;
    std::vector<int> frames;
    for (const FrameReport& report : reports) {
      if (report.*happened) frames.push_back(report.index);
    }
    if (frames.empty()) return;
    const std::size_t named = std::min(frames.size(), kMostNamed);
    lines.push_back(fmt::format(
        "poses: {} at frame{} {}{}", what, frames.size() == 1 ? "" : "s",
        fmt::join(frames.begin(), frames.begin() + named, ", "),
        named < frames.size() ? fmt::format(" and {} more", frames.size() - named) : ""));
  };
  std::vector<std::string> lines;
  add(&FrameReport::slipped, "a sudden turn that the scans do not show was taken out", lines);
  add(&FrameReport::carried,
      "what is seen lies elsewhere, as where the camera was carried or the place was wrong,",
      lines);
  add(&FrameReport::relocated, "what was seen since they were lost was moved to its place", lines);
  return lines;
}

std::vector<std::string> GuessWarnings(const std::vector<GuessedFrames>& guessed) {
  std::vector<std::string> lines;
  constexpr std::size_t kMostGuesses = 4;
  for (const auto& [first, last] : guessed) {
    if (lines.size() == kMostGuesses && guessed.size() > kMostGuesses + 1) {
      lines.push_back(fmt::format("poses: and {} such parts more", guessed.size() - kMostGuesses));
      break;
    }
    const std::string where =
        last ? fmt::format(" and again after frame {}; where the map has what lies between", *last)
             : "; where the map goes on from there";
    lines.push_back(
        fmt::format("poses: SLAM was lost before frame {}{} is a guess that nothing seen since "
                    "confirms",
                    first, where));
  }
  return lines;
}

std::vector<std::string> AstrayWarnings(const std::vector<AstrayFrames>& astray) {
  std::vector<std::string> lines;
  for (const AstrayFrames& part : astray) {
    lines.push_back(fmt::format(
        "poses: from frame {} to {} the map's way is {:.2f} m apart from SLAM's, {:.0f} "
        "times as much as usual, and nothing seen tells which is right: SLAM slipped, "
        "or something that moved along was taken for walls",
        part.first, part.last, part.apart_m, part.apart_m / part.usual_m));
  }
  return lines;
}

std::vector<std::string> FrameRecorder::Warnings() const {
  std::vector<std::string> lines = MendedPoses(run_.reports);
  if (const auto cut = saturation_.Found(); cut && cut->z_m < scan_.max_range_m) {
    lines.push_back(
        fmt::format("depth images: {} hold {:.3f} m, the largest depth, all over whatever is "
                    "behind: if all that is farther is cut to it, it is drawn as walls; --set "
                    "mapper.scan.max_range_m={:.2f} takes it for free space",
                    Counted(cut->frames, "frame"), cut->z_m, 0.99 * cut->z_m));
  }
  for (std::string& line : GuessWarnings(run_.result.guessed)) lines.push_back(std::move(line));
  for (std::string& line : AstrayWarnings(run_.result.astray)) lines.push_back(std::move(line));
  return lines;
}

MappingRun MapFrames(FrameSource& source, const MapperOptions& options,
                     const MappingInputs& inputs) {
  const int count = source.FrameCount();
  FrameRecorder recorder(options, source.Camera(), count, inputs.oracle, inputs.match_oracle);
  if (inputs.prior != nullptr) recorder.StartFrom(*inputs.prior);
  int done = 0;
  while (const std::optional<Frame> frame = source.Next()) {
    recorder.Add(*frame);
    if (inputs.progress) inputs.progress(++done, count);
  }
  MappingRun run = recorder.Finish(inputs.final_poses);
  const std::vector<std::string> of_source = source.Warnings();
  run.warnings.insert(run.warnings.begin(), of_source.begin(), of_source.end());
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
