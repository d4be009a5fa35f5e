#include "mapper/io/slam_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/damage.h"
#include "mapper/io/file.h"
#include "mapper/io/loop_events.h"
#include "mapper/io/lost_markers.h"
#include "mapper/io/pose_file.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/slam_jumps.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

constexpr const char* kHeader =
    "kind,frame,epoch,first,second,tx_m,ty_m,tz_m,qx,qy,qz,qw,sigma_translation_m,"
    "sigma_rotation_rad,stamp_s,first_stamp_s,second_stamp_s\n";

std::string LoopRow(const LoopClosure& loop, int epoch, const std::vector<SlamPose>& live) {
  const auto stamp_s = [&](int frame) { return live[static_cast<std::size_t>(frame)].stamp_s; };
  const Eigen::Vector3d& t = loop.first_from_second.translation;
  const Eigen::Quaterniond& q = loop.first_from_second.rotation;
  return fmt::format("loop,{},{},{},{},{},{},{},{},{},{},{},{},{},{:.6f},{:.6f},{:.6f}\n",
                     loop.reported_at_frame, epoch, loop.first_frame, loop.second_frame, t.x(),
                     t.y(), t.z(), q.x(), q.y(), q.z(), q.w(), loop.sigma_translation_m,
                     loop.sigma_rotation_rad, stamp_s(loop.reported_at_frame),
                     stamp_s(loop.first_frame), stamp_s(loop.second_frame));
}

// Whether SLAM was found again at this frame, so that a loop here need not be its only correction.
bool IsFoundAgain(const std::vector<SlamPose>& live, std::size_t frame) {
  return frame > 0 && live[frame].slam_from_camera && !live[frame - 1].slam_from_camera;
}

constexpr const char* kImuPosesTaken =
    "EuRoC's and VINS's poses are those of the IMU, these are taken for the camera's; if they are "
    "not, --set sequence.camera_mount=FILE says where the camera is on it (EuRoC's sensor.yaml, "
    "Kalibr's camchain, VINS's settings)";

struct FramedPose {
  std::size_t frame = 0;
  StampedPose pose;
};

std::string RangesOf(const FrameNames& frames, const Trajectory& poses) {
  return StampRanges(frames, StampsOf(poses));
}

// The error for a file without a pose at the stamp of any mapped frame.
void RequireShared(bool any_shared, const Trajectory& poses, const std::string& path,
                   const FrameNames& frames, double max_difference_s) {
  if (any_shared || frames.stamps_s.empty()) return;
  throw InputError(path, fmt::format("no pose within {} s of any image: {}", max_difference_s,
                                     RangesOf(frames, poses)));
}

std::string FewText(std::size_t with_pose, const FrameNames& frames, const Trajectory& poses,
                    const std::string& path) {
  return fmt::format("{}: gives {} of {} frames a pose: {}", path, with_pose, frames.CountInPart(),
                     RangesOf(frames, poses));
}

// Assigns poses to input frames, to each the nearest. Poses without a frame are counted in the
// warnings.
std::vector<FramedPose> PosesByFrame(const Trajectory& poses, const FrameNames& frames,
                                     double max_difference_s, const std::string& path,
                                     std::vector<std::string>& warnings) {
  const std::vector<double>& stamps_s = frames.stamps_s;
  std::vector<FramedPose> framed;
  int homeless = 0;
  int doubled = 0;
  const auto distance_s = [&](const FramedPose& f) {
    return std::abs(f.pose.stamp_s - stamps_s[f.frame]);
  };
  for (const StampedPose& pose : poses) {
    const auto frame = NearestStamp(stamps_s, pose.stamp_s, max_difference_s);
    if (!frame) {
      ++homeless;
      continue;
    }
    const FramedPose found{*frame, pose};
    if (framed.empty() || framed.back().frame != *frame) {
      framed.push_back(found);
      continue;
    }
    ++doubled;
    if (distance_s(found) < distance_s(framed.back())) framed.back() = found;
  }
  const auto warn = [&](int count, const char* thing, const char* what) {
    WarnOfCount(warnings, path, count, thing, what);
  };
  warn(homeless, "pose", "with the stamp of no input frame, ignored");
  warn(doubled, "pose",
       "beside a nearer one of the same input frame, ignored "
       "(sequence.recording.interpolate_poses=true goes between neighbours)");
  return framed;
}

std::vector<SlamPose> LivePoses(const std::vector<FramedPose>& poses,
                                const std::vector<SlamEvent>& events,
                                const std::vector<double>& stamps_s) {
  std::vector<SlamPose> live;
  for (const double stamp_s : stamps_s) live.push_back({stamp_s, std::nullopt, 0});
  for (const FramedPose& framed : poses) {
    live[framed.frame].slam_from_camera = framed.pose.world_from_camera;
  }
  auto event = events.begin();
  int epoch = 0;
  for (std::size_t i = 0; i < live.size(); ++i) {
    for (; event != events.end() && static_cast<std::size_t>(event->frame) == i; ++event) {
      epoch = event->epoch ? *event->epoch : epoch + (event->new_epoch ? 1 : 0);
    }
    live[i].epoch = epoch;
  }
  return live;
}

// Starts an epoch at each of SLAM's corrections that `live` shows.
void StartCorrections(const SlamFilePaths& paths, const Trajectory& revised,
                      std::vector<SlamPose>& live, std::vector<std::string>& warnings) {
  const std::vector<int> markers = FindLostMarkers(live);
  WarnOfCount(warnings, paths.live, static_cast<int>(markers.size()), "pose", kLostMarkers);
  Forget(markers, live);
  const std::vector<int> jumps = FindJumps(live, revised);
  if (const auto doubt = DoubtOf(live, jumps)) {
    warnings.push_back(paths.live + ": " + *doubt);
    return;  // these are no corrections
  }
  StartEpochs(jumps, live);
}

// The frames with the first pose of an epoch that none of `before` has.
std::vector<int> Corrected(const std::vector<SlamPose>& before, const std::vector<SlamPose>& live) {
  std::vector<int> corrected;
  int begun = 0;
  for (std::size_t i = 0; i < live.size(); ++i) {
    const int more = live[i].epoch - before[i].epoch;
    if (!live[i].slam_from_camera || more <= begun) continue;
    corrected.push_back(static_cast<int>(i));
    begun = more;
  }
  return corrected;
}

// Tells SLAM's corrections, and takes loops from them if nothing else states any.
void SayCorrections(const SlamFilePaths& paths, const std::vector<int>& frames,
                    const FramePart& part, SlamInput& input) {
  SlamOutput& slam = input.slam;
  const auto count = std::count_if(frames.begin(), frames.end(), [&](int frame) {
    return part.Has(static_cast<std::size_t>(frame));
  });
  if (count > 0) {
    input.notes.push_back(fmt::format("SLAM corrected itself at {} (jumps of its live poses)",
                                      Counted(count, "frame")));
  }
  if (!paths.loops.empty() || paths.final.empty()) return;
  slam.loops = LoopsFromRevision(slam.live, slam.final, frames);
  if (!slam.loops.empty()) {
    input.notes.push_back(
        fmt::format("{} read off the revised poses", Counted(slam.loops.size(), "loop closure")));
  }
}

// The poses, which may be of no frame, with the epochs of the frames.
std::vector<SlamPose> WithEpochs(const Trajectory& poses, const std::vector<SlamPose>& frames) {
  std::vector<SlamPose> all;
  std::size_t next = 0;
  int epoch = 0;
  for (const auto& [stamp_s, pose] : poses) {
    for (; next < frames.size() && frames[next].stamp_s <= stamp_s; ++next) {
      epoch = frames[next].epoch;
    }
    all.push_back({stamp_s, pose, epoch});
  }
  return all;
}

// Interpolates each frame's pose between the two nearest ones. Epochs never go down; a frame
// without a pose keeps its own.
std::vector<SlamPose> InterpolatedFrames(const std::vector<SlamPose>& poses,
                                         const SlamReading& reading, std::vector<SlamPose> frames) {
  RecordingOptions options;
  options.interpolate_poses = true;
  options.max_interpolation_gap_s = reading.max_interpolation_gap_s;
  const PoseTrack track(poses, options);
  int epoch = 0;
  for (SlamPose& frame : frames) {
    const PoseTrack::Found found = track.At(frame.stamp_s);
    epoch = std::max(epoch, found.slam_from_camera ? found.epoch : frame.epoch);
    frame = {frame.stamp_s, found.slam_from_camera, epoch};
  }
  return frames;
}

// Reads a file of events and adds its loops, warnings and a note to `input`.
SlamEvents TakeEvents(const std::string& path, const FrameNames& frames, double max_difference_s,
                      SlamInput& input) {
  SlamEvents events = ParseSlamEvents(ReadTextFile(path), path, frames, max_difference_s);
  input.warnings.insert(input.warnings.end(), events.warnings.begin(), events.warnings.end());
  std::vector<LoopClosure>& loops = input.slam.loops;
  for (const SlamEvent& event : events.events) {
    if (event.loop) loops.push_back(*event.loop);
  }
  input.notes.push_back(
      fmt::format("{} from {}", Counted(loops.size(), "loop closure"), events.kind));
  return events;
}

// Keeps only loops within the part; others join frames that are not mapped.
void KeepLoopsOf(const FramePart& part, SlamInput& input) {
  const auto left_out =
      std::erase_if(input.slam.loops, [&](const LoopClosure& loop) { return !part.Has(loop); });
  if (left_out == 0) return;
  input.notes.push_back(
      fmt::format("{} with an end outside the part, left out", Counted(left_out, "loop closure")));
}

std::vector<FramedPose> FramedLive(const Trajectory& live, const std::string& path,
                                   const FrameNames& frames, const SlamReading& reading,
                                   std::vector<std::string>& warnings) {
  std::vector<std::string> unsaid;  // dropped: poses of no frame are needed for interpolation
  auto framed = PosesByFrame(live, frames, reading.max_difference_s, path,
                             reading.interpolate ? unsaid : warnings);
  if (!reading.interpolate) {
    RequireShared(!framed.empty(), live, path, frames, reading.max_difference_s);
  }
  return framed;
}

// SLAM's final poses. Warns if few frames have one: they may have another clock or unit or be of
// another recording.
Trajectory ReadFinal(const std::string& path, const FrameNames& frames, double max_difference_s,
                     std::vector<std::string>& warnings) {
  Trajectory final = ReadPoseFile(path, frames, warnings);
  const auto revised = PosesByFrame(final, frames, max_difference_s, path, warnings);
  RequireShared(!revised.empty(), final, path, frames, max_difference_s);
  const auto of_part = static_cast<std::size_t>(
      std::count_if(revised.begin(), revised.end(),
                    [&](const FramedPose& pose) { return frames.part.Has(pose.frame); }));
  if (MostLackPoses(of_part, frames.CountInPart())) {
    warnings.push_back(FewText(of_part, frames, final, path));
  }
  return final;
}

// Starts the epochs of corrections that only the poses show, unless `epochs_known`, and
// interpolates, if wanted. `poses`: the live ones as given.
void FinishLive(const Trajectory& poses, const SlamFilePaths& paths, const SlamReading& reading,
                bool epochs_known, SlamInput& input) {
  SlamOutput& slam = input.slam;
  const Trajectory revised = paths.final.empty() ? Trajectory{} : slam.final;
  if (reading.interpolate) {
    // A correction is sought in the poses as they were given: spread over the frames between two of
    // them it looks like motion.
    std::vector<SlamPose> all = WithEpochs(poses, slam.live);
    if (!epochs_known) StartCorrections(paths, revised, all, input.warnings);
    slam.live = InterpolatedFrames(all, reading, std::move(slam.live));
  } else if (!epochs_known) {
    StartCorrections(paths, revised, slam.live, input.warnings);
  }
}

// Requires that a frame of the part has a pose. A warning if few have one, or each second has none.
std::optional<std::string> DoubtOfPosed(const std::vector<SlamPose>& live, const Trajectory& poses,
                                        const std::string& path, const FrameNames& frames,
                                        double max_difference_s) {
  std::vector<bool> has_pose;
  for (std::size_t i = frames.part.begin; i < frames.part.EndAmong(live.size()); ++i) {
    has_pose.push_back(live[i].slam_from_camera.has_value());
  }
  const auto posed = static_cast<std::size_t>(std::count(has_pose.begin(), has_pose.end(), true));
  RequireShared(posed > 0, poses, path, frames, max_difference_s);
  if (!MostLackPoses(posed, frames.CountInPart()) && !LacksEachSecondPose(has_pose)) return {};
  return FewText(posed, frames, poses, path);
}

// Makes a body's poses the camera's. ORB-SLAM's events are about the camera whatever its poses are.
void MountCamera(const CameraMount& mount, bool loops_are_cameras, SlamInput& input) {
  std::vector<LoopClosure> loops = input.slam.loops;
  input.slam = OnBody(std::move(input.slam), mount);
  if (loops_are_cameras) input.slam.loops = std::move(loops);
  input.notes.push_back(Said(mount));
}

}  // namespace

std::string LoopsText(const SlamOutput& output) {
  std::string text = kHeader;
  auto loop = output.loops.begin();
  int epoch = 0;
  for (std::size_t i = 0; i < output.live.size(); ++i) {
    const auto is_here = [&] {
      return loop != output.loops.end() && static_cast<std::size_t>(loop->reported_at_frame) == i;
    };
    const bool corrected = output.live[i].epoch != epoch;
    epoch = output.live[i].epoch;
    if (corrected && (!is_here() || IsFoundAgain(output.live, i))) {
      text += fmt::format("relocalisation,{},{},,,,,,,,,,,,{:.6f},,\n", i, epoch,
                          output.live[i].stamp_s);
    }
    for (; is_here(); ++loop) text += LoopRow(*loop, epoch, output.live);
  }
  Require(loop == output.loops.end(), "loops are ordered by the frame that reports them");
  return text;
}

void WriteSlamFiles(const std::string& folder, const SlamOutput& output) {
  Trajectory live;
  for (const SlamPose& pose : output.live) {
    if (pose.slam_from_camera) live.push_back({pose.stamp_s, *pose.slam_from_camera});
  }
  WriteTrajectory(folder + "/slam.txt", live);
  WriteTrajectory(folder + "/slam_final.txt", output.final);
  WriteFile(folder + "/loops.csv", LoopsText(output));
}

SlamInput ReadLoops(const std::string& path, const FrameNames& frames, double max_difference_s) {
  SlamInput input;
  TakeEvents(path, frames, max_difference_s, input);
  KeepLoopsOf(frames.part, input);
  return input;
}

SlamInput ReadSlamFiles(const SlamFilePaths& paths, const FrameNames& frames,
                        const SlamReading& reading) {
  const double max_difference_s = reading.max_difference_s;
  SlamInput input;
  SlamOutput& slam = input.slam;
  SlamEvents events;
  if (!paths.loops.empty()) events = TakeEvents(paths.loops, frames, max_difference_s, input);
  const std::string text = ReadTextFile(paths.live);
  const FilePoses given = ParsePoses(text, paths.live, frames, input.warnings);
  const Trajectory& live = given.poses;
  slam.lack_is_told = given.lack_is_told;
  slam.live = LivePoses(FramedLive(live, paths.live, frames, reading, input.warnings),
                        events.events, frames.stamps_s);
  slam.final =
      paths.final.empty() ? live : ReadFinal(paths.final, frames, max_difference_s, input.warnings);
  const std::vector<SlamPose> before = slam.live;
  const bool epochs_known = events.kind == kOwnEvents;
  FinishLive(live, paths, reading, epochs_known, input);
  if (!epochs_known) SayCorrections(paths, Corrected(before, slam.live), frames.part, input);
  KeepLoopsOf(frames.part, input);
  if (reading.mount) MountCamera(*reading.mount, events.kind == kOrbSlamEvents, input);
  if (!reading.mount && given.of_imu) input.warnings.push_back(paths.live + ": " + kImuPosesTaken);
  const auto doubt = DoubtOfPosed(slam.live, live, paths.live, frames, max_difference_s);
  // Matrices have the stamps of the frames that they were paired with.
  if (doubt && !HoldsMatrices(text)) input.warnings.push_back(*doubt);
  return input;
}

}  // namespace depthgrid
