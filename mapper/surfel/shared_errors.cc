#include "mapper/surfel/shared_errors.h"

#include <algorithm>
#include <cstddef>

#include "mapper/surfel/sign_correlation.h"

namespace depthgrid {
namespace {

// 0.6 m of wall. Longer stretches, up to all that a group saw, made no difference.
constexpr std::size_t kStretch = 16;
constexpr double kMinCosine = 0.94;  // 20 degrees between normals
// The signs of this many pairs determine the correlation to 0.15.
constexpr std::int64_t kMinPairs = 100;

// Calls `visit` with the indices of each pair of companions, the smaller first.
template <typename Visitor>
void ForCompanions(std::span<const Surfel> surfels, const Visitor& visit) {
  for (std::size_t begin = 0; begin < surfels.size(); begin += kStretch) {
    const std::size_t end = std::min(begin + kStretch, surfels.size());
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        if (surfels[i].normal.dot(surfels[j].normal) > kMinCosine) visit(i, j);
      }
    }
  }
}

int SignOf(double value) { return value > 0.0 ? 1 : -1; }

}  // namespace

void CountCompanions(std::span<const Surfel> surfels, std::vector<int>& companies) {
  companies.assign(surfels.size(), 1);
  ForCompanions(surfels, [&](std::size_t i, std::size_t j) {
    ++companies[i];
    ++companies[j];
  });
}

void SharedErrors::Add(std::span<const Surfel> surfels, std::span<const double> residuals) {
  ForCompanions(surfels, [&](std::size_t i, std::size_t j) {
    if (residuals[i] == 0.0 || residuals[j] == 0.0) return;
    ++pairs_;
    signs_ += SignOf(residuals[i]) * SignOf(residuals[j]);
  });
}

double SharedErrors::Correlation() const {
  if (pairs_ < kMinPairs) return 0.0;
  const double mean = static_cast<double>(signs_) / static_cast<double>(pairs_);
  return std::max(0.0, CorrelationOfSigns(mean));
}

}  // namespace depthgrid
