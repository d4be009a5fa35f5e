#include "eval/output/run_graph.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// Three frames of a prior map and three new ones, 0.1 m apart; SLAM's motions are 1 cm too long.
TEST(RunGraph, APriorMapDoesNotMakeSlamLookExact) {
  MappingRun run;
  for (int i = -3; i < 3; ++i) {
    MappedFrame frame;
    frame.frame = i;
    frame.map_from_base = {0.1 * i, 0.0, 0.0};
    if (i != -3 && i != 0) frame.slam_motion = Pose2{i < 0 ? 0.1 : 0.11, 0.0, 0.0};
    run.result.mapped.push_back(frame);
  }
  const PlanarGraph graph = GraphOf(run);
  EXPECT_EQ(graph.vertices.size(), 6U);
  ASSERT_EQ(graph.edges.size(), 4U);
  for (const PlanarGraph::Edge& edge : graph.edges) {
    EXPECT_NEAR(edge.sigma.x(), edge.second < 0 ? 1e-4 : 0.01, 1e-9) << edge.second;
  }
}

}  // namespace
}  // namespace depthgrid
