#include "mapper/grid/beam_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

constexpr std::size_t kMetres = 32;
// With fewer in a metre, that of all ranges is taken. Chosen, not measured.
constexpr std::size_t kLeastBends = 200;
// Neighbouring beams of a depth image err alike, which shows only between beams farther apart than
// that reaches; over wider angles surfaces are not flat. In an image of 640 columns and 58 to 90
// degrees it takes in 8 columns.
constexpr double kWidestRad = RadFromDeg(1.2);
constexpr std::size_t kMostApart = 64;
// Errors that neighbours share show as several times the noise at twice the spacing; edges and
// round things add less than this.
constexpr double kMarkedly = 1.5;

// How far a beam's range is from what those `apart` beams before and after it say of a flat wall,
// as a share of the range. Along a wall 1 / range is a sum of a sine and a cosine of the bearing.
std::optional<double> BendAt(const std::vector<Beam>& beams, std::size_t i, std::size_t apart) {
  const Beam &before = beams[i - apart], &here = beams[i], &after = beams[i + apart];
  if (!before.hit || !here.hit || !after.hit) return {};
  const double step_rad = 0.5 * (after.bearing_rad - before.bearing_rad);
  if (apart > 1 && step_rad > kWidestRad) return {};
  const double range_m = here.range_m;
  return std::abs(range_m / before.range_m - 2.0 * std::cos(step_rad) + range_m / after.range_m);
}

// On a flat wall a bend is noise alone, of variance (1 + 4 + 1) sigma^2; edges are few, so the
// median passes over them.
double NoiseOf(std::vector<double> bends) {
  constexpr double kMedianOfNormal = 0.6745;
  if (bends.empty()) return 0.0;
  const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
  std::nth_element(bends.begin(), middle, bends.end());
  return *middle / (kMedianOfNormal * std::sqrt(6.0));
}

std::size_t MetreOf(double range_m) {
  return std::min(static_cast<std::size_t>(std::max(range_m, 0.0)), kMetres - 1);
}

// Of beams that far apart.
std::vector<double> NoiseByMetre(const std::vector<Scan>& scans, std::size_t apart) {
  std::vector<double> all;
  std::vector<std::vector<double>> of_metre(kMetres);
  for (const Scan& scan : scans) {
    for (std::size_t i = apart; i + apart < scan.beams.size(); ++i) {
      const auto bend = BendAt(scan.beams, i, apart);
      if (!bend) continue;
      all.push_back(*bend);
      of_metre[MetreOf(scan.beams[i].range_m)].push_back(*bend);
    }
  }
  const double of_all = NoiseOf(std::move(all));
  std::vector<double> shares;
  for (std::vector<double>& bends : of_metre) {
    shares.push_back(bends.size() < kLeastBends ? of_all : NoiseOf(std::move(bends)));
  }
  return shares;
}

}  // namespace

BeamNoise::BeamNoise(const std::vector<Scan>& scans) : share_of_metre_(kMetres, 0.0) {
  for (std::size_t apart = 1; apart <= kMostApart; apart *= 2) {
    const std::vector<double> shares = NoiseByMetre(scans, apart);
    for (std::size_t i = 0; i < kMetres; ++i) {
      double& share = share_of_metre_[i];
      if (apart == 1 || shares[i] > kMarkedly * share) share = shares[i];
    }
  }
}

double BeamNoise::Share(double range_m) const { return share_of_metre_[MetreOf(range_m)]; }

}  // namespace depthgrid
