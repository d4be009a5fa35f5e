#include "mapper/surfel/scan_surfels.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// Neighbours this many steps apart are still one surface (dropped beams between them).
constexpr double kMaxGapSteps = 3.5;
// Steepest incidence that is a surface and not a jump.
constexpr double kMaxIncidenceTangent = 11.4;  // 85 degrees
// Without evidence a surface's slope against the beam is this uncertain (tangent of incidence).
constexpr double kPriorSlopeSigma = 1.5;
constexpr int kSplitStride = 4;

}  // namespace

void ScanSurfelOptions::Visit(OptionsVisitor& v) {
  v.Number("beams", beams, {1, 1000}, "beams of a cluster, at most");
  v.Number("max_width_m", max_width_m, {0.01, 10}, "width of a cluster, at most");
  v.Number("jump_sigmas", jump_sigmas, {1, 100}, "a difference of neighbours that cuts the scan");
  v.Number("split_chi2", split_chi2, {1, 1e6}, "a gain of fit that makes two lines of one");
  v.Number("min_segment_beams", min_segment_beams, {2, 1000}, "shorter pieces are left out");
  v.Number("bearing_noise_steps", bearing_noise_steps, {0, 10},
           "uncertainty of a bearing, in steps between beams");
}

const std::vector<ScanSurfel>& ScanSurfelExtractor::Extract(const Scan& scan,
                                                            const RangeNoise& noise) {
  surfels_.clear();
  CollectReturns(scan, noise);
  CutAtJumps();
  for (const Piece& run : runs_) {
    stack_.push_back(run);
    while (!stack_.empty()) {
      const Piece piece = stack_.back();
      stack_.pop_back();
      Split(piece);
    }
  }
  return surfels_;
}

void ScanSurfelExtractor::CollectReturns(const Scan& scan, const RangeNoise& noise) {
  const auto& beams = scan.beams;
  const bool same =
      bearings_.size() == beams.size() &&
      std::equal(beams.begin(), beams.end(), bearings_.begin(),
                 [](const Beam& b, float bearing) { return b.bearing_rad == bearing; });
  if (!same) {
    bearings_.clear();
    directions_.clear();
    for (const Beam& beam : beams) {
      bearings_.push_back(beam.bearing_rad);
      directions_.push_back({std::cos(static_cast<double>(beam.bearing_rad)),
                             std::sin(static_cast<double>(beam.bearing_rad))});
    }
    step_rad_ = beams.size() < 2 ? 1.0
                                 : (beams.back().bearing_rad - beams.front().bearing_rad) /
                                       static_cast<double>(beams.size() - 1);
  }
  returns_.clear();
  double sigma_range_m = 0.0;
  double relative_sigma = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!beams[i].hit) continue;
    const double range_m = beams[i].range_m;
    // The noise changes slowly with the range; looking it up again within 10 % is not needed.
    if (std::abs(range_m - sigma_range_m) > 0.1 * sigma_range_m) {
      sigma_range_m = range_m;
      relative_sigma = noise.RelativeSigma(range_m);
    }
    returns_.push_back(
        {bearings_[i], directions_[i].x(), directions_[i].y(), 1.0 / range_m, relative_sigma});
  }
}

void ScanSurfelExtractor::CutAtJumps() {
  runs_.clear();
  kept_.clear();
  const auto jumps = [&](const Return& a, const Return& b) {
    const double gap_rad = b.bearing_rad - a.bearing_rad;
    if (gap_rad > kMaxGapSteps * step_rad_) return true;
    const double relative =
        std::abs(a.inverse_range - b.inverse_range) / std::min(a.inverse_range, b.inverse_range);
    return relative >
           options_.jump_sigmas * 1.4142 * a.relative_sigma + kMaxIncidenceTangent * gap_rad;
  };
  // Single returns that differ from both neighbours, which agree, are left out.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < returns_.size(); ++i) {
    const bool inside = kept > 0 && i + 1 < returns_.size();
    if (inside && jumps(returns_[kept - 1], returns_[i]) && jumps(returns_[i], returns_[i + 1]) &&
        !jumps(returns_[kept - 1], returns_[i + 1])) {
      continue;
    }
    returns_[kept++] = returns_[i];
  }
  returns_.resize(kept);
  int begin = 0;
  const int n = static_cast<int>(returns_.size());
  sums_.resize(returns_.size() + 1);
  Sums sum;
  sums_[0] = sum;
  // Weights from the mean of neighbours: a weight that knows its own error biases the fit.
  constexpr int kHalfWindow = 8;
  double window = 0.0;
  for (int i = 0; i < std::min(kHalfWindow, n); ++i)
    window += returns_[static_cast<std::size_t>(i)].inverse_range;
  for (int i = 0; i < n; ++i) {
    const Return& r = returns_[static_cast<std::size_t>(i)];
    if (i > 0 && jumps(returns_[static_cast<std::size_t>(i - 1)], r)) {
      runs_.push_back({begin, i});
      begin = i;
    }
    if (i + kHalfWindow < n)
      window += returns_[static_cast<std::size_t>(i + kHalfWindow)].inverse_range;
    if (i - kHalfWindow - 1 >= 0)
      window -= returns_[static_cast<std::size_t>(i - kHalfWindow - 1)].inverse_range;
    const int count = std::min(i + kHalfWindow, n - 1) - std::max(i - kHalfWindow, 0) + 1;
    const double sigma = r.relative_sigma * window / count;
    const double w = 1.0 / (sigma * sigma);
    sum.cc += w * r.cosine * r.cosine;
    sum.cs += w * r.cosine * r.sine;
    sum.ss += w * r.sine * r.sine;
    sum.cu += w * r.cosine * r.inverse_range;
    sum.su += w * r.sine * r.inverse_range;
    sum.uu += w * r.inverse_range * r.inverse_range;
    sums_[static_cast<std::size_t>(i + 1)] = sum;
  }
  if (n > begin) runs_.push_back({begin, n});
}

ScanSurfelExtractor::Sums ScanSurfelExtractor::SumsOf(int begin, int end) const {
  const Sums& a = sums_[static_cast<std::size_t>(begin)];
  const Sums& b = sums_[static_cast<std::size_t>(end)];
  return {b.cc - a.cc, b.cs - a.cs, b.ss - a.ss, b.cu - a.cu, b.su - a.su, b.uu - a.uu};
}

// The weighted squared error of the best line through returns [begin, end).
double ScanSurfelExtractor::Chi2(int begin, int end) const {
  const Sums s = SumsOf(begin, end);
  const double determinant = s.cc * s.ss - s.cs * s.cs;
  return s.uu - (s.ss * s.cu * s.cu - 2.0 * s.cs * s.cu * s.su + s.cc * s.su * s.su) / determinant;
}

void ScanSurfelExtractor::Split(Piece piece) {
  const int m = options_.min_segment_beams;
  if (piece.end - piece.begin < m) return;
  if (piece.end - piece.begin >= 2 * m) {
    const double whole = Chi2(piece.begin, piece.end);
    const auto gain = [&](int k) { return whole - Chi2(piece.begin, k) - Chi2(k, piece.end); };
    double best_gain = options_.split_chi2;
    int best = -1;
    const auto consider = [&](int k) {
      const double g = gain(k);
      if (g > best_gain) {
        best_gain = g;
        best = k;
      }
    };
    if (whole > options_.split_chi2) {
      for (int k = piece.begin + m; k <= piece.end - m; k += kSplitStride) consider(k);
      if (best >= 0) {
        const int centre = best;
        for (int k = std::max(centre - kSplitStride + 1, piece.begin + m);
             k <= std::min(centre + kSplitStride - 1, piece.end - m); ++k) {
          consider(k);
        }
        stack_.push_back({best, piece.end});
        stack_.push_back({piece.begin, best});
        return;
      }
    }
  }
  Emit(piece);
}

void ScanSurfelExtractor::Emit(Piece piece) {
  // The line in axes turned to the piece's middle: u = a cos(d) + b sin(d), with a prior on the
  // slope b / a, so that a piece too short to know its slope faces the sensor.
  const Return& first = returns_[static_cast<std::size_t>(piece.begin)];
  const Return& last = returns_[static_cast<std::size_t>(piece.end - 1)];
  const double middle_rad = 0.5 * (first.bearing_rad + last.bearing_rad);
  const double c = std::cos(middle_rad);
  const double s = std::sin(middle_rad);
  const Sums g = SumsOf(piece.begin, piece.end);
  const double aa = c * c * g.cc + 2.0 * c * s * g.cs + s * s * g.ss;
  const double ab = c * s * (g.ss - g.cc) + (c * c - s * s) * g.cs;
  double bb = s * s * g.cc - 2.0 * c * s * g.cs + c * c * g.ss;
  const double au = c * g.cu + s * g.su;
  const double bu = -s * g.cu + c * g.su;
  const double a0 = au / aa;
  bb += 1.0 / (kPriorSlopeSigma * kPriorSlopeSigma * a0 * a0);
  const double determinant = aa * bb - ab * ab;
  const double a = (bb * au - ab * bu) / determinant;
  const double b = (aa * bu - ab * au) / determinant;
  const double length2 = a * a + b * b;
  const double length = std::sqrt(length2);
  // n.p = 1 / length on the line, n pointing away from the sensor.
  const double normal_x = (c * a - s * b) / length;
  const double normal_y = (s * a + c * b) / length;
  // The normal's angle is middle + atan2(b, a); its variance by propagation.
  const double var_normal =
      (b * b * bb + 2.0 * a * b * ab + a * a * aa) / (determinant * length2 * length2);
  const double sigma_normal_rad = std::sqrt(var_normal);
  const double line_x = normal_x * length;
  const double line_y = normal_y * length;

  for (int begin = piece.begin; begin < piece.end;) {
    const Return& r0 = returns_[static_cast<std::size_t>(begin)];
    const double range0_m = 1.0 / (line_x * r0.cosine + line_y * r0.sine);
    const double cos0 = std::max(normal_x * r0.cosine + normal_y * r0.sine, 0.02);
    const double spacing_m = range0_m * step_rad_ / cos0;
    const int remaining = piece.end - begin;
    const int wanted =
        std::clamp(static_cast<int>(options_.max_width_m / spacing_m), 1, options_.beams);
    const int chunks = (remaining + wanted - 1) / wanted;
    const int size = (remaining + chunks - 1) / chunks;
    const int end = begin + size;
    // The chunk's own distance, as a share of the line's: its noise is independent of the others'.
    double ratio = 0.0;
    double sigma2 = 0.0;
    double bearing_rad = 0.0;
    for (int i = begin; i < end; ++i) {
      const Return& r = returns_[static_cast<std::size_t>(i)];
      ratio += r.inverse_range / (line_x * r.cosine + line_y * r.sine);
      sigma2 += r.relative_sigma * r.relative_sigma;
      bearing_rad += r.bearing_rad;
    }
    ratio /= size;
    bearing_rad /= size;
    const double relative_sigma2 = sigma2 / (static_cast<double>(size) * size);
    const double direction_x = std::cos(bearing_rad);
    const double direction_y = std::sin(bearing_rad);
    const double range_m = 1.0 / (ratio * (line_x * direction_x + line_y * direction_y));
    const double cosine = normal_x * direction_x + normal_y * direction_y;
    const double sine2 = std::max(1.0 - cosine * cosine, 0.0);
    const double bearing_sigma = options_.bearing_noise_steps * step_rad_;
    ScanSurfel surfel;
    surfel.point_m = {range_m * direction_x, range_m * direction_y};
    surfel.normal = {-normal_x, -normal_y};
    surfel.sigma_m = range_m * std::sqrt(relative_sigma2 * cosine * cosine +
                                         bearing_sigma * bearing_sigma * sine2);
    surfel.sigma_normal_rad = sigma_normal_rad;
    surfel.beams = size;
    if (ratio > 0.0 && cosine > 0.0) surfels_.push_back(surfel);
    begin = end;
  }
}

}  // namespace depthgrid
