#include "mapper/core/frozen_scan.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// 2 degrees or 5 cm plus as much per second, more than SLAM and odometry drift while the sensor
// stands. Chosen, not measured.
bool IsFrozenTurn(double turn_rad, double seconds) {
  return std::abs(turn_rad) > RadFromDeg(2.0) * (1.0 + seconds);
}
double FrozenWayM(double seconds) { return 0.05 * (1.0 + seconds); }

// With fewer hits, or fewer pieces of wall that must have moved, nothing can be decided.
constexpr int kFewHits = 20;
constexpr int kFewPieces = 5;
// A piece of wall: long enough that noise and rounding to centimetres do not change its direction,
// straight, and not across the gap between two objects.
constexpr double kPieceM = 0.3;
constexpr double kMostPieceM = 0.6;
constexpr double kStraightM = 0.03;
constexpr double kMostBendM = 0.003;

// The number of pieces of wall whose range changes by more than `least_m` with this motion of the
// laser.
int PiecesThatMove(const Scan& scan, const Eigen::Vector2d& motion, double least_m) {
  int pieces = 0;
  std::vector<Eigen::Vector2d> wall;  // hits without one missing in between
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) {
      wall.clear();
      continue;
    }
    wall.push_back(EndPoint(beam));
    const Eigen::Vector2d along = wall.back() - wall.front();
    const double length_m = along.norm();
    if (length_m < kPieceM) continue;
    const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()) / length_m;
    const bool is_straight =
        length_m < kMostPieceM &&
        std::all_of(wall.begin(), wall.end(), [&](const Eigen::Vector2d& point) {
          return std::abs(normal.dot(point - wall.front())) < kStraightM;
        });
    const Eigen::Vector2d middle = wall[wall.size() / 2];
    const double towards = std::abs(normal.dot(middle.normalized()));
    if (is_straight && std::abs(normal.dot(motion)) > least_m * towards) ++pieces;
    wall.assign(1, wall.back());
  }
  return pieces;
}

// The resolution of the readings as written, such as a centimetre; 0 with more than six decimals.
double WrittenStepM(const Scan& scan) {
  double step_m = 1.0;
  for (int decimals = 0; decimals <= 6; ++decimals, step_m *= 0.1) {
    const bool is_whole = std::all_of(scan.beams.begin(), scan.beams.end(), [&](const Beam& beam) {
      const double steps = beam.range_m / step_m;
      // The last of a float's seven digits may be off.
      return !beam.hit || std::abs(steps - std::round(steps)) < 1e-6 * steps + 1e-9;
    });
    if (is_whole) return step_m;
  }
  return 0.0;
}

// Whether the readings have noise, which never repeats exactly, by their second differences.
// Without noise these are below 3 mm on walls in the middle of a scan (1 degree apart, a corridor 2
// m wide) plus at most one step of rounding.
bool IsNoisy(const Scan& scan) {
  std::vector<double> bends_m;
  for (std::size_t i = 1; i + 1 < scan.beams.size(); ++i) {
    const Beam &a = scan.beams[i - 1], &b = scan.beams[i], &c = scan.beams[i + 1];
    if (!a.hit || !b.hit || !c.hit) continue;
    bends_m.push_back(std::abs(static_cast<double>(a.range_m) - 2.0 * b.range_m + c.range_m));
  }
  if (bends_m.size() < static_cast<std::size_t>(kFewHits)) return false;
  constexpr double kFloatRounding = 1.0 + 1e-3;  // for differences of centimetres
  return UpperMedian(std::move(bends_m)) > kMostBendM + WrittenStepM(scan) * kFloatRounding;
}

}  // namespace

bool MustDiffer(const Scan& scan, const Pose2& motion, double seconds) {
  const auto hits = std::count_if(scan.beams.begin(), scan.beams.end(),
                                  [](const Beam& beam) { return beam.hit; });
  if (hits < kFewHits) return false;
  if (IsFrozenTurn(motion.yaw_rad, seconds)) return true;
  const double least_m = FrozenWayM(seconds);
  if (motion.translation().norm() < least_m) return false;
  return IsNoisy(scan) || PiecesThatMove(scan, motion.translation(), least_m) >= kFewPieces;
}

}  // namespace depthgrid
