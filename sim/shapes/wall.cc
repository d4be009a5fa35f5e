#include "sim/shapes/wall.h"

#include <algorithm>
#include <map>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Edges of openings nearer than this are merged: narrower slits are rounding errors.
constexpr double kSameEdgeM = 1e-6;

std::vector<double> SortedUnique(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(),
                           [](double a, double b) { return b - a < kSameEdgeM; }),
               values.end());
  return values;
}

// The wall's face, divided into solid and open cells along all edges of its openings.
class WallFace {
 public:
  WallFace(double length_m, double height_m, const std::vector<WallOpening>& openings) {
    x_m_ = {0.0, length_m};
    z_m_ = {0.0, height_m};
    for (const auto& o : openings) {
      x_m_.insert(x_m_.end(), {o.along_m, o.along_m + o.width_m});
      z_m_.insert(z_m_.end(), {o.bottom_m, o.bottom_m + o.height_m});
    }
    x_m_ = SortedUnique(x_m_);
    z_m_ = SortedUnique(z_m_);
    for (int i = 0; i < columns(); ++i) {
      for (int k = 0; k < rows(); ++k) solid_.push_back(!InOpening(i, k, openings));
    }
  }

  int columns() const { return static_cast<int>(x_m_.size()) - 1; }
  int rows() const { return static_cast<int>(z_m_.size()) - 1; }
  double x_m(int column) const { return x_m_[static_cast<std::size_t>(column)]; }
  double z_m(int row) const { return z_m_[static_cast<std::size_t>(row)]; }
  bool Solid(int column, int row) const {
    if (column < 0 || row < 0 || column >= columns() || row >= rows()) return false;
    return solid_[static_cast<std::size_t>(column * rows() + row)];
  }

 private:
  bool InOpening(int column, int row, const std::vector<WallOpening>& openings) const {
    const double x = 0.5 * (x_m(column) + x_m(column + 1));
    const double z = 0.5 * (z_m(row) + z_m(row + 1));
    return std::any_of(openings.begin(), openings.end(), [&](const WallOpening& o) {
      return x > o.along_m && x < o.along_m + o.width_m && z > o.bottom_m &&
             z < o.bottom_m + o.height_m;
    });
  }

  std::vector<double> x_m_;
  std::vector<double> z_m_;
  std::vector<bool> solid_;
};

}  // namespace

TriangleMesh MakeWall(double length_m, double height_m, double right_y_m, double thickness_m,
                      const std::vector<WallOpening>& openings) {
  Require(length_m > 0 && height_m > 0 && thickness_m > 0, "a wall has a size");
  const WallFace face(length_m, height_m, openings);
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> index_of;
  const auto at = [&](int column, int side, int row) {
    const auto [entry, added] = index_of.try_emplace({column, side, row}, 0U);
    if (added) {
      entry->second = mesh.AddVertex(
          {face.x_m(column), right_y_m + (side == 1 ? thickness_m : 0.0), face.z_m(row)});
    }
    return entry->second;
  };
  for (int i = 0; i < face.columns(); ++i) {
    for (int k = 0; k < face.rows(); ++k) {
      if (!face.Solid(i, k)) continue;
      mesh.AddQuad(at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1));
      mesh.AddQuad(at(i + 1, 1, k), at(i, 1, k), at(i, 1, k + 1), at(i + 1, 1, k + 1));
      if (!face.Solid(i - 1, k)) {
        mesh.AddQuad(at(i, 1, k), at(i, 0, k), at(i, 0, k + 1), at(i, 1, k + 1));
      }
      if (!face.Solid(i + 1, k)) {
        mesh.AddQuad(at(i + 1, 0, k), at(i + 1, 1, k), at(i + 1, 1, k + 1), at(i + 1, 0, k + 1));
      }
      if (!face.Solid(i, k - 1)) {
        mesh.AddQuad(at(i, 1, k), at(i + 1, 1, k), at(i + 1, 0, k), at(i, 0, k));
      }
      if (!face.Solid(i, k + 1)) {
        mesh.AddQuad(at(i, 0, k + 1), at(i + 1, 0, k + 1), at(i + 1, 1, k + 1), at(i, 1, k + 1));
      }
    }
  }
  return mesh;
}

}  // namespace depthgrid
