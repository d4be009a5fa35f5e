#include "sim/shapes/box.h"

#include <cmath>
#include <map>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// A point of the cube's surface grid. Each coordinate is in 0..2 segments + 1; the lower half
// belongs to the rounded corner on the low side, the upper half to that on the high side. Points on
// an edge have the same coordinates in both faces, so vertices are shared.
using GridPoint = std::array<int, 3>;

class RoundedBoxBuilder {
 public:
  RoundedBoxBuilder(const Eigen::Vector3d& size_m, double radius_m, int segments)
      : core_half_m_(size_m / 2.0 - Eigen::Vector3d::Constant(radius_m)),
        centre_z_m_(size_m.z() / 2.0),
        radius_m_(radius_m),
        segments_(segments) {}

  TriangleMesh Build() {
    for (int axis = 0; axis < 3; ++axis) {
      AddFace(axis, 0);
      AddFace(axis, Last());
    }
    return std::move(mesh_);
  }

 private:
  int Last() const { return 2 * segments_ + 1; }

  // A component of the direction on the cube sphere: the tangent of equal angle steps in [-45, 45]
  // degrees.
  double Tangent(int index) const {
    const int step = index <= segments_ ? index : index - 1;
    return std::tan(kPi / 4.0 * (step - segments_) / segments_);
  }

  std::uint32_t VertexAt(const GridPoint& g) {
    const auto [entry, added] = index_of_.try_emplace(g, 0U);
    if (added) {
      const Eigen::Vector3d direction(Tangent(g[0]), Tangent(g[1]), Tangent(g[2]));
      Eigen::Vector3d corner;
      for (int i = 0; i < 3; ++i) {
        corner[i] =
            g[static_cast<std::size_t>(i)] <= segments_ ? -core_half_m_[i] : core_half_m_[i];
      }
      const Eigen::Vector3d point = corner + radius_m_ * direction.normalized();
      entry->second = mesh_.AddVertex(point + Eigen::Vector3d(0, 0, centre_z_m_));
    }
    return entry->second;
  }

  // The face where coordinate `axis` has the value `level`.
  void AddFace(int axis, int level) {
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t u = (a + 1) % 3;
    const std::size_t v = (a + 2) % 3;
    const auto at = [&](int i, int j) {
      GridPoint g{};
      g[a] = level;
      g[u] = i;
      g[v] = j;
      return VertexAt(g);
    };
    for (int i = 0; i < Last(); ++i) {
      for (int j = 0; j < Last(); ++j) {
        if (level == 0) {
          mesh_.AddQuad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
        } else {
          mesh_.AddQuad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
  }

  Eigen::Vector3d core_half_m_;
  double centre_z_m_;
  double radius_m_;
  int segments_;
  TriangleMesh mesh_;
  std::map<GridPoint, std::uint32_t> index_of_;
};

}  // namespace

TriangleMesh MakeBox(const Eigen::Vector3d& size_m) {
  Require(size_m.minCoeff() > 0.0, "a box has a size");
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.AddVertex({(i & 1) != 0 ? size_m.x() / 2 : -size_m.x() / 2,
                    (i & 2) != 0 ? size_m.y() / 2 : -size_m.y() / 2,
                    (i & 4) != 0 ? size_m.z() : 0.0});
  }
  mesh.AddQuad(0, 2, 3, 1);  // bottom
  mesh.AddQuad(4, 5, 7, 6);  // top
  mesh.AddQuad(0, 1, 5, 4);  // -y
  mesh.AddQuad(2, 6, 7, 3);  // +y
  mesh.AddQuad(0, 4, 6, 2);  // -x
  mesh.AddQuad(1, 3, 7, 5);  // +x
  return mesh;
}

TriangleMesh MakeRoundedBox(const Eigen::Vector3d& size_m, double radius_m, int segments) {
  Require(radius_m > 0.0 && 2.0 * radius_m < size_m.minCoeff() && segments >= 1,
          "a rounded box has flat faces left and facets on its edges");
  return RoundedBoxBuilder(size_m, radius_m, segments).Build();
}

}  // namespace depthgrid
