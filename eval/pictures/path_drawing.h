// Paths in a picture of a map, and the legend below it that names them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "eval/pictures/canvas.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

constexpr int kTextScale = 2;  // of all text in such a picture
constexpr Colour kInk = {30, 30, 30};

Colour Paler(Colour colour);

// A path that another one may lie upon is wide and pale, so that it is seen on both sides of it.
enum class PathStyle { kLine, kBeneath };

struct Path {
  std::string name;
  Colour colour;
  Trajectory poses;
  PathStyle style = PathStyle::kLine;
  // Of a dashed line, behind each of its dashes; -1: it is not dashed.
  int dots = -1;
};

// Which end of each path has a dot.
enum class PathDot { kStart, kNow };

// Over a picture of so many rows, whose lower left corner is the origin. The centre of cell (i,
// j)'s picture is that of its enlarged square.
void DrawPath(const Path& path, PathDot dot, const Eigen::Vector2d& origin_m, double px_per_m,
              int rows_px, Canvas& canvas);

// A scale bar, the paths' names and what their dots are, in as many lines as they take.
class Legend {
 public:
  // Of a picture so wide. `paths` must outlive it; `most_px`: the length of a line, unless one item
  // alone is longer.
  Legend(double width_m, double px_per_m, const std::vector<Path>& paths, PathDot dot, int most_px);

  int WidthPx() const { return width_px_; }
  int HeightPx() const;
  // Below this row.
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
  int left_px_ = 0;          // where the next one goes
  int top_px_ = 0;
  int width_px_ = 0;
};

}  // namespace depthgrid
