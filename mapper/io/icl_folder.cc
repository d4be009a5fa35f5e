#include "mapper/io/icl_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/numbered_images.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRayEnding = ".depth";
// Rays longer than this are not in metres: the office's files are in centimetres. A few may be
// longer, through a window or as outliers.
constexpr float kCentimetresAbove = 50.0F;
constexpr double kNearlyAll = 0.95;
// After this many images without data or damaged, the unit is taken to be metres.
constexpr std::size_t kImagesToTry = 20;

// The first file (by name) with the ending, empty when there is none.
std::string FileWith(const std::string& folder, const std::string& ending) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().ends_with(ending)) found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  return found.empty() ? "" : found.front();
}

// .gt.sim has no stamps: one matrix per image, or one for each but the first. Images may have been
// removed since, matrices not.
SlamOutput SlamOutputOf(std::vector<std::optional<Pose3>> poses, Recording& recording,
                        const std::string& path) {
  const std::size_t images = recording.images.size();
  const auto last = static_cast<std::size_t>(recording.images.back().number);
  const bool lacks_first = poses.size() + 1 == images || poses.size() == last;
  if (poses.size() != images && lacks_first) poses.insert(poses.begin(), std::nullopt);
  if (poses.size() < images) {
    throw InputError(path, fmt::format("holds {} for {}", Counted(poses.size(), "pose"),
                                       Counted(images, "image")));
  }
  const PairedPoses paired =
      PairInOrder(std::move(poses), NamesOf(recording), path, recording.warnings);
  SlamOutput slam;
  slam.lack_is_told = paired.lack_is_told;
  for (std::size_t i = 0; i < images; ++i) {
    const auto& pose = paired.poses[i];
    slam.live.push_back({recording.images[i].stamp_s, pose, 0});
    if (pose) slam.final.push_back({recording.images[i].stamp_s, *pose});
  }
  return slam;
}

}  // namespace

bool IsIclFolder(const std::string& folder) {
  const bool truth =
      !FileWith(folder, ".gt.freiburg").empty() || !FileWith(folder, ".gt.sim").empty();
  return !NumberedImagesIn(folder, kRayEnding).empty() ||
         (truth && !NumberedImagesIn(fs::path(folder) / "depth", ".png").empty());
}

Recording ListIclFolder(const std::string& folder) {
  Recording recording;
  recording.name = folder;
  auto images = NumberedImagesIn(fs::path(folder) / "depth", ".png");
  if (images.empty()) images = NumberedImagesIn(folder, kRayEnding);
  for (const NumberedImage& image : images) {
    const auto stamp_s = static_cast<double>(image.number);
    if (!recording.images.empty() && recording.images.back().stamp_s == stamp_s) continue;
    recording.images.push_back({stamp_s, image.path.string(), image.number});
  }
  if (recording.images.empty()) {
    throw InputError(folder, "holds neither depth/<n>.png nor *_<n>.depth");
  }
  return recording;
}

SlamOutput ReadIclPoses(const std::string& folder, Recording& recording) {
  if (const std::string path = FileWith(folder, ".gt.freiburg"); !path.empty()) {
    return SlamOutputOf(ReadTrajectory(path, recording.warnings));
  }
  if (const std::string path = FileWith(folder, ".gt.sim"); !path.empty()) {
    return SlamOutputOf(ReadMatrixPoses(path, recording.warnings), recording, path);
  }
  throw InputError(folder, "holds no poses (*.gt.freiburg or *.gt.sim)");
}

CameraDescription IclCamera(const std::string& folder, std::vector<std::string>& warnings) {
  const std::string path = (fs::path(folder) / "camera.yaml").string();
  if (fs::exists(path)) return ReadCameraDescription(path, warnings);
  CameraDescription camera;
  camera.kind = "ICL-NUIM";
  camera.file.camera = PinholeCamera{640, 480, 481.20, 480.00, 319.5, 239.5, {}};
  camera.y_up = true;  // its fy is -480
  return camera;
}

DepthImage ParseRayLengths(const std::string& text, const PinholeCamera& camera,
                           const std::string& place) {
  DepthImage image(camera.width_px, camera.height_px);
  std::size_t count = 0;
  for (const TextRow& row : SplitRows(text)) {
    for (const std::string_view field : row.fields) {
      const auto number = ParseNumber(field);
      if (!number) {
        throw InputError(PlaceOfLine(place, row.line),
                         fmt::format("'{}' is not a number", field.substr(0, 40)));
      }
      if (count < image.z_m.size()) {
        image.z_m[count] =
            std::isfinite(*number) && *number > 0.0 ? static_cast<float>(*number) : kInvalidDepth;
      }
      ++count;
    }
  }
  if (count != image.z_m.size()) {
    throw InputError(place, fmt::format("holds {} ray lengths, must hold {} ({}x{})", count,
                                        image.z_m.size(), camera.width_px, camera.height_px));
  }
  return image;
}

double RayUnitM(const DepthImage& lengths) {
  std::vector<float> seen;
  std::copy_if(lengths.z_m.begin(), lengths.z_m.end(), std::back_inserter(seen),
               [](float length) { return length != kInvalidDepth; });
  if (seen.empty()) return 0.0;
  const auto nearly_all = static_cast<std::size_t>(kNearlyAll * static_cast<double>(seen.size()));
  const auto longest = seen.begin() + static_cast<std::ptrdiff_t>(nearly_all);
  std::nth_element(seen.begin(), longest, seen.end());
  return *longest > kCentimetresAbove ? 0.01 : 1.0;
}

namespace {

// One unit for the whole folder, as an image of a near wall in centimetres could pass for metres.
double RayUnitM(const Recording& recording, const PinholeCamera& camera) {
  const auto images = ImagesOfPart(recording);
  for (const RecordedImage& image : images.first(std::min(images.size(), kImagesToTry))) {
    const std::string& path = image.depth_path;
    if (!path.ends_with(kRayEnding)) break;
    try {
      const double unit_m = RayUnitM(ParseRayLengths(ReadTextFile(path), camera, path));
      if (unit_m > 0.0) return unit_m;
    } catch (const InputError&) {  // reported when the recording is read
    }
  }
  return 1.0;
}

DepthImage DepthOfRays(const DepthImage& lengths, double unit_m, const PinholeCamera& camera) {
  DepthImage image(camera.width_px, camera.height_px);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const double stretch = Unproject(camera, u, v, 1.0).norm();
      image.Row(v)[u] = static_cast<float>(lengths.At(u, v) * unit_m / stretch);
    }
  }
  return image;
}

}  // namespace

DepthReader IclDepthReader(const Recording& recording, const RecordingOptions& options) {
  const PinholeCamera& camera = recording.camera.camera;
  return [png = PngDepthReader(DepthFormatOf(recording.camera, options)), camera,
          unit_m = RayUnitM(recording, camera)](const std::string& path) {
    if (!path.ends_with(kRayEnding)) return png(path);
    return DepthOfRays(ParseRayLengths(ReadTextFile(path), camera, path), unit_m, camera);
  };
}

}  // namespace depthgrid
