// A planar pose graph in g2o's text form, for the viewers and solvers that read it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mapper/core/pose2.h"

namespace depthgrid {

struct PlanarGraph {
  struct Vertex {
    int id = 0;
    Pose2 map_from_base;
  };
  struct Edge {
    int first = 0;  // ids
    int second = 0;
    Pose2 first_from_second;
    Eigen::Vector3d sigma = Eigen::Vector3d::Ones();  // x m, y m, yaw rad
  };
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
};

// VERTEX_SE2 id x y yaw, FIX of the first, EDGE_SE2 first second dx dy dyaw and the upper triangle
// of the information matrix. Numbers are in the shortest form that parses to the same double.
std::string G2oText(const PlanarGraph& graph);

}  // namespace depthgrid
