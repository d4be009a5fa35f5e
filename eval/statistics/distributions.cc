#include "eval/statistics/distributions.h"

#include <algorithm>
#include <cmath>

#include "eval/statistics/log_gamma.h"
#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Logarithm of the density of S, where S^2 is a chi-square variable over its degrees.
double LogDensity(double s, double degrees) {
  const double half = 0.5 * degrees;
  return std::log(2.0) + half * std::log(half) - LogGamma(half) + (degrees - 1.0) * std::log(s) -
         half * s * s;
}

// Simpson's rule over the density of S times the normal distribution at t * S.
double Integral(double t, double degrees, double noncentrality, double low, double high) {
  constexpr int kIntervals = 1200;  // even; error below 1e-9 for all degrees
  const double step = (high - low) / kIntervals;
  double sum = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double s = low + step * i;
    const double weight = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * std::exp(LogDensity(s, degrees)) * NormalCdf(t * s - noncentrality);
  }
  return sum * step / 3.0;
}

}  // namespace

double NormalCdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double StudentTCdf(double t, double degrees, double noncentrality) {
  Require(degrees >= 1.0, "degrees of freedom are at least 1");
  if (noncentrality == 0.0 && degrees == 1.0) return 0.5 + std::atan(t) / kPi;
  if (noncentrality == 0.0 && degrees == 2.0) return 0.5 + 0.5 * t / std::sqrt(2.0 + t * t);
  // S has a standard deviation below 1 / sqrt(2 degrees); beyond 9 sqrt(2) of these the density is
  // negligible.
  const double reach = 9.0 / std::sqrt(degrees);
  const double low = std::max(1e-12, 1.0 - reach);
  const double high = 1.0 + reach;
  // The normal distribution rises within 9 of its standard deviations, which for a large t are
  // narrow compared to those of S: that part is integrated separately.
  constexpr double kLargeT = 10.0;
  if (std::abs(t) < kLargeT)
    return std::clamp(Integral(t, degrees, noncentrality, low, high), 0.0, 1.0);
  const double middle = noncentrality / t;
  const double from = std::clamp(middle - 9.0 / std::abs(t), low, high);
  const double to = std::clamp(middle + 9.0 / std::abs(t), low, high);
  return std::clamp(Integral(t, degrees, noncentrality, low, from) +
                        Integral(t, degrees, noncentrality, from, to) +
                        Integral(t, degrees, noncentrality, to, high),
                    0.0, 1.0);
}

double StudentTQuantile(double probability, double degrees) {
  Require(probability > 0.0 && probability < 1.0, "a probability is between 0 and 1");
  constexpr double kFarthest = 1e12;  // beyond this the integral's error dominates
  double low = -1.0;
  double high = 1.0;
  while (low > -kFarthest && StudentTCdf(low, degrees) > probability) low *= 2.0;
  while (high < kFarthest && StudentTCdf(high, degrees) < probability) high *= 2.0;
  constexpr double kClose = 1e-11;
  while (high - low > kClose * std::max(1.0, std::abs(low))) {
    const double middle = 0.5 * (low + high);
    (StudentTCdf(middle, degrees) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace depthgrid
