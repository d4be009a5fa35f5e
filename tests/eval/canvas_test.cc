#include "eval/pictures/canvas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "eval/pictures/map_picture.h"

namespace depthgrid {
namespace {

constexpr Colour kWhite = {255, 255, 255};
constexpr Colour kBlack = {0, 0, 0};

Colour At(const RgbImage& image, int u, int v) {
  const std::uint8_t* p = image.At(u, v);
  return {p[0], p[1], p[2]};
}

int DarkPixels(const RgbImage& image) {
  int dark = 0;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) dark += At(image, u, v) == kBlack ? 1 : 0;
  }
  return dark;
}

TEST(Canvas, ALineCoversItsWidth) {
  Canvas canvas(20, 9, kWhite);
  canvas.Line({-5, 4}, {25, 4}, 3.0, kBlack);
  EXPECT_EQ(DarkPixels(canvas.image()), 3 * 20);
  EXPECT_EQ(At(canvas.image(), 10, 3), kBlack);
  EXPECT_EQ(At(canvas.image(), 10, 5), kBlack);
  EXPECT_EQ(At(canvas.image(), 10, 6), kWhite);
}

TEST(Canvas, WhatLiesOutsideIsClipped) {
  Canvas canvas(5, 5, kWhite);
  canvas.Line({-1e9, -1e9}, {-10, 2}, 2.0, kBlack);
  canvas.Line({0, std::nan("")}, {1, 1}, 2.0, kBlack);
  canvas.Fill(-3, -3, 100, 2, kBlack);
  canvas.Text(-2, 100, "out", 1, kBlack);
  EXPECT_EQ(DarkPixels(canvas.image()), 0);
}

TEST(Canvas, TextIsDotsOfItsScale) {
  Canvas canvas(20, 20, kWhite);
  canvas.Text(0, 0, "-", 2, kBlack);  // five dots in a row
  EXPECT_EQ(DarkPixels(canvas.image()), 5 * 4);
  EXPECT_EQ(Canvas::TextWidth("ab", 2), 24);
  Canvas unknown(20, 20, kWhite);
  unknown.Text(0, 0, "\xc3", 1, kBlack);
  EXPECT_GT(DarkPixels(unknown.image()), 0);
}

TEST(MapPicture, NorthIsUp) {
  StateMap map(GridGeometry{0.05, {0, 0}, 2, 2});
  map.states[map.geometry.Index({1, 1})] = CellState::kOccupied;  // east and north
  const RgbImage image = PictureOf(map, map.geometry);
  EXPECT_EQ(At(image, 1, 0), kBlack);
  EXPECT_EQ(DarkPixels(image), 1);
}

TEST(MapPicture, DifferenceTellsMissedFromInvented) {
  const GridGeometry row{0.05, {0, 0}, 3, 1};
  StateMap truth(row);
  StateMap estimate(row);
  truth.states = {CellState::kOccupied, CellState::kOccupied, CellState::kFree};
  estimate.states = {CellState::kOccupied, CellState::kFree, CellState::kOccupied};
  const RgbImage image = DifferencePicture(truth, estimate, std::nullopt, row);
  EXPECT_EQ(At(image, 0, 0), kBlack);
  EXPECT_EQ(At(image, 1, 0), palette::kMissed);
  EXPECT_EQ(At(image, 2, 0), palette::kInvented);
}

TEST(MapPicture, PathsLieWhereTheirCellsAre) {
  const GridGeometry geometry{0.05, {-10, -10}, 20, 20};
  const StateMap map(geometry);
  Path path{"p", {255, 0, 0}, {}};
  // From the middle of the cell left of the map's middle to that right of it.
  path.poses.push_back({0.0, {Eigen::Quaterniond::Identity(), {-0.025, 0.025, 1.0}}});
  path.poses.push_back({1.0, {Eigen::Quaterniond::Identity(), {0.025, 0.025, 1.0}}});
  const RgbImage image = AnnotatedMap(PictureOf(map, geometry), geometry, {path});
  const int factor = image.width_px / geometry.width_cells;
  ASSERT_EQ(image.width_px, factor * geometry.width_cells);
  // Cell (0, 0) is the tenth from the left and, rows counted from the top, the tenth.
  EXPECT_EQ(At(image, 10 * factor, 9 * factor + factor / 2), (Colour{255, 0, 0}));
}

TEST(MapPicture, LatticeLinesLieAtWholeMetres) {
  const GridGeometry geometry{0.05, {-30, -10}, 60, 40};  // x -1.5 to 1.5, y -0.5 to 1.5 m
  const StateMap map(geometry);
  const RgbImage plain = AnnotatedMap(PictureOf(map, geometry), geometry, {});
  const RgbImage lined =
      AnnotatedMap(PictureOf(map, geometry), geometry, {}, PathDot::kStart, Lattice::kMetres);
  const int factor = plain.width_px / geometry.width_cells;
  const int free_row = 20 * factor;  // y = 0.5 m
  std::vector<int> lines;
  for (int u = 0; u < plain.width_px; ++u) {
    if (At(lined, u, free_row) != At(plain, u, free_row)) lines.push_back(u);
  }
  // A line one pixel wide between two pixels colours both.
  EXPECT_EQ(lines, (std::vector<int>{10 * factor - 1, 10 * factor, 30 * factor - 1, 30 * factor,
                                     50 * factor - 1, 50 * factor}));
  const int free_column = 20 * factor;  // x = -0.5 m
  EXPECT_NE(At(lined, free_column, 30 * factor), At(plain, free_column, 30 * factor));  // y = 0
  EXPECT_NE(At(lined, free_column, 10 * factor), At(plain, free_column, 10 * factor));  // y = 1 m
  EXPECT_EQ(At(lined, free_column, 15 * factor), At(plain, free_column, 15 * factor));
}

TEST(MapPicture, ATruthBeneathAnEstimateIsSeenOnBothSides) {
  const GridGeometry geometry{0.05, {-10, -10}, 20, 20};
  Path truth{"truth", {255, 0, 0}, {}, PathStyle::kBeneath};
  truth.poses.push_back({0.0, {Eigen::Quaterniond::Identity(), {-0.2, 0.025, 1.0}}});
  truth.poses.push_back({1.0, {Eigen::Quaterniond::Identity(), {0.2, 0.025, 1.0}}});
  const Path estimate{"estimate", {0, 0, 255}, truth.poses};
  const RgbImage image =
      AnnotatedMap(PictureOf(StateMap(geometry), geometry), geometry, {truth, estimate});
  const int factor = image.width_px / geometry.width_cells;
  const int middle = 9 * factor + factor / 2;
  EXPECT_EQ(At(image, 10 * factor, middle), (Colour{0, 0, 255}));
  for (const int side : {-3, 3}) {
    EXPECT_EQ(At(image, 10 * factor, middle + side), (Colour{255, 127, 127}));
  }
}

TEST(MapPicture, TheDotIsAtTheStartOrWhereItIsNow) {
  const GridGeometry geometry{0.05, {-10, -10}, 20, 20};
  Path path{"p", {255, 0, 0}, {}};
  path.poses.push_back({0.0, {Eigen::Quaterniond::Identity(), {-0.225, 0.025, 1.0}}});
  path.poses.push_back({1.0, {Eigen::Quaterniond::Identity(), {0.225, 0.025, 1.0}}});
  int pictures = 0;
  for (const PathDot dot : {PathDot::kStart, PathDot::kNow}) {
    const RgbImage image =
        AnnotatedMap(PictureOf(StateMap(geometry), geometry), geometry, {path}, dot);
    const int factor = image.width_px / geometry.width_cells;
    const int above = 9 * factor + factor / 2 - 3;
    const bool at_start = At(image, 5 * factor + factor / 2, above) == path.colour;
    const bool at_end = At(image, 14 * factor + factor / 2, above) == path.colour;
    EXPECT_EQ(at_start, dot == PathDot::kStart);
    EXPECT_EQ(at_end, dot == PathDot::kNow);
    ++pictures;
  }
  EXPECT_EQ(pictures, 2);
}

TEST(MapPicture, TheLegendHasEveryPathsDotInItsColour) {
  const GridGeometry geometry{0.05, {0, 0}, 300, 20};
  const std::vector<Path> paths = {{"truth", {255, 0, 0}, {}, PathStyle::kBeneath},
                                   {"estimate", {0, 0, 255}, {}}};
  const RgbImage image = AnnotatedMap(PictureOf(StateMap(geometry), geometry), geometry, paths);
  // Above the middle, where a dot is and no stroke of that colour.
  const int row = image.height_px - 12 - Canvas::TextHeight(2) / 2 - 3;
  int dots = 0;
  for (const Path& path : paths) {
    int width_px = 0;
    for (int column = 0; column < image.width_px; ++column) {
      width_px += At(image, column, row) == path.colour ? 1 : 0;
    }
    EXPECT_GT(width_px, 1);
    ++dots;
  }
  EXPECT_EQ(dots, 2);
}

TEST(MapPicture, TheLegendIsNotCut) {
  const std::vector<Path> paths = {
      {"truth", {255, 0, 0}, {}}, {"odometry", {0, 255, 0}, {}}, {"estimate", {0, 0, 255}, {}}};
  int pictures = 0;
  for (const auto& [width, height] : {std::pair{617, 300}, {5, 2000}, {899, 10}, {1000, 20}}) {
    const GridGeometry geometry{0.05, {0, 0}, width, height};
    const RgbImage image = AnnotatedMap(PictureOf(StateMap(geometry), geometry), geometry, paths);
    // After the last dot of colour there is text, which ends before the picture does.
    const int row = image.height_px - 12 - Canvas::TextHeight(2) / 2;
    int stroke = 0;
    int ink = 0;
    for (int column = 0; column < image.width_px; ++column) {
      for (int v = row - 8; v < row + 8; ++v) {
        if (At(image, column, v) == paths.back().colour) stroke = column;
        if (At(image, column, v) == (Colour{30, 30, 30})) ink = column;
      }
    }
    EXPECT_GT(stroke, 0) << width;
    EXPECT_GE(ink - stroke, Canvas::TextWidth("start", 2) - 8) << width;
    EXPECT_LT(ink, image.width_px - 1) << width;
    EXPECT_LT(image.height_px, 4100);
    ++pictures;
  }
  EXPECT_EQ(pictures, 4);
}

// One that does not fit goes on below, and nothing of it is cut.
TEST(MapPicture, TheLegendOfManyPathsHasSeveralLines) {
  const GridGeometry geometry{0.05, {0, 0}, 300, 20};
  const auto picture_of = [&](int paths) {
    std::vector<Path> many;
    for (int i = 0; i < paths; ++i) {
      many.push_back({"a path of some name", {0, 0, static_cast<std::uint8_t>(200 + i)}, {}});
    }
    return AnnotatedMap(PictureOf(StateMap(geometry), geometry), geometry, many);
  };
  const int line_px = Canvas::TextHeight(2) + 12;
  const RgbImage one = picture_of(1), many = picture_of(12);
  EXPECT_LE(many.width_px, 1200);
  EXPECT_GE(many.height_px, one.height_px + 3 * line_px);
  EXPECT_EQ((many.height_px - one.height_px) % line_px, 0);
  // Each has a sample of its colour, in a line of the legend.
  std::set<int> blues;
  for (int v = one.height_px - line_px; v < many.height_px; ++v) {
    for (int u = 0; u < many.width_px; ++u) {
      const Colour colour = At(many, u, v);
      if (colour.red == 0 && colour.green == 0) blues.insert(colour.blue);
    }
  }
  for (int i = 0; i < 12; ++i) EXPECT_TRUE(blues.contains(200 + i)) << i;
}

// By their dots, paths of one colour are told apart.
TEST(MapPicture, ADashedPathHasGaps) {
  const GridGeometry geometry{0.05, {-10, -10}, 20, 20};
  Path path{"p", {255, 0, 0}, {}};
  for (int i = 0; i <= 90; ++i) {
    path.poses.push_back({0.1 * i, {Eigen::Quaterniond::Identity(), {-0.45 + 0.01 * i, 0.0, 1.0}}});
  }
  const auto strokes_of = [&](int dots) {
    path.dots = dots;
    const RgbImage image = AnnotatedMap(PictureOf(StateMap(geometry), geometry), geometry, {path});
    const int row = image.width_px / geometry.width_cells * 10;
    int strokes = 0;
    bool was_on = false;
    for (int u = 0; u < image.width_px; ++u) {
      const bool is_on = At(image, u, row).green < 100;
      strokes += is_on && !was_on ? 1 : 0;
      was_on = is_on;
    }
    return strokes;
  };
  const double length_px = 0.9 / 0.05 * 45;  // 45 pixels a cell
  EXPECT_EQ(strokes_of(-1), 1);
  EXPECT_EQ(strokes_of(0), static_cast<int>(std::ceil(length_px / 22.0)));
  EXPECT_NEAR(strokes_of(1), 2.0 * length_px / 31.0, 1.0);
  EXPECT_NEAR(strokes_of(2), 3.0 * length_px / 40.0, 2.0);
}

TEST(MapPicture, KnownPartHasAMargin) {
  StateMap map(GridGeometry{0.05, {-50, -50}, 100, 100});
  map.states[map.geometry.Index({3, 4})] = CellState::kFree;
  const GridGeometry part = KnownPart(map, 2);
  EXPECT_EQ(part.min_cell, (Cell{1, 2}));
  EXPECT_EQ(part.width_cells, 5);
  EXPECT_EQ(KnownPart(StateMap(map.geometry), 2).size(), 0U);
}

TEST(MapPicture, TheCameraIsInThePicture) {
  const GridGeometry part{0.05, {0, 0}, 10, 10};
  Trajectory path = {
      {0.0, {Eigen::Quaterniond::Identity(), {-0.225, 0.025, 1.0}}}};  // cell (-5, 0)
  path.push_back({1.0, {Eigen::Quaterniond::Identity(), {1000.0, 0.0, 1.0}}});
  EXPECT_EQ(WithPath(part, path, 2), (GridGeometry{0.05, {-7, -2}, 17, 12}));
}

// Of a large grid, mostly unknown, what is known and driven; the far end of a path that went astray
// is left out.
TEST(MapPicture, ShownIsWhatIsKnownAndThePathsHalfAMetreAround) {
  StateMap map(GridGeometry{0.1, {-500, -500}, 1000, 1000});
  map.states[map.geometry.Index({0, 0})] = CellState::kFree;
  map.states[map.geometry.Index({9, 3})] = CellState::kOccupied;
  const auto pose_at = [](double x_m, double y_m) {
    return StampedPose{0.0, {Eigen::Quaterniond::Identity(), {x_m, y_m, 1.0}}};
  };
  EXPECT_EQ(ShownPart(map, {}), (GridGeometry{0.1, {-5, -5}, 20, 14}));
  const std::vector<Path> paths = {{"a", {}, {pose_at(2.05, 0.05), pose_at(40.0, 0.0)}},
                                   {"b", {}, {pose_at(0.05, -1.95)}}};
  EXPECT_EQ(ShownPart(map, paths), (GridGeometry{0.1, {-5, -25}, 31, 34}));
}

// Frames that see nothing leave a map of one unknown cell at the origin, wherever the camera was.
TEST(MapPicture, OfAMapOfNothingThePathsAreShown) {
  const StateMap map(GridGeometry{0.1, {0, 0}, 1, 1});
  const auto pose_at = [](double x_m, double y_m) {
    return StampedPose{0.0, {Eigen::Quaterniond::Identity(), {x_m, y_m, 1.0}}};
  };
  const std::vector<Path> paths = {{"none", {}, {}},
                                   {"a", {}, {pose_at(20.05, 20.05), pose_at(22.05, 20.05)}},
                                   {"b", {}, {pose_at(20.05, 21.05), pose_at(900.0, 0.0)}},
                                   {"astray", {}, {pose_at(1e6, 1e6)}}};
  EXPECT_EQ(ShownPart(map, paths), (GridGeometry{0.1, {195, 195}, 31, 21}));
  EXPECT_EQ(ShownPart(map, {paths[0]}), map.geometry);
}

}  // namespace
}  // namespace depthgrid
