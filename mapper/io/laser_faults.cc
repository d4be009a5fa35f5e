#include "mapper/io/laser_faults.h"

#include <fmt/format.h>

#include <algorithm>

#include "mapper/core/angle.h"
#include "mapper/io/carmen_scan_impl.h"

namespace depthgrid {
namespace {

std::string FramesText(std::size_t count) {
  return count == 1 ? "1 frame is" : fmt::format("{} frames are", count);
}

// Empty if none is held in the part.
std::string HeldText(const HeldPoses& poses, const FramePart& part) {
  const HeldCount count = CountHeld(poses.gaps(), part);
  if (!count.first) return {};
  const std::string how_often = poses.times() == 1
                                    ? "again and again while the scans move"
                                    : fmt::format("for {} scans in a row", poses.times());
  std::string mended;
  if (count.interpolated > 0) mended = FramesText(count.interpolated) + " interpolated";
  if (count.interpolated > 0 && count.lost > 0) mended += ", ";
  if (count.lost > 0) mended += FramesText(count.lost) + " taken for lost";
  return fmt::format("the odometry gives one pose {}, first in frame {}: {}", how_often,
                     *count.first, mended);
}

std::string FrozenText(const std::vector<bool>& frozen, const FramePart& part) {
  const auto count = std::count(frozen.begin(), frozen.end(), true);
  if (count == 0) return {};
  const auto first = std::find(frozen.begin(), frozen.end(), true) - frozen.begin();
  return fmt::format(
      "the laser gives one scan again and again while the robot moves, first in frame {}: {} "
      "placed by the odometry alone",
      part.begin + static_cast<std::size_t>(first), FramesText(static_cast<std::size_t>(count)));
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

void LaserFaults::AddPose(const CarmenScan& line, int epoch) {
  held_.Add({line.stamp_s, line.odom_from_laser, epoch}, line.range_m, options_.min_range_m,
            ReachOf(line, options_).no_return_m);
}

void LaserFaults::Add(const CarmenScan& line) {
  frozen_.Add(line.stamp_s, LaserPoseOf(line, options_), line.range_m,
              [&] { return ScanOfLine(line, options_); });
  if (!options_.drop_body) return;
  if (!bearings_) bearings_ = BearingsOf(line, options_);
  body_.Add(line, options_.min_range_m);
}

void LaserFaults::Find() {
  held_.Mend();
  body_.Find();
}

bool LaserFaults::HasScan(std::size_t scan) const {
  return scan >= frozen_.frozen().size() || !frozen_.frozen()[scan];
}

std::vector<std::string> LaserFaults::Warnings(const std::string& path,
                                               const FramePart& part) const {
  std::vector<std::string> warnings;
  for (const std::string& text : {HeldText(held_, part), FrozenText(frozen_.frozen(), part)}) {
    if (!text.empty()) warnings.push_back(path + ": " + text);
  }
  if (!body_.parts().empty()) {
    warnings.push_back(fmt::format(
        "{}: readings stay the same while the robot turns ({}): taken for parts of the robot and "
        "left out (sequence.laser.drop_body=false keeps them)",
        path, BodyText(body_.parts(), *bearings_)));
  }
  return warnings;
}

}  // namespace depthgrid
