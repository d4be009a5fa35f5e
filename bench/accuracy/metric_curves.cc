// Writes the sanity curves of docs/metrics.md: metric_curves.csv and metric_curves.svg, in the
// folder given.
#include "tests/metrics/metric_curves.h"

#include <fmt/format.h>

#include <filesystem>

#include "bench/guarded_main.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

constexpr int kCurveSteps = 20;
constexpr double kPanelWidth = 190.0;
constexpr double kPanelHeight = 92.0;
constexpr double kPlotWidth = 140.0;
constexpr double kPlotHeight = 52.0;

std::string Csv(const std::vector<Curve>& curves) {
  std::string csv = "disturbance,amount";
  for (const auto& [name, value] : curves.front().points.front()) csv += ",\"" + name + "\"";
  csv += "\n";
  for (const Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.amounts.size(); ++i) {
      csv += fmt::format("{},{}", curve.disturbance, curve.amounts[i]);
      for (const auto& column : curve.points[i]) {
        csv += std::isnan(column.second) ? "," : fmt::format(",{}", column.second);
      }
      csv += "\n";
    }
  }
  return csv;
}

// The common scale of a row of the figure.
double HighestOf(const std::vector<Curve>& curves, const std::string& score) {
  double highest = 1e-9;
  for (const Curve& curve : curves) {
    for (const double value : curve.Of(score)) {
      if (std::isfinite(value)) highest = std::max(highest, value);
    }
  }
  return highest;
}

std::string Panel(const Curve& curve, const std::string& score, double highest, double left,
                  double top) {
  std::string points;
  const std::vector<double> values = curve.Of(score);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    points +=
        fmt::format("{:.1f},{:.1f} ", left + kPlotWidth * curve.amounts[i] / curve.amounts.back(),
                    top + kPlotHeight * (1.0 - values[i] / highest));
  }
  return fmt::format(
      "<rect x='{0}' y='{1}' width='{2}' height='{3}' fill='#f6f7f9' stroke='#c4c9d0'/>\n"
      "<polyline points='{4}' fill='none' stroke='#1f6fb2' stroke-width='1.6'/>\n"
      "<text x='{0}' y='{5}'>0</text><text x='{6}' y='{5}' text-anchor='end'>{7:g} {8}</text>\n"
      "<text x='{9}' y='{10}' text-anchor='end'>{11:.3g}</text>\n",
      left, top, kPlotWidth, kPlotHeight, points, top + kPlotHeight + 12.0, left + kPlotWidth,
      curve.amounts.back(), curve.disturbance, left - 4.0, top + 9.0, highest);
}

std::string Svg(const std::vector<Curve>& curves) {
  const CurvePoint& scores = curves.front().points.front();
  const double width = kPanelWidth * static_cast<double>(curves.size()) + 10.0;
  const double height = kPanelHeight * static_cast<double>(scores.size()) + 10.0;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
      "font-family='sans-serif' font-size='10'>\n<rect width='100%' height='100%' fill='white'/>\n",
      width, height);
  for (std::size_t row = 0; row < scores.size(); ++row) {
    const std::string& score = scores[row].first;
    const double top = kPanelHeight * static_cast<double>(row) + 20.0;
    const double highest = HighestOf(curves, score);
    for (std::size_t column = 0; column < curves.size(); ++column) {
      const double left = kPanelWidth * static_cast<double>(column) + 42.0;
      svg +=
          fmt::format("<text x='{}' y='{}' font-weight='bold'>{}</text>\n", left, top - 5.0, score);
      svg += Panel(curves[column], score, highest, left, top);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace
}  // namespace depthgrid

namespace {
int Measure(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: metric_curves FOLDER\n");
    return 2;
  }
  const std::string folder = argv[1];
  if (!std::filesystem::is_directory(folder)) throw depthgrid::InputError(folder, "is no folder");
  const std::vector<depthgrid::Curve> curves = depthgrid::SanityCurves(depthgrid::kCurveSteps);
  depthgrid::WriteFile(folder + "/metric_curves.csv", depthgrid::Csv(curves));
  depthgrid::WriteFile(folder + "/metric_curves.svg", depthgrid::Svg(curves));
  return 0;
}
}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
