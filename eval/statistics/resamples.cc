#include "eval/statistics/resamples.h"

#include "eval/metrics/statistics.h"
#include "mapper/core/error.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

double MeanAt(const std::vector<double>& values, std::span<const std::uint32_t> indices) {
  double sum = 0.0;
  for (const std::uint32_t i : indices) sum += values[i];
  return sum / static_cast<double>(indices.size());
}

}  // namespace

Resamples::Resamples(std::size_t size, const BootstrapOptions& options)
    : options_(options), size_(size) {
  Require(size > 0, "a resample is of at least one value");
  Require(options.resamples > 0, "the number of resamples is positive");
  Require(options.confidence > 0.0 && options.confidence < 1.0, "a confidence is between 0 and 1");
  indices_.reserve(size * static_cast<std::size_t>(options.resamples));
  for (int i = 0; i < options.resamples; ++i) {
    RandomStream random(options.seed, RandomStage::kBootstrap, static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < size; ++k) {
      indices_.push_back(static_cast<std::uint32_t>(random.Below(size)));
    }
  }
}

std::span<const std::uint32_t> Resamples::operator[](int index) const {
  return {indices_.data() + static_cast<std::size_t>(index) * size_, size_};
}

std::vector<double> FiguresOf(const Resamples& resamples, const ResampledFigure& figure) {
  std::vector<double> figures;
  figures.reserve(static_cast<std::size_t>(resamples.count()));
  for (int i = 0; i < resamples.count(); ++i) figures.push_back(figure(resamples[i]));
  return figures;
}

ConfidenceInterval PercentileInterval(const std::vector<double>& figures, double confidence) {
  return {Percentile(figures, 0.5 * (1.0 - confidence)),
          Percentile(figures, 0.5 * (1.0 + confidence))};
}

std::optional<ConfidenceInterval> MeanInterval(const std::vector<double>& values,
                                               const Resamples& resamples) {
  Require(values.size() == resamples.size(), "resamples are of as many values as there are");
  if (values.size() < 2) return std::nullopt;
  const auto figures =
      FiguresOf(resamples, [&](std::span<const std::uint32_t> at) { return MeanAt(values, at); });
  return PercentileInterval(figures, resamples.confidence());
}

}  // namespace depthgrid
