// The bootstrap (Efron 1979): samples drawn with replacement from a sample. One table is used for
// all statistics over the same seeds, so that paired values are resampled in pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace depthgrid {

struct BootstrapOptions {
  // With 10,000 the ends of a 95 % interval vary by about 1 % of its width from seed to seed.
  int resamples = 10000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
};

struct ConfidenceInterval {
  double low = 0.0;
  double high = 0.0;
};

class Resamples {
 public:
  // For a sample of `size` values, at least one.
  explicit Resamples(std::size_t size, const BootstrapOptions& options = {});

  std::size_t size() const { return size_; }
  int count() const { return options_.resamples; }
  double confidence() const { return options_.confidence; }
  // The indices drawn for resample `index`.
  std::span<const std::uint32_t> operator[](int index) const;

 private:
  BootstrapOptions options_;
  std::size_t size_;
  std::vector<std::uint32_t> indices_;  // one resample after the other
};

// A statistic of the values at these indices.
using ResampledFigure = std::function<double(std::span<const std::uint32_t> indices)>;

// The statistic of each resample, in order.
std::vector<double> FiguresOf(const Resamples& resamples, const ResampledFigure& figure);

// The percentile interval: the quantiles (1 - confidence) / 2 and (1 + confidence) / 2 of
// `figures`, interpolated as NumPy does.
ConfidenceInterval PercentileInterval(const std::vector<double>& figures, double confidence);

// Interval of the mean; empty for fewer than two values.
std::optional<ConfidenceInterval> MeanInterval(const std::vector<double>& values,
                                               const Resamples& resamples);

}  // namespace depthgrid
