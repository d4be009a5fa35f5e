#include "eval/output/run_graph.h"

namespace depthgrid {
namespace {

// Keeps the information finite where the final poses are SLAM's own.
const Eigen::Vector3d kLeastSigma(1e-4, 1e-4, 1e-4);

// Motions with a common sigma.
struct Motions {
  std::vector<PlanarGraph::Edge> edges;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();

  void AddTo(PlanarGraph& graph) {
    if (edges.empty()) return;
    const Eigen::Vector3d mean = squares / static_cast<double>(edges.size());
    const Eigen::Vector3d sigma = mean.cwiseSqrt().cwiseMax(kLeastSigma);
    for (PlanarGraph::Edge& edge : edges) edge.sigma = sigma;
    graph.edges.insert(graph.edges.end(), edges.begin(), edges.end());
  }
};

}  // namespace

PlanarGraph GraphOf(const MappingRun& run) {
  PlanarGraph graph;
  const std::vector<MappedFrame>& mapped = run.result.mapped;
  Motions prior_map;
  Motions slam;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    graph.vertices.push_back({mapped[i].frame, mapped[i].map_from_base});
    if (i == 0 || !mapped[i].slam_motion) continue;
    const Pose2& motion = *mapped[i].slam_motion;
    const Pose2 between = Between(mapped[i - 1].map_from_base, mapped[i].map_from_base);
    const Eigen::Vector3d error = Between(motion, between).vector();
    Motions& motions = mapped[i].of_prior_map() ? prior_map : slam;
    motions.squares += error.cwiseProduct(error);
    motions.edges.push_back({mapped[i - 1].frame, mapped[i].frame, motion, kLeastSigma});
  }
  prior_map.AddTo(graph);
  slam.AddTo(graph);
  for (const PlanarLoop& loop : run.result.loops) {
    const auto frame = [&](int i) { return mapped[static_cast<std::size_t>(i)].frame; };
    graph.edges.push_back(
        {frame(loop.first),
         frame(loop.second),
         loop.first_from_second,
         {loop.sigma_translation_m, loop.sigma_translation_m, loop.sigma_yaw_rad}});
  }
  return graph;
}

}  // namespace depthgrid
