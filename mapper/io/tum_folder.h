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
  std::int64_t number = 0;  // in order of stamps; damaged rows count, duplicates do not
};

struct StampedFileList {
  std::vector<StampedFile> files;  // sorted by strictly increasing stamp
  std::vector<std::string> warnings;
};

// A row other than a finite stamp and a file name is damaged. Throws InputError unless most rows
// are good.
StampedFileList ParseFileList(const std::string& text, const std::string& place);

// Throws InputError for a missing depth.txt. The camera is not filled in.
Recording ListTumFolder(const std::string& folder, const RecordingOptions& options = {});

// From camera.yaml, which may be any kind of camera file. Without it, a folder named like TUM's
// sequences (freiburg1, 2, 3) gets that camera, with a warning. Throws InputError if neither
// applies.
CameraDescription TumFolderCamera(const std::string& folder, std::vector<std::string>& warnings);

// Writes a TUM folder. Frames may be written in any order and from several threads at once; Finish
// writes the lists.
class TumFolderWriter {
 public:
  // Creates the folder.
  TumFolderWriter(std::string folder, const CameraFile& camera);

  // The colour image may be absent.
  void WriteFrame(double stamp_s, const DepthImage& depth, const RgbImage* rgb) const;
  // depth.txt (and rgb.txt) for these stamps, groundtruth.txt and camera.yaml.
  void Finish(const std::vector<double>& stamps_s, bool with_colour, const Trajectory& truth) const;

  // Of a folder it wrote, the listed images that have names as written by it, relative to the
  // folder, and rgb.txt if it lists no others.
  static std::set<std::string> FilesIn(const std::string& folder);

 private:
  std::string folder_;
  CameraFile camera_;
};

}  // namespace depthgrid
