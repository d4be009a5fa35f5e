// Laser logs that tests write out in full.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
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

// The scan as a ROBOTLASER1 line without the line end; ranges in 0.1 mm, poses in nanometres.
inline std::string RobotLaserLine(const CarmenScan& scan) {
  const auto steps = static_cast<double>(scan.range_m.size() - 1);
  std::string line;
  line += fmt::format("ROBOTLASER1 0 {:.9f} {:.9f} {:.12f} {:.3f} 0.01 0 {}",
                      scan.first_bearing_rad, scan.bearing_step_rad * steps, scan.bearing_step_rad,
                      scan.max_range_m, scan.range_m.size());
  for (const double range_m : scan.range_m) line += fmt::format(" {:.4f}", range_m);
  const Pose2& pose = scan.odom_from_laser;
  line += " 0";
  for (int i = 0; i < 2; ++i) {  // laser and robot coincide
    line += fmt::format(" {:.9f} {:.9f} {:.9f}", pose.x_m, pose.y_m, pose.yaw_rad);
  }
  line += fmt::format(" 0 0 0 0 0 {0:.6f} sim {0:.6f}", scan.stamp_s);
  return line;
}

// A scan of two readings at this pose and time.
inline std::string ScanAt(double x_m, double y_m, int stamp_s) {
  std::ostringstream line;
  line.precision(17);
  line << "FLASER 2 1 1 " << x_m << " " << y_m << " 0 0 0 0 " << stamp_s << " h 1\n";
  return line.str();
}

inline std::vector<Frame> ReadAll(FrameSource& source) {
  std::vector<Frame> frames;
  while (auto frame = source.Next()) frames.push_back(*frame);
  return frames;
}

// The warnings for a log with this text, one per line.
inline std::string WarningsOf(const std::string& text, const CarmenLogOptions& options = {}) {
  const TextFile file(text);
  std::string all;
  for (const std::string& warning : OpenCarmenLog(file.path(), options)->Warnings())
    all += warning + "\n";
  return all;
}

}  // namespace depthgrid
