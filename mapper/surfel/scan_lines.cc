#include "mapper/surfel/scan_lines.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// A surface's slope against the beam before anything is known of it, as the standard deviation of
// the tangent of incidence (56 degrees): pieces too short to show their slope face the sensor.
constexpr double kPriorSlopeSigma = 1.5;
// Candidates for a split are tried this far apart, then around the best.
constexpr int kSplitStride = 4;
// Weights come from the mean of so many neighbours on either side: a weight that knows its own
// beam's error (nearer looks more precise) would bias the fit.
constexpr int kWeightWindow = 8;

// A line fits as noise lets it until more returns than this tell (4 and 16 do the same:
// docs/tried.md, "Lines that do not fit").
constexpr double kReturnsLikeNoise = 4.0;
// Of a line.
constexpr double kFitted = 2.0;

}  // namespace

const std::vector<ScanLine>& ScanLineFinder::Find(const ScanReturns& returns) {
  Accumulate(returns);
  lines_.clear();
  for (const Span& run : returns.runs()) {
    stack_.push_back(run);
    while (!stack_.empty()) {
      const Span span = stack_.back();
      stack_.pop_back();
      if (span.size() < min_returns_) continue;
      const int split = BestSplit(span);
      if (split < 0) {
        lines_.push_back(Fit(span, returns));
      } else {
        stack_.push_back({split, span.end});
        stack_.push_back({span.begin, split});
      }
    }
  }
  return lines_;
}

void ScanLineFinder::Accumulate(const ScanReturns& returns) {
  const int n = returns.size();
  sums_.resize(static_cast<std::size_t>(n) + 1);
  Sums sum;
  sums_[0] = sum;
  double window = 0.0;
  for (int i = 0; i < std::min(kWeightWindow, n); ++i) window += returns[i].inverse_range;
  for (int i = 0; i < n; ++i) {
    const int first = i - kWeightWindow;
    const int last = i + kWeightWindow;
    if (last < n) window += returns[last].inverse_range;
    if (first > 0) window -= returns[first - 1].inverse_range;
    const double mean = window / (std::min(last, n - 1) - std::max(first, 0) + 1);
    const ScanReturn& r = returns[i];
    const double sigma = r.relative_sigma * mean;
    const double w = 1.0 / (sigma * sigma);
    const double wx = w * r.direction.x();
    const double wy = w * r.direction.y();
    const double u = r.inverse_range;
    sum.xx += wx * r.direction.x();
    sum.xy += wx * r.direction.y();
    sum.yy += wy * r.direction.y();
    sum.xu += wx * u;
    sum.yu += wy * u;
    sum.uu += w * u * u;
    sums_[static_cast<std::size_t>(i) + 1] = sum;
  }
}

ScanLineFinder::Sums ScanLineFinder::SumsOf(Span span) const {
  const Sums& a = sums_[static_cast<std::size_t>(span.begin)];
  const Sums& b = sums_[static_cast<std::size_t>(span.end)];
  return {b.xx - a.xx, b.xy - a.xy, b.yy - a.yy, b.xu - a.xu, b.yu - a.yu, b.uu - a.uu};
}

// The weighted squared error of the best line.
double ScanLineFinder::Chi2(Span span) const {
  const Sums s = SumsOf(span);
  const double determinant = s.xx * s.yy - s.xy * s.xy;
  const double explained = s.yy * s.xu * s.xu - 2.0 * s.xy * s.xu * s.yu + s.xx * s.yu * s.yu;
  return s.uu - explained / determinant;
}

// The index that divides the span best, -1 if one line is enough.
int ScanLineFinder::BestSplit(Span span) const {
  const int first = span.begin + min_returns_;
  const int last = span.end - min_returns_;
  if (first > last) return -1;
  const double whole = Chi2(span);
  if (whole < split_chi2_) return -1;
  int best = -1;
  double best_chi2 = whole - split_chi2_;
  const auto consider = [&](int k) {
    const double chi2 = Chi2({span.begin, k}) + Chi2({k, span.end});
    if (chi2 >= best_chi2) return;
    best_chi2 = chi2;
    best = k;
  };
  for (int k = first; k <= last; k += kSplitStride) consider(k);
  if (best < 0) return -1;
  const int centre = best;
  for (int k = std::max(centre - kSplitStride + 1, first);
       k <= std::min(centre + kSplitStride - 1, last); ++k) {
    consider(k);
  }
  return best;
}

ScanLine ScanLineFinder::Fit(Span span, const ScanReturns& returns) const {
  // In axes turned to the middle of the span: 1/r = a cos + b sin, with the prior on b / a.
  const Eigen::Vector2d ahead =
      (returns[span.begin].direction + returns[span.end - 1].direction).normalized();
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const Sums s = SumsOf(span);
  Eigen::Matrix2d h;
  h << s.xx, s.xy, s.xy, s.yy;
  const Eigen::Vector2d g(s.xu, s.yu);
  const double aa = ahead.dot(h * ahead);
  const double ab = ahead.dot(h * left);
  const double ag = ahead.dot(g);
  const double slope_sigma = kPriorSlopeSigma * ag / aa;
  const double bb = left.dot(h * left) + 1.0 / (slope_sigma * slope_sigma);
  const double bg = left.dot(g);
  const double determinant = aa * bb - ab * ab;
  const double a = (bb * ag - ab * bg) / determinant;
  const double b = (aa * bg - ab * ag) / determinant;
  // The variance of atan2(b, a), from the inverse of (aa ab; ab bb).
  const double length2 = a * a + b * b;
  const double variance = (b * b * bb + 2.0 * a * b * ab + a * a * aa) / determinant;
  const double misfit =
      (Chi2(span) + kReturnsLikeNoise) / (span.size() - kFitted + kReturnsLikeNoise);
  return {span, a * ahead + b * left, std::sqrt(variance) / length2, std::max(misfit, 1.0)};
}

}  // namespace depthgrid
