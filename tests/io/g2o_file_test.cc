#include "mapper/io/g2o_file.h"

#include <gtest/gtest.h>

#include "mapper/io/matrix_poses.h"

namespace depthgrid {
namespace {

TEST(G2oFile, WrittenByHand) {
  PlanarGraph graph;
  graph.vertices = {{3, {1.0, 2.0, 0.5}}, {7, {1.5, 2.0, -0.25}}};
  graph.edges = {{3, 7, {0.5, 0.0, -0.75}, {0.5, 0.25, 0.125}}};
  EXPECT_EQ(G2oText(graph),
            "VERTEX_SE2 3 1 2 0.5\n"
            "VERTEX_SE2 7 1.5 2 -0.25\n"
            "FIX 3\n"
            "EDGE_SE2 3 7 0.5 0 -0.75 4 0 0 16 0 64\n");
  EXPECT_EQ(G2oText({}), "");
}

// A quarter turn about z and a shift.
TEST(MatrixPosesText, IsReadBackAndIsKittis) {
  const Trajectory written = {
      {0.0, {Eigen::Quaterniond(1, 0, 0, 1).normalized(), {0.25, -1.5, 3.0}}}, {1.0, Pose3{}}};
  const std::string text = MatrixPosesText(written);
  RowDamage damage;
  const auto read = ParseMatrixPoses(text, "x", damage);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_LT((read[0]->rotation.coeffs() - written[0].world_from_camera.rotation.coeffs()).norm(),
            1e-12);
  EXPECT_EQ(read[0]->translation, written[0].world_from_camera.translation);
  EXPECT_EQ(text.substr(text.find('\n') + 1), "1 0 0 0 0 1 0 0 0 0 1 0\n");
}

}  // namespace
}  // namespace depthgrid
