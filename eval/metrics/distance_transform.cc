#include "eval/metrics/distance_transform.h"

#include <algorithm>
#include <limits>

namespace depthgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The lower envelope of the parabolas (p - q)^2 + f(q), sampled at every p.
class LineTransform {
 public:
  explicit LineTransform(std::size_t length) : apex_(length), start_(length + 1) {}

  void Apply(std::vector<double>& f) {
    const std::size_t count = BuildEnvelope(f);
    if (count == 0) return;
    result_.resize(f.size());
    std::size_t k = 0;
    for (std::size_t p = 0; p < f.size(); ++p) {
      while (k + 1 < count && start_[k + 1] < static_cast<double>(p)) ++k;
      const double offset = static_cast<double>(p) - static_cast<double>(apex_[k]);
      result_[p] = offset * offset + f[apex_[k]];
    }
    f.swap(result_);
  }

 private:
  // Parabolas that are part of the envelope, from left to right; start_[k] is where k takes over.
  std::size_t BuildEnvelope(const std::vector<double>& f) {
    std::size_t count = 0;
    for (std::size_t q = 0; q < f.size(); ++q) {
      if (f[q] == kInfinity) continue;
      double crossing = -kInfinity;
      while (count > 0) {
        crossing = Crossing(f, apex_[count - 1], q);
        if (crossing > start_[count - 1]) break;
        --count;
      }
      if (count == 0) crossing = -kInfinity;
      apex_[count] = q;
      start_[count] = crossing;
      ++count;
    }
    return count;
  }

  static double Crossing(const std::vector<double>& f, std::size_t left, std::size_t right) {
    const auto l = static_cast<double>(left);
    const auto r = static_cast<double>(right);
    return ((f[right] + r * r) - (f[left] + l * l)) / (2.0 * (r - l));
  }

  std::vector<std::size_t> apex_;
  std::vector<double> start_;
  std::vector<double> result_;
};

// out[p] is the largest of in[p - radius .. p + radius].
void GrowLine(std::vector<std::uint8_t>& line, int radius) {
  const auto length = static_cast<int>(line.size());
  std::vector<std::uint8_t> grown(line.size(), 0);
  int reached = -1;  // cells up to here are grown from members seen so far
  for (int p = 0; p < length; ++p) {
    if (line[static_cast<std::size_t>(p)] == 0) continue;
    const int last = std::min(length - 1, p + radius);
    for (int q = std::max(reached + 1, p - radius); q <= last; ++q) {
      grown[static_cast<std::size_t>(q)] = 1;
    }
    reached = std::max(reached, last);
  }
  line.swap(grown);
}

// Applies `transform` to every column, then to every row, of a row-by-row grid.
template <typename T, typename Transform>
void ForColumnsThenRows(const GridGeometry& geometry, std::vector<T>& cells, Transform transform) {
  const auto width = static_cast<std::size_t>(geometry.width_cells);
  const auto height = static_cast<std::size_t>(geometry.height_cells);
  std::vector<T> line(height);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) line[y] = cells[y * width + x];
    transform(line);
    for (std::size_t y = 0; y < height; ++y) cells[y * width + x] = line[y];
  }
  line.resize(width);
  for (std::size_t y = 0; y < height; ++y) {
    const auto row = cells.begin() + static_cast<std::ptrdiff_t>(y * width);
    std::copy_n(row, width, line.begin());
    transform(line);
    std::copy_n(line.begin(), width, row);
  }
}

}  // namespace

std::vector<double> SquaredDistances(const CellSet& mask) {
  std::vector<double> squared(mask.members.size());
  std::transform(mask.members.begin(), mask.members.end(), squared.begin(),
                 [](std::uint8_t member) { return member != 0 ? 0.0 : kInfinity; });
  LineTransform line_transform(static_cast<std::size_t>(
      std::max({mask.geometry.width_cells, mask.geometry.height_cells, 1})));
  ForColumnsThenRows(mask.geometry, squared,
                     [&](std::vector<double>& line) { line_transform.Apply(line); });
  return squared;
}

CellSet Grown(const CellSet& mask, int radius_cells) {
  CellSet grown = mask;
  if (radius_cells <= 0) return grown;
  ForColumnsThenRows(mask.geometry, grown.members,
                     [&](std::vector<std::uint8_t>& line) { GrowLine(line, radius_cells); });
  return grown;
}

}  // namespace depthgrid
