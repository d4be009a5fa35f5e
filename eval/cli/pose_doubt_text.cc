#include "eval/cli/pose_doubt_text.h"

#include <fmt/format.h>

#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid::cli {
namespace {

std::string PitchOf(const PoseDoubt& doubt) {
  return fmt::format("about {:.0f} degrees {}", std::abs(DegFromRad(doubt.down_rad)),
                     doubt.down_rad > 0.0 ? "below" : "above");
}

// Three digits, which is how well it is known: 0.664, 1000.
std::string ShownScale(double scale) {
  const double unit = std::pow(10.0, std::floor(std::log10(scale)) - 2.0);
  return fmt::format("{:g}", std::round(scale / unit) * unit);
}

// A slow camera moves a centimetre in it.
constexpr double kSureOfTimeS = 0.04;

std::string RemedyOf(const PoseDoubt& doubt) {
  switch (doubt.reading) {
    case PoseReading::kWFirst:
      return "with quaternions that begin with w; rows must be t x y z qx qy qz qw";
    case PoseReading::kInverse:
      return "with each pose inverted; poses must take the camera to the world";
    case PoseReading::kBodyAxes:
      return "with poses of axes x forward, y left, z up; they must be the camera's x right, y "
             "down, z forward";
    case PoseReading::kGlAxes:
      return "with poses of axes x right, y up, z backward; they must be the camera's x right, y "
             "down, z forward";
    case PoseReading::kScaled:
      return fmt::format(
          "with images {} times as deep: their scale (depth_scale of the camera file, or --set "
          "sequence.recording.depth_scale) or SLAM's is wrong",
          ShownScale(1.0 / doubt.scale));
    case PoseReading::kPitched:
      return fmt::format(
          "with a camera that looks {} the poses' z axis; they must be the camera's own "
          "(formats.md, \"Poses of a robot's base\")",
          PitchOf(doubt));
    case PoseReading::kPitchedBodyAxes:
      return fmt::format(
          "with poses of axes x forward, y left, z up, the camera looking {} x; they must be the "
          "camera's x right, y down, z forward (formats.md, \"Poses of a robot's base\")",
          PitchOf(doubt));
    case PoseReading::kFocal:
      return fmt::format(
          "with fx and fy about {:.2g} times as large: those of the camera are wrong", doubt.scale);
    case PoseReading::kImageSize:
      return fmt::format(
          "with fx, fy, cx and cy about {:.2g} times as large: those of the camera are for images "
          "of another size",
          doubt.scale);
    case PoseReading::kShifted:
      break;
  }
  const std::string setting = fmt::format(
      "with other stamps: --set sequence.recording.time_offset_s={:.2f}", doubt.time_offset_s);
  if (doubt.time_unsure_s < kSureOfTimeS) return setting;
  return fmt::format("{}, {:.2f} s more or less fit alike", setting, doubt.time_unsure_s);
}

}  // namespace

std::string PoseDoubtText(const PoseDoubt& doubt) {
  constexpr double kPercent = 100.0;
  return fmt::format(
      "the depth images do not fit the poses, surfaces seen twice lie {:.1f} % of their depth "
      "apart; they would, at {:.1f} %, {}",
      kPercent * doubt.misfit, kPercent * doubt.better_misfit, RemedyOf(doubt));
}

}  // namespace depthgrid::cli
