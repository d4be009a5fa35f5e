// Straight pieces of a scan. On a line n.p = d the inverse range is linear in the beam's direction,
// 1/r = (n/d).(cos, sin), so lines are fitted there: no bias at grazing incidence.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapper/surfel/scan_returns.h"

namespace depthgrid {

struct ScanLine {
  Span span;
  Eigen::Vector2d coefficients;   // 1/r = coefficients . direction
  double sigma_normal_rad = 0.0;  // of the direction of `coefficients`
  // Reduced chi-square of the fit, at least 1: above 1 for bent surfaces and edges too short to be
  // split.
  double variance_factor = 1.0;
};

class ScanLineFinder {
 public:
  // `split_chi2`: a decrease of chi-square by this much splits a line in two. Lines have at least
  // `min_returns` returns. `correct_cutoff`: whether returns near the sensor's reach are corrected
  // for those that are missing (range_cutoff.h).
  ScanLineFinder(double split_chi2, int min_returns, bool correct_cutoff)
      : split_chi2_(split_chi2), min_returns_(min_returns), correct_cutoff_(correct_cutoff) {}

  // In order of bearing; valid until the next call. Applies the correction to `returns`.
  const std::vector<ScanLine>& Find(ScanReturns& returns);

 private:
  // Weighted sums over returns: the normal equations of a line fit and its error.
  struct Sums {
    double xx = 0, xy = 0, yy = 0, xu = 0, yu = 0, uu = 0;
  };

  static void Add(const ScanReturn& r, double inverse_range, Sums& sums);
  static double Chi2(const Sums& sums);
  void Accumulate(const ScanReturns& returns);
  Sums SumsOf(Span span) const;
  int BestSplit(Span span) const;
  static ScanLine Fit(Span span, const Sums& sums, const ScanReturns& returns);
  std::optional<ScanLine> WithinReach(const ScanLine& fitted, ScanReturns& returns) const;

  double split_chi2_;
  int min_returns_;
  bool correct_cutoff_;
  std::vector<Sums> sums_;  // prefix sums: of all returns before each
  std::vector<Span> stack_;
  std::vector<ScanLine> lines_;
};

}  // namespace depthgrid
