#include "mapper/io/tum_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/trajectory.h"
#include "mapper/io/damage.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/png.h"
#include "mapper/io/stamp_order.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Before all stamps.
constexpr double kFirstStampS = -std::numeric_limits<double>::infinity();

std::string Joined(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

// The name that TumFolderWriter gives an image; `kind`: depth or rgb.
std::string ImageName(const std::string& kind, double stamp_s) {
  return fmt::format("{}/{:.6f}.png", kind, stamp_s);
}

// vision.in.tum.de/data/datasets/rgbd-dataset/file_formats, "Intrinsic Camera Calibration of the
// Kinect": the colour cameras, to which the depth images are registered.
std::optional<CameraFile> TumCamera(const std::string& folder) {
  const auto named = [&](const char* name) { return folder.find(name) != std::string::npos; };
  CameraFile file;
  PinholeCamera& camera = file.camera;
  if (named("freiburg1")) {
    camera = {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
  } else if (named("freiburg2")) {
    camera = {640, 480, 520.9, 521.0, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}};
  } else if (named("freiburg3")) {
    camera = {640, 480, 535.4, 539.2, 320.1, 247.6, {}};
  } else {
    return {};
  }
  return file;
}

StampedFileList ReadFileList(const std::string& path) {
  return ParseFileList(ReadTextFile(path), path);
}

// Gives each depth image the stamp of the nearest colour image, if poses have those stamps.
void StampByColour(const std::string& folder, const RecordingOptions& options,
                   Recording& recording) {
  const std::string path = Joined(folder, "rgb.txt");
  if (!fs::exists(path)) return;
  const StampedFileList colour = ReadFileList(path);
  recording.warnings.insert(recording.warnings.end(), colour.warnings.begin(),
                            colour.warnings.end());
  std::vector<double> stamps_s;
  for (const StampedFile& file : colour.files) stamps_s.push_back(file.stamp_s);
  int unpaired = 0;
  for (RecordedImage& image : recording.images) {
    const auto nearest = NearestStamp(stamps_s, image.stamp_s, options.max_stamp_difference_s);
    if (!nearest) {
      ++unpaired;
      continue;
    }
    if (options.pose_stamp == PoseStamp::kColour) image.stamp_s = stamps_s[*nearest];
  }
  if (unpaired > 0) {
    recording.warnings.push_back(
        fmt::format("{}: {} without a colour image within {} s, used with its own stamp", folder,
                    Counted(unpaired, "depth image"), options.max_stamp_difference_s));
  }
}

// Two depth images may pair with one colour image; the first keeps the stamp. An image without a
// colour image keeps its own, possibly earlier, stamp.
void DropRepeatedStamps(const std::string& folder, Recording& recording) {
  std::vector<RecordedImage> later;
  for (RecordedImage& image : recording.images) {
    if (later.empty() || image.stamp_s > later.back().stamp_s) later.push_back(std::move(image));
  }
  const auto dropped = static_cast<int>(recording.images.size() - later.size());
  recording.images = std::move(later);
  if (dropped > 0) {
    recording.warnings.push_back(
        fmt::format("{}: {} with the colour image of the one before, ignored", folder,
                    Counted(dropped, "depth image")));
  }
}

// Drops damaged rows (those without a name) and all but the first of one stamp; returns how many of
// these there were.
int SortAndNumber(std::vector<StampedFile>& files) {
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return a.stamp_s < b.stamp_s; });
  std::vector<StampedFile> kept;
  std::int64_t number = 0;
  int repeated = 0;
  for (StampedFile& file : files) {
    file.number = number;
    if (file.path.empty()) {
      ++number;
    } else if (!kept.empty() && IsSameStamp(kept.back().stamp_s, file.stamp_s)) {
      ++repeated;
    } else {
      kept.push_back(std::move(file));
      ++number;
    }
  }
  files = std::move(kept);
  return repeated;
}

}  // namespace

StampedFileList ParseFileList(const std::string& text, const std::string& place) {
  StampedFileList list;
  RowDamage damage;
  int unsorted = 0;
  std::vector<double> stamps_s;
  std::vector<int> lines;
  for (const TextRow& row : SplitRows(text)) {
    const auto stamp_s = ParseNumber(row.fields.front());
    const bool good = damage.Try([&] {
      RequireText(row, place);
      if (row.fields.size() < 2 || !stamp_s || !std::isfinite(*stamp_s)) {
        throw InputError(PlaceOfLine(place, row.line), "must be a stamp and a file name");
      }
      RequireSeconds(*stamp_s, PlaceOfLine(place, row.line));
      if (!list.files.empty() && *stamp_s < list.files.back().stamp_s) ++unsorted;
      list.files.push_back({*stamp_s, std::string(RestOf(row, 1))});
      stamps_s.push_back(*stamp_s);
      lines.push_back(row.line);
    });
    // A placeholder after the row before, so that later rows keep their numbers.
    if (!good)
      list.files.push_back({list.files.empty() ? kFirstStampS : list.files.back().stamp_s, ""});
  }
  damage.RequireMostGood(text);
  damage.AppendTo(list.warnings, place);
  const int repeated = SortAndNumber(list.files);
  const auto warn = [&](int count, const char* thing, const char* what) {
    WarnOfCount(list.warnings, place, count, thing, what);
  };
  warn(unsorted, "row", "earlier than the row before, sorted");
  if (auto doubt = DoubtOfSorted(stamps_s, lines, place)) list.warnings.push_back(*doubt);
  warn(repeated, "row", "with a stamp already given, ignored");
  return list;
}

CameraDescription TumFolderCamera(const std::string& folder, std::vector<std::string>& warnings) {
  const std::string path = Joined(folder, "camera.yaml");
  if (fs::exists(path)) return ReadCameraDescription(path, warnings);
  const auto known = TumCamera(fs::absolute(folder).lexically_normal().string());
  if (!known) {
    throw InputError(
        path, "no such file; it states the camera's intrinsics (--camera FILE names another)");
  }
  warnings.push_back(path + ": no such file, taking the camera TUM gives for this sequence");
  CameraDescription camera;
  camera.file = *known;
  return camera;
}

Recording ListTumFolder(const std::string& folder, const RecordingOptions& options) {
  Recording recording;
  recording.name = folder;
  const std::string path = Joined(folder, "depth.txt");
  StampedFileList depth = ReadFileList(path);
  if (depth.files.empty()) throw InputError(path, "lists no depth image");
  recording.warnings = std::move(depth.warnings);
  for (const StampedFile& file : depth.files) {
    recording.images.push_back({file.stamp_s, Joined(folder, file.path), file.number});
  }
  StampByColour(folder, options, recording);
  DropRepeatedStamps(folder, recording);
  return recording;
}

std::set<std::string> TumFolderWriter::FilesIn(const std::string& folder) {
  std::set<std::string> files;
  for (const std::string kind : {"depth", "rgb"}) {
    const std::string list = Joined(folder, kind + ".txt");
    if (!fs::is_regular_file(list)) continue;
    bool has_others = false;
    const std::string text = ReadFile(list);
    for (const TextRow& row : SplitRows(text)) {
      const std::string image = ImageName(kind, ParseNumber(row.fields.front()).value_or(0.0));
      if (row.fields.size() == 2 && row.fields[1] == image) {
        files.insert(image);
      } else {
        has_others = true;
      }
    }
    if (kind == "rgb" && !has_others) files.insert(kind + ".txt");
  }
  return files;
}

TumFolderWriter::TumFolderWriter(std::string folder, const CameraFile& camera)
    : folder_(std::move(folder)), camera_(camera) {
  fs::create_directories(fs::path(folder_) / "depth");
}

void TumFolderWriter::WriteFrame(double stamp_s, const DepthImage& depth,
                                 const RgbImage* rgb) const {
  WriteDepthPng(Joined(folder_, ImageName("depth", stamp_s)), depth, camera_.depth_scale_per_m);
  if (rgb == nullptr) return;
  fs::create_directories(fs::path(folder_) / "rgb");
  WriteRgbPng(Joined(folder_, ImageName("rgb", stamp_s)), *rgb);
}

void TumFolderWriter::Finish(const std::vector<double>& stamps_s, bool with_colour,
                             const Trajectory& truth) const {
  const auto write_list = [&](const std::string& kind, const char* title) {
    std::string text = fmt::format("# {}\n# timestamp filename\n", title);
    for (const double stamp_s : stamps_s) {
      text += fmt::format("{:.6f} {}\n", stamp_s, ImageName(kind, stamp_s));
    }
    WriteFile(Joined(folder_, kind + ".txt"), text);
  };
  write_list("depth", "depth maps");
  if (with_colour) write_list("rgb", "color images");
  WriteTrajectory(Joined(folder_, "groundtruth.txt"), truth);
  WriteCameraFile(Joined(folder_, "camera.yaml"), camera_);
}

}  // namespace depthgrid
