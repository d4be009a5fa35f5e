#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "sim/truth_grid.h"

namespace depthgrid {
namespace {

using Eigen::Vector3d;

struct Span {
  double low = 0.0;
  double high = 0.0;
};

// What the camera's image covers: a pyramid of four planes through its centre, and z > 0.
class ViewPyramid {
 public:
  ViewPyramid(const PinholeCamera& camera, const Pose3& world_from_camera)
      : centre_(world_from_camera.translation) {
    const Vector3d top_left = Unproject(camera, -0.5, -0.5, 1.0);
    const Vector3d bottom_right =
        Unproject(camera, camera.width_px - 0.5, camera.height_px - 0.5, 1.0);
    const std::array<Vector3d, 5> inward_in_camera = {
        Vector3d(1, 0, -top_left.x()), Vector3d(-1, 0, bottom_right.x()),
        Vector3d(0, 1, -top_left.y()), Vector3d(0, -1, bottom_right.y()), Vector3d(0, 0, 1)};
    for (std::size_t k = 0; k < 5; ++k)
      inward_[k] = world_from_camera.rotation * inward_in_camera[k];
    for (std::size_t k = 0; k < 4; ++k) {
      corners_[k] =
          world_from_camera.rotation * Vector3d(k % 2 == 0 ? top_left.x() : bottom_right.x(),
                                                k / 2 == 0 ? top_left.y() : bottom_right.y(), 1.0);
    }
  }

  bool Holds(const Vector3d& point) const {
    return std::all_of(inward_.begin(), inward_.end(),
                       [&](const Vector3d& inward) { return inward.dot(point - centre_) >= 0.0; });
  }

  // The part of the ray within the pyramid (which is convex); nothing when there is none.
  std::optional<Span> Part(const Vector3d& origin, const Vector3d& direction, Span span) const {
    for (const Vector3d& inward : inward_) {
      const double offset = inward.dot(origin - centre_), slope = inward.dot(direction);
      if (slope > 0.0) {
        span.low = std::max(span.low, -offset / slope);
      } else if (slope < 0.0) {
        span.high = std::min(span.high, -offset / slope);
      } else if (offset < 0.0) {
        return std::nullopt;
      }
    }
    if (span.low >= span.high) return std::nullopt;
    return span;
  }

  // Bearings in the world that the image reaches, a range around `heading_rad`; all of them when
  // the camera sees straight up or down.
  Span Bearings(double heading_rad) const {
    const auto sees = [&](const Vector3d& direction) { return Holds(centre_ + direction); };
    if (sees(Vector3d::UnitZ()) || sees(-Vector3d::UnitZ())) return {-kPi, kPi};
    Span relative;
    for (const Vector3d& corner : corners_) {
      const double angle = WrapAngle(std::atan2(corner.y(), corner.x()) - heading_rad);
      relative = {std::min(relative.low, angle), std::max(relative.high, angle)};
    }
    return {heading_rad + relative.low, heading_rad + relative.high};
  }

 private:
  Vector3d centre_;
  std::array<Vector3d, 5> inward_;
  std::array<Vector3d, 4> corners_;
};

// Calls visit(cell) for each cell that the segment crosses (Amanatides and Woo 1987).
template <typename Visit>
void Walk(const Eigen::Vector2d& from_cells, const Eigen::Vector2d& to_cells, const Visit& visit) {
  Cell cell = {static_cast<int>(std::floor(from_cells.x())),
               static_cast<int>(std::floor(from_cells.y()))};
  const Eigen::Vector2d way = to_cells - from_cells;
  const auto first_crossing = [](double from, double along) {
    if (along == 0.0) return std::numeric_limits<double>::infinity();
    return along > 0 ? (std::floor(from) + 1 - from) / along : (from - std::floor(from)) / -along;
  };
  double next_x = first_crossing(from_cells.x(), way.x());
  double next_y = first_crossing(from_cells.y(), way.y());
  const double step_x = 1.0 / std::abs(way.x()), step_y = 1.0 / std::abs(way.y());
  const int turn_x = way.x() > 0 ? 1 : -1, turn_y = way.y() > 0 ? 1 : -1;
  while (true) {
    visit(cell);
    if (std::min(next_x, next_y) >= 1.0) return;
    if (next_x < next_y) {
      cell.x += turn_x;
      next_x += step_x;
    } else {
      cell.y += turn_y;
      next_y += step_y;
    }
  }
}

class Observer {
 public:
  Observer(const RayScene& scene, double floor_z_m, const StateMap& truth,
           const PinholeCamera& camera, const TruthGridOptions& band,
           const ObservableOptions& options)
      : scene_(scene), truth_(truth), camera_(camera), options_(options) {
    const double band_m = band.band_high_m - band.band_low_m;
    const int count = std::max(1, static_cast<int>(std::ceil(band_m / options.height_step_m)));
    for (int k = 0; k < count; ++k) {
      heights_m_.push_back(floor_z_m + band.band_low_m + (k + 0.5) * band_m / count);
    }
  }

  void Look(const Pose3& world_from_camera, CellSet& seen) {
    const ViewPyramid view(camera_, world_from_camera);
    const Span bearings = view.Bearings(BaseOf(world_from_camera).yaw_rad);
    const double half_cell_rad = 0.5 * truth_.geometry.resolution_m / options_.max_range_m;
    const int count =
        static_cast<int>(std::ceil((bearings.high - bearings.low) / half_cell_rad)) + 1;
    const auto heights = heights_m_.size();
    rays_.resize(static_cast<std::size_t>(count) * heights);
    distances_.resize(rays_.size());
    for (std::size_t b = 0; b < static_cast<std::size_t>(count); ++b) {
      const double bearing = bearings.low + (bearings.high - bearings.low) *
                                                static_cast<double>(b) / std::max(1, count - 1);
      for (std::size_t h = 0; h < heights; ++h) {
        Vector3d origin = world_from_camera.translation;
        origin.z() = heights_m_[h];
        const Vector3d direction(std::cos(bearing), std::sin(bearing), 0.0);
        rays_[b * heights + h] = {origin.cast<float>(), direction.cast<float>(),
                                  static_cast<float>(options_.max_range_m)};
      }
    }
    scene_.NearestHits(rays_, distances_);
    for (std::size_t b = 0; b < static_cast<std::size_t>(count); ++b) {
      MarkBearing(view, std::span(rays_).subspan(b * heights, heights),
                  std::span(distances_).subspan(b * heights, heights), seen);
    }
  }

 private:
  void MarkBearing(const ViewPyramid& view, std::span<const Ray> rays,
                   std::span<const float> distances, CellSet& seen) const {
    const double blocked_m = *std::min_element(distances.begin(), distances.end());
    const Vector3d lowest_origin = rays[0].origin.cast<double>();
    const Vector3d direction = rays[0].direction.cast<double>();
    const Span wanted = {options_.min_range_m, std::min(blocked_m, options_.max_range_m)};
    if (const auto part = view.Part(lowest_origin, direction, wanted)) {
      MarkFree(lowest_origin + part->low * direction, lowest_origin + part->high * direction, seen);
    }
    // Of a wall that blocks at all heights some are in view and some are not.
    const double same_m = blocked_m + 0.5 * truth_.geometry.resolution_m;
    if (blocked_m < options_.min_range_m) return;
    for (std::size_t h = 0; h < rays.size(); ++h) {
      const double distance_m = distances[h];
      if (distance_m > same_m || distance_m > options_.max_range_m) continue;
      const Vector3d hit = rays[h].origin.cast<double>() + distance_m * direction;
      if (view.Holds(hit)) MarkOccupied(hit, seen);
    }
  }

  void MarkFree(const Vector3d& from, const Vector3d& to, CellSet& seen) const {
    const double resolution_m = truth_.geometry.resolution_m;
    Walk(from.head<2>() / resolution_m, to.head<2>() / resolution_m, [&](const Cell& cell) {
      if (!truth_.geometry.Contains(cell)) return;
      const std::size_t index = truth_.geometry.Index(cell);
      if (truth_.states[index] == CellState::kFree) seen.members[index] = 1;
    });
  }

  // A hit on a cell boundary lands on either side of it by rounding; the surface is in one.
  void MarkOccupied(const Vector3d& hit, CellSet& seen) const {
    constexpr double kRounding_m = 1e-4;
    for (const double dx : {kRounding_m, -kRounding_m}) {
      for (const double dy : {kRounding_m, -kRounding_m}) {
        const Cell cell = CellOf({hit.x() + dx, hit.y() + dy}, truth_.geometry.resolution_m);
        if (truth_.At(cell) != CellState::kOccupied) continue;
        seen.members[truth_.geometry.Index(cell)] = 1;
        return;
      }
    }
  }

  const RayScene& scene_;
  const StateMap& truth_;
  const PinholeCamera& camera_;
  const ObservableOptions options_;
  std::vector<double> heights_m_;
  std::vector<Ray> rays_;
  std::vector<float> distances_;
};

}  // namespace

CellSet ObservableCells(const RayScene& scene, double floor_z_m, const StateMap& truth,
                        const PinholeCamera& camera, const Trajectory& world_from_camera,
                        const TruthGridOptions& band, const ObservableOptions& options) {
  Require(options.threads >= 1 && options.height_step_m > 0 &&
              options.min_range_m < options.max_range_m,
          "at least one thread, a height step above 0 and a range that is not empty");
  const auto threads = static_cast<std::size_t>(options.threads);
  std::vector<CellSet> parts(threads, CellSet(truth.geometry));
  const auto look = [&](std::size_t part) {
    Observer observer(scene, floor_z_m, truth, camera, band, options);
    for (std::size_t i = part; i < world_from_camera.size(); i += threads) {
      observer.Look(world_from_camera[i].world_from_camera, parts[part]);
    }
  };
  if (threads == 1) {
    look(0);
  } else {
    tbb::task_arena(options.threads).execute([&] {
      tbb::parallel_for(std::size_t{0}, threads, look);
    });
  }
  // A union: no order to depend on.
  for (std::size_t part = 1; part < threads; ++part) {
    std::transform(parts[0].members.begin(), parts[0].members.end(), parts[part].members.begin(),
                   parts[0].members.begin(), [](auto a, auto b) { return a | b; });
  }
  return parts[0];
}

}  // namespace depthgrid
