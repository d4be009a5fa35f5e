#include "mapper/surfel/range_noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

constexpr double kFirstRangeM = 0.25;
constexpr int kRangeBinsPerOctave = 2;
// Initial value: a cheap scanner's data sheet.
constexpr double kDefaultRelativeSigma = 0.01;
// No sensor is better (0.2 mm at 1 m), and weights stay finite for simulated scans without noise.
constexpr double kMinRelativeSigma = 2e-4;
// The median of |x| of a normal variable is 0.6745 sigma; a second difference has sqrt(6) sigma.
constexpr double kNormalMedian = 0.674489750196;
constexpr double kSigmaOfMedianDifference = 1.0 / (kNormalMedian * 2.449489742783);
// A range bin with fewer samples borrows from its neighbours.
constexpr std::uint32_t kMinSamples = 200;
// With so many times as many samples well within the reach, the first value does no harm near it;
// with as many only, the wall of range_cutoff_test.cc was still turned.
constexpr std::uint64_t kMuchWhole = 10;
// Of a wall half a sigma before the reach what is left has .7 of the noise (range_cutoff.h).
constexpr double kOfCutSigma = 1.4;
// Enough for sigma to a fifth.
constexpr std::uint32_t kFewSamples = 30;
// Three beams count as evenly spaced when their gaps agree within this share.
constexpr float kSpacingTolerance = 0.05F;
// After this many scans only every kThinning-th is counted, as the histograms are full.
constexpr std::int64_t kScansInFull = 50;
constexpr std::int64_t kThinning = 8;
// Variance ratio between a stride and its double below which beams share their errors. Independent
// errors give 1; errors correlated by exp(-(d / L)^2 / 2) give at most .15 up to d = 2 L / 3 and .5
// at 4 L / 3 (docs/math.md, "Errors that beams share").
constexpr double kAlikeShare = 0.25;
// Beams as far apart as a laser's err independently, as each is measured alone: where scans differ
// more the farther apart their beams are, they show pillars and furniture. Stereo images have more
// columns than this in any view that is wide enough to map with (docs/tried.md, "A recorded laser
// log").
const auto kWidestAlikeRad = static_cast<float>(RadFromDeg(0.24));
// A stride must leave at least this many beams.
constexpr std::size_t kLeastBeams = 40;
// Ranges within this many sigmas of the sensor's reach are skipped: the returns that differ most
// are missing there.
constexpr float kUncut = 2.0F;
constexpr int kValueBinOffset = (127 - 19) * 8;  // bin of 2^-19: exponent bias, eight an octave

int RangeBin(double range_m) {
  const double octave = std::log2(range_m / kFirstRangeM);
  return static_cast<int>(octave * kRangeBinsPerOctave);
}

// Exponent and three bits of the mantissa: eight bins an octave, linear within it.
int ValueBin(float value) {
  return static_cast<int>(std::bit_cast<std::uint32_t>(value) >> 20) - kValueBinOffset;
}

double ValueBinLow(int bin) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bin + kValueBinOffset) << 20);
}

using Histogram = std::array<std::uint32_t, RangeNoise::kValueBins>;

// Of the lowest `count` values.
double MedianOf(const Histogram& histogram, double count) {
  const double half = 0.5 * count;
  double below = 0.0;
  std::size_t bin = 0;
  while (below + histogram[bin] < half) below += histogram[bin++];
  const double low = ValueBinLow(static_cast<int>(bin));
  const double high = ValueBinLow(static_cast<int>(bin) + 1);
  return low + (high - low) * (half - below) / histogram[bin];
}

// How many values are below this one.
double CountBelow(const Histogram& histogram, double value) {
  double below = 0.0;
  for (int bin = 0; bin < RangeNoise::kValueBins && ValueBinLow(bin) < value; ++bin) {
    const double width = ValueBinLow(bin + 1) - ValueBinLow(bin);
    const double share = std::min(1.0, (value - ValueBinLow(bin)) / width);
    below += share * histogram[static_cast<std::size_t>(bin)];
  }
  return below;
}

// The median of what noise makes of flat walls. Pillars, furniture and edges, of which there may be
// more, make larger values, so those beyond three sigmas are left out again and again.
double MedianOfNoise(const Histogram& histogram, double count) {
  constexpr int kMostTurns = 30;
  constexpr double kLeastLeftOut = 1e-3;  // of the values
  double median = MedianOf(histogram, count);
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const double within = CountBelow(histogram, 3.0 / kNormalMedian * median);
    if (within > (1.0 - kLeastLeftOut) * count || within < kFewSamples) break;
    count = within;
    median = MedianOf(histogram, count);
  }
  return median;
}

// Whether the beams are close enough to share their errors.
bool MayErrAlike(const Scan& scan) {
  if (scan.beams.size() < 2) return false;
  const float view = scan.beams.back().bearing_rad - scan.beams.front().bearing_rad;
  return view < kWidestAlikeRad * static_cast<float>(scan.beams.size() - 1);
}

}  // namespace

RangeNoise::RangeNoise(bool skips_alike) : skips_alike_(skips_alike) {
  for (Differences& differences : by_stride_) {
    differences.relative_sigma.fill(kDefaultRelativeSigma);
  }
}

void RangeNoise::Add(const Scan& scan) {
  if (scans_++ >= kScansInFull && scans_ % kThinning != 0) return;
  const bool may_err_alike = MayErrAlike(scan);
  const std::size_t strides = skips_alike_ && may_err_alike ? by_stride_.size() : 1;
  for (std::size_t k = 0; k < strides; ++k) {
    by_stride_[k].Add(scan, std::size_t{1} << k);
    by_stride_[k].Refresh(!may_err_alike);
  }
  chosen_ = 0;
  while (chosen_ + 1 < strides && scan.beams.size() >> (chosen_ + 1) >= kLeastBeams &&
         AreAlike(chosen_)) {
    ++chosen_;
  }
  if (!ShowNoise(chosen_)) chosen_ = 0;
}

void RangeNoise::Differences::Add(const Scan& scan, std::size_t stride) {
  const auto& beams = scan.beams;
  const auto reach_m =
      static_cast<float>(scan.max_range_m > 0.0 ? scan.max_range_m : kFarthestSeenM);
  for (std::size_t i = stride; i + stride < beams.size(); ++i) {
    const Beam& left = beams[i - stride];
    const Beam& middle = beams[i];
    const Beam& right = beams[i + stride];
    if (!left.hit || !middle.hit || !right.hit) continue;
    const float gap = middle.bearing_rad - left.bearing_rad;
    const float next_gap = right.bearing_rad - middle.bearing_rad;
    if (std::abs(gap - next_gap) > kSpacingTolerance * gap) continue;
    // (u- - 2 cos(step) u + u+) / u; the cosine matters for coarse scanners.
    const float twice_cosine = 2.0F - gap * gap;
    const float difference =
        middle.range_m / left.range_m - twice_cosine + middle.range_m / right.range_m;
    // The bin is that of the mean, which is independent of the second difference, unlike a single
    // range.
    const float mean_m = (left.range_m + middle.range_m + right.range_m) / 3.0F;
    const auto range_bin =
        static_cast<std::size_t>(std::clamp(RangeBin(mean_m), 0, kRangeBins - 1));
    const float whole_to_m =
        mean_m * (1.0F + kUncut * static_cast<float>(relative_sigma[range_bin]));
    Samples& samples = whole_to_m > reach_m ? near_cut : whole;
    const int value_bin = std::clamp(ValueBin(std::abs(difference)), 0, kValueBins - 1);
    ++samples.histogram[range_bin][static_cast<std::size_t>(value_bin)];
    ++samples.count[range_bin];
  }
}

bool RangeNoise::Differences::Knows(std::size_t range_bin) const {
  return whole.count[range_bin] >= kMinSamples;
}

std::uint64_t RangeNoise::Samples::Total() const {
  return std::accumulate(count.begin(), count.end(), std::uint64_t{0});
}

// Where much of what was seen is near the reach, sigma is learnt from few samples, if need be from
// those: the first value may be ten times too large, and then hardly anything would ever count as
// well within.
void RangeNoise::Differences::Refresh(bool are_independent) {
  independent = are_independent;
  tells_cutoff =
      LearnFrom(whole, kMinSamples, 1.0) || whole.Total() > kMuchWhole * near_cut.Total() ||
      LearnFrom(whole, kFewSamples, 1.0) || LearnFrom(near_cut, kFewSamples, kOfCutSigma);
}

bool RangeNoise::Differences::LearnFrom(const Samples& samples, std::uint32_t least,
                                        double factor) {
  std::array<bool, kRangeBins> known{};
  for (std::size_t r = 0; r < kRangeBins; ++r) {
    known[r] = samples.count[r] >= least;
    if (!known[r]) continue;
    const double median = independent ? MedianOfNoise(samples.histogram[r], samples.count[r])
                                      : MedianOf(samples.histogram[r], samples.count[r]);
    shown_sigma[r] = factor * kSigmaOfMedianDifference * median;
    relative_sigma[r] = std::max(shown_sigma[r], kMinRelativeSigma);
  }
  if (std::none_of(known.begin(), known.end(), [](bool k) { return k; })) return false;
  // Unknown bins take the nearest known one's, the shorter range's first.
  for (int r = 0; r < kRangeBins; ++r) {
    for (int d = 0; !known[static_cast<std::size_t>(r)] && d < kRangeBins; ++d) {
      const int from = r - d >= 0 && known[static_cast<std::size_t>(r - d)] ? r - d : r + d;
      if (from >= kRangeBins || !known[static_cast<std::size_t>(from)]) continue;
      relative_sigma[static_cast<std::size_t>(r)] = relative_sigma[static_cast<std::size_t>(from)];
      break;
    }
  }
  return true;
}

// Whether beams 2^power apart share most of the error seen between beams twice as far apart, over
// all ranges.
bool RangeNoise::AreAlike(std::size_t power) const {
  const Differences& near = by_stride_[power];
  const Differences& far = by_stride_[power + 1];
  double seen = 0.0, samples = 0.0;
  for (std::size_t r = 0; r < kRangeBins; ++r) {
    if (!near.Knows(r) || !far.Knows(r)) continue;
    const double ratio = near.shown_sigma[r] / far.shown_sigma[r];
    seen += far.whole.count[r] * ratio * ratio;
    samples += far.whole.count[r];
  }
  return seen < kAlikeShare * samples;
}

// Whether beams 2^power apart differ by more than the best sensor's noise, for most samples:
// smaller differences, such as rounding, are not sensor noise.
bool RangeNoise::ShowNoise(std::size_t power) const {
  const Differences& differences = by_stride_[power];
  double noisy = 0.0, samples = 0.0;
  for (std::size_t r = 0; r < kRangeBins; ++r) {
    if (!differences.Knows(r)) continue;
    samples += differences.whole.count[r];
    noisy += differences.shown_sigma[r] > kMinRelativeSigma ? differences.whole.count[r] : 0.0;
  }
  return 2.0 * noisy > samples;
}

double RangeNoise::RelativeSigma(double range_m) const {
  const std::array<double, kRangeBins>& relative_sigma = by_stride_[chosen_].relative_sigma;
  // Linear between the bins' centres on the logarithm of the range.
  const double place = std::log2(range_m / kFirstRangeM) * kRangeBinsPerOctave - 0.5;
  const double clamped = std::clamp(place, 0.0, kRangeBins - 1.0);
  const auto low = std::min(static_cast<std::size_t>(clamped), std::size_t{kRangeBins - 2});
  const double share = clamped - static_cast<double>(low);
  return (1.0 - share) * relative_sigma[low] + share * relative_sigma[low + 1];
}

}  // namespace depthgrid
