// Straight pieces of a scan. On a line n.p = d the inverse range is linear in the beam's direction,
// 1/r = (n/d).(cos, sin), so lines are fitted there: no bias at grazing incidence.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/surfel/scan_returns.h"

namespace depthgrid {

struct ScanLine {
  Span span;
  Eigen::Vector2d coefficients;   // 1/r = coefficients . direction
  double sigma_normal_rad = 0.0;  // of the direction of `coefficients`
  // How much farther from the line its returns lie than their noise explains, at least 1: of what
  // is bent or an edge, and too short to be split.
  double variance_factor = 1.0;
};

class ScanLineFinder {
 public:
  // `split_chi2`: a gain of fit this large makes two lines of one. Lines have at least
  // `min_returns`.
  ScanLineFinder(double split_chi2, int min_returns)
      : split_chi2_(split_chi2), min_returns_(min_returns) {}

  // In order of bearing; valid until the next call.
  const std::vector<ScanLine>& Find(const ScanReturns& returns);

 private:
  // Weighted sums over returns: the normal equations of a line fit and its error.
  struct Sums {
    double xx = 0, xy = 0, yy = 0, xu = 0, yu = 0, uu = 0;
  };

  void Accumulate(const ScanReturns& returns);
  Sums SumsOf(Span span) const;
  double Chi2(Span span) const;
  int BestSplit(Span span) const;
  ScanLine Fit(Span span, const ScanReturns& returns) const;

  double split_chi2_;
  int min_returns_;
  std::vector<Sums> sums_;  // before each return
  std::vector<Span> stack_;
  std::vector<ScanLine> lines_;
};

}  // namespace depthgrid
