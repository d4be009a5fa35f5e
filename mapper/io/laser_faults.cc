#include "mapper/io/laser_faults.h"

#include <fmt/format.h>

#include <algorithm>

#include "mapper/core/angle.h"
#include "mapper/io/carmen_scan_impl.h"

namespace depthgrid {
namespace {

bool IsAt(const std::vector<bool>& faults, std::size_t scan) {
  return scan < faults.size() && faults[scan];
}

void Warn(const std::vector<bool>& faults, std::size_t first_frame, const std::string& fault,
          const char* mended, std::vector<std::string>& warnings) {
  const auto count = std::count(faults.begin(), faults.end(), true);
  if (count == 0) return;
  const auto first = std::find(faults.begin(), faults.end(), true) - faults.begin();
  warnings.push_back(fmt::format(
      "{}, first in frame {}: {} {}", fault, first_frame + static_cast<std::size_t>(first),
      count == 1 ? "1 frame is" : fmt::format("{} frames are", count), mended));
}

std::string BodyText(const std::vector<OwnBody::Part>& parts, const Bearings& bearings) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(parts.size(), kShown); ++i) {
    const OwnBody::Part& part = parts[i];
    text +=
        fmt::format("{}{:.2f} m from {:.0f} to {:.0f} degrees", i == 0 ? "" : ", ", part.range_m,
                    DegFromRad(bearings.At(part.first)), DegFromRad(bearings.At(part.last)));
  }
  if (parts.size() > kShown) text += fmt::format(" and {} more", parts.size() - kShown);
  return text;
}

}  // namespace

void LaserFaults::Add(const CarmenScan& line) {
  held_.Add(line.odom_from_laser, line.range_m, options_.min_range_m,
            ReachOf(line, options_).no_return_m);
  frozen_.Add(line.stamp_s, LaserPoseOf(line, options_), line.range_m,
              [&] { return ScanOfLine(line, options_); });
  if (!options_.drop_body) return;
  if (!bearings_) bearings_ = BearingsOf(line, options_);
  body_.Add(line, options_.min_range_m);
}

void LaserFaults::Find() { body_.Find(); }

bool LaserFaults::HasPose(std::size_t scan) const { return !IsAt(held_.held(), scan); }
bool LaserFaults::HasScan(std::size_t scan) const { return !IsAt(frozen_.frozen(), scan); }

std::vector<std::string> LaserFaults::Warnings(const std::string& path,
                                               std::size_t first_frame) const {
  std::vector<std::string> warnings;
  Warn(held_.held(), first_frame,
       path + ": the odometry gives one pose again and again while the scans move",
       "taken for lost", warnings);
  Warn(frozen_.frozen(), first_frame,
       path + ": the laser gives one scan again and again while the robot moves",
       "placed by the odometry alone", warnings);
  if (!body_.parts().empty()) {
    warnings.push_back(fmt::format(
        "{}: readings stay the same while the robot turns ({}): taken for parts of the robot and "
        "left out (sequence.laser.drop_body=false keeps them)",
        path, BodyText(body_.parts(), *bearings_)));
  }
  return warnings;
}

}  // namespace depthgrid
