#include "sim/colour/colour_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "sim/depth/depth_camera.h"
#include "sim/shapes/box.h"
#include "sim/shapes/revolve.h"
#include "tests/paths.h"

namespace depthgrid {
namespace {

// Unlike focal lengths, principal point off the middle, sides that are not multiples of a tile.
PinholeCamera OddCamera() {
  PinholeCamera camera;
  camera.width_px = 330;
  camera.height_px = 214;
  camera.fx_px = 280.0;
  camera.fy_px = 251.0;
  camera.cx_px = 150.25;
  camera.cy_px = 120.5;
  return camera;
}

Pose3 Tilted(const Pose2& base, double height_m, double pitch_down_rad, double roll_rad) {
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(-pitch_down_rad, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()));
  return CameraOf(base, height_m) * Pose3{tilt, Eigen::Vector3d::Zero()};
}

// Whether one smooth surface fills the pixel's neighbourhood. Inverse depth is linear in the pixel
// on a plane, so its second differences show silhouettes and creases.
bool IsInside(const DepthImage& depth, int u, int v) {
  constexpr double kMaxBend = 1e-3;  // of the inverse depth: steps of 2 mm seen from 2 m
  const double here_m = depth.At(u, v);
  if (depth.At(u, v) == kInvalidDepth) return false;
  for (const auto& [du, dv] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
    const double bend = here_m / depth.At(u + du, v + dv) + here_m / depth.At(u - du, v - dv) - 2.0;
    if (!(std::abs(bend) <= kMaxBend)) return false;
  }
  return true;
}

struct Agreement {
  int compared = 0;
  double rms_m = 0.0;
  double worst_m = 0.0;
};

Agreement Compare(const DepthImage& expected, const DepthImage& actual) {
  Agreement agreement;
  double sum = 0.0;
  for (int v = 1; v + 1 < expected.height_px; ++v) {
    for (int u = 1; u + 1 < expected.width_px; ++u) {
      if (!IsInside(expected, u, v)) continue;
      const double error = actual.At(u, v) - expected.At(u, v);
      sum += error * error;
      agreement.worst_m = std::max(agreement.worst_m, std::abs(error));
      ++agreement.compared;
    }
  }
  agreement.rms_m = std::sqrt(sum / std::max(1, agreement.compared));
  return agreement;
}

TEST(ColourCamera, DepthIsThatOfTheDepthCamera) {
  int frames = 0;
  for (const char* name : {"living_room", "office_room"}) {
    const Scene scene = LoadScene(ShippedSceneFile(name));
    const RayScene rays(scene.mesh);
    for (const PinholeCamera& camera : {PinholeCamera{}, OddCamera()}) {
      ColourCamera colour(scene, camera);
      const DepthCamera depth(rays, camera);
      for (const double yaw : {0.3, 2.1, -1.7}) {
        const Pose3 pose = Tilted({2.4, 1.5, yaw}, 1.15, 0.3, 0.1);
        const Agreement agreement = Compare(depth.Render(pose), colour.Render(pose).depth);
        EXPECT_GT(agreement.compared, camera.width_px * camera.height_px * 2 / 3);
        EXPECT_LT(agreement.rms_m, 20e-6) << name << " yaw " << yaw;
        ++frames;
      }
    }
  }
  EXPECT_EQ(frames, 12);
}

// A board on the left, a ball at the top right, nothing else.
Scene Signpost() {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].colour = {1, 0, 0};
  scene.materials[1].colour = {0, 0, 1};
  scene.lighting.sky = {0, 1, 0};
  TriangleMesh board = MakeBox({0.1, 1.0, 1.0});
  TriangleMesh ball = Revolve(SphereOutline(0.5, 32), 32);
  for (auto& material : ball.material_of_triangle) material = 1;
  Eigen::Affine3d at = Eigen::Affine3d::Identity();
  at.translation() = Eigen::Vector3d(3, 1, -0.5);
  Append(scene.mesh, Transformed(board, at));
  at.translation() = Eigen::Vector3d(3, -1, 0.8);
  Append(scene.mesh, Transformed(ball, at));
  return scene;
}

TEST(ColourCamera, ImageIsUprightAndNotMirrored) {
  const PinholeCamera camera;
  ColourCamera colour(Signpost(), camera);
  const ColourFrame frame = colour.Render(CameraOf({0, 0, 0}, 0.0));  // looks along +x
  const auto pixel_of = [&](const Eigen::Vector3d& forward_left_up) {
    const Eigen::Vector2d p =
        Project(camera, {-forward_left_up.y(), -forward_left_up.z(), forward_left_up.x()});
    return frame.rgb.At(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  };
  const auto* board = pixel_of({3, 1, 0});
  EXPECT_GT(board[0], 2 * board[2]);
  const auto* ball = pixel_of({3, -1, 0.8});
  EXPECT_GT(ball[2], 2 * ball[0]);
  const auto* sky = pixel_of({3, -1, -0.8});
  EXPECT_EQ(sky[0], 0);
  EXPECT_EQ(sky[1], 255);
  EXPECT_EQ(frame.depth.At(0, 479), kInvalidDepth);
  EXPECT_NEAR(frame.depth.At(static_cast<int>(319.5 - 481.2 / 3), 239), 2.95, 1e-5);
}

TEST(ColourCamera, CamerasTakeTurnsAndRepeatThemselves) {
  const Scene scene = Signpost();
  ColourCamera first(scene, PinholeCamera{});
  const Pose3 pose = CameraOf({0.5, 0.2, 0.1}, 0.1);
  const ColourFrame before = first.Render(pose);
  ColourCamera second(scene, OddCamera());
  EXPECT_EQ(second.Render(pose).rgb.width_px, 330);
  ColourCamera moved = std::move(first);
  const ColourFrame after = moved.Render(pose);
  EXPECT_EQ(before.rgb, after.rgb);
  EXPECT_EQ(before.depth.z_m, after.depth.z_m);
}

TEST(ColourCamera, EveryTextureDrawsItsOwnPattern) {
  Scene scene;
  scene.mesh = MakeBox({4, 4, 4});
  scene.materials.resize(1);
  scene.materials[0].colour = {0.8F, 0.2F, 0.2F};
  scene.materials[0].second_colour = {0.1F, 0.1F, 0.6F};
  scene.materials[0].scale_m = 0.2F;
  std::vector<RgbImage> images;
  for (int kind = 0; kind <= static_cast<int>(TextureKind::kStone); ++kind) {
    scene.materials[0].texture = static_cast<TextureKind>(kind);
    ColourCamera camera(scene, OddCamera());
    images.push_back(camera.Render(Tilted({0, 0, 0.4}, 1.5, 0.3, 0.0)).rgb);
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(images[i], images[j]) << i << " and " << j;
  }
  EXPECT_EQ(images.size(), 12U);
}

TEST(ColourCamera, RefusesWhatItCannotDraw) {
  PinholeCamera distorted;
  distorted.distortion[0] = 0.1;
  EXPECT_THROW(ColourCamera(Signpost(), distorted), InputError);
  PinholeCamera huge;
  huge.width_px = 100000;
  EXPECT_THROW(ColourCamera(Signpost(), huge), InputError);
}

}  // namespace
}  // namespace depthgrid
