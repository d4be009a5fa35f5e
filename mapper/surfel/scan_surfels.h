// A scan cut into short pieces of surface: what is matched and what is mapped.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/scan.h"
#include "mapper/surfel/range_noise.h"

namespace depthgrid {

// A piece of surface as one scan sees it, in base axes.
struct ScanSurfel {
  Eigen::Vector2d point_m;
  Eigen::Vector2d normal;         // unit, towards the sensor
  double sigma_m = 0.0;           // of the point along the normal
  double sigma_normal_rad = 0.0;  // of the normal's direction
  int beams = 0;
};

struct ScanSurfelOptions {
  int beams = 8;                     // of a cluster, at most: trades time for nothing else
  double max_width_m = 0.2;          // of a cluster, so that coarse scanners keep details
  double jump_sigmas = 5.0;          // a difference of neighbours this unlikely cuts the scan
  double split_chi2 = 30.0;          // a gain of fit this large makes two lines of one
  int min_segment_beams = 4;         // shorter pieces are left out
  double bearing_noise_steps = 0.0;  // uncertainty of a bearing, in steps between beams

  void Visit(OptionsVisitor& v);
};

class ScanSurfelExtractor {
 public:
  explicit ScanSurfelExtractor(const ScanSurfelOptions& options) : options_(options) {}
  // Valid until the next call.
  const std::vector<ScanSurfel>& Extract(const Scan& scan, const RangeNoise& noise);

 private:
  struct Return {
    double bearing_rad, cosine, sine, inverse_range, relative_sigma;
  };
  // Sums of weighted products over the returns before an index: normal equations of a line fit.
  struct Sums {
    double cc = 0, cs = 0, ss = 0, cu = 0, su = 0, uu = 0;
  };
  struct Piece {
    int begin, end;
  };

  void CollectReturns(const Scan& scan, const RangeNoise& noise);
  void CutAtJumps();
  void Split(Piece piece);
  void Emit(Piece piece);
  Sums SumsOf(int begin, int end) const;
  double Chi2(int begin, int end) const;

  ScanSurfelOptions options_;
  std::vector<float> bearings_;  // of the table below
  std::vector<Eigen::Vector2d> directions_;
  double step_rad_ = 0.0;
  std::vector<Return> returns_;
  std::vector<int> kept_;
  std::vector<Sums> sums_;
  std::vector<Piece> runs_;
  std::vector<Piece> stack_;
  std::vector<ScanSurfel> surfels_;
};

}  // namespace depthgrid
