// MP4 files (H.264), written by the program `ffmpeg` (Debian package of that name).
#pragma once

#include <atomic>
#include <string>

#include "mapper/core/rgb_image.h"
#include "mapper/io/end_task.h"

namespace depthgrid {

// Throws InputError for a name that is not a video's or without ffmpeg; called before hours of
// mapping.
void RequireVideo(const std::string& path);

// Encodes frames to a file. The same frames give the same bytes with the same ffmpeg.
class VideoWriter {
 public:
  // All frames have this size. Throws std::runtime_error when ffmpeg cannot be started.
  VideoWriter(std::string path, int width_px, int height_px, int frames_per_s);
  // Removes all files unless Finish() was called.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void Add(const RgbImage& frame);
  // Throws std::runtime_error when ffmpeg failed or the disk was full; an earlier file of that name
  // is then unchanged.
  void Finish();

 private:
  void Close();
  void Abandon();
  std::string Complaint() const;

  std::string path_;
  std::string temporary_;
  int width_px_;
  int height_px_;
  int pipe_ = -1;
  int errors_ = -1;                // file with ffmpeg's messages
  std::atomic<int> process_ = -1;  // atomic, because any thread may abandon it
  int status_ = -1;
  EndTask remove_temporary_;
};

}  // namespace depthgrid
