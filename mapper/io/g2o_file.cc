#include "mapper/io/g2o_file.h"

#include <fmt/format.h>

namespace depthgrid {

std::string G2oText(const PlanarGraph& graph) {
  std::string text;
  for (const auto& [id, pose] : graph.vertices) {
    text += fmt::format("VERTEX_SE2 {} {} {} {}\n", id, pose.x_m, pose.y_m, pose.yaw_rad);
  }
  if (!graph.vertices.empty()) text += fmt::format("FIX {}\n", graph.vertices.front().id);
  for (const PlanarGraph::Edge& edge : graph.edges) {
    const Pose2& pose = edge.first_from_second;
    const Eigen::Vector3d information = edge.sigma.cwiseProduct(edge.sigma).cwiseInverse();
    text +=
        fmt::format("EDGE_SE2 {} {} {} {} {} {} 0 0 {} 0 {}\n", edge.first, edge.second, pose.x_m,
                    pose.y_m, pose.yaw_rad, information.x(), information.y(), information.z());
  }
  return text;
}

}  // namespace depthgrid
