#include "eval/map_picture.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

constexpr Colour kUnknownCell = {205, 205, 205};  // as Nav2's tools show it
constexpr Colour kFreeCell = {254, 254, 254};
constexpr Colour kOccupiedCell = {0, 0, 0};
constexpr Colour kLatticeLine = {170, 190, 215};
constexpr Colour kInk = {30, 30, 30};
constexpr Colour kPaper = {255, 255, 255};

template <typename ColourOf>
RgbImage Paint(const GridGeometry& geometry, ColourOf colour_of) {
  RgbImage image(geometry.width_cells, geometry.height_cells);
  for (int row = 0; row < geometry.height_cells; ++row) {
    for (int column = 0; column < geometry.width_cells; ++column) {
      SetPixel(image, column, row,
               colour_of(Cell{geometry.min_cell.x + column,
                              geometry.min_cell.y + geometry.height_cells - 1 - row}));
    }
  }
  return image;
}

Colour ColourOf(CellState state) {
  switch (state) {
    case CellState::kOccupied:
      return kOccupiedCell;
    case CellState::kFree:
      return kFreeCell;
    case CellState::kUnknown:
      break;
  }
  return kUnknownCell;
}

Colour Paler(Colour colour) {
  const auto half = [](std::uint8_t c) { return static_cast<std::uint8_t>((c + 255) / 2); };
  return {half(colour.red), half(colour.green), half(colour.blue)};
}

Colour DifferenceOf(CellState truth, CellState estimate) {
  const bool wall = truth == CellState::kOccupied;
  const bool drawn = estimate == CellState::kOccupied;
  if (wall && drawn) return kOccupiedCell;
  if (wall) return palette::kMissed;
  if (drawn) return palette::kInvented;
  return ColourOf(estimate);
}

RgbImage Enlarged(const RgbImage& image, int factor) {
  RgbImage large(image.width_px * factor, image.height_px * factor);
  for (int v = 0; v < large.height_px; ++v) {
    for (int u = 0; u < large.width_px; ++u) {
      std::copy_n(image.At(u / factor, v / factor), 3, large.At(u, v));
    }
  }
  return large;
}

// Wide enough to look at, unless that makes it too tall.
int Enlargement(const RgbImage& cells) {
  constexpr int kLeastWidthPx = 900;
  constexpr int kMostHeightPx = 4000;
  const int width = std::max(cells.width_px, 1);
  const int wanted = (kLeastWidthPx + width - 1) / width;
  return std::max(1, std::min(wanted, kMostHeightPx / std::max(cells.height_px, 1)));
}

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
constexpr int kTextScale = 2;
constexpr double kPathWidthPx = 2.5;
constexpr double kBeneathWidthPx = 7.0;
constexpr double kDotRadiusPx = 5.0;
constexpr double kDotStepPx = 12.0;  // in the legend, from one to the next

double WidthOf(const Path& path) {
  return path.style == PathStyle::kBeneath ? kBeneathWidthPx : kPathWidthPx;
}

Colour ShownColour(const Path& path) {
  return path.style == PathStyle::kBeneath ? Paler(path.colour) : path.colour;
}

// A scale bar, the paths' names and what their dots are, in one line.
class Legend {
 public:
  Legend(double width_m, double px_per_m, const std::vector<Path>& paths, PathDot dot)
      : dot_text_(dot == PathDot::kStart ? "start" : "now"),
        bar_text_(LengthText(ScaleBarLength(width_m))),
        bar_px_(static_cast<int>(std::lround(ScaleBarLength(width_m) * px_per_m))),
        paths_(paths) {}

  int WidthPx() const {
    int width_px = 4 * kMarginPx + bar_px_ + Canvas::TextWidth(bar_text_, kTextScale);
    for (const Path& path : paths_) {
      width_px += 5 * kMarginPx + Canvas::TextWidth(path.name, kTextScale);
    }
    if (!paths_.empty()) {
      width_px += DotsPx() + 2 * kMarginPx + Canvas::TextWidth(dot_text_, kTextScale);
    }
    return width_px;
  }
  static int HeightPx() { return Canvas::TextHeight(kTextScale) + 2 * kMarginPx; }

  // Below this row.
  void Draw(int row_px, Canvas& canvas) const {
    const int text_top = row_px + kMarginPx;
    const int middle = text_top + Canvas::TextHeight(kTextScale) / 2;
    canvas.Fill(kMarginPx, middle - 1, bar_px_, 3, kInk);
    canvas.Fill(kMarginPx, middle - 6, 2, 13, kInk);
    canvas.Fill(kMarginPx + bar_px_ - 2, middle - 6, 2, 13, kInk);
    int left = kMarginPx + bar_px_ + kMarginPx;
    canvas.Text(left, text_top, bar_text_, kTextScale, kInk);
    left += Canvas::TextWidth(bar_text_, kTextScale) + 2 * kMarginPx;
    for (const Path& path : paths_) {
      const int half_px = path.style == PathStyle::kBeneath ? 4 : 2;
      canvas.Fill(left, middle - half_px, 2 * kMarginPx, 2 * half_px, ShownColour(path));
      left += 3 * kMarginPx;
      canvas.Text(left, text_top, path.name, kTextScale, kInk);
      left += Canvas::TextWidth(path.name, kTextScale) + 2 * kMarginPx;
    }
    if (paths_.empty()) return;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      const double centre = left + kDotRadiusPx + static_cast<double>(i) * kDotStepPx;
      canvas.Disc({centre, middle}, kDotRadiusPx, paths_[i].colour);
    }
    canvas.Text(left + DotsPx(), text_top, dot_text_, kTextScale, kInk);
  }

 private:
  // Every path's own, and a gap behind them.
  int DotsPx() const {
    return static_cast<int>(kDotStepPx * static_cast<double>(paths_.size())) + kMarginPx;
  }

  std::string dot_text_;
  std::string bar_text_;
  int bar_px_;
  const std::vector<Path>& paths_;
};

// Over a picture of so many rows, whose lower left corner is the origin. The centre of cell (i,
// j)'s picture is that of its enlarged square.
void DrawPath(const Path& path, PathDot dot, const Eigen::Vector2d& origin_m, double px_per_m,
              int rows_px, Canvas& canvas) {
  std::vector<Eigen::Vector2d> points;
  for (const StampedPose& pose : path.poses) {
    const Eigen::Vector2d offset_m = pose.world_from_camera.translation.head<2>() - origin_m;
    points.emplace_back(offset_m.x() * px_per_m - 0.5, rows_px - offset_m.y() * px_per_m - 0.5);
  }
  canvas.Polyline(points, WidthOf(path), ShownColour(path));
  if (points.empty()) return;
  canvas.Disc(dot == PathDot::kStart ? points.front() : points.back(), kDotRadiusPx, path.colour);
}

// 1, 2 or 5 times a power of ten, from 1 m: the least step whose lines stand well apart.
double LatticeSpacingM(double px_per_m) {
  constexpr double kLeastPx = 60.0;
  for (double decade_m = 1.0;; decade_m *= 10.0) {
    for (const double step_m : {decade_m, 2.0 * decade_m, 5.0 * decade_m}) {
      if (step_m * px_per_m >= kLeastPx) return step_m;
    }
  }
}

void DrawLattice(const GridGeometry& geometry, double px_per_m, Canvas& canvas) {
  const double step_m = LatticeSpacingM(px_per_m);
  const Eigen::Vector2d origin_m = geometry.OriginM();
  const Eigen::Vector2d size_px = px_per_m * geometry.resolution_m *
                                  Eigen::Vector2d(geometry.width_cells, geometry.height_cells);
  const auto first = [&](double from_m) { return std::ceil(from_m / step_m) * step_m; };
  const auto number = [](double at_m) { return std::to_string(std::lround(at_m)); };
  constexpr int kGapPx = 3;
  for (double x_m = first(origin_m.x());; x_m += step_m) {
    const double u_px = (x_m - origin_m.x()) * px_per_m - 0.5;
    if (u_px >= size_px.x()) break;
    canvas.Line({u_px, 0.0}, {u_px, size_px.y() - 1.0}, 1.0, kLatticeLine);
    const int left_px = static_cast<int>(u_px) + kGapPx;
    const bool fits = left_px + Canvas::TextWidth(number(x_m), kTextScale) < size_px.x();
    if (fits) canvas.Text(left_px, kGapPx, number(x_m), kTextScale, kInk);
  }
  for (double y_m = first(origin_m.y());; y_m += step_m) {
    const double v_px = size_px.y() - (y_m - origin_m.y()) * px_per_m - 0.5;
    if (v_px < 0.0) break;
    canvas.Line({0.0, v_px}, {size_px.x() - 1.0, v_px}, 1.0, kLatticeLine);
    const int top_px = static_cast<int>(v_px) - Canvas::TextHeight(kTextScale) - kGapPx;
    const bool below_other_axis = top_px > Canvas::TextHeight(kTextScale) + 2 * kGapPx;
    if (below_other_axis) canvas.Text(kGapPx, top_px, number(y_m), kTextScale, kInk);
  }
}

}  // namespace

RgbImage PictureOf(const OccupancyMap& map, const GridGeometry& geometry) {
  return Paint(geometry, [&](const Cell& cell) {
    const float prob = map.At(cell);
    if (std::isnan(prob)) return kUnknownCell;
    const auto grey =
        static_cast<std::uint8_t>(std::lround(254.0F * (1.0F - std::clamp(prob, 0.0F, 1.0F))));
    return Colour{grey, grey, grey};
  });
}

RgbImage PictureOf(const StateMap& map, const GridGeometry& geometry) {
  return Paint(geometry, [&](const Cell& cell) { return ColourOf(map.At(cell)); });
}

RgbImage PictureOf(const CellSet& cells, const GridGeometry& geometry) {
  return Paint(geometry,
               [&](const Cell& cell) { return cells.Has(cell) ? kFreeCell : kUnknownCell; });
}

RgbImage DifferencePicture(const StateMap& truth, const StateMap& estimate,
                           const std::optional<CellSet>& observable, const GridGeometry& geometry) {
  return Paint(geometry, [&](const Cell& cell) {
    const Colour colour = DifferenceOf(truth.At(cell), estimate.At(cell));
    return observable && !observable->Has(cell) ? Paler(colour) : colour;
  });
}

RgbImage AnnotatedMap(const RgbImage& cells, const GridGeometry& geometry,
                      const std::vector<Path>& paths, PathDot dot, Lattice lattice) {
  const int factor = Enlargement(cells);
  const RgbImage large = Enlarged(cells, factor);
  const double px_per_m = factor / geometry.resolution_m;
  const Legend legend(geometry.width_cells * geometry.resolution_m, px_per_m, paths, dot);
  Canvas canvas(std::max(large.width_px, legend.WidthPx()), large.height_px + Legend::HeightPx(),
                kPaper);
  RgbImage image = canvas.image();
  for (int row = 0; row < large.height_px; ++row) {
    std::copy_n(large.At(0, row), 3 * large.width_px, image.At(0, row));
  }
  canvas = Canvas(std::move(image));
  if (lattice == Lattice::kMetres) DrawLattice(geometry, px_per_m, canvas);
  for (const Path& path : paths) {
    DrawPath(path, dot, geometry.OriginM(), px_per_m, large.height_px, canvas);
  }
  legend.Draw(large.height_px, canvas);
  return canvas.image();
}

GridGeometry KnownPart(const StateMap& map, int margin_cells) {
  GridGeometry known = map.geometry;
  known.width_cells = 0;
  known.height_cells = 0;
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    if (map.states[i] == CellState::kUnknown) continue;
    known = Union(known, OnlyCell(map.geometry.CellAt(i), map.geometry.resolution_m));
  }
  return known.size() > 0 ? Widened(known, margin_cells) : known;
}

GridGeometry WithPath(GridGeometry part, const Trajectory& path, int margin_cells) {
  constexpr double kFarM = 10.0;
  const int far_cells = CellIndex(kFarM, part.resolution_m);
  const auto cell_of = [&](const StampedPose& pose) {
    return CellOf(pose.world_from_camera.translation.head<2>(), part.resolution_m);
  };
  if (path.empty()) return part;
  const GridGeometry middle =
      part.size() > 0 ? part : OnlyCell(cell_of(path.front()), part.resolution_m);
  const GridGeometry near = Widened(middle, far_cells);
  for (const StampedPose& pose : path) {
    const Cell at = cell_of(pose);
    const GridGeometry around = Widened(OnlyCell(at, part.resolution_m), margin_cells);
    if (near.Contains(at)) part = Union(part, around);
  }
  return part;
}

GridGeometry OrAllOf(const StateMap& map, const GridGeometry& part) {
  return part.size() > 0 ? part : map.geometry;
}

GridGeometry ShownPart(const StateMap& map, const std::vector<Path>& paths) {
  constexpr double kMarginM = 0.5;
  const auto margin_cells = static_cast<int>(std::lround(kMarginM / map.geometry.resolution_m));
  GridGeometry known = KnownPart(map, margin_cells);
  GridGeometry part = known;
  // Each by its distance from what is known, or from the first: no stray path draws another one in.
  for (const Path& path : paths) {
    const GridGeometry with_path = WithPath(known, path.poses, margin_cells);
    if (known.size() == 0) known = with_path;
    part = Union(part, with_path);
  }
  return OrAllOf(map, part);
}

}  // namespace depthgrid
