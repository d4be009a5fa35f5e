#include "mapper/io/frame_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/damage.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/numbered_images.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Exports of depth in millimetres (7-Scenes, 3DMatch, ScanNet) when no camera file says otherwise.
constexpr double kMillimetres = 1000.0;

std::vector<NumberedImage> DepthImagesOf(const fs::path& folder) {
  for (const char* ending : {".depth.png", "-depth.png", "_depth.png"}) {
    auto images = NumberedImagesIn(folder, ending);
    if (!images.empty()) return images;
  }
  return NumberedImagesIn(folder / "depth", ".png");
}

// The folder itself, or its only sequence (3DMatch keeps the intrinsics beside seq-01).
fs::path FolderOfImages(const fs::path& folder) {
  if (!DepthImagesOf(folder).empty()) return folder;
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory() && entry.path().filename().string().starts_with("seq") &&
        !DepthImagesOf(entry.path()).empty()) {
      found.push_back(entry.path());
    }
  }
  if (found.size() > 1) {
    throw InputError(
        folder.string(),
        fmt::format("holds {} sequences, name one of them such as {}", found.size(),
                    std::min_element(found.begin(), found.end())->filename().string()));
  }
  return found.empty() ? folder : found.front();
}

// Large numbers are stamps since 1970 (ROS, EuRoC, RealSense), others count the frames.
double StampS(long number, const RecordingOptions& options) {
  const auto value = static_cast<double>(number);
  const double units_a_second = StampUnitsASecond(value);
  return value / (units_a_second > 1.0 ? units_a_second : options.frame_rate_hz);
}

std::optional<fs::path> FirstExisting(const std::vector<fs::path>& paths) {
  for (const fs::path& path : paths) {
    if (fs::is_regular_file(path)) return path;
  }
  return {};
}

std::optional<fs::path> PoseFileOf(const NumberedImage& image, const fs::path& folder) {
  const std::string plain = std::to_string(image.number) + ".txt";
  const std::string as_image = image.stem.filename().string() + ".txt";
  return FirstExisting({fs::path(image.stem.string() + ".pose.txt"), folder / "pose" / as_image,
                        folder / "pose" / plain, folder / "poses" / as_image,
                        folder / "poses" / plain});
}

std::optional<fs::path> PoseListOf(const fs::path& folder) {
  return FirstExisting({folder / "poses.txt", folder / "pose.txt", folder / "traj.txt"});
}

std::string CameraPathOf(const fs::path& folder) {
  std::vector<fs::path> candidates;
  for (const fs::path& place :
       {folder, folder / "intrinsic", fs::absolute(folder).lexically_normal().parent_path()}) {
    for (const char* name :
         {"camera.yaml", "camera_info.yaml", "camera-intrinsics.txt", "intrinsic_depth.txt",
          "intrinsics.txt", "intrinsic.json", "camera_intrinsic.json", "intrinsics.json"}) {
      candidates.push_back(place / name);
    }
  }
  const auto found = FirstExisting(candidates);
  return found ? found->string() : "";
}

// Poses of the images in order: one file each, or one line each in a common file.
std::vector<std::optional<Pose3>> PosesOf(const std::vector<NumberedImage>& images,
                                          const fs::path& folder, FrameFolder& listed) {
  Recording& recording = listed.recording;
  if (const auto list = PoseListOf(folder); list && !PoseFileOf(images.front(), folder)) {
    try {
      PairedPoses paired = PairInOrder(ReadMatrixPoses(list->string(), recording.warnings),
                                       NamesOf(recording), list->string(), recording.warnings);
      listed.poses.lack_is_told = paired.lack_is_told;
      return std::move(paired.poses);
    } catch (const InputError& error) {
      listed.poses_fault = error.what();
      return std::vector<std::optional<Pose3>>(images.size());
    }
  }
  std::vector<std::optional<Pose3>> poses;
  Tally damaged;
  for (const NumberedImage& image : images) {
    poses.emplace_back();
    const auto path = PoseFileOf(image, folder);
    if (!path) continue;
    try {
      poses.back() = ReadMatrixPose(path->string(), listed.without_pose);
    } catch (const InputError& error) {
      damaged.Add(error.what());
      listed.without_pose.Add(error.what());
    }
  }
  damaged.AppendTo(recording.warnings, recording.name, "pose file", "damaged");
  return poses;
}

}  // namespace

bool IsFrameFolder(const std::string& folder) {
  return !DepthImagesOf(FolderOfImages(folder)).empty();
}

FrameFolder ListFrameFolder(const std::string& folder, const RecordingOptions& options) {
  const fs::path images_folder = FolderOfImages(folder);
  std::vector<NumberedImage> images = DepthImagesOf(images_folder);
  if (images.empty()) {
    throw InputError(folder,
                     "holds no numbered depth images (frame-000000.depth.png, depth/0.png)");
  }
  FrameFolder listed;
  Recording& recording = listed.recording;
  recording.name = folder;
  const auto same = [](const auto& a, const auto& b) { return a.number == b.number; };
  const auto end = std::unique(images.begin(), images.end(), same);
  if (end != images.end()) {
    recording.warnings.push_back(fmt::format("{}: {} with a number already given, ignored", folder,
                                             Counted(images.end() - end, "image")));
    images.erase(end, images.end());
  }
  for (const NumberedImage& image : images) {
    const double stamp_s = image.stamp_s ? *image.stamp_s : StampS(image.number, options);
    recording.images.push_back({stamp_s, image.path.string(), image.number});
  }
  const auto poses = PosesOf(images, images_folder, listed);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const double stamp_s = recording.images[i].stamp_s;
    listed.poses.live.push_back({stamp_s, poses[i], 0});
    if (poses[i]) listed.poses.final.push_back({stamp_s, *poses[i]});
  }
  listed.camera_path = CameraPathOf(images_folder);
  return listed;
}

SlamOutput OwnPoses(const FrameFolder& folder) {
  if (!folder.poses_fault.empty()) throw InputError("", folder.poses_fault);
  const Tally& without = folder.without_pose;
  if (folder.poses.final.empty() && without.count > 0) {
    throw InputError(folder.recording.name,
                     fmt::format("none of {} holds a pose that can be used; first: {}",
                                 Counted(without.count, "pose file"), without.first));
  }
  if (folder.poses.final.empty()) {
    throw InputError(folder.recording.name,
                     "holds no poses (frame-000000.pose.txt, poses.txt, ...); --poses FILE gives "
                     "them");
  }
  return folder.poses;
}

CameraDescription FrameFolderCamera(const FrameFolder& folder, const std::string& camera_path,
                                    std::vector<std::string>& warnings) {
  const std::string path = camera_path.empty() ? folder.camera_path : camera_path;
  if (path.empty()) {
    throw InputError(folder.recording.name,
                     "has no camera file (camera.yaml, camera-intrinsics.txt, ... or --camera "
                     "FILE)");
  }
  CameraDescription camera = ReadCameraDescription(path, warnings);
  if (!camera.has_depth_scale) camera.file.depth_scale_per_m = kMillimetres;
  if (camera.takes_usual_scale) {
    warnings.push_back(NoDepthScale(path, camera.file.depth_scale_per_m));
  }
  CompleteSize(folder.recording, camera);
  return camera;
}

}  // namespace depthgrid
