#include "mapper/io/depth_sequence.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/io/camera_mount.h"
#include "mapper/io/frame_folder.h"
#include "mapper/io/icl_folder.h"
#include "mapper/io/leave_out_body.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// A TUM folder's own camera, or that of --camera. A file that cannot state a scale (a matrix) gives
// the same warning as a camera.yaml without it: many folders of this layout are in millimetres.
CameraDescription CameraOfTum(const std::string& folder, const std::string& given,
                              std::vector<std::string>& warnings) {
  CameraDescription camera =
      given.empty() ? TumFolderCamera(folder, warnings) : ReadCameraDescription(given, warnings);
  if (!camera.has_depth_scale || camera.takes_usual_scale) {
    const std::string path = given.empty() ? (fs::path(folder) / "camera.yaml").string() : given;
    warnings.push_back(NoDepthScale(path, camera.file.depth_scale_per_m));
  }
  return camera;
}

void TakeCamera(const CameraDescription& camera, const SequenceOptions& options,
                DepthSequence& sequence) {
  sequence.recording.camera = camera.file;
  sequence.y_up = camera.y_up;
  if (camera.mount_key.empty() || !options.camera_mount.empty()) return;
  sequence.notes.push_back(fmt::format(
      "poses are taken for the camera's; if they are a body's, such as the IMU's, --set "
      "sequence.camera_mount={} takes the camera's place on it from {}",
      camera.path, camera.mount_key));
}

// Makes the folder's own poses, if they are a body's, those of the camera.
void MountCamera(const std::string& path, DepthSequence& sequence) {
  const CameraMount mount = ReadCameraMount(path);
  sequence.slam = OnBody(std::move(sequence.slam), mount);
  sequence.body_from_camera = mount.body_from_camera;
  sequence.notes.push_back(Said(mount));
}

DepthSequence TumSequence(const std::string& path, const SequenceOptions& options,
                          const std::optional<SlamOutput>& slam) {
  DepthSequence sequence;
  sequence.recording = ListTumFolder(path, options.recording);
  sequence.recording.part = FindPart(options.part, sequence.recording);
  if (slam) {
    sequence.slam = *slam;
  } else {
    const std::string truth = (fs::path(path) / "groundtruth.txt").string();
    if (!fs::exists(truth)) {
      throw InputError(path,
                       "a TUM folder needs poses: a TUM trajectory (--poses FILE), or "
                       "groundtruth.txt in it");
    }
    sequence.slam = SlamOutputOf(ReadTrajectory(truth, sequence.recording.warnings));
    sequence.notes.emplace_back("poses: groundtruth.txt of the folder");
  }
  CameraDescription camera = CameraOfTum(path, options.camera, sequence.recording.warnings);
  CompleteSize(sequence.recording, camera);
  TakeCamera(camera, options, sequence);
  sequence.reader = PngDepthReader(DepthFormatOf(sequence.recording.camera, options.recording));
  return sequence;
}

DepthSequence IclSequence(const std::string& path, const SequenceOptions& options,
                          const std::optional<SlamOutput>& slam) {
  DepthSequence sequence;
  sequence.recording = ListIclFolder(path);
  sequence.recording.part = FindPart(options.part, sequence.recording);
  sequence.slam = slam ? *slam : ReadIclPoses(path, sequence.recording);
  CameraDescription camera =
      options.camera.empty() ? IclCamera(path, sequence.recording.warnings)
                             : ReadCameraDescription(options.camera, sequence.recording.warnings);
  CompleteSize(sequence.recording, camera);
  TakeCamera(camera, options, sequence);
  sequence.usual_up = camera.y_up ? WorldUp::kMinusY : WorldUp::kY;
  sequence.reader = IclDepthReader(sequence.recording, options.recording);
  return sequence;
}

DepthSequence FrameSequence(const std::string& path, const SequenceOptions& options,
                            const std::optional<SlamOutput>& slam) {
  FrameFolder listed = ListFrameFolder(path, options.recording);
  listed.recording.part = FindPart(options.part, listed.recording);
  const CameraDescription camera =
      FrameFolderCamera(listed, options.camera, listed.recording.warnings);
  DepthSequence sequence;
  sequence.slam = slam ? *slam : OwnPoses(listed);
  sequence.recording = std::move(listed.recording);
  TakeCamera(camera, options, sequence);
  sequence.reader = PngDepthReader(DepthFormatOf(camera.file, options.recording));
  return sequence;
}

DepthSequence ReadAsWritten(const std::string& path, SequenceFormat format,
                            const SequenceOptions& options, const std::optional<SlamOutput>& slam) {
  if (format == SequenceFormat::kTum) return TumSequence(path, options, slam);
  if (format == SequenceFormat::kIcl) return IclSequence(path, options, slam);
  return FrameSequence(path, options, slam);
}

}  // namespace

Recording ListDepthImages(const std::string& path, SequenceFormat format,
                          const SequenceOptions& options) {
  Recording recording = format == SequenceFormat::kTum ? ListTumFolder(path, options.recording)
                        : format == SequenceFormat::kIcl
                            ? ListIclFolder(path)
                            : ListFrameFolder(path, options.recording).recording;
  recording.part = FindPart(options.part, recording);
  return recording;
}

DepthSequence ReadDepthSequence(const std::string& path, SequenceFormat format,
                                const SequenceOptions& options,
                                const std::optional<SlamOutput>& slam) {
  DepthSequence sequence = ReadAsWritten(path, format, options, slam);
  sequence.recording.poses_given = slam.has_value();
  if (sequence.y_up && !options.camera_mount.empty()) {
    throw SettingError("sequence.camera_mount",
                       fmt::format("is {}, must be empty where fy is negative: such poses are of a "
                                   "left-handed camera",
                                   options.camera_mount));
  }
  if (!slam && !options.camera_mount.empty()) MountCamera(options.camera_mount, sequence);
  if (sequence.y_up) sequence.slam = FlipY(std::move(sequence.slam));
  if (options.recording.drop_body) internal::LeaveOutBody(options.recording, sequence);
  return sequence;
}

}  // namespace depthgrid
