#include "sim/truth/observable_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "sim/depth/parallel_calls.h"
#include "sim/depth/ray_scene.h"
#include "sim/depth/view_pyramid.h"
#include "sim/truth/band_outline.h"

namespace depthgrid {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Calls visit(cell) for each cell that the segment crosses (Amanatides and Woo 1987).
template <typename Visit>
void Walk(const Vector2d& from_cells, const Vector2d& to_cells, const Visit& visit) {
  Cell cell = {static_cast<int>(std::floor(from_cells.x())),
               static_cast<int>(std::floor(from_cells.y()))};
  const Vector2d way = to_cells - from_cells;
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

// Casts rays from poses and accumulates the cells seen.
class Observer {
 public:
  Observer(const RayScene& fences, const std::vector<ValueSpan>& height_m, const HeightBand& band,
           const StateMap& truth, const PinholeCamera& camera, const ObservableOptions& options)
      : fences_(fences),
        height_m_(height_m),
        band_(band),
        truth_(truth),
        camera_(camera),
        options_(options),
        seen_(truth.geometry) {}

  void LookFrom(const Pose3& world_from_camera) {
    const ViewPyramid view(camera_, world_from_camera,
                           {options_.min_depth_m, options_.max_depth_m});
    const ValueSpan bearings = view.Bearings(BaseOf(world_from_camera).yaw_rad);
    const double half_cell_rad = 0.5 * truth_.geometry.resolution_m / options_.max_range_m;
    const double width_rad = bearings.high - bearings.low;
    const auto count = static_cast<std::size_t>(std::ceil(width_rad / half_cell_rad)) + 1;
    const Vector2d at = world_from_camera.translation.head<2>();
    const Eigen::Vector3f origin(static_cast<float>(at.x()), static_cast<float>(at.y()),
                                 kFenceMiddleM);
    rays_.resize(count);
    directions_.resize(count);
    distances_.resize(count);
    for (std::size_t b = 0; b < count; ++b) {
      const double part = count > 1 ? static_cast<double>(b) / static_cast<double>(count - 1) : 0.5;
      const double bearing_rad = bearings.low + part * width_rad;
      directions_[b] = {std::cos(bearing_rad), std::sin(bearing_rad)};
      rays_[b] = {
          origin,
          {static_cast<float>(directions_[b].x()), static_cast<float>(directions_[b].y()), 0.0F},
          static_cast<float>(options_.max_range_m)};
    }
    fences_.NearestHits(rays_, distances_);
    for (std::size_t b = 0; b < count; ++b) MarkBearing(view, at, directions_[b], distances_[b]);
  }

  const CellSet& seen() const { return seen_; }

 private:
  void MarkBearing(const ViewPyramid& view, const Vector2d& at, const Vector2d& direction,
                   double blocked_m) {
    const ValueSpan reach_m = {options_.min_range_m, std::min(blocked_m, options_.max_range_m)};
    if (reach_m.low > reach_m.high) return;
    const auto clear =
        view.Part({at.x(), at.y(), band_.low_z_m}, {direction.x(), direction.y(), 0.0}, reach_m);
    if (clear) MarkFree(at + clear->low * direction, at + clear->high * direction);
    if (blocked_m <= options_.max_range_m) MarkOccupied(view, at + blocked_m * direction);
  }

  void MarkFree(const Vector2d& from, const Vector2d& to) {
    const double resolution_m = truth_.geometry.resolution_m;
    Walk(from / resolution_m, to / resolution_m, [&](const Cell& cell) {
      if (!truth_.geometry.Contains(cell)) return;
      const std::size_t index = truth_.geometry.Index(cell);
      if (truth_.states[index] == CellState::kFree) seen_.members[index] = 1;
    });
  }

  void MarkOccupied(const ViewPyramid& view, const Vector2d& hit) {
    const auto cell = OccupiedCellAt(truth_, hit);
    if (!cell) return;
    const Vector3d ground(hit.x(), hit.y(), 0.0);
    if (view.Part(ground, Vector3d::UnitZ(), height_m_[*cell])) seen_.members[*cell] = 1;
  }

  const RayScene& fences_;
  const std::vector<ValueSpan>& height_m_;
  const HeightBand band_;
  const StateMap& truth_;
  const PinholeCamera& camera_;
  const ObservableOptions options_;
  CellSet seen_;
  std::vector<Ray> rays_;
  std::vector<Vector2d> directions_;
  std::vector<float> distances_;
};

}  // namespace

CellSet ObservableCells(const TriangleMesh& mesh, double floor_z_m, const StateMap& truth,
                        const PinholeCamera& camera, const Trajectory& world_from_camera,
                        const TruthGridOptions& grid, const ObservableOptions& options) {
  Require(options.threads >= 1 && options.min_range_m < options.max_range_m,
          "at least one thread and a range that is not empty");
  Require(grid.resolution_m == truth.geometry.resolution_m || truth.states.empty(),
          "the truth map's own resolution");
  const HeightBand band = {floor_z_m + grid.band_low_m, floor_z_m + grid.band_high_m};
  const BandOutline outline = OutlineOf(mesh, band, truth);
  // Not the sensor's instruction set: what could be seen does not depend on it.
  const RayScene fences(outline.fences, RayIsa::kAvx2, options.threads);
  const auto threads = static_cast<std::size_t>(options.threads);
  std::vector<Observer> observers(threads,
                                  Observer(fences, outline.height_m, band, truth, camera, options));
  CallInParallel(threads, options.threads, [&](std::size_t k) {
    for (std::size_t i = k; i < world_from_camera.size(); i += threads) {
      observers[k].LookFrom(world_from_camera[i].world_from_camera);
    }
  });
  // A union does not depend on the order.
  CellSet seen = observers[0].seen();
  for (const Observer& observer : observers) {
    for (std::size_t i = 0; i < seen.members.size(); ++i) {
      seen.members[i] |= observer.seen().members[i];
    }
  }
  return seen;
}

}  // namespace depthgrid
