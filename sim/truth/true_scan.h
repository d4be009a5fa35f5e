// The scans a perfect converter would make of a camera's view: cast in the room itself, for
// experiments that put the truth in place of depth images and their conversion.
#pragma once

#include <memory>
#include <optional>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"
#include "mapper/core/scan.h"
#include "sim/depth/ray_scene.h"
#include "sim/depth/view_pyramid.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

struct TrueScanOptions {
  int beams = 640;          // over the camera's horizontal field of view, uniform in angle
  double band_low_m = 0.1;  // above the floor
  double band_high_m = 1.8;
  double min_range_m = 0.4;
  double max_range_m = 6.0;
  double min_depth_m = 0.0;  // z-depths the sensor can measure
  double max_depth_m = 1e9;
  double resolution_m = 0.05;  // of the truth map, whose cells' surfaces are in view or not
};

class TrueScanner {
 public:
  // `rays` are of the mesh.
  TrueScanner(const TriangleMesh& mesh, double floor_z_m, const RayScene& rays,
              const PinholeCamera& camera, const TrueScanOptions& options);

  // The nearest obstacle of the band on each bearing that is in view: nearer ones below the image,
  // or above it, are passed. Free as far as the band is seen down to its lower edge and nothing at
  // all stands in it (docs/truth.md, observable cells: the same rules).
  Scan Obstacles(const Pose3& world_from_camera) const;
  // The level slice at the camera's own height.
  Scan Slice(const Pose3& world_from_camera) const;

 private:
  template <typename BeamOf>
  Scan ScanOf(const Pose3& world_from_camera, const RayScene& rays, float height_m,
              BeamOf beam_of) const;
  // Of the band's surfaces where a level ray ends, any part.
  bool IsSeen(const ViewPyramid& view, const Eigen::Vector2d& end) const;
  // Distances along a level ray; infinity where there is nothing.
  double NextOutline(const Eigen::Vector3d& at, const Eigen::Vector3d& direction,
                     double from_m) const;
  double NearestOnEdges(const ViewPyramid& image, const Eigen::Vector3d& at,
                        const Eigen::Vector3d& direction) const;
  struct Sight {
    double seen_m = 0.0;        // the nearest obstacle in view
    double free_until_m = 0.0;  // the nearest one out of view that is not below it
  };
  Sight Look(const ViewPyramid& image, const Eigen::Vector3d& at, const Eigen::Vector3d& direction,
             double outline_m, const std::optional<ValueSpan>& low_line) const;

  double band_low_z_m_;
  double band_high_z_m_;
  struct Surfaces;  // of the band
  std::shared_ptr<const Surfaces> surfaces_;
  RayScene rays_;
  PinholeCamera camera_;
  TrueScanOptions options_;
};

}  // namespace depthgrid
