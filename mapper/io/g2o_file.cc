#include "mapper/io/g2o_file.h"

#include <fmt/format.h>

#include <iterator>

namespace depthgrid {

std::string G2oText(const PlanarGraph& graph) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const auto& [id, pose] : graph.vertices) {
    fmt::format_to(out, "VERTEX_SE2 {} {} {} {}\n", id, pose.x_m, pose.y_m, pose.yaw_rad);
  }
  if (!graph.vertices.empty()) fmt::format_to(out, "FIX {}\n", graph.vertices.front().id);
  for (const PlanarGraph::Edge& edge : graph.edges) {
    const Pose2& pose = edge.first_from_second;
    const Eigen::Vector3d information = edge.sigma.cwiseProduct(edge.sigma).cwiseInverse();
    fmt::format_to(out, "EDGE_SE2 {} {} {} {} {} {} 0 0 {} 0 {}\n", edge.first, edge.second,
                   pose.x_m, pose.y_m, pose.yaw_rad, information.x(), information.y(),
                   information.z());
  }
  return text;
}

}  // namespace depthgrid
