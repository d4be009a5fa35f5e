#include "eval/cli/pose_doubt_text.h"

#include <fmt/format.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {
namespace {

std::string PitchOf(const PoseDoubt& doubt) {
  return fmt::format("about {:.0f} degrees {}", std::abs(DegFromRad(doubt.down_rad)),
                     doubt.down_rad > 0.0 ? "below" : "above");
}

// Three significant digits, its accuracy: 0.664, 1000.
std::string ShownScale(double scale) {
  const double unit = std::pow(10.0, std::floor(std::log10(scale)) - 2.0);
  return fmt::format("{:g}", std::round(scale / unit) * unit);
}

// "-y x z": which numbers of a row give the three axes.
std::string PositionsOf(const Eigen::Matrix3d& axes) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    int column = 0;
    axes.row(row).cwiseAbs().maxCoeff(&column);
    text += fmt::format("{}{}{}", row > 0 ? " " : "", axes(row, column) < 0.0 ? "-" : "",
                        "xyz"[column]);
  }
  return text;
}

// "x forward, y left, z up"
std::string AxesOf(const Eigen::Matrix3d& camera_from_own) {
  constexpr const char* kWays[3][2] = {{"right", "left"}, {"down", "up"}, {"forward", "backward"}};
  std::string text;
  for (int own = 0; own < 3; ++own) {
    int way = 0;
    camera_from_own.col(own).cwiseAbs().maxCoeff(&way);
    text += fmt::format("{}{} {}", own > 0 ? ", " : "", "xyz"[own],
                        kWays[way][camera_from_own(way, own) < 0.0 ? 1 : 0]);
  }
  return text;
}

// Smaller uncertainties of the time offset are not shown.
constexpr double kSureOfTimeS = 0.0005;

std::string OffsetRemedyOf(const PoseDoubt& doubt) {
  const std::string unsure =
      doubt.time_unsure_s < kSureOfTimeS
          ? ""
          : fmt::format(" ({:.3f} s more or less fit as well)", doubt.time_unsure_s);
  return fmt::format("with other stamps{}: --set sequence.recording.time_offset_s={:.3f}", unsure,
                     doubt.time_offset_s);
}

std::string KeptText(const std::optional<KeptDepth>& kept) {
  if (!kept) return "";
  return fmt::format(
      " {:.0f} % of what they see, most of it in columns {} to {} and rows {} to {} and about "
      "{:.2g} m away, keeps its depth from one image to another half a second later, while the "
      "rest changes: does something move along with the camera there?",
      100.0 * kept->share, kept->first_column_px, kept->last_column_px, kept->first_row_px,
      kept->last_row_px, kept->depth_m);
}

std::string RemedyOf(const PoseDoubt& doubt) {
  switch (doubt.reading) {
    case PoseReading::kWFirst:
      return "with quaternions that begin with w; rows must be t x y z qx qy qz qw, or a header "
             "line name their columns";
    case PoseReading::kWLast:
      return "with quaternions that end with w; a header line must name the columns so";
    case PoseReading::kInverse:
      return "with each pose inverted; poses must take the camera to the world";
    case PoseReading::kPositions:
      return fmt::format(
          "with {} as the positions' x y z; they must be in the axes that the quaternions are of",
          PositionsOf(doubt.axes));
    case PoseReading::kYUp:
      return "with poses of a left-handed world and a camera whose y points up; they must be of "
             "one whose y points down, or fy of the camera file negative";
    case PoseReading::kYDown:
      return "with poses of a camera whose y points down; fy of the camera file must be positive "
             "with them";
    case PoseReading::kAxes:
      return fmt::format(
          "with poses of {}axes {}; they must be the camera's x right, y down, z forward",
          doubt.axes.determinant() < 0.0 ? "a left-handed world and " : "", AxesOf(doubt.axes));
    case PoseReading::kScaled:
      return fmt::format(
          "with images {} times as deep: their scale (depth_scale of the camera file, or --set "
          "sequence.recording.depth_scale) or SLAM's is wrong",
          ShownScale(1.0 / doubt.scale));
    case PoseReading::kPitched:
      return fmt::format(
          "with a camera that looks {} the poses' z axis; they must be the camera's own "
          "(formats.md, \"Poses of an IMU or a robot\")",
          PitchOf(doubt));
    case PoseReading::kPitchedBodyAxes:
      return fmt::format(
          "with poses of axes x forward, y left, z up, the camera looking {} x; they must be the "
          "camera's x right, y down, z forward (formats.md, \"Poses of an IMU or a robot\")",
          PitchOf(doubt));
    case PoseReading::kFocal:
      return fmt::format(
          "with fx and fy about {:.2g} times as large: those of the camera are wrong", doubt.scale);
    case PoseReading::kImageSize:
      return fmt::format(
          "with fx, fy, cx and cy about {:.2g} times as large: those of the camera are for images "
          "of another size",
          doubt.scale);
    case PoseReading::kCentre:
      return fmt::format(
          "with cx about {:.0f} and cy about {:.0f}: those of the camera are for images that are "
          "cut otherwise",
          doubt.centre_px.x(), doubt.centre_px.y());
    case PoseReading::kRayLengths:
      return "with images that hold lengths of rays; they must hold depth along the camera's z "
             "axis, the ray's length / sqrt(((u - cx) / fx)^2 + ((v - cy) / fy)^2 + 1)";
    case PoseReading::kShifted:
      return OffsetRemedyOf(doubt);
    case PoseReading::kStanding:
    case PoseReading::kUnturned:
    case PoseReading::kNone:
      break;
  }
  Broken("poses that are read otherwise have a remedy");
}

// With its standard deviation.
std::string SlightRemedyOf(const PoseDoubt& doubt) {
  switch (doubt.reading) {
    case PoseReading::kFocal:
      return fmt::format(
          "with fx and fy {:.3f} ({:.3f} more or less) times as large: those of the camera are "
          "off, or its images distorted",
          doubt.scale, doubt.sigma);
    case PoseReading::kScaled:
      return fmt::format(
          "with images {:.3f} ({:.3f} more or less) times as deep: their scale (depth_scale of the "
          "camera file, or --set sequence.recording.depth_scale) or SLAM's is off",
          1.0 / doubt.scale, doubt.sigma);
    case PoseReading::kShifted:
      return fmt::format(
          "with other stamps: --set sequence.recording.time_offset_s={:.3f} ({:.3f} more or less)",
          doubt.time_offset_s, doubt.sigma);
    default:
      Broken("only factors and stamps are slightly off");
  }
}

}  // namespace

std::string PoseDoubtText(const PoseDoubt& doubt) {
  constexpr double kPercent = 100.0;
  if (doubt.sigma > 0.0) {
    return fmt::format(
        "the depth images fit the poses better, surfaces seen twice {:.2f} % of their depth apart "
        "in place of {:.2f} %, {}",
        kPercent * doubt.better_misfit, kPercent * doubt.misfit, SlightRemedyOf(doubt));
  }
  const std::string apart = fmt::format(
      "the depth images do not fit the poses, surfaces seen twice lie {:.1f} % of their depth "
      "apart",
      kPercent * doubt.misfit);
  if (doubt.reading == PoseReading::kStanding) {
    return apart + ": the poses do not move, all positions are the same";
  }
  if (doubt.reading == PoseReading::kUnturned) {
    return apart + ": the poses do not turn, all quaternions are the same";
  }
  if (doubt.reading == PoseReading::kNone) {
    return apart + ", and no reading of them fits: are they of these images, in this order?" +
           KeptText(doubt.kept);
  }
  return fmt::format("{}; they would fit, to {:.1f} %, {}", apart, kPercent * doubt.better_misfit,
                     RemedyOf(doubt));
}

}  // namespace depthgrid::cli
