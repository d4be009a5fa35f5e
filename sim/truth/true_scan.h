// The scans of a perfect depth-to-scan conversion, ray-cast in the scene itself, for experiments
// that replace depth images and their conversion by the truth.
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
  double band_low_m = 0.1;  // heights above the floor
  double band_high_m = 1.8;
  double min_range_m = 0.4;
  double max_range_m = 6.0;
  double min_depth_m = 0.0;  // z-depths the sensor can measure
  double max_depth_m = 1e9;
  double resolution_m = 0.05;  // of the truth map; visibility is decided per cell
};

class TrueScanner {
 public:
  // `rays` is built from `mesh`.
  TrueScanner(const TriangleMesh& mesh, double floor_z_m, const RayScene& rays,
              const PinholeCamera& camera, const TrueScanOptions& options);

  // Hits are the nearest obstacle of the band in view on each bearing; nearer ones below or above
  // the image are skipped. A bearing is free as far as the band's lower edge is in view and nothing
  // stands in the band (the rules for observable cells in docs/truth.md).
  Scan Obstacles(const Pose3& world_from_camera) const;
  // The scan of a level slice at the camera's height.
  Scan Slice(const Pose3& world_from_camera) const;

 private:
  template <typename BeamOf>
  Scan ScanOf(const Pose3& world_from_camera, const RayScene& rays, float height_m,
              BeamOf beam_of) const;
  // Whether any part of the band's surfaces in the cell at `end` is in view.
  bool IsSeen(const ViewPyramid& view, const Eigen::Vector2d& end) const;
  // Distances along a level ray; infinity where there is nothing.
  double NextOutline(const Eigen::Vector3d& at, const Eigen::Vector3d& direction,
                     double from_m) const;
  double NearestOnEdges(const ViewPyramid& image, const Eigen::Vector3d& at,
                        const Eigen::Vector3d& direction) const;
  struct Sight {
    double seen_m = 0.0;        // the nearest obstacle in view
    double free_until_m = 0.0;  // the nearest obstacle out of view but not below the image
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
