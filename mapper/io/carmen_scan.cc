#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/io/carmen_scan_impl.h"

namespace depthgrid {
namespace {

// Used if nothing else defines no-returns (CarmenLogOptions).
constexpr double kUsualMaxM = 80.0;
// Some lasers write a little less than the stated maximum (29.99 of 30.00).
constexpr double kMaxToleranceM = 0.01, kMaxToleranceShare = 1e-3;

Beam BeamOf(double bearing_rad, double range_m, const LaserReach& reach,
            const CarmenLogOptions& options) {
  Beam beam;
  beam.bearing_rad = static_cast<float>(bearing_rad);
  if (std::isnan(range_m) || range_m < options.min_range_m) return beam;
  if (range_m >= reach.no_return_m) {
    beam.clear_to_m = static_cast<float>(std::min(options.no_return_clear_m, reach.max_m));
    return beam;
  }
  beam.hit = true;
  beam.range_m = static_cast<float>(range_m);
  beam.clear_to_m = beam.range_m;
  return beam;
}

// The range of the nearer hit beside the gap of beams [first, after) if the gap is too narrow there
// for an opening, else empty. Next to an end of the scan there is one hit; the gap is taken to end
// one step beyond the last beam. Readings of no data belong to a gap: beside a fault there is often
// another one, which must not open the wall.
std::optional<float> BarOf(const std::vector<Beam>& beams, std::size_t first, std::size_t after,
                           double narrowest_m) {
  if (after - first == beams.size()) return {};
  const Beam& right = beams[first > 0 ? first - 1 : after];
  const Beam& left = beams[after < beams.size() ? after : first - 1];
  const float nearer_m = std::min(left.range_m, right.range_m);
  const double step_rad = std::abs(beams[1].bearing_rad - beams[0].bearing_rad);
  const double width_rad = static_cast<double>(after - first + 1) * step_rad;
  if (nearer_m * width_rad >= narrowest_m) return {};
  return nearer_m;
}

// Gaps that are too narrow for an opening clear no farther than the hits beside them.
void NarrowGaps(Scan& scan, double narrowest_m) {
  std::vector<Beam>& beams = scan.beams;
  for (std::size_t first = 0; first < beams.size(); ++first) {
    if (beams[first].hit) continue;
    std::size_t after = first;
    while (after < beams.size() && !beams[after].hit) ++after;
    if (const auto bar_m = BarOf(beams, first, after, narrowest_m)) {
      for (std::size_t i = first; i < after; ++i) {
        beams[i].clear_to_m = std::min(beams[i].clear_to_m, *bar_m);
      }
    }
    first = after;
  }
}

}  // namespace

double MostRangeM(const CarmenLogOptions& options) {
  return options.max_range_m > 0.0 ? options.max_range_m : kUsualMaxM;
}

LaserReach ReachOf(const CarmenScan& line, const CarmenLogOptions& options) {
  const double most_m = MostRangeM(options);
  const double stated_m = line.max_range_m;
  if (!(stated_m > 0.0) || stated_m > most_m) return {most_m, most_m};
  return {stated_m, stated_m - std::max(kMaxToleranceM, kMaxToleranceShare * stated_m)};
}

Bearings BearingsOf(const CarmenScan& line, const CarmenLogOptions& options) {
  const double sign = options.upside_down ? -1.0 : 1.0;
  if (line.states_angles || options.fov_deg == 0.0) {
    return {sign * line.first_bearing_rad, sign * line.bearing_step_rad};
  }
  const double fov_rad = RadFromDeg(options.fov_deg);
  return {sign * -0.5 * fov_rad, sign * fov_rad / static_cast<double>(line.range_m.size() - 1)};
}

Pose2 LaserPoseOf(const CarmenScan& line, const CarmenLogOptions& options) {
  const Pose2 base_from_laser = options.mount.base_from_laser();
  // The identity would turn -0 into 0.
  if (base_from_laser == Pose2{}) return line.odom_from_laser;
  return line.odom_from_laser * base_from_laser;
}

Scan ScanOfLine(const CarmenScan& line, const CarmenLogOptions& options) {
  const LaserReach reach = ReachOf(line, options);
  const Bearings bearings = BearingsOf(line, options);
  Scan scan;
  scan.max_range_m = reach.max_m;
  scan.beams.reserve(line.range_m.size());
  for (std::size_t i = 0; i < line.range_m.size(); ++i) {
    scan.beams.push_back(BeamOf(bearings.At(i), line.range_m[i], reach, options));
  }
  if (options.upside_down) std::reverse(scan.beams.begin(), scan.beams.end());
  NarrowGaps(scan, options.no_return_gap_m);
  return scan;
}

Scan ScanOf(const CarmenScan& line, const CarmenLogOptions& options) {
  RequireInRange(options, "sequence.laser");
  RequireFieldOfView(options.fov_deg);
  RequireSound(line);
  return ScanOfLine(line, options);
}

void CarmenLogOptions::Visit(OptionsVisitor& v) {
  v.Number("max_range_m", max_range_m, {0.0, 1000.0},
           "readings of this or more are no return; 0 takes the log's own maximum, or 80");
  v.Number("fov_deg", fov_deg, {0.0, 360.0},
           "degrees from the first to the last reading of a FLASER line; 0: a half circle");
  v.Group("mount", mount, "where the laser is on the robot whose poses the log states");
  v.Group("sweep", sweep, "when a scan's readings are taken");
  v.Flag("upside_down", upside_down,
         "whether the readings go from left to right, as of a laser mounted upside down");
  v.Number("min_range_m", min_range_m, {0.0, 100.0}, "nearer readings are no data");
  v.Less("min_range_m", min_range_m, "max_range_m", MostRangeM(*this));
  v.Flag("drop_body", drop_body,
         "leave out what stays nearer than 1 m while the robot turns: its own body");
  v.Number("no_return_clear_m", no_return_clear_m, {0.0, 1000.0},
           "how far a reading without return clears");
  v.Number(
      "no_return_gap_m", no_return_gap_m, {0.0, 100.0},
      "readings without return in a gap narrower than this clear up to the nearer hit beside it");
}

}  // namespace depthgrid
