#include "sim/scene/mover_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "sim/colour/colour_camera.h"
#include "sim/depth/sensor_options.h"
#include "sim/shapes/box.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;

const Pose3 kPose = CameraOf({0, 0, 0}, 1.0);  // looks along +x from 1 m above the floor

// Goes along y at 1 m/s, from where the camera looks; the walk's margin makes it 1.01 s a metre.
Mover Walker(const TriangleMesh& mesh) {
  Mover mover = {"walker", mesh, {}};
  mover.options.speed_mps = 1.0;
  mover.options.waypoints = {{{3.0, 0.0}}, {{3.0, 8.0}}};
  return mover;
}

Scene RoomWith(const TriangleMesh& mesh) {
  Scene scene;
  scene.mesh = test::Box({-4, -4, 0}, {6, 10, 3}, 4);
  scene.materials.resize(1);
  scene.movers = {Walker(mesh)};
  return scene;
}

// The camera stands still, a frame every 0.505 s: the walker goes half a metre.
Trajectory StandingFor(int frames) {
  Trajectory trajectory;
  for (int i = 0; i < frames; ++i) trajectory.push_back({100.0 + 0.505 * i, kPose});
  return trajectory;
}

// The scene as it is at one place of its mover, with nothing that moves.
Scene Frozen(const Scene& scene, const MoverPlace& place) {
  Scene frozen = scene;
  frozen.movers.clear();
  Eigen::Affine3d world_from_mover = Eigen::Affine3d::Identity();
  world_from_mover.translate(place.world_from_mover.translation);
  world_from_mover.rotate(place.world_from_mover.rotation);
  Append(frozen.mesh, Transformed(scene.movers[place.mover].mesh, world_from_mover));
  return frozen;
}

TEST(MoverScene, ClockBeginsWithTheFirstFrame) {
  const Scene scene = RoomWith(MakeBox({0.4, 0.6, 1.8}));
  const MoverScene movers(scene, RayIsa::kAvx2);
  const Trajectory trajectory = StandingFor(5);
  for (std::size_t frame = 0; frame < 5; ++frame) {
    const auto places = movers.At(trajectory, frame);
    ASSERT_EQ(places.size(), 1U);
    EXPECT_NEAR(places[0].world_from_mover.translation.y(), 0.5 * static_cast<double>(frame), 1e-6);
  }
}

// Where the mover is not in the way, every bit is the room's.
TEST(MoverCamera, SeesTheMoverBeforeTheRoom) {
  const Scene scene = RoomWith(MakeBox({0.4, 0.6, 1.8}));
  const MoverScene movers(scene, RayIsa::kAvx2);
  const PinholeCamera pinhole;
  const DepthCamera camera(RayScene(scene.mesh), pinhole);
  const DepthFrame room = camera.RenderWithIncidence(kPose);
  DepthFrame frame = room;
  const auto places = movers.At(StandingFor(2), 1);
  MoverCamera(movers, pinhole).DrawOver(kPose, places, frame);
  const DepthFrame expected =
      DepthCamera(RayScene(Frozen(scene, places[0]).mesh), pinhole).RenderWithIncidence(kPose);
  int nearer = 0, same = 0, elsewhere = 0;
  for (std::size_t i = 0; i < room.depth.z_m.size(); ++i) {
    const bool agrees = std::abs(frame.depth.z_m[i] - expected.depth.z_m[i]) < 2e-5F &&
                        std::abs(frame.incidence_cos[i] - expected.incidence_cos[i]) < 1e-4F;
    elsewhere += agrees ? 0 : 1;  // edges
    if (frame.depth.z_m[i] == room.depth.z_m[i]) {
      EXPECT_EQ(frame.incidence_cos[i], room.incidence_cos[i]);
      ++same;
    } else {
      ++nearer;
    }
  }
  // It faces +y: 0.6 m deep and 0.4 m wide there, its front at x = 2.7, and 1.8 m of it is seen.
  EXPECT_NEAR(nearer, 0.4 / 2.7 * 481.2 * 1.8 / 2.7 * 481.2, 40000.0);
  EXPECT_GT(same, 200'000);
  EXPECT_LT(elsewhere, 500);
  EXPECT_NEAR(frame.depth.At(319 - static_cast<int>(0.5 / 2.7 * 481.2), 239), 2.7F, 1e-4F);
  // The same depth where nobody asks for angles.
  DepthFrame plain{camera.Render(kPose), {}};
  MoverCamera(movers, pinhole).DrawOver(kPose, places, plain);
  EXPECT_EQ(plain.depth.z_m, frame.depth.z_m);
}

TEST(MoverScene, DistanceIsToTheSurfaceAndNothingInside) {
  const Scene scene = RoomWith(MakeBox({2.0, 2.0, 2.0}));
  const MoverScene movers(scene, RayIsa::kAvx2);
  const MoverPlace place = movers.At(StandingFor(1), 0)[0];  // its middle is (3, 0)
  EXPECT_NEAR(movers.DistanceM(place, {1.5, 0, 1}, 5.0), 0.5, 1e-5);
  EXPECT_NEAR(movers.DistanceM(place, {1.5, 0, 1}, 0.3), 0.3, 1e-5);
  EXPECT_EQ(movers.DistanceM(place, {3.0, 0.2, 1}, 5.0), 0.0);
  EXPECT_EQ(movers.DistanceM(place, {3.9, 0.9, 0.1}, 5.0), 0.0);
  EXPECT_NEAR(movers.DistanceM(place, {3.0, 0, 2.5}, 5.0), 0.5, 1e-5);
}

TEST(MoverScene, SaysWhereItMeetsTheCamera) {
  Scene scene = RoomWith(MakeBox({0.4, 0.4, 1.8}));
  scene.movers[0].options.waypoints = {{{0.0, -3.0}}, {{0.0, 3.0}}};
  const MoverScene movers(scene, RayIsa::kAvx2);
  // From 3 m away by half a metre a frame: its front is 0.3 m away in frame 5, around it in 6.
  const auto text = NearMoverText(StandingFor(13), scene, movers, 0.31);
  ASSERT_TRUE(text.has_value());
  EXPECT_THAT(*text, HasSubstr("frame 5 at (0.00, 0.00, 1.00) is 0.300 m from mover 'walker', must "
                               "be at least 0.310 m"));
  EXPECT_FALSE(NearMoverText(StandingFor(5), scene, movers, 0.31).has_value());
  const auto inside = NearMoverText(StandingFor(13), scene, movers, 0.1);
  ASSERT_TRUE(inside.has_value());
  EXPECT_THAT(*inside, HasSubstr("frame 6 at (0.00, 0.00, 1.00) is 0.000 m from mover 'walker'"));
}

TEST(MoverScene, SaysWhereItPassesThroughTheCamera) {
  // A screen of 2 cm across its way: half a metre before the camera, then half a metre behind it.
  Scene scene = RoomWith(MakeBox({0.02, 3.0, 1.8}));
  scene.movers[0].options.waypoints = {{{0.0, -2.75}}, {{0.0, 3.0}}};
  const MoverScene movers(scene, RayIsa::kAvx2);
  const auto text = NearMoverText(StandingFor(11), scene, movers, 0.1);
  ASSERT_TRUE(text.has_value());
  EXPECT_EQ(*text,
            "frame 6 at (0.00, 0.00, 1.00): mover 'walker' has gone through the camera since the "
            "frame before");
  EXPECT_FALSE(NearMoverText(StandingFor(6), scene, movers, 0.1).has_value());
  // Lower than the camera.
  scene.movers[0].mesh = MakeBox({0.02, 3.0, 0.8});
  EXPECT_FALSE(
      NearMoverText(StandingFor(11), scene, MoverScene(scene, RayIsa::kAvx2), 0.1).has_value());
}

// The camera goes through a screen that stands, its pose turned.
TEST(MoverScene, PassesIsToldInItsOwnAxes) {
  const Scene scene = RoomWith(MakeBox({0.02, 3.0, 1.8}));
  const MoverScene movers(scene, RayIsa::kAvx2);
  MoverPlace place = movers.At(StandingFor(1), 0)[0];
  const Eigen::Vector3d forward = place.world_from_mover.rotation * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d at = place.world_from_mover.translation + Eigen::Vector3d(0, 0, 1);
  EXPECT_TRUE(movers.Passes(place, at - 0.3 * forward, place, at + 0.3 * forward));
  EXPECT_FALSE(movers.Passes(place, at - 0.3 * forward, place, at - 0.1 * forward));
  // Both move alike.
  MoverPlace next = place;
  next.world_from_mover.translation += forward;
  EXPECT_FALSE(movers.Passes(place, at - 0.3 * forward, next, at + 0.7 * forward));
  EXPECT_TRUE(movers.Passes(place, at + 0.3 * forward, next, at + 0.7 * forward));
}

int DifferingPixels(const RgbImage& a, const RgbImage& b) {
  int differing = 0;
  for (int v = 0; v < a.height_px; ++v) {
    for (int u = 0; u < a.width_px; ++u) {
      int most = 0;
      for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(a.At(u, v)[k] - b.At(u, v)[k]));
      differing += most > 3 ? 1 : 0;
    }
  }
  return differing;
}

TEST(ColourCamera, DrawsMoversWhereTheyAre) {
  Scene scene = RoomWith(MakeBox({0.4, 0.6, 1.8}));
  scene.materials[0].texture = TextureKind::kPlain;
  scene.lighting.lights.push_back({{0, 2, 2.5}, {2, 2, 2}});
  const MoverScene movers(scene, RayIsa::kAvx2);
  const auto places = movers.At(StandingFor(2), 1);
  ColourCamera camera(scene, PinholeCamera{});
  const ColourFrame frame = camera.Render(kPose, places);
  ColourCamera frozen(Frozen(scene, places[0]), PinholeCamera{});
  const ColourFrame expected = frozen.Render(kPose);
  EXPECT_LT(DifferingPixels(frame.rgb, expected.rgb), 300);
  int elsewhere = 0;
  for (std::size_t i = 0; i < frame.depth.z_m.size(); ++i) {
    elsewhere += std::abs(frame.depth.z_m[i] - expected.depth.z_m[i]) < 1e-4F ? 0 : 1;
  }
  EXPECT_LT(elsewhere, 500);
  // Without any it is the scene that has none.
  scene.movers.clear();
  ColourCamera without(scene, PinholeCamera{});
  const ColourFrame empty = camera.Render(kPose);
  EXPECT_EQ(empty.rgb, without.Render(kPose).rgb);
  EXPECT_GT(DifferingPixels(frame.rgb, empty.rgb), 10'000);
}

// It carries its pattern along: to a camera that goes with it, it looks the same everywhere.
TEST(ColourCamera, PatternsGoWithMovers) {
  Scene scene = RoomWith(MakeBox({0.6, 0.6, 1.8}));
  scene.mesh = {};
  scene.movers[0].options.ahead_m = 2.0;
  scene.materials[0].texture = TextureKind::kChecker;
  scene.materials[0].scale_m = 0.11F;
  scene.materials[0].second_colour = {0, 0, 0};
  scene.materials[0].glow = 1.0F;
  scene.lighting.ambient = {0, 0, 0};
  const MoverScene movers(scene, RayIsa::kAvx2);
  ColourCamera camera(scene, PinholeCamera{});
  const auto image_from = [&](const Pose2& base) {
    const Trajectory here = {{0.0, CameraOf(base, 1.0)}};
    return camera.Render(here[0].world_from_camera, movers.At(here, 0)).rgb;
  };
  const RgbImage image = image_from({0, 0, 0});
  EXPECT_LT(DifferingPixels(image, image_from({0.37, -0.21, 0.0})), 300);
  EXPECT_LT(DifferingPixels(image, image_from({0.37, -0.21, 1.2})), 300);
}

}  // namespace
}  // namespace depthgrid
