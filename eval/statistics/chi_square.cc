#include "eval/statistics/chi_square.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "eval/statistics/log_gamma.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr double kShare = 0.95;

}  // namespace

// The regularised incomplete gamma function P(a, x), a = degrees / 2, x = value / 2: by its series
// for x < a + 1, else 1 minus the continued fraction by Lentz's method (Abramowitz & Stegun 6.5.29
// and 6.5.31).
double ChiSquareCdf(double value, double degrees) {
  Require(degrees > 0.0, "degrees of freedom are above 0");
  if (value <= 0.0) return 0.0;
  const double a = 0.5 * degrees;
  const double x = 0.5 * value;
  constexpr double kClose = 1e-12;
  constexpr int kMostTerms = 100000;
  const double scale = std::exp(a * std::log(x) - x - LogGamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < kMostTerms && term > kClose * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return std::min(scale * sum, 1.0);
  }
  double b = x + 1.0 - a;
  double c = 1e300;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / (numerator * d + b);
    c = b + numerator / c;
    fraction *= c * d;
    if (std::abs(c * d - 1.0) < kClose) break;
  }
  return std::max(1.0 - scale * fraction, 0.0);
}

double ChiSquareQuantile(double probability, double degrees) {
  Require(probability > 0.0 && probability < 1.0, "a probability is between 0 and 1");
  double low = 0.0;
  double high = degrees;
  while (ChiSquareCdf(high, degrees) < probability) high *= 2.0;
  constexpr double kClose = 1e-10;
  while (high - low > kClose * high) {
    const double middle = 0.5 * (low + high);
    (ChiSquareCdf(middle, degrees) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<Consistency> ConsistencyOf(const std::vector<ChiSquareSample>& samples) {
  constexpr std::size_t kMostDegrees = 8;
  std::array<double, kMostDegrees> limit{};  // computed once per degree
  Consistency result;
  double sum = 0.0;
  double degrees = 0.0;
  int within = 0;
  for (const ChiSquareSample& sample : samples) {
    if (sample.degrees < 1) continue;
    const auto own = static_cast<std::size_t>(sample.degrees);
    Require(own < kMostDegrees, "a sample has few degrees of freedom");
    if (limit[own] == 0.0) limit[own] = ChiSquareQuantile(kShare, sample.degrees);
    ++result.count;
    sum += sample.value;
    degrees += sample.degrees;
    within += sample.value <= limit[own] ? 1 : 0;
  }
  if (result.count == 0) return std::nullopt;
  result.mean = sum / degrees;
  result.low = ChiSquareQuantile(0.5 * (1.0 - kShare), degrees) / degrees;
  result.high = ChiSquareQuantile(0.5 * (1.0 + kShare), degrees) / degrees;
  result.share_within_95 = static_cast<double>(within) / result.count;
  return result;
}

}  // namespace depthgrid
