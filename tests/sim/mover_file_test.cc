// `movers` of a scene file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/depth/ray_scene.h"
#include "sim/scene/mover_scene.h"
#include "sim/scene/scene.h"
#include "tests/io/temporary_folder.h"
#include "tests/paths.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;

class MoverFiles : public TemporaryFolderTest {
 protected:
  // With these lines below `movers`, which is line 5.
  Scene Load(const std::string& movers) const {
    Write("s.yaml",
          "materials: {red: {colour: [255, 0, 0]}}\n"
          "groups: {pole: [{shape: cylinder, radius_m: 0.2}]}\n"
          "shapes:\n"
          "  - {shape: box, size: [4, 4, 0.5], at: [0, 0, 0.5]}\n"
          "movers:\n" +
              movers);
    return LoadScene(Path("s.yaml"));
  }
  // Of a mover with these lines, of which the first is line 7.
  std::string ErrorOf(const std::string& lines) const {
    return Short(RefusalOf([&] { Load("  tom:\n" + lines); }));
  }
};

const std::string kShapes = "    shapes: [{shape: use, group: pole, material: red}]\n";
const std::string kWay = "    waypoints: [{at: [0, 0]}, {at: [1, 0]}]\n";

TEST_F(MoverFiles, AreReadAndStandOnTheFloor) {
  const Scene scene = Load("  tom:\n" + kShapes +
                           "    waypoints: [{at: [0, 1]}, {at: [2, 1], wait_s: 3}]\n"
                           "    there_and_back: true\n    laps: 2.5\n    speed_mps: 0.5\n"
                           "    turn_rate_dps: 90\n    from_s: 4\n    stays: false\n"
                           "  ann:\n    shapes: [{shape: box}, {shape: sphere}]\n    ahead_m: 2\n");
  ASSERT_EQ(scene.movers.size(), 2U);
  const Mover& tom = scene.movers[0];
  EXPECT_EQ(tom.name, "tom");
  EXPECT_EQ(scene.materials[tom.mesh.material_of_triangle.front()].name, "red");
  EXPECT_EQ(tom.options.waypoints[1].at, (std::array<double, 2>{2, 1}));
  EXPECT_EQ(tom.options.waypoints[1].wait_s, 3.0);
  EXPECT_TRUE(tom.options.there_and_back);
  EXPECT_EQ(tom.options.laps, 2.5);
  EXPECT_EQ(tom.options.speed_mps, 0.5);
  EXPECT_EQ(tom.options.turn_rate_dps, 90.0);
  EXPECT_EQ(tom.options.from_s, 4.0);
  EXPECT_FALSE(tom.options.stays);
  EXPECT_EQ(scene.movers[1].options.ahead_m, 2.0);
  // What stands is as without them.
  EXPECT_EQ(scene.mesh.triangles.size(), 12U);
  EXPECT_EQ(scene.floor_z_m, 1.0);
  const MoverScene movers(scene, RayIsa::kAvx2);
  const auto places = movers.At({{0.0, {}}, {5.0, {}}}, 1);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0].world_from_mover.translation.z(), 1.0);
}

TEST_F(MoverFiles, ErrorsNameLineMoverAndRule) {
  EXPECT_EQ(ErrorOf("    from_s: 1\n"), "~/s.yaml:7: mover 'tom': has no shapes");
  EXPECT_EQ(ErrorOf("    shapes: [{shape: bx}]\n" + kWay).substr(0, 44),
            "~/s.yaml:7: mover 'tom': shape is 'bx', must");
  EXPECT_EQ(ErrorOf(kShapes),
            "~/s.yaml:7: mover 'tom': has 0 waypoints, must have at least 2, or ahead_m");
  EXPECT_EQ(ErrorOf(kShapes + "    waypoints: [{at: [0, 0]}]\n"),
            "~/s.yaml:7: mover 'tom': has 1 waypoint, must have at least 2, or ahead_m");
  EXPECT_EQ(ErrorOf(kShapes + "    waypoints:\n      - {at: [0, 0]}\n      - {wait_s: 1}\n"),
            "~/s.yaml:10: mover 'tom': at is missing, must be 2 numbers");
  EXPECT_EQ(ErrorOf(kShapes + "    waypoints: [{at: [0, 0, 0]}, {at: [1, 0]}]\n"),
            "~/s.yaml:8: mover 'tom': at is '[0, 0, 0]', must be a list of 2 numbers");
  EXPECT_EQ(ErrorOf(kShapes + "    waypoints: [{at: [0, 0], wait: 1}, {at: [1, 0]}]\n"),
            "~/s.yaml:8: mover 'tom': unknown key 'wait', did you mean 'wait_s'?");
  EXPECT_EQ(ErrorOf(kShapes + kWay + "    speed: 1\n"),
            "~/s.yaml:9: mover 'tom': unknown key 'speed', did you mean 'speed_mps'?");
  EXPECT_EQ(ErrorOf(kShapes + kWay + "    speed_mps: 0\n"),
            "~/s.yaml:9: mover 'tom': speed_mps is '0', must be from 0.001 to 10");
  EXPECT_EQ(ErrorOf(kShapes + kWay + "    laps: 2\n"),
            "~/s.yaml:7: mover 'tom': laps needs closed: true or there_and_back: true");
  EXPECT_EQ(ErrorOf(kShapes + kWay + "    closed: true\n"),
            "~/s.yaml:7: mover 'tom': closed has 2 waypoints, must have at least 3; there_and_back "
            "needs no more");
  EXPECT_EQ(
      ErrorOf(kShapes + kWay + "    closed: true\n    there_and_back: true\n"),
      "~/s.yaml:7: mover 'tom': closed and there_and_back are both true, must be one of them");
  EXPECT_EQ(ErrorOf(kShapes + kWay + "    ahead_m: 1\n"),
            "~/s.yaml:8: mover 'tom': waypoints is not for a mover with ahead_m, which goes where "
            "the camera looks");
  EXPECT_EQ(ErrorOf(kShapes + "    ahead_m: 0\n"),
            "~/s.yaml:8: mover 'tom': ahead_m is '0', must be from 0.1 to 100");
  EXPECT_EQ(ErrorOf(kShapes + "    waypoints: [{at: [0, 0]}, {at: [0, 0]}]\n"),
            "~/s.yaml:7: mover 'tom': two waypoints in a row are the same, at (0.00, 0.00, 0.00)");
  EXPECT_THAT(
      ErrorOf("    shapes: [{shape: box, size: [1500, 1, 1], scale: 2}]\n" + kWay),
      HasSubstr("~/s.yaml:7: mover 'tom': the mover is 3000 m across, must be at most 2000 m"));
  for (const char* name : {"all", "none", "a+b"}) {
    EXPECT_THAT(RefusalOf([&] { Load(std::string("  ") + name + ":\n" + kShapes + kWay); }),
                HasSubstr(std::string("mover '") + name + "': must be called otherwise"));
  }
  EXPECT_THAT(RefusalOf([&] { Load("  - tom\n"); }), HasSubstr("'movers' must be a map of keys"));
}

TEST_F(MoverFiles, SeveralFilesAreIncluded) {
  Write("a.yaml", "materials: {green: {colour: [0, 255, 0]}}\n");
  Write("b.yaml", "groups: {post: [{shape: box}]}\n");
  Write("s.yaml",
        "include: [a.yaml, b.yaml]\nshapes:\n  - {shape: use, group: post, material: green}\n");
  EXPECT_EQ(LoadScene(Path("s.yaml")).mesh.triangles.size(), 12U);
  Write("s.yaml", "include: [a.yaml, c.yaml]\nshapes: []\n");
  EXPECT_THAT(RefusalOf([&] { LoadScene(Path("s.yaml")); }),
              HasSubstr("s.yaml:1: include is 'c.yaml': no such file"));
  Write("s.yaml", "shapes: []\ninclude: [a.yaml, [b.yaml]]\n");
  EXPECT_THAT(RefusalOf([&] { LoadScene(Path("s.yaml")); }),
              HasSubstr("s.yaml:2: include is '[b.yaml]', must be a text"));
}

// Those who walk through the shipped rooms meet neither furniture nor the cameras.
TEST(ShippedScenes, PeopleHaveRoomToWalk) {
  int checked = 0;
  for (const char* name : {"living_room", "office_room"}) {
    SCOPED_TRACE(name);
    const Scene scene = LoadScene(ShippedSceneFile(name));
    ASSERT_EQ(scene.movers.size(), 2U);
    EXPECT_EQ(scene.movers[0].name, "crossing");
    EXPECT_EQ(scene.movers[1].name, "ahead");
    for (const Mover& mover : scene.movers) {
      EXPECT_NEAR(BoundsOf(mover.mesh).max().z(), 1.75F, 0.02F);
      EXPECT_NEAR(BoundsOf(mover.mesh).min().z(), 0.0F, 0.01F);
    }
    const MoverScene movers(scene, RayIsa::kAvx2);
    for (const auto& [path, options] : scene.trajectories) {
      for (const int frames : {MinimumFrames(options), std::max(900, MinimumFrames(options))}) {
        const Trajectory trajectory = MakeTrajectory(options, frames, kFrameRateHz, 1);
        EXPECT_EQ(NearMoverText(trajectory, scene, movers, options.clearance_m).value_or(""), "")
            << path;
        ++checked;
      }
    }
    const RayScene rays(scene.mesh);
    constexpr float kBodyM = 0.19F;
    const MoverPath path(scene.movers[0].options);
    for (double time_s = 0.0; time_s < path.RoundS(); time_s += 0.1) {
      const auto pose = path.At(scene.movers[0].options.from_s + time_s, {});
      ASSERT_TRUE(pose.has_value());
      for (const float height_m : {0.3F, 0.8F, 1.3F}) {
        const Eigen::Vector3f at(static_cast<float>(pose->x_m), static_cast<float>(pose->y_m),
                                 height_m);
        EXPECT_EQ(rays.DistanceToSurface(at, kBodyM), kBodyM) << at.transpose();
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 200);
}

}  // namespace
}  // namespace depthgrid
