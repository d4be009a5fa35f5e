// Draws paths in a picture of a map, and the legend below it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "eval/pictures/canvas.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

constexpr int kTextScale = 2;  // for all text in such a picture
constexpr Colour kInk = {30, 30, 30};

Colour Paler(Colour colour);

// kBeneath is wide and pale, so that the path is visible on both sides of another one on top of it.
enum class PathStyle { kLine, kBeneath };

struct Path {
  std::string name;
  Colour colour;
  Trajectory poses;
  PathStyle style = PathStyle::kLine;
  // Number of dots after each dash of a dashed line; -1: not dashed.
  int dots = -1;
};

// Which end of each path is marked by a dot.
enum class PathDot { kStart, kNow };

// Draws into a picture of `rows_px` rows, whose lower left corner is at `origin_m`. The centre of a
// cell is the centre of its enlarged square.
void DrawPath(const Path& path, PathDot dot, const Eigen::Vector2d& origin_m, double px_per_m,
              int rows_px, Canvas& canvas);

// A scale bar, the paths' names and the meaning of the dots, in as many lines as needed.
class Legend {
 public:
  // `width_m`: of the picture. `paths` must outlive it. `most_px`: length of a line, unless a
  // single item is longer.
  Legend(double width_m, double px_per_m, const std::vector<Path>& paths, PathDot dot, int most_px);

  int WidthPx() const { return width_px_; }
  int HeightPx() const;
  // Draws below this row.
  void Draw(int row_px, Canvas& canvas) const;

 private:
  struct Item {
    int left_px;
    int top_px;
  };

  int DotsPx() const;
  void Place(int item_px, int most_px);
  void DrawBar(const Item& at, Canvas& canvas) const;
  void DrawDots(const Item& at, Canvas& canvas) const;

  std::string dot_text_;
  std::string bar_text_;
  int bar_px_;
  const std::vector<Path>& paths_;
  std::vector<Item> items_;  // the bar, the paths, the dots
  int left_px_ = 0;          // position of the next item
  int top_px_ = 0;
  int width_px_ = 0;
};

}  // namespace depthgrid
