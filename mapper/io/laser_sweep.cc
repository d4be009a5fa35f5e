#include "mapper/io/laser_sweep.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// A slower scanner is none that a robot moves with.
constexpr double kLongestSweepS = 10.0;

// Chosen: after a longer time the motion does not tell how the laser moves now, and what is faster
// is a correction of the odometry or an error of the clock.
constexpr double kPauseS = 1.0;
constexpr double kFastestMps = 5.0;
constexpr double kFastestRadps = 2.0 * kPi;

Beam Moved(const Beam& beam, const Pose2& stamp_from_beam) {
  Beam moved = beam;
  if (!beam.hit) {
    moved.bearing_rad += static_cast<float>(stamp_from_beam.yaw_rad);
    return moved;
  }
  const Eigen::Vector2d end_m = stamp_from_beam * EndPoint(beam);
  moved.range_m = static_cast<float>(end_m.norm());
  // Bearings may be beyond half a turn.
  const double turn_rad = WrapAngle(std::atan2(end_m.y(), end_m.x()) - beam.bearing_rad);
  moved.bearing_rad += static_cast<float>(turn_rad);
  if (beam.clear_to_m == beam.range_m) moved.clear_to_m = moved.range_m;
  return moved;
}

}  // namespace

void LaserSweep::Visit(OptionsVisitor& v) {
  v.Number("duration_s", duration_s, {0.0, kLongestSweepS},
           "seconds from a scan's first reading to its last, during which the laser moves on; 0: "
           "all at once");
  v.Number("stamp_share", stamp_share, {0.0, 1.0},
           "which reading the stamp is of: 0 the first, 1 the last, in between a share");
}

Eigen::Vector3d LaserVelocity::To(double stamp_s, const Pose2& odom_from_laser, int epoch) {
  const std::optional<Seen> before = std::exchange(before_, Seen{stamp_s, odom_from_laser, epoch});
  if (!before || before->epoch != epoch) return Eigen::Vector3d::Zero();
  const double step_s = stamp_s - before->stamp_s;
  if (!(step_s > 0.0) || step_s > kPauseS) return Eigen::Vector3d::Zero();
  const Pose2 laser_from_before = Between(odom_from_laser, before->odom_from_laser);
  const Eigen::Vector3d velocity = -laser_from_before.vector() / step_s;
  const bool is_possible =
      velocity.head<2>().norm() <= kFastestMps && std::abs(velocity.z()) <= kFastestRadps;
  return is_possible ? velocity : Eigen::Vector3d::Zero();
}

Scan AtStamp(Scan scan, const LaserSweep& sweep, SweepOrder order,
             const Eigen::Vector3d& velocity) {
  if (sweep.duration_s == 0.0 || scan.beams.size() < 2) return scan;
  const auto last = static_cast<double>(scan.beams.size() - 1);
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    double share = static_cast<double>(i) / last;
    if (order == SweepOrder::kReversed) share = 1.0 - share;
    const double after_s = (share - sweep.stamp_share) * sweep.duration_s;
    scan.beams[i] = Moved(scan.beams[i], Pose2::FromVector(after_s * velocity));
  }
  return scan;
}

}  // namespace depthgrid
