// The scans a perfect converter would make of a camera's view: cast in the room itself, for
// experiments that put the truth in place of depth images and their conversion.
#pragma once

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"
#include "mapper/core/scan.h"
#include "sim/ray_scene.h"
#include "sim/triangle_mesh.h"

namespace depthgrid {

struct TrueScanOptions {
  int beams = 640;          // over the camera's horizontal field of view, uniform in angle
  double band_low_m = 0.1;  // above the floor
  double band_high_m = 1.8;
  double min_range_m = 0.4;
  double max_range_m = 6.0;
  double min_depth_m = 0.0;  // z-depths the sensor can measure
  double max_depth_m = 1e9;
};

class TrueScanner {
 public:
  // `rays` are of the mesh.
  TrueScanner(const TriangleMesh& mesh, double floor_z_m, const RayScene& rays,
              const PinholeCamera& camera, const TrueScanOptions& options);

  // The nearest obstacle of the whole band on each bearing, where the camera sees any of the band
  // above that place; free as far as the band is seen down to its lower edge (docs/truth.md,
  // observable cells: the same rules).
  Scan Obstacles(const Pose3& world_from_camera) const;
  // The level slice at the camera's own height.
  Scan Slice(const Pose3& world_from_camera) const;

 private:
  template <typename BeamOf>
  Scan ScanOf(const Pose3& world_from_camera, const RayScene& rays, float height_m,
              BeamOf beam_of) const;

  double band_low_z_m_;
  double band_high_z_m_;
  RayScene fences_;
  RayScene rays_;
  PinholeCamera camera_;
  TrueScanOptions options_;
};

}  // namespace depthgrid
