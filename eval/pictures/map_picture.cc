#include "eval/pictures/map_picture.h"

#include <algorithm>
#include <cmath>

#include "eval/pictures/path_drawing.h"

namespace depthgrid {
namespace {

constexpr Colour kUnknownCell = {205, 205, 205};  // as in Nav2's tools
constexpr Colour kFreeCell = {254, 254, 254};
constexpr Colour kOccupiedCell = {0, 0, 0};
constexpr Colour kLatticeLine = {170, 190, 215};
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

// Pixels per cell: enough for a sufficient width, unless the picture becomes too tall.
int Enlargement(const RgbImage& cells) {
  constexpr int kLeastWidthPx = 900;
  constexpr int kMostHeightPx = 4000;
  const int width = std::max(cells.width_px, 1);
  const int wanted = (kLeastWidthPx + width - 1) / width;
  return std::max(1, std::min(wanted, kMostHeightPx / std::max(cells.height_px, 1)));
}

// 1, 2 or 5 times a power of ten, from 1 m: the smallest step with sufficient distance between
// lines.
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
  constexpr int kLeastLinePx = 1200;  // of the legend, before a line break
  const Legend legend(geometry.width_cells * geometry.resolution_m, px_per_m, paths, dot,
                      std::max(large.width_px, kLeastLinePx));
  Canvas canvas(std::max(large.width_px, legend.WidthPx()), large.height_px + legend.HeightPx(),
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
  // Each path is extended from the known part (or the first path) independently, so that an
  // outlying path does not bring in another one.
  for (const Path& path : paths) {
    const GridGeometry with_path = WithPath(known, path.poses, margin_cells);
    if (known.size() == 0) known = with_path;
    part = Union(part, with_path);
  }
  return OrAllOf(map, part);
}

}  // namespace depthgrid
