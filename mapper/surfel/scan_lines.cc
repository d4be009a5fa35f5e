#include "mapper/surfel/scan_lines.h"

#include <algorithm>
#include <cmath>

#include "mapper/surfel/range_cutoff.h"

namespace depthgrid {
namespace {

// Prior on a surface's slope: standard deviation of the tangent of the incidence angle (56
// degrees). Lines too short to determine their slope face the sensor.
constexpr double kPriorSlopeSigma = 1.5;
// Candidates for a split are tried this far apart, then around the best.
constexpr int kSplitStride = 4;
// Weights use the mean range of this many neighbours on either side: a weight that depends on its
// own beam's error (nearer looks more precise) would bias the fit.
constexpr int kWeightWindow = 8;

// Prior weight, in returns, of a line fitting as well as noise allows (4 and 16 do the same:
// docs/tried.md, "Lines that do not fit").
constexpr double kReturnsLikeNoise = 4.0;
// Fitted parameters of a line.
constexpr double kFitted = 2.0;

// Determinant over squared trace below which all returns have one bearing but for rounding; four
// beams spaced by a thousandth of a right angle have 1e-6.
constexpr double kOneBearing = 1e-12;

// Distance before the reach, in sigmas, below which too few returns remain to locate the wall.
constexpr double kLeastSigmas = 0.0;
// A line with less information than this many returns far from the reach is an artefact of noise.
constexpr double kLeastInformation = 10.0;
// Rounds of the correction: the first ones are too small, as the line starts too near.
constexpr int kCorrections = 6;

// Distance of the line before the sensor's reach at this return, in sigmas.
double SigmasWithinReach(const ScanLine& line, const ScanReturn& r, double max_range_m) {
  const double inverse_range = line.coefficients.dot(r.direction);
  return (max_range_m * inverse_range - 1.0) / r.relative_sigma;
}

}  // namespace

const std::vector<ScanLine>& ScanLineFinder::Find(ScanReturns& returns) {
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
        const ScanLine line = Fit(span, SumsOf(span), returns);
        const std::optional<ScanLine> sound = correct_cutoff_ ? WithinReach(line, returns) : line;
        if (sound) lines_.push_back(*sound);
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
    Add(returns[i], mean, sum);
    sums_[static_cast<std::size_t>(i) + 1] = sum;
  }
}

// `inverse_range`: scales the return's relative noise.
void ScanLineFinder::Add(const ScanReturn& r, double inverse_range, Sums& sums) {
  const double sigma = r.relative_sigma * inverse_range;
  const double w = r.information / (sigma * sigma);
  const double wx = w * r.direction.x();
  const double wy = w * r.direction.y();
  const double u = r.inverse_range;
  sums.xx += wx * r.direction.x();
  sums.xy += wx * r.direction.y();
  sums.yy += wy * r.direction.y();
  sums.xu += wx * u;
  sums.yu += wy * u;
  sums.uu += w * u * u;
}

ScanLineFinder::Sums ScanLineFinder::SumsOf(Span span) const {
  const Sums& a = sums_[static_cast<std::size_t>(span.begin)];
  const Sums& b = sums_[static_cast<std::size_t>(span.end)];
  return {b.xx - a.xx, b.xy - a.xy, b.yy - a.yy, b.xu - a.xu, b.yu - a.yu, b.uu - a.uu};
}

// Chi-square of the best line; of their mean, if all returns have one bearing.
double ScanLineFinder::Chi2(const Sums& s) {
  const double determinant = s.xx * s.yy - s.xy * s.xy;
  const double trace = s.xx + s.yy;
  if (!(determinant > kOneBearing * trace * trace)) {
    return s.uu - (s.xu * s.xu + s.yu * s.yu) / trace;
  }
  const double explained = s.yy * s.xu * s.xu - 2.0 * s.xy * s.xu * s.yu + s.xx * s.yu * s.yu;
  return s.uu - explained / determinant;
}

// The index that best splits the span, -1 if one line is enough.
int ScanLineFinder::BestSplit(Span span) const {
  const int first = span.begin + min_returns_;
  const int last = span.end - min_returns_;
  if (first > last) return -1;
  const double whole = Chi2(SumsOf(span));
  if (whole < split_chi2_) return -1;
  int best = -1;
  double best_chi2 = whole - split_chi2_;
  const auto consider = [&](int k) {
    const double chi2 = Chi2(SumsOf({span.begin, k})) + Chi2(SumsOf({k, span.end}));
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

ScanLine ScanLineFinder::Fit(Span span, const Sums& s, const ScanReturns& returns) {
  // In axes turned to the middle of the span: 1/r = a cos + b sin, with the prior on b / a.
  const Eigen::Vector2d ahead =
      (returns[span.begin].direction + returns[span.end - 1].direction).normalized();
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
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
  const double independent = std::max(span.size() * returns.independent_share(), kFitted);
  const double misfit = (Chi2(s) + kReturnsLikeNoise) / (independent - kFitted + kReturnsLikeNoise);
  return {span, a * ahead + b * left, std::sqrt(variance) / length2, std::max(misfit, 1.0)};
}

// Near the sensor's reach only returns that noise made short remain: adds their expected shortfall
// (range_cutoff.h). Empty where too little of the line lies within the reach.
std::optional<ScanLine> ScanLineFinder::WithinReach(const ScanLine& fitted,
                                                    ScanReturns& returns) const {
  if (!(returns.max_range_m() > 0.0)) return fitted;  // not known
  ScanLine line = fitted;
  const auto sigmas = [&](int i) {
    return SigmasWithinReach(line, returns[i], returns.max_range_m());
  };
  for (int round = 0; round < kCorrections; ++round) {
    Span span = line.span;
    // The range along a line is largest at its ends.
    if (sigmas(span.begin) > kUncutSigmas && sigmas(span.end - 1) > kUncutSigmas) break;
    while (span.size() > 0 && sigmas(span.begin) < kLeastSigmas) ++span.begin;
    while (span.size() > 0 && sigmas(span.end - 1) < kLeastSigmas) --span.end;
    Sums sums;
    double information = 0.0;
    for (int i = span.begin; i < span.end; ++i) {
      ScanReturn& r = returns[i];
      const double inverse_range = line.coefficients.dot(r.direction);
      const RangeCutoff cutoff = CutoffAt(sigmas(i));
      r.inverse_range = 1.0 / (r.range_m + cutoff.shortfall * r.relative_sigma / inverse_range);
      r.information = returns.independent_share() * cutoff.information;
      information += r.information;
      Add(r, inverse_range, sums);
    }
    if (span.size() < min_returns_ || information < kLeastInformation) return std::nullopt;
    line = Fit(span, sums, returns);
  }
  return line;
}

}  // namespace depthgrid
