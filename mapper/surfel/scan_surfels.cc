#include "mapper/surfel/scan_surfels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depthgrid {
namespace {

// Cosine of the incidence (60 degrees) beyond which a line runs along the beams rather than across.
constexpr double kAlongBeams = 0.5;

// False for a fit that does not intersect its end beams within any sensor's range, and for one that
// spans half a turn, as with a few beams all round.
bool WasSeen(const ScanLine& line, const ScanReturns& returns) {
  const ScanReturn& first = returns[line.span.begin];
  const ScanReturn& last = returns[line.span.end - 1];
  const auto within_sight = [&](const ScanReturn& r) {  // false for NaN
    return line.coefficients.dot(r.direction) * kFarthestSeenM >= 1.0;
  };
  return within_sight(first) && within_sight(last) && last.bearing_rad - first.bearing_rad < kPi;
}

}  // namespace

void ScanSurfelOptions::Visit(OptionsVisitor& v) {
  v.Number("beams", beams, {1, 1000}, "beams of a surfel, at most");
  v.Number("max_length_m", max_length_m, {0.01, 10.0}, "length of a surfel, at most");
  v.Number("jump_sigmas", jump_sigmas, {1.0, 100.0},
           "neighbouring ranges that differ by more sigmas are an edge");
  v.Number("split_chi2", split_chi2, {1.0, 1e6},
           "a line is split where two lines fit better by this chi-square");
  v.Number("min_line_beams", min_line_beams, {3, 1000}, "lines of fewer beams are left out");
  v.Flag("judge_fit", judge_fit,
         "whether a line that fits its beams worse than their noise explains is believed less");
  v.Number("edge_misfit", edge_misfit, {0.0, 1e6},
           "a line along the beams, too short to be split, is taken for an edge and left out where "
           "it fits worse than this many times what noise explains; 0 leaves out none");
  v.Flag("skip_alike", skip_alike,
         "whether beams that err as their neighbours do, as far as scans show, are left out");
  v.Flag("correct_cutoff", correct_cutoff,
         "whether returns near the sensor's reach are corrected for those that noise pushed beyond "
         "it");
}

std::vector<Surfel> ScanSurfelMaker::Make(const Scan& scan, const RangeNoise& noise, int stride,
                                          std::vector<Surfel> memory) {
  std::vector<Surfel> surfels = std::move(memory);
  surfels.clear();
  returns_.Read(scan, noise, stride);
  // Where beams err as their neighbours do, walls misfit as well.
  const bool drops_edges = options_.edge_misfit > 0.0 && noise.stride() == 1;
  for (const ScanLine& line : lines_.Find(returns_)) {
    if (!WasSeen(line, returns_) || (drops_edges && IsEdge(line))) continue;
    for (int begin = line.span.begin; begin < line.span.end;) {
      const int end = begin + BeamsAt(line, begin);
      surfels.push_back(SurfelOf(line, {begin, end}));
      begin = end;
    }
  }
  return surfels;
}

// A few beams before an edge and a few behind it, on one line: its normal lies across the beams,
// where it claims the precision that their ranges have along it, a tenth of sigma at 84 degrees.
// But where between two beams the edge lies, and which of them noise put before it, the ranges do
// not tell.
bool ScanSurfelMaker::IsEdge(const ScanLine& line) const {
  if (line.span.size() >= 2 * options_.min_line_beams) return false;  // could have been split
  if (line.variance_factor <= options_.edge_misfit) return false;
  const Eigen::Vector2d middle =
      (returns_[line.span.begin].direction + returns_[line.span.end - 1].direction).normalized();
  return line.coefficients.dot(middle) < kAlongBeams * line.coefficients.norm();
}

// Number of beams of the surfel that starts at `begin`: the rest of the line is divided equally.
int ScanSurfelMaker::BeamsAt(const ScanLine& line, int begin) const {
  const Eigen::Vector2d& direction = returns_[begin].direction;
  const double inverse_range = line.coefficients.dot(direction);
  // Along the wall beams are step * r / cos(incidence) apart, cos = (1/r) / |coefficients|.
  const double spacing_m = returns_.step_rad() * line.coefficients.norm() /
                           std::max(inverse_range * inverse_range, 1e-9);
  const double fit =
      std::clamp(options_.max_length_m / spacing_m, 1.0, static_cast<double>(options_.beams));
  const int left = line.span.end - begin;
  const int parts = (left + static_cast<int>(fit) - 1) / static_cast<int>(fit);
  return (left + parts - 1) / parts;
}

// A surfel with the line's normal and the distance measured by these beams alone, as a multiple of
// the line's distance, so that neither the slope nor the noise of other beams enters.
Surfel ScanSurfelMaker::SurfelOf(const ScanLine& line, Span span) const {
  double share = 0.0;
  double variance = 0.0;  // of the mean relative range
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  for (int i = span.begin; i < span.end; ++i) {
    const ScanReturn& r = returns_[i];
    share += r.inverse_range / line.coefficients.dot(r.direction);
    variance += r.relative_sigma * r.relative_sigma / r.information;
    direction += r.direction;
  }
  const double count = span.size();
  share /= count;
  const double factor = options_.judge_fit ? line.variance_factor : 1.0;
  variance *= factor / (count * count);
  direction.normalize();
  // Limits the precision across the wall of grazing beams.
  constexpr double kMinCosine = 0.05;
  const double line_inverse_range = line.coefficients.dot(direction);
  const double line_range_m = 1.0 / line_inverse_range;
  const double cosine = line_inverse_range / line.coefficients.norm();
  Surfel surfel;
  surfel.normal = -line.coefficients.normalized();
  // Noise moves the piece along the normal only, not along the beam: a position along the wall that
  // is correlated with the error across it would bias the match's yaw. For the same reason sigma
  // uses the line's range, not the piece's (docs/math.md, "Scan").
  const double before_line_m = cosine * (line_range_m - line_range_m / share);
  surfel.point_m = line_range_m * direction + before_line_m * surfel.normal;
  const double sigma_m = std::sqrt(variance) * std::max(cosine, kMinCosine) * line_range_m;
  surfel.information = 1.0 / (sigma_m * sigma_m);
  surfel.normal_information = 1.0 / (factor * line.sigma_normal_rad * line.sigma_normal_rad);
  return surfel;
}

}  // namespace depthgrid
