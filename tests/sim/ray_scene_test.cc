#include "sim/depth/ray_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mapper/core/rng.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

using Eigen::Vector3f;

Vector3f RandomPoint(RandomStream& random, double half_size) {
  const auto draw = [&] { return static_cast<float>(random.Uniform(-half_size, half_size)); };
  const float x = draw(), y = draw();
  return {x, y, draw()};
}

TEST(RayScene, HitsTheNearestSurfaceFromEitherSide) {
  const RayScene scene(test::Box({1, -1, -1}, {2, 1, 1}));
  const auto hit = scene.NearestHit({{0, 0.1F, 0.2F}, {1, 0, 0}});
  ASSERT_TRUE(hit.has_value());
  EXPECT_FLOAT_EQ(hit->distance, 1.0F);
  EXPECT_FLOAT_EQ(scene.NearestHit({{1.5F, 0.1F, 0.2F}, {0, 0, 2}})->distance, 0.4F);
  EXPECT_FALSE(scene.NearestHit({{0, 0, 0}, {-1, 0, 0}}).has_value());
  EXPECT_FALSE(scene.NearestHit({{0, 0, 0}, {1, 0, 0}, 0.9F}).has_value());
}

TEST(RayScene, ManyRaysGetTheAnswersOfSingleOnes) {
  const RayScene scene(test::ClutteredRoom(5000));
  RandomStream random(1, RandomStage::kTest);
  for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 1000U}) {
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
      ray = {RandomPoint(random, 1.0) + Vector3f(2.4F, 2.4F, 1.2F), RandomPoint(random, 1.0),
             static_cast<float>(random.Uniform(0.5, 5.0))};
    }
    std::vector<float> distances(count);
    scene.NearestHits(rays, distances);
    for (std::size_t i = 0; i < count; ++i) {
      const auto hit = scene.NearestHit(rays[i]);
      EXPECT_EQ(distances[i], hit ? hit->distance : std::numeric_limits<float>::infinity());
    }
  }
}

TEST(RayScene, SeesWhatIsBetweenTwoPoints) {
  const RayScene scene(test::Box({1, -1, -1}, {2, 1, 1}));
  EXPECT_TRUE(scene.Occluded({0, 0, 0}, {3, 0, 0}));
  EXPECT_FALSE(scene.Occluded({0, 0, 0}, {0.9F, 0, 0}));
  EXPECT_FALSE(scene.Occluded({1.1F, 0, 0}, {1.9F, 0.5F, 0.5F}));
  EXPECT_FALSE(scene.Occluded({0, 2, 0}, {3, 2, 0}));
}

TEST(RayScene, DistanceToABoxIsClosedForm) {
  const RayScene scene(test::Box({-1, -1, -1}, {1, 1, 1}, 5));
  RandomStream random(2, RandomStage::kTest);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3f p = RandomPoint(random, 3.0);
    const Vector3f beyond = (p.cwiseAbs() - Vector3f::Ones()).cwiseMax(0.0F);
    const bool is_inside = p.cwiseAbs().maxCoeff() < 1.0F;
    const float expected = is_inside ? 1.0F - p.cwiseAbs().maxCoeff() : beyond.norm();
    EXPECT_NEAR(scene.DistanceToSurface(p, 100.0F), expected, 1e-5F);
    inside += is_inside ? 1 : 0;
  }
  EXPECT_GT(inside, 30);
}

TEST(RayScene, DistanceStopsAtItsLimit) {
  const RayScene scene(test::Box({1, -1, -1}, {2, 1, 1}));
  EXPECT_EQ(scene.DistanceToSurface({0, 0, 0}, 0.5F), 0.5F);
  EXPECT_FLOAT_EQ(scene.DistanceToSurface({0, 0, 0}, 1.5F), 1.0F);
  EXPECT_EQ(RayScene(TriangleMesh{}).DistanceToSurface({0, 0, 0}, 2.0F), 2.0F);
}

TEST(RayScene, RefusesABrokenMesh) {
  TriangleMesh mesh = test::Box({0, 0, 0}, {1, 1, 1});
  mesh.triangles[3][1] = 1000;
  EXPECT_THROW(RayScene{mesh}, std::logic_error);
  mesh = test::Box({0, 0, 0}, {1, 1, 1});
  mesh.vertices[2].x() = std::nanf("");
  EXPECT_THROW(RayScene{mesh}, std::logic_error);
}

}  // namespace
}  // namespace depthgrid
