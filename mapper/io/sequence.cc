#include "mapper/io/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/damage.h"
#include "mapper/io/depth_sequence.h"
#include "mapper/io/find_up.h"
#include "mapper/io/frame_folder.h"
#include "mapper/io/icl_folder.h"
#include "mapper/io/lost_markers.h"
#include "mapper/io/slam_jumps.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// A given axis farther than this from the floor's normal is wrong: axes are 90 degrees apart, and
// an oblique world has no nearest one.
const double kSureOfAxis = std::cos(RadFromDeg(45.0));
// Tolerance for the opposite of an axis: SLAM's tilt, errors of normals, and what poses of a
// left-handed world make of the floor (15 degrees were seen). Not more, as up comes near to -z also
// in the axes of a first camera that looks down steeply. Chosen.
const double kSureOfOpposite = std::cos(RadFromDeg(30.0));
// Of the first pose of a world that it defines; files round.
constexpr double kIsIdentityRad = RadFromDeg(0.1);
// A floor this near to zero is set to zero, where ground truth has it; estimates scatter by
// centimetres.
constexpr double kFloorIsZeroM = 0.02;

// The number of jumps within the part.
std::size_t JumpsOfPart(const std::vector<int>& jumps, const DepthSequence& sequence,
                        const RecordingOptions& options) {
  const Recording& recording = sequence.recording;
  if (ImagesOfPart(recording).size() == recording.images.size()) return jumps.size();
  const double begin_s = ImagesOfPart(recording).front().stamp_s + options.time_offset_s;
  const double end_s = ImagesOfPart(recording).back().stamp_s + options.time_offset_s;
  return static_cast<std::size_t>(std::count_if(jumps.begin(), jumps.end(), [&](int jump) {
    const double stamp_s = sequence.slam.live[static_cast<std::size_t>(jump)].stamp_s;
    return begin_s < stamp_s && stamp_s <= end_s;
  }));
}

// Finds SLAM's corrections in a folder's own poses, which do not state them.
void FindCorrections(const std::string& path, const RecordingOptions& options,
                     DepthSequence& sequence, std::vector<std::string>& notes) {
  SlamOutput& slam = sequence.slam;
  const std::vector<int> markers = FindLostMarkers(slam.live, Pose3{} * sequence.body_from_camera);
  WarnOfCount(sequence.recording.warnings, path, static_cast<int>(markers.size()), "pose",
              kLostMarkers);
  Forget(markers, slam.live);
  const std::vector<int> jumps = FindJumps(slam.live, {});
  if (const auto doubt = DoubtOf(slam.live, jumps)) {
    sequence.recording.warnings.push_back(path + ": " + *doubt);
    return;  // these are no corrections
  }
  if (const std::size_t count = JumpsOfPart(jumps, sequence, options); count > 0) {
    notes.push_back(fmt::format("the poses jump at {}: their motion there is not used",
                                Counted(count, "frame")));
  }
  StartEpochs(jumps, slam.live);
}

// Checks the convention of its poses.
std::optional<PoseDoubt> CheckPoses(const DepthSequence& sequence,
                                    const RecordingOptions& options) {
  std::vector<RecordedImage> chosen = PairsAmong(ImagesOfPart(sequence.recording));
  std::vector<ImagePair> pairs;
  try {
    const auto source = OpenRecording(WithImages(sequence.recording, std::move(chosen)),
                                      sequence.slam, options, sequence.reader);
    while (const auto first = source->Next()) {
      const auto second = source->Next();
      if (!first->depth || !second->depth) continue;
      if (IsMostlyCut(*first->depth) || IsMostlyCut(*second->depth)) continue;
      pairs.push_back({first->stamp_s, second->stamp_s, first->depth, second->depth});
    }
    return DoubtOfPoses(pairs, *source->Camera(), sequence.slam.live, options, sequence.y_up);
  } catch (const InputError&) {
    return {};  // the error is reported when the whole recording is opened
  }
}

std::optional<Gravity> FindGravity(const DepthSequence& sequence, const RecordingOptions& options) {
  return FindGravity(sequence.recording, sequence.slam, sequence.reader, options);
}

// Warns if the images contradict a given axis, which is used anyway.
void CheckAxis(const DepthSequence& sequence, const SequenceOptions& options, Sequence& result) {
  const auto gravity = FindGravity(sequence, options.recording);
  if (!gravity) return;
  const double along = gravity->up_in_world.dot(AxisOf(options.world_up));
  if (along <= kSureOfAxis) {
    result.up_doubt =
        UpDoubt{ShownUp(SnappedUp(*gravity, sequence.usual_up)), along < -kSureOfOpposite};
  } else if (!IsTable(*gravity)) {
    result.seen_floor_z_m = gravity->floor_m;
  }
}

// Whether the first camera is the poses' world, as for ORB-SLAM2: if it looks down, z points down.
bool WorldIsFirstCamera(const SlamOutput& slam) {
  const auto first = std::find_if(slam.live.begin(), slam.live.end(), [](const SlamPose& pose) {
    return pose.slam_from_camera.has_value();
  });
  return first != slam.live.end() &&
         LogRotation(first->slam_from_camera->rotation).norm() < kIsIdentityRad;
}

std::string NoFloorWarning(const DepthSequence& sequence, const RecordingOptions& options) {
  const std::string taken =
      fmt::format("no floor seen in the images, {} is taken as up (--up says another axis)",
                  NameOf(sequence.usual_up));
  RecordingOptions other = options;
  other.upside_down = !options.upside_down;
  if (!FindGravity(sequence, other)) return taken;
  return fmt::format("{}; one is seen if {}", taken, OtherMount(options));
}

// Warns of an up that the images leave open.
void DoubtUp(const std::string& path, const RecordingOptions& options, const Gravity& gravity,
             const Eigen::Vector3d& up, DepthSequence& sequence) {
  std::vector<std::string>& warnings = sequence.recording.warnings;
  const bool is_minus_z = up == AxisOf(WorldUp::kMinusZ);
  if (is_minus_z || (-up.z() > kSureOfOpposite && !WorldIsFirstCamera(sequence.slam))) {
    warnings.push_back(fmt::format(
        "{}: up is {}, right if z of the poses' world points down{}; if {}, the ceiling is taken "
        "for the floor and the map is mirrored; poses of a left-handed world have no right axis",
        path, ShownUp(up), is_minus_z ? " (--up -z says so)" : "", OtherMount(options)));
  } else if (gravity.crowded_above) {
    warnings.push_back(
        fmt::format("{}: things stand on what is taken for the ceiling: if {}, the map is mirrored",
                    path, OtherMount(options)));
  }
  if (gravity.floor_is_late) {
    warnings.push_back(path +
                       ": SLAM's height drifts, and the first images see no floor: every z may be "
                       "off by its drift until one does");
  }
}

// Finds up and adds notes about it.
Eigen::Vector3d FindUp(const std::string& path, const RecordingOptions& options,
                       DepthSequence& sequence, Sequence& result) {
  const auto gravity = FindGravity(sequence, options);
  if (!gravity) {
    sequence.recording.warnings.push_back(path + ": " + NoFloorWarning(sequence, options));
    return AxisOf(sequence.usual_up);
  }
  const Eigen::Vector3d up = SnappedUp(*gravity, sequence.usual_up);
  if (!IsTable(*gravity)) result.seen_floor_z_m = gravity->floor_m;
  result.floor_z_m = std::abs(gravity->floor_m) < kFloorIsZeroM ? 0.0 : gravity->floor_m;
  const double removed_deg = DegFromRad(std::acos(std::clamp(up.z(), -1.0, 1.0)));
  result.notes.push_back(fmt::format("up is {}, removed {:.1f} degrees", ShownUp(up), removed_deg));
  result.notes.push_back(
      fmt::format("the camera is {:.2f} m above the floor, the floor at z = {:.2f}",
                  gravity->camera_height_m, *result.floor_z_m));
  DoubtUp(path, options, *gravity, up, sequence);
  return up;
}

[[noreturn]] void RefuseBag(const std::string& path, const char* name) {
  throw InputError(path, fmt::format("is {}, which is not read: must be a folder of depth images "
                                     "or a CARMEN laser log (docs/formats.md); "
                                     "docs/examples/from_bag.py makes either of it",
                                     name));
}

// Rejects recordings that would otherwise be taken for damaged text.
void RefuseOtherSystems(const std::string& path) {
  if (path.ends_with(".bag")) RefuseBag(path, "a ROS bag by its name");
  if (path.ends_with(".db3")) RefuseBag(path, "a ROS 2 bag by its name");
  if (path.ends_with(".mcap")) RefuseBag(path, "an MCAP recording by its name");
  for (const auto& [ending, name] :
       {std::pair(".rawlog", "an MRPT rawlog"), std::pair(".pbstream", "a Cartographer map")}) {
    if (!path.ends_with(ending)) continue;
    throw InputError(path, fmt::format("is {} by its name, which is not read: must be a folder of "
                                       "depth images or a CARMEN laser log (docs/formats.md)",
                                       name));
  }
}

// Whether it is a folder as written by `ros2 bag record`.
bool IsRos2Folder(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(fs::path(path) / "metadata.yaml", ignored)) return false;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored)) {
    const std::string name = entry.path().filename().string();
    for (const char* kind : {".db3", ".mcap"}) {
      if (name.find(kind) != std::string::npos) return true;
    }
  }
  return false;
}

void SayPart(const FrameNames& names, std::vector<std::string>& notes) {
  if (!names.IsWhole()) notes.push_back("the part of it: " + PartShown(names));
}

}  // namespace

std::string UpDoubtText(const UpDoubt& doubt, const RecordingOptions& options) {
  const std::string ceiling =
      doubt.opposite ? fmt::format("; if {}, that is the ceiling", OtherMount(options)) : "";
  return fmt::format("the floor seen in the images says {}, if they are {}{}", doubt.up,
                     options.upside_down ? "upside down" : "upright", ceiling);
}

SequenceFormat DetectFormat(const std::string& path) {
  std::error_code ignored;  // such as for a name that is too long
  if (!fs::exists(path, ignored)) throw InputError(path, "no such file or folder");
  if (!fs::is_directory(path)) {
    RefuseOtherSystems(path);
    return SequenceFormat::kCarmen;
  }
  if (fs::exists(fs::path(path) / "depth.txt")) return SequenceFormat::kTum;
  if (IsIclFolder(path)) return SequenceFormat::kIcl;
  if (IsFrameFolder(path)) return SequenceFormat::kFrames;
  if (IsRos2Folder(path)) RefuseBag(path, "a ROS 2 bag");
  const fs::path above = (fs::path(path) / "..").lexically_normal();
  if (fs::exists(above / "depth.txt", ignored)) {
    const bool ends_in_slash = !above.has_filename() && above.has_relative_path();
    throw InputError(path, fmt::format("is no sequence, must be the folder above it, {}, which "
                                       "holds depth.txt",
                                       (ends_in_slash ? above.parent_path() : above).string()));
  }
  throw InputError(path,
                   "is no kind of sequence that is known (docs/formats.md): no depth.txt, no "
                   "*.gt.freiburg, no numbered depth images");
}

SequenceFormat FormatOf(const std::string& path, const SequenceOptions& options) {
  if (options.format == SequenceFormat::kAuto) return DetectFormat(path);
  std::error_code ignored;
  if (options.format != SequenceFormat::kCarmen && fs::exists(path, ignored) &&
      !fs::is_directory(path, ignored)) {
    throw InputError(
        path, fmt::format("is a file, must be a {} (sequence.format)", NameOf(options.format)));
  }
  return options.format;
}

FrameNames SequenceFrames(const std::string& path, const SequenceOptions& options) {
  const SequenceFormat format = FormatOf(path, options);
  if (format == SequenceFormat::kCarmen) return CarmenFrames(path, options.laser, options.part);
  return NamesOf(ListDepthImages(path, format, options), options.recording);
}

Sequence OpenSequence(const std::string& path, const SequenceOptions& options,
                      const std::optional<SlamOutput>& slam) {
  const SequenceFormat format = FormatOf(path, options);
  Sequence result;
  result.kind = NameOf(format);
  if (format == SequenceFormat::kCarmen) {
    if (slam && !slam->live.empty()) throw InputError(path, "a laser log brings its own poses");
    CarmenLog log = OpenCarmenLog(path, options.laser,
                                  slam ? slam->loops : std::vector<LoopClosure>{}, options.part);
    result.source = std::move(log.source);
    SayPart(log.names, result.notes);
    return result;
  }
  DepthSequence sequence = ReadDepthSequence(path, format, options, slam);
  result.notes = std::move(sequence.notes);
  SayPart(NamesOf(sequence.recording), result.notes);
  if (!slam) FindCorrections(path, options.recording, sequence, result.notes);
  result.pose_doubt = CheckPoses(sequence, options.recording);
  if (options.world_up != WorldUp::kAuto) CheckAxis(sequence, options, result);
  const Eigen::Vector3d up = options.world_up == WorldUp::kAuto
                                 ? FindUp(path, options.recording, sequence, result)
                                 : AxisOf(options.world_up);
  const auto& images = sequence.recording.images;
  if (!images.empty() && images.front().depth_path.ends_with(".png")) {
    result.depth_scale_per_m =
        DepthFormatOf(sequence.recording.camera, options.recording).scale_per_m;
  }
  SlamOutput level = Rotated(std::move(sequence.slam), LevelFromWorld(up));
  result.source = OpenRecording(std::move(sequence.recording), level, options.recording,
                                std::move(sequence.reader));
  result.final_poses = std::move(level.final);
  for (StampedPose& pose : result.final_poses) pose.stamp_s -= options.recording.time_offset_s;
  return result;
}

}  // namespace depthgrid
