#include "sim/depth/depth_camera.h"

#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kToleranceM = 2e-5;

Eigen::Quaterniond RandomRotation(RandomStream& random) {
  return Eigen::Quaterniond(random.Normal(), random.Normal(), random.Normal(), random.Normal())
      .normalized();
}

Vector3d DirectionInWorld(const PinholeCamera& camera, const Pose3& pose, int u, int v) {
  return pose.rotation * Unproject(camera, u, v, 1.0);
}

struct Comparison {
  double max_error_m = 0.0;
  int hits = 0;
  int wrong = 0;  // hit where there is nothing, or the reverse
};

// Against depth(origin, direction) in closed form; 0 is a miss. `sure` says whether the answer is
// not one of a silhouette.
template <typename ClosedForm>
Comparison Compare(const DepthImage& image, const PinholeCamera& camera, const Pose3& pose,
                   const ClosedForm& closed_form) {
  Comparison result;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      const double expected = closed_form(pose.translation, DirectionInWorld(camera, pose, u, v));
      const double seen = image.At(u, v);
      if (expected < 0) continue;  // too close to a silhouette
      if ((expected > 0) != (seen > 0)) {
        ++result.wrong;
      } else if (expected > 0) {
        ++result.hits;
        result.max_error_m = std::max(result.max_error_m, std::abs(seen - expected));
      }
    }
  }
  return result;
}

double BoxFromInside(const Vector3d& low, const Vector3d& high, const Vector3d& origin,
                     const Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double wall = direction[k] > 0 ? high[k] : low[k];
    if (direction[k] != 0) nearest = std::min(nearest, (wall - origin[k]) / direction[k]);
  }
  return nearest;
}

TEST(DepthCamera, SeesABoxFromInsideAsClosedForm) {
  const Vector3f low(0, 0, 0), high(4.9F, 5.0F, 2.5F);
  const PinholeCamera pinhole;
  RandomStream random(1, RandomStage::kTest);
  for (const int n : {1, 7}) {
    const DepthCamera camera(RayScene(test::Box(low, high, n)), pinhole);
    for (int i = 0; i < 5; ++i) {
      const Pose3 pose{
          RandomRotation(random),
          {random.Uniform(0.3, 4.6), random.Uniform(0.3, 4.7), random.Uniform(0.3, 2.2)}};
      const Comparison c =
          Compare(camera.Render(pose), pinhole, pose, [&](const Vector3d& o, const Vector3d& d) {
            return BoxFromInside(low.cast<double>(), high.cast<double>(), o, d);
          });
      EXPECT_EQ(c.hits, 640 * 480);
      EXPECT_EQ(c.wrong, 0);
      EXPECT_LT(c.max_error_m, kToleranceM);
    }
  }
}

TEST(DepthCamera, SeesAFacingPlaneAtItsDistance) {
  // z-depth, not ray length: a wall 3 m ahead has 3 m in every pixel.
  TriangleMesh wall;
  test::AddQuad(wall, {3, -50, -50}, {3, 50, -50}, {3, 50, 50}, {3, -50, 50});
  const DepthCamera camera(RayScene(wall), PinholeCamera{});
  const DepthFrame frame = camera.RenderWithIncidence(CameraOf({0, 0, 0}, 0));
  for (const float z : frame.depth.z_m) ASSERT_NEAR(z, 3.0F, kToleranceM);
  const auto cosine = [&](int u, int v) {
    return frame.incidence_cos[static_cast<std::size_t>(v * 640 + u)];
  };
  EXPECT_NEAR(cosine(320, 240), 1.0, 1e-5);
  const double corner = 1.0 / Unproject(camera.camera(), 0, 0, 1.0).norm();
  EXPECT_NEAR(cosine(0, 0), corner, 1e-5);
}

TEST(DepthCamera, SeesASphereAsClosedForm) {
  // 0.25 m and 512 rings: the quads lie up to 2.4 um inside the true sphere, which a view at 80
  // degrees stretches to 14 um; nearer to the silhouette the mesh is not the sphere to 20 um.
  const Vector3d centre(0.9, 0.05, -0.02);
  const double radius = 0.25;
  const DepthCamera camera(RayScene(test::Sphere(centre.cast<float>(), 0.25F, 512)),
                           PinholeCamera{});
  const Pose3 pose = CameraOf({0, 0, 0}, 0);
  const auto closed_form = [&](const Vector3d& o, const Vector3d& d) {
    const double along = d.dot(centre - o) / d.squaredNorm();
    const double miss = (o + along * d - centre).norm();
    if (miss > radius * std::sin(RadFromDeg(80.0)) && miss < 1.001 * radius) return -1.0;
    return miss > radius ? 0.0 : along - std::sqrt(radius * radius - miss * miss) / d.norm();
  };
  const Comparison c = Compare(camera.Render(pose), camera.camera(), pose, closed_form);
  EXPECT_EQ(c.wrong, 0);
  EXPECT_GT(c.hits, 50000);
  EXPECT_LT(c.max_error_m, kToleranceM);
}

TEST(DepthCamera, LeavesPixelsThatSeeNothingInvalid) {
  TriangleMesh half;  // covers y > 0, the image's left half
  test::AddQuad(half, {2, 0, -9}, {2, 9, -9}, {2, 9, 9}, {2, 0, 9});
  const DepthCamera camera(RayScene(half), PinholeCamera{});
  const DepthFrame frame = camera.RenderWithIncidence(CameraOf({0, 0, 0}, 0));
  EXPECT_NEAR(frame.depth.At(319, 100), 2.0F, kToleranceM);
  EXPECT_EQ(frame.depth.At(320, 100), kInvalidDepth);
  EXPECT_EQ(frame.incidence_cos[320], 0.0F);
  const DepthCamera nothing(RayScene(TriangleMesh{}), PinholeCamera{});
  for (const float z : nothing.Render(Pose3{}).z_m) ASSERT_EQ(z, kInvalidDepth);
}

TEST(DepthCamera, IncidenceIsTheAngleToTheNormal) {
  // A wall turned by 60 degrees: at the image centre the ray meets it at 60 degrees.
  TriangleMesh wall;
  const double turn = RadFromDeg(60.0);
  const Vector3f along(static_cast<float>(20 * std::sin(turn)),
                       static_cast<float>(20 * std::cos(turn)), 0);
  const Vector3f middle(2, 0, 0), up(0, 0, 20);
  test::AddQuad(wall, middle - along - up, middle + along - up, middle + along + up,
                middle - along + up);
  PinholeCamera pinhole;
  pinhole.cx_px = 320;
  pinhole.cy_px = 240;
  const DepthFrame frame =
      DepthCamera(RayScene(wall), pinhole).RenderWithIncidence(CameraOf({0, 0, 0}, 0));
  EXPECT_NEAR(frame.incidence_cos[240 * 640 + 320], 0.5, 1e-6);
}

TEST(DepthCamera, NoRayLeaksOutOfAClosedMesh) {
  const PinholeCamera pinhole;
  RandomStream random(2, RandomStage::kTest);
  long rays = 0;
  for (const TriangleMesh& mesh :
       {test::Box({-2, -2, -2}, {2, 2, 2}, 16), test::Sphere({0, 0, 0}, 2.0F, 40)}) {
    const DepthCamera camera(RayScene(mesh), pinhole);
    for (int i = 0; i < 17; ++i) {
      // The first pose looks straight along the grid lines of the mesh.
      const Pose3 pose =
          i == 0 ? CameraOf({0, 0, 0}, 0)
                 : Pose3{RandomRotation(random),
                         {random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)}};
      const DepthImage image = camera.Render(pose);
      for (const float z : image.z_m) ASSERT_GT(z, 0.0F);
      rays += static_cast<long>(image.z_m.size());
    }
  }
  EXPECT_GE(rays, 10'000'000);
}

std::vector<RayIsa> IsasOfThisMachine() {
  std::vector<RayIsa> isas = {RayIsa::kAvx2};
  if (__builtin_cpu_supports("avx512vl")) isas.push_back(RayIsa::kAvx512);
  return isas;
}

TEST(DepthCamera, ThreadsDoNotChangeABit) {
  const TriangleMesh mesh = test::ClutteredRoom(20000);
  const Pose3 pose = CameraOf({2.0, 2.0, 0.4}, 1.15);
  for (const RayIsa isa : IsasOfThisMachine()) {
    const DepthFrame serial =
        DepthCamera(RayScene(mesh, isa, 1), PinholeCamera{}, 1).RenderWithIncidence(pose);
    for (const int threads : {2, 3, 4}) {
      const DepthFrame parallel =
          DepthCamera(RayScene(mesh, isa, threads), PinholeCamera{}, threads)
              .RenderWithIncidence(pose);
      EXPECT_EQ(parallel.depth.z_m, serial.depth.z_m);
      EXPECT_EQ(parallel.incidence_cos, serial.incidence_cos);
    }
  }
}

TEST(DepthCamera, PacketsGiveWhatSingleRaysGive) {
  const TriangleMesh mesh = test::ClutteredRoom(20000);
  const PinholeCamera pinhole;
  const Pose3 pose = CameraOf({2.0, 2.0, 0.4}, 1.15);
  for (const RayIsa isa : IsasOfThisMachine()) {
    const RayScene scene(mesh, isa);
    const DepthImage image = DepthCamera(scene, pinhole).Render(pose);
    const Eigen::Matrix3f r = pose.rotation.toRotationMatrix().cast<float>();
    int differing = 0;
    for (int v = 0; v < image.height_px; ++v) {
      for (int u = 0; u < image.width_px; ++u) {
        const auto x = static_cast<float>((u - pinhole.cx_px) / pinhole.fx_px);
        const auto y = static_cast<float>((v - pinhole.cy_px) / pinhole.fy_px);
        const Vector3f direction = r.col(0) * x + (r.col(1) * y + r.col(2));
        const auto hit = scene.NearestHit({pose.translation.cast<float>(), direction});
        differing += hit.has_value() && hit->distance == image.At(u, v) ? 0 : 1;
      }
    }
    EXPECT_EQ(differing, 0);
  }
}

TEST(DepthCamera, AnySizeIsPartOfTheFullImage) {
  // A camera that looks at a part of another's image sees the same depths, whatever the tile's
  // fill.
  const RayScene scene(test::ClutteredRoom(5000));
  const Pose3 pose = CameraOf({2.0, 2.0, 0.4}, 1.15);
  const DepthImage full = DepthCamera(scene, PinholeCamera{}).Render(pose);
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{1, 1}, {541, 361}, {3, 5}, {640, 1}, {1, 480}, {4, 4}}) {
    PinholeCamera part;
    part.width_px = width;
    part.height_px = height;
    const DepthImage image = DepthCamera(scene, part, 2).Render(pose);
    ASSERT_EQ(image.z_m.size(), static_cast<std::size_t>(width * height));
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) ASSERT_EQ(image.At(u, v), full.At(u, v));
    }
  }
}

TEST(DepthCamera, RefusesWhatItCannotRender) {
  const RayScene scene(test::Box({0, 0, 0}, {1, 1, 1}));
  PinholeCamera distorted;
  distorted.distortion[0] = 0.1;
  EXPECT_THROW(DepthCamera(scene, distorted), InputError);
  PinholeCamera negative;
  negative.width_px = -1;
  EXPECT_THROW(DepthCamera(scene, negative), InputError);
}

}  // namespace
}  // namespace depthgrid
