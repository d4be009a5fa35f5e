#include "eval/statistics/seed_units.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// The distinct seeds of an axis, numbered, and each run's number.
struct Levels {
  std::size_t axis = 0;
  std::size_t count = 0;
  std::vector<std::size_t> of_run;
};

Levels LevelsOf(const std::vector<std::vector<std::string>>& seeds, std::size_t axis) {
  std::map<std::string, std::size_t> number;
  for (const auto& run : seeds) number.emplace(run[axis], 0);
  std::size_t next = 0;
  for (auto& [seed, level] : number) level = next++;
  Levels levels{axis, number.size(), {}};
  for (const auto& run : seeds) levels.of_run.push_back(number.at(run[axis]));
  return levels;
}

// Whether each seed of `fine` occurs with only one seed of `coarse`.
bool Decides(const Levels& fine, const Levels& coarse) {
  std::set<std::pair<std::size_t, std::size_t>> together;
  for (std::size_t run = 0; run < fine.of_run.size(); ++run) {
    together.emplace(fine.of_run[run], coarse.of_run[run]);
  }
  return together.size() == fine.count;
}

// The axes that vary, without those that determine another one, because their runs share the
// other's seed. Of two that determine each other the first is kept.
std::vector<Levels> AxesThatCount(const std::vector<std::vector<std::string>>& seeds) {
  std::vector<Levels> axes;
  for (std::size_t axis = 0; axis < seeds.front().size(); ++axis) {
    Levels levels = LevelsOf(seeds, axis);
    if (levels.count < 2) continue;
    const bool is_finer = std::any_of(axes.begin(), axes.end(),
                                      [&](const Levels& other) { return Decides(levels, other); });
    if (is_finer) continue;
    std::erase_if(axes, [&](const Levels& other) { return Decides(other, levels); });
    axes.push_back(std::move(levels));
  }
  return axes;
}

struct Mean {
  double sum = 0.0;
  int count = 0;

  void Add(double value) {
    sum += value;
    ++count;
  }
  double Value() const { return sum / count; }  // NaN if there are none
};

// Units with different numbers of runs count equally, so their mean may differ from that of all
// runs.
void MoveMeanTo(double mean, std::vector<double>& figures) {
  Mean units;
  for (const double figure : figures) {
    if (std::isfinite(figure)) units.Add(figure);
  }
  for (double& figure : figures) figure += mean - units.Value();
}

// Where means of about `size` cancel, as when most scores are 0, only rounding remains.
double WithoutRounding(double figure, double size) {
  constexpr double kRounding = 1e-12;
  return std::abs(figure) < kRounding * size ? 0.0 : figure;
}

}  // namespace

SeedUnits::SeedUnits(const std::vector<std::vector<std::string>>& seeds) {
  if (seeds.empty()) return;
  const std::vector<Levels> axes = AxesThatCount(seeds);
  if (axes.empty()) {
    count_ = seeds.size();
    unit_of_run_.emplace_back(count_);
    std::iota(unit_of_run_[0].begin(), unit_of_run_[0].end(), std::size_t{0});
    return;
  }
  count_ = std::min_element(axes.begin(), axes.end(), [](const Levels& a, const Levels& b) {
             return a.count < b.count;
           })->count;
  for (const Levels& levels : axes) {
    if (axes.size() > 1) crossed_.push_back(levels.axis);
    unit_of_run_.emplace_back();
    for (const std::size_t level : levels.of_run) {
      unit_of_run_.back().push_back(level * count_ / levels.count);
    }
  }
}

std::vector<double> SeedUnits::Figures(const std::vector<double>& values) const {
  Mean all;
  for (const double value : values) {
    if (std::isfinite(value)) all.Add(value);
  }
  std::vector<double> figures(count_, 0.0);
  std::vector<double> sizes(count_, 0.0);
  for (std::size_t axis = 0; axis < unit_of_run_.size(); ++axis) {
    Require(values.size() == unit_of_run_[axis].size(), "every run has a value");
    std::vector<Mean> means(count_);
    for (std::size_t run = 0; run < values.size(); ++run) {
      if (std::isfinite(values[run])) means[unit_of_run_[axis][run]].Add(values[run]);
    }
    for (std::size_t unit = 0; unit < count_; ++unit) {
      figures[unit] += axis == 0 ? means[unit].Value() : means[unit].Value() - all.Value();
      sizes[unit] = std::max(sizes[unit], std::abs(means[unit].Value()));
    }
  }
  if (unit_of_run_.size() > 1) MoveMeanTo(all.Value(), figures);
  for (std::size_t unit = 0; unit < count_; ++unit) {
    figures[unit] = WithoutRounding(figures[unit], sizes[unit]);
  }
  return figures;
}

}  // namespace depthgrid
