#include "sim/laser/laser_world.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Widens each wall's bearing interval, so that no ray passes between two walls that share a corner.
constexpr double kSlackRad = 1e-9;

// Lowers the ranges of all beams that cross the wall (a, b in laser axes).
void CastWall(const Eigen::Vector2d& a_m, const Eigen::Vector2d& b_m, const LaserOptions& options,
              std::vector<double>& range_m) {
  const double cross = a_m.x() * b_m.y() - a_m.y() * b_m.x();
  if (cross == 0.0) return;  // the wall's line goes through the laser: seen edge on
  const Eigen::Vector2d& right_m = cross > 0.0 ? a_m : b_m;
  const Eigen::Vector2d along_m = b_m - a_m;
  const double width_rad = std::atan2(std::abs(cross), a_m.dot(b_m));
  // On the wall's line, range = cross / (direction x along).
  const double first_rad = options.FirstBearingRad();
  const double step_rad = options.BearingStepRad();
  const double offset_rad = std::atan2(right_m.y(), right_m.x()) - first_rad;
  const double begin_rad = offset_rad - 2.0 * kPi * std::floor(offset_rad / (2.0 * kPi));
  const auto last = static_cast<double>(range_m.size() - 1);
  for (const double from_rad : {begin_rad - 2.0 * kPi, begin_rad}) {
    const double low = std::ceil((from_rad - kSlackRad) / step_rad);
    const double high = std::floor((from_rad + width_rad + kSlackRad) / step_rad);
    for (double beam = std::max(low, 0.0); beam <= std::min(high, last); beam += 1.0) {
      const double bearing_rad = first_rad + beam * step_rad;
      const double denominator =
          std::cos(bearing_rad) * along_m.y() - std::sin(bearing_rad) * along_m.x();
      const double wall_range_m = cross / denominator;
      double& nearest_m = range_m[static_cast<std::size_t>(beam)];
      if (wall_range_m > 0.0 && wall_range_m < nearest_m) nearest_m = wall_range_m;
    }
  }
}

bool WithinReach(const Eigen::Vector2d& a_m, const Eigen::Vector2d& b_m, double reach_m) {
  const Eigen::Vector2d along_m = b_m - a_m;
  const double length2 = along_m.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a_m.dot(along_m) / length2, 0.0, 1.0) : 0.0;
  return (a_m + t * along_m).norm() <= reach_m;
}

}  // namespace

void LaserOptions::Visit(OptionsVisitor& v) {
  v.Number("beams", beams, {2, 20000}, "beams of a scan");
  v.Number("field_of_view_deg", field_of_view_deg, {1, 360}, "from the first beam to the last");
  v.Number("min_range_m", min_range_m, {0, 100}, "nearer is reported as 0");
  v.Number("max_range_m", max_range_m, {0.1, 1000}, "farther is reported as this");
  v.Number("noise_relative", noise_relative, {0, 0.5}, "sigma of a range, share of the range");
  v.Number("noise_quadratic_per_m", noise_quadratic_per_m, {0, 0.5},
           "sigma of a range, share of its square");
  v.Number("noise_correlation", noise_correlation, {0, 0.999}, "of neighbouring beams' noise");
  v.Number("outlier_share", outlier_share, {0, 1}, "beams that report anything");
}

double LaserOptions::BearingStepRad() const { return RadFromDeg(field_of_view_deg) / (beams - 1); }

double LaserOptions::FirstBearingRad() const { return -0.5 * RadFromDeg(field_of_view_deg); }

LaserWorld ReadLaserWorld(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path, "cannot be read");
  LaserWorld world;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1) line = std::string(WithoutByteOrderMark(line));
    line.erase(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream fields(line);
    WallSegment wall;
    std::string rest;
    if (!(fields >> wall.a_m.x() >> wall.a_m.y() >> wall.b_m.x() >> wall.b_m.y()) ||
        fields >> rest) {
      throw InputError(path + ":" + std::to_string(number),
                       "\"" + line + "\" is not a segment of four numbers x1 y1 x2 y2");
    }
    world.walls.push_back(wall);
  }
  if (file.bad()) throw InputError(path, "cannot be read");
  if (world.walls.empty()) throw InputError(path, "has no segment");
  return world;
}

std::vector<double> CastScan(const LaserWorld& world, const Pose2& world_from_laser,
                             const LaserOptions& options) {
  std::vector<double> range_m(static_cast<std::size_t>(options.beams),
                              std::numeric_limits<double>::infinity());
  const Pose2 laser_from_world = Inverse(world_from_laser);
  for (const WallSegment& wall : world.walls) {
    const Eigen::Vector2d a_m = laser_from_world * wall.a_m;
    const Eigen::Vector2d b_m = laser_from_world * wall.b_m;
    if (WithinReach(a_m, b_m, options.max_range_m)) CastWall(a_m, b_m, options, range_m);
  }
  return range_m;
}

std::vector<double> DisturbScan(const std::vector<double>& exact_range_m,
                                const LaserOptions& options, std::uint64_t seed, int frame) {
  RandomStream random(seed, RandomStage::kLaserRange, static_cast<std::uint32_t>(frame));
  std::vector<double> reported_m;
  reported_m.reserve(exact_range_m.size());
  const double innovation = std::sqrt(1.0 - options.noise_correlation * options.noise_correlation);
  double unit = random.Normal();
  for (const double exact_m : exact_range_m) {
    unit = options.noise_correlation * unit + innovation * random.Normal();
    const double outlier = random.Uniform();
    if (outlier < options.outlier_share) {
      reported_m.push_back(random.Uniform(options.min_range_m, options.max_range_m));
    } else if (exact_m >= options.max_range_m) {
      reported_m.push_back(options.max_range_m);
    } else {
      const double sigma_m =
          options.noise_relative * exact_m + options.noise_quadratic_per_m * exact_m * exact_m;
      const double noisy_m = exact_m + sigma_m * unit;
      reported_m.push_back(noisy_m < options.min_range_m ? 0.0
                                                         : std::min(noisy_m, options.max_range_m));
    }
  }
  return reported_m;
}

}  // namespace depthgrid
