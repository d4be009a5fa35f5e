#include "eval/cli/way_warnings.h"

#include <fmt/format.h>

#include <cmath>

#include "eval/cli/console.h"
#include "eval/doubts/mount_check.h"
#include "eval/doubts/scale_check.h"
#include "eval/doubts/way_check.h"
#include "mapper/core/angle.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::cli {
namespace {

std::string WaysText(const Ways& ways) {
  return fmt::format("over the same stretches the given poses go {:.1f} m, the map's {:.1f} m",
                     ways.slam_m, ways.map_m);
}

// ", 1.132 (0.003 more or less) times as far: the depth images' scale ... is wrong: if SLAM's ...".
std::string SlightScaleText(const ScaleFault& fault, std::optional<double> depth_scale_per_m) {
  std::string text = fmt::format(
      ", {:.3f} ({:.3f} more or less) times as far: the depth images' scale (depth_scale of the "
      "camera file) or SLAM's is wrong",
      fault.ratio, fault.sigma);
  if (!depth_scale_per_m) return text;
  return text + fmt::format(
                    "; if SLAM's is right, --set sequence.recording.depth_scale={:.4g} fits, not "
                    "{:g}",
                    *depth_scale_per_m * fault.ratio, *depth_scale_per_m);
}

std::string ScaleText(const Ways& ways, bool has_camera) {
  constexpr double kStandingM = 1e-3;  // allows for rounding
  if (ways.slam_m < kStandingM) {
    return fmt::format("the given poses do not move, but the map's go {:.1f} m", ways.map_m);
  }
  return WaysText(ways) +
         fmt::format(": {} is wrong",
                     has_camera
                         ? "the depth images' scale (depth_scale of the camera file) or SLAM's"
                         : "the odometry's scale or the laser's");
}

// `found`: the actual laser pose relative to the stated one.
std::string MountText(const LaserMount& stated, const Pose2& found) {
  const Pose2 mount = stated.base_from_laser() * found;
  const auto side = [](double value, const char* left, const char* right) {
    return value < 0.0 ? right : left;
  };
  return fmt::format(
      "the laser sits {:.2f} m {}, {:.2f} m to the {} and looks {:.0f} degrees to the {} of {}, "
      "throughout: if they are the robot's, --set sequence.laser.mount.x_m={} --set "
      "sequence.laser.mount.y_m={} --set sequence.laser.mount.yaw_deg={} says where on it the "
      "laser is; or are the poses' headings or the scans' bearings counted from another axis?",
      std::abs(found.x_m), side(found.x_m, "ahead", "behind"), std::abs(found.y_m),
      side(found.y_m, "left", "right"), std::abs(DegFromRad(found.yaw_rad)),
      side(found.yaw_rad, "left", "right"),
      stated.base_from_laser() == Pose2{} ? "the given poses" : "where sequence.laser.mount has it",
      Number(mount.x_m, 2), Number(mount.y_m, 2), Number(DegFromRad(mount.yaw_rad), 0));
}

}  // namespace

void CheckScale(const std::string& input, std::optional<double> depth_scale_per_m,
                const MappingRun& run, std::vector<std::string>& warnings) {
  if (run.camera) {
    if (const auto slight = SlightScaleDoubt(run)) {
      warnings.push_back(input + ": " + WaysText(slight->ways) +
                         SlightScaleText(*slight, depth_scale_per_m));
      return;
    }
  }
  const auto ways = ScaleDoubt(run);
  if (ways) warnings.push_back(input + ": " + ScaleText(*ways, run.camera.has_value()));
}

void CheckDirections(const std::string& input, const CarmenLogOptions& laser, const MappingRun& run,
                     std::vector<std::string>& warnings) {
  if (run.camera) return;
  const auto fault = WayDoubt(run);
  const auto scale = fault ? std::nullopt : TurnScaleDoubt(run);
  if (scale) {
    warnings.push_back(fmt::format(
        "{}: where the odometry turns by 1 degree the map turns by {:.2f}: the scale of the "
        "odometry's headings is wrong or that of the scans' angles (for FLASER "
        "sequence.laser.fov_deg)",
        input, *scale));
  }
  const bool may_be_mount = !scale && (!fault || *fault == WayFault::kDirections);
  const auto mount = may_be_mount ? MountDoubt(run) : std::nullopt;
  if (mount) warnings.push_back(input + ": " + MountText(laser.mount, *mount));
  if (!fault || mount) return;
  std::string what =
      "the odometry goes other ways than the scans: are x and y swapped, or headings "
      "counted from another axis than x?";
  if (*fault == WayFault::kTurns) {
    what = "the odometry's headings turn the other way than the scans: is their sign wrong?";
  } else if (*fault == WayFault::kMirroredScans) {
    what = fmt::format(
        "the scans turn the other way than the odometry, so the map is mirrored: is the laser "
        "{} --set sequence.laser.upside_down={}",
        laser.upside_down ? "not mounted upside down?" : "mounted upside down?",
        !laser.upside_down);
  }
  warnings.push_back(input + ": " + what);
}

}  // namespace depthgrid::cli
