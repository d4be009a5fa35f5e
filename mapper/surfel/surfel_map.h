// Oriented surfels of everything seen so far, and scans matched against them (docs/math.md,
// "Surfels").
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/pose2.h"
#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

struct SurfelOptions {
  ScanSurfelOptions scan;
  double spacing_m = 0.05;         // of surfels along a wall
  double gate_m = 0.15;            // farther along the normal nothing is associated
  double max_angle_deg = 45.0;     // between a piece of scan and the surfel it is matched to
  double huber_sigmas = 2.5;       // residuals beyond count linearly
  double normal_floor_rad = 0.01;  // no surfel's normal is known better
  double debias = 3.0;             // directions with less than this times the false information
                                   // of noisy normals are not seen; 0 switches it off
  double correlation = 3.0;        // a match's information is divided by this
  int max_iterations = 8;

  void Visit(OptionsVisitor& v);
};

struct SurfelMatch {
  bool found = false;
  Pose2 map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of the match alone, debiased
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // information * (observed - map_from_base)
  double explained = 0.0;
  double chi2 = 0.0;
  int used = 0;
  int iterations = 0;
};

class SurfelMapCore {
 public:
  explicit SurfelMapCore(const SurfelOptions& options)
      : options_(options), extractor_(options.scan) {}

  const std::vector<ScanSurfel>& Extract(const Scan& scan);
  // Maximum a posteriori: the pieces against the surfels, and the prediction with its covariance in
  // base axes.
  SurfelMatch Match(const std::vector<ScanSurfel>& pieces, const Pose2& predicted,
                    const Eigen::Matrix3d& covariance) const;
  void Insert(const std::vector<ScanSurfel>& pieces, const Pose2& map_from_base, int frame);
  const SurfelStore& store() const { return store_; }
  SurfelStore& store() { return store_; }

 private:
  int Associate(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal, double reach_m,
                double gate_m) const;

  SurfelOptions options_;
  RangeNoise noise_;
  ScanSurfelExtractor extractor_;
  SurfelStore store_;
};

}  // namespace depthgrid
