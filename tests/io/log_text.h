// Laser logs that tests write out in full.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mapper/io/carmen_log.h"
#include "tests/scratch.h"

namespace depthgrid {

class TextFile {
 public:
  explicit TextFile(const std::string& text) : path_(ScratchPath() + ".log") {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::vector<Frame> ReadAll(FrameSource& source) {
  std::vector<Frame> frames;
  while (auto frame = source.Next()) frames.push_back(*frame);
  return frames;
}

// Of the log with this text, one a line.
inline std::string WarningsOf(const std::string& text) {
  const TextFile file(text);
  std::string all;
  for (const std::string& warning : OpenCarmenLog(file.path())->Warnings()) all += warning + "\n";
  return all;
}

}  // namespace depthgrid
