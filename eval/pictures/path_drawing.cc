#include "eval/pictures/path_drawing.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// 1, 2 or 5 times a power of ten: the largest such length below a third of the width.
double ScaleBarLength(double width_m) {
  double length_m = std::pow(10.0, std::floor(std::log10(width_m / 3.0)));
  if (length_m * 5.0 <= width_m / 3.0) return length_m * 5.0;
  if (length_m * 2.0 <= width_m / 3.0) return length_m * 2.0;
  return length_m;
}

std::string LengthText(double length_m) {
  if (length_m >= 1.0) return std::to_string(std::lround(length_m)) + " m";
  return std::to_string(std::lround(length_m * 100.0)) + " cm";
}

constexpr int kMarginPx = 12;
constexpr double kPathWidthPx = 2.5;
constexpr double kBeneathWidthPx = 7.0;
constexpr double kDotRadiusPx = 5.0;
constexpr double kDotStepPx = 12.0;  // distance between dots in the legend

// Lengths of a dashed line's parts.
constexpr double kDashPx = 14.0;
constexpr double kDashDotPx = 1.0;
constexpr double kDashGapPx = 8.0;

double WidthOf(const Path& path) {
  return path.style == PathStyle::kBeneath ? kBeneathWidthPx : kPathWidthPx;
}

Colour ShownColour(const Path& path) {
  return path.style == PathStyle::kBeneath ? Paler(path.colour) : path.colour;
}

double DashPeriodPx(int dots) { return kDashPx + kDashGapPx + dots * (kDashDotPx + kDashGapPx); }

// The remaining length of the stroke or gap at `along_px` of a dashed line.
struct DashStretch {
  bool is_drawn;
  double left_px;
};

DashStretch DashAt(double along_px, int dots) {
  double in_period_px = std::fmod(along_px, DashPeriodPx(dots));
  for (int stroke = 0; stroke <= dots; ++stroke) {
    const double stroke_px = stroke == 0 ? kDashPx : kDashDotPx;
    if (in_period_px < stroke_px) return {true, stroke_px - in_period_px};
    in_period_px -= stroke_px;
    if (in_period_px < kDashGapPx) return {false, kDashGapPx - in_period_px};
    in_period_px -= kDashGapPx;
  }
  return {true, kDashPx};  // for rounding errors at the end of the period
}

void DrawDashed(const std::vector<Eigen::Vector2d>& points, const Path& path, Canvas& canvas) {
  constexpr double kLeastStepPx = 1e-6;  // so that rounding cannot stop the loop
  double along_px = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d& from = points[i - 1];
    const double length_px = (points[i] - from).norm();
    for (double at_px = 0.0; at_px < length_px;) {
      const DashStretch stretch = DashAt(along_px + at_px, path.dots);
      const double to_px = std::min(length_px, at_px + std::max(stretch.left_px, kLeastStepPx));
      const auto point = [&](double px) -> Eigen::Vector2d {
        return from + (points[i] - from) * (px / length_px);
      };
      if (stretch.is_drawn) canvas.Line(point(at_px), point(to_px), WidthOf(path), path.colour);
      at_px = to_px;
    }
    along_px += length_px;
  }
}

int TextPx(const std::string& text) { return Canvas::TextWidth(text, kTextScale); }

// The row of pixels through the middle of a line of text.
int MiddleOf(int text_top) { return text_top + Canvas::TextHeight(kTextScale) / 2; }

bool IsDashed(const Path& path) { return path.dots >= 0; }

// Length of a path's sample in the legend; for a dashed line at least one period.
int SamplePx(const Path& path) {
  if (!IsDashed(path)) return 2 * kMarginPx;
  return std::max(2 * kMarginPx, static_cast<int>(DashPeriodPx(path.dots)));
}

void DrawName(const Path& path, int left, int text_top, Canvas& canvas) {
  const int middle = MiddleOf(text_top);
  if (IsDashed(path)) {
    DrawDashed({Eigen::Vector2d(left, middle), Eigen::Vector2d(left + SamplePx(path), middle)},
               path, canvas);
  } else {
    const int half_px = path.style == PathStyle::kBeneath ? 4 : 2;
    canvas.Fill(left, middle - half_px, SamplePx(path), 2 * half_px, ShownColour(path));
  }
  canvas.Text(left + SamplePx(path) + kMarginPx, text_top, path.name, kTextScale, kInk);
}

}  // namespace

Colour Paler(Colour colour) {
  const auto half = [](std::uint8_t c) { return static_cast<std::uint8_t>((c + 255) / 2); };
  return {half(colour.red), half(colour.green), half(colour.blue)};
}

void DrawPath(const Path& path, PathDot dot, const Eigen::Vector2d& origin_m, double px_per_m,
              int rows_px, Canvas& canvas) {
  std::vector<Eigen::Vector2d> points;
  for (const StampedPose& pose : path.poses) {
    const Eigen::Vector2d offset_m = pose.world_from_camera.translation.head<2>() - origin_m;
    points.emplace_back(offset_m.x() * px_per_m - 0.5, rows_px - offset_m.y() * px_per_m - 0.5);
  }
  if (IsDashed(path)) {
    DrawDashed(points, path, canvas);
  } else {
    canvas.Polyline(points, WidthOf(path), ShownColour(path));
  }
  if (points.empty()) return;
  canvas.Disc(dot == PathDot::kStart ? points.front() : points.back(), kDotRadiusPx, path.colour);
}

Legend::Legend(double width_m, double px_per_m, const std::vector<Path>& paths, PathDot dot,
               int most_px)
    : dot_text_(dot == PathDot::kStart ? "start" : "now"),
      bar_text_(LengthText(ScaleBarLength(width_m))),
      bar_px_(static_cast<int>(std::lround(ScaleBarLength(width_m) * px_per_m))),
      paths_(paths),
      left_px_(kMarginPx),
      top_px_(kMarginPx) {
  Place(bar_px_ + TextPx(bar_text_) + 3 * kMarginPx, most_px);
  for (const Path& path : paths_) {
    Place(SamplePx(path) + TextPx(path.name) + 3 * kMarginPx, most_px);
  }
  if (!paths_.empty()) Place(DotsPx() + TextPx(dot_text_) + 2 * kMarginPx, most_px);
}

int Legend::HeightPx() const {
  return items_.back().top_px + Canvas::TextHeight(kTextScale) + kMarginPx;
}

void Legend::Draw(int row_px, Canvas& canvas) const {
  const auto below = [&](const Item& item) { return Item{item.left_px, row_px + item.top_px}; };
  DrawBar(below(items_.front()), canvas);
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const Item at = below(items_[1 + i]);
    DrawName(paths_[i], at.left_px, at.top_px, canvas);
  }
  if (!paths_.empty()) DrawDots(below(items_.back()), canvas);
}

// Width of the dots, one for each line that is not dashed, and a gap after them.
int Legend::DotsPx() const {
  const auto dashed = std::count_if(paths_.begin(), paths_.end(), IsDashed);
  const auto dots = static_cast<double>(paths_.size()) - static_cast<double>(dashed);
  return static_cast<int>(kDotStepPx * dots) + kMarginPx;
}

// Places the item after the previous one, or on a new line.
void Legend::Place(int item_px, int most_px) {
  if (!items_.empty() && left_px_ + item_px > most_px) {
    left_px_ = kMarginPx;
    top_px_ += Canvas::TextHeight(kTextScale) + kMarginPx;
  }
  items_.push_back({left_px_, top_px_});
  left_px_ += item_px;
  width_px_ = std::max(width_px_, left_px_);
}

void Legend::DrawBar(const Item& at, Canvas& canvas) const {
  const int middle = MiddleOf(at.top_px);
  canvas.Fill(at.left_px, middle - 1, bar_px_, 3, kInk);
  canvas.Fill(at.left_px, middle - 6, 2, 13, kInk);
  canvas.Fill(at.left_px + bar_px_ - 2, middle - 6, 2, 13, kInk);
  canvas.Text(at.left_px + bar_px_ + kMarginPx, at.top_px, bar_text_, kTextScale, kInk);
}

void Legend::DrawDots(const Item& at, Canvas& canvas) const {
  double centre = at.left_px + kDotRadiusPx;
  for (const Path& path : paths_) {
    if (IsDashed(path)) continue;
    canvas.Disc({centre, MiddleOf(at.top_px)}, kDotRadiusPx, path.colour);
    centre += kDotStepPx;
  }
  canvas.Text(at.left_px + DotsPx(), at.top_px, dot_text_, kTextScale, kInk);
}

}  // namespace depthgrid
