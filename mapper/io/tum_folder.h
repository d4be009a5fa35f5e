// TUM RGB-D folders: depth/ and rgb/ with PNG images, depth.txt and rgb.txt listing `stamp file`,
// groundtruth.txt, and our camera.yaml (docs/formats.md, "TUM folder").
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/core/frame.h"
#include "mapper/core/rgb_image.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/recording.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {

// A row of depth.txt or rgb.txt.
struct StampedFile {
  double stamp_s = 0.0;
  std::string path;
  std::int64_t number = 0;  // in order of stamps; damaged rows count, doubled ones do not
};

struct StampedFileList {
  std::vector<StampedFile> files;  // sorted by strictly increasing stamp
  std::vector<std::string> warnings;
};

// A row that is not a finite stamp and a file name is damaged. Throws InputError when not most are
// good.
StampedFileList ParseFileList(const std::string& text, const std::string& place);

// Throws InputError for a missing depth.txt. The camera is not filled in.
Recording ListTumFolder(const std::string& folder, const RecordingOptions& options = {});

// camera.yaml, or what else of camera files has that name; without it, a folder named as TUM names
// its sequences (freiburg1, 2, 3) gets that camera, with a warning. Throws InputError when neither
// says it.
CameraDescription TumFolderCamera(const std::string& folder, std::vector<std::string>& warnings);

// Writes such a folder. Frames may be written in any order and from several threads at once; Finish
// writes the lists.
class TumFolderWriter {
 public:
  // Creates the folder.
  TumFolderWriter(std::string folder, const CameraFile& camera);

  // The colour image may be absent.
  void WriteFrame(double stamp_s, const DepthImage& depth, const RgbImage* rgb) const;
  // depth.txt (and rgb.txt) for these stamps, groundtruth.txt and camera.yaml.
  void Finish(const std::vector<double>& stamps_s, bool with_colour, const Trajectory& truth) const;

  // The images that the lists of a folder it wrote name as it names them, relative to the folder,
  // and rgb.txt when it names no others.
  static std::set<std::string> FilesIn(const std::string& folder);

 private:
  std::string folder_;
  CameraFile camera_;
};

}  // namespace depthgrid
