#include "mapper/io/laser_mount.h"

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Larger than any robot for such maps; exceeded by values in millimetres.
constexpr double kFarthestMountM = 10.0;

}  // namespace

Pose2 LaserMount::base_from_laser() const { return {x_m, y_m, WrapAngle(RadFromDeg(yaw_deg))}; }

void LaserMount::Visit(OptionsVisitor& v) {
  v.Number("x_m", x_m, {-kFarthestMountM, kFarthestMountM},
           "how far the laser is ahead of the point whose poses the log states, metres");
  v.Number("y_m", y_m, {-kFarthestMountM, kFarthestMountM},
           "how far the laser is to the left of that point, metres");
  v.Number("yaw_deg", yaw_deg, {-360.0, 360.0},
           "how far to the left of those poses' headings the laser looks");
}

}  // namespace depthgrid
