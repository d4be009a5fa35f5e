#include "sim/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "sim/depth/ray_scene.h"
#include "sim/mesh/floor.h"
#include "sim/path/trajectory.h"
#include "tests/io/temporary_folder.h"
#include "tests/paths.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A floor for scenes whose point is something else.
const std::string kFloor = "  - {shape: box, size: [4, 4, 0.5], at: [0, 0, -0.5]}\n";

class SceneFiles : public TemporaryFolderTest {
 protected:
  Scene Load(const std::string& text) {
    Write("s.yaml", text);
    return LoadScene(Path("s.yaml"));
  }
  // The message, with the folder as ~.
  std::string ErrorOf(const std::string& text) {
    try {
      Load(text);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return Short(error.what());
    }
    return "no error";
  }
};

TEST(ShippedScenes, AreFurnishedAndHaveRoomForTheirPaths) {
  struct Expected {
    const char* name;
    Eigen::Vector3f size_m;  // inside, between the walls
    std::size_t least_triangles;
  };
  for (const auto& [name, size_m, least_triangles] :
       {Expected{"living_room", {4.9F, 5.0F, 2.5F}, 100'000},
        Expected{"office_room", {5.0F, 7.0F, 2.4F}, 50'000},
        Expected{"office_floor", {30.0F, 20.0F, 2.6F}, 300'000}}) {
    SCOPED_TRACE(name);
    const Scene scene = LoadScene(ShippedSceneFile(name));
    EXPECT_EQ(scene.name, name);
    EXPECT_EQ(scene.floor_z_m, 0.0);
    ASSERT_TRUE(scene.ceiling_z_m.has_value());
    EXPECT_NEAR(*scene.ceiling_z_m, size_m.z(), 1e-6);
    EXPECT_GE(scene.mesh.triangles.size(), least_triangles);
    // Walls stand outside the room, a few tenths of a metre thick at most.
    const Eigen::Vector3f outside_m = BoundsOf(scene.mesh).sizes() - size_m;
    EXPECT_GT(outside_m.minCoeff(), 0.0F);
    EXPECT_LT(outside_m.maxCoeff(), 0.5F);
    const RayScene rays(scene.mesh);
    ASSERT_EQ(scene.trajectories.size(), 2U);
    for (const auto& [path, options] : scene.trajectories) {
      const auto distance_m = [&](const Eigen::Vector3d& p) {
        return rays.DistanceToSurface(p.cast<float>(), 2.0F);
      };
      const Trajectory trajectory =
          MakeTrajectory(options, MinimumFrames(options), kFrameRateHz, 1);
      EXPECT_NO_THROW(CheckClearance(trajectory, distance_m, options.clearance_m, path));
    }
  }
}

// From inside a closed room no ray reaches the sky, whichever way it goes.
TEST(ShippedScenes, RoomsAreClosed) {
  for (const auto& [name, middle] : {std::pair{"living_room", Eigen::Vector3f(2.5F, 3.6F, 1.3F)},
                                     {"office_room", Eigen::Vector3f(2.5F, 4.6F, 1.3F)},
                                     {"office_floor", Eigen::Vector3f(6.0F, 10.0F, 1.3F)}}) {
    const RayScene rays(LoadScene(ShippedSceneFile(name)).mesh);
    int escaped = 0;
    constexpr int kRays = 20000;
    for (int i = 0; i < kRays; ++i) {  // a Fibonacci sphere
      const double z = 1.0 - (2.0 * i + 1.0) / kRays;
      const double azimuth = 2.399963229728653 * i;
      const double r = std::sqrt(1.0 - z * z);
      const Eigen::Vector3d direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
      if (!rays.NearestHit({middle, direction.cast<float>()})) ++escaped;
    }
    EXPECT_EQ(escaped, 0) << name;
  }
}

TEST_F(SceneFiles, ErrorsOfTrajectoriesNameLineAndTrajectory) {
  const auto error = [&](const std::string& path) {
    return ErrorOf("shapes:\n" + kFloor + "trajectories:\n  tour:\n" + path);
  };
  EXPECT_EQ(error("    kind: plane\n"),
            "~/s.yaml:5: trajectory 'tour': kind is 'plane', must be one of handheld, planar (did "
            "you mean 'planar'?)");
  EXPECT_EQ(error("    kind: planar\n    waypoints: [{at: [1, 1]}]\n"),
            "~/s.yaml:5: trajectory 'tour': has 1 waypoint, must have at least 2");
  EXPECT_EQ(
      error("    kind: planar\n    waypoints:\n      - {at: [1, 1]}\n      - {at: [1, 1, 1]}\n"),
      "~/s.yaml:8: trajectory 'tour': at has 3 numbers, must have 2");
  EXPECT_EQ(error("    kind: planar\n    speed: 1\n    waypoints: [{at: [1, 1]}, {at: [2, 1]}]\n"),
            "~/s.yaml:6: trajectory 'tour': unknown key 'speed', did you mean 'speed_mps'?");
}

TEST_F(SceneFiles, GroupsArePlacedTurnedScaledAndRepeated) {
  const Scene scene = Load(
      "materials:\n  red: {colour: [255, 0, 0]}\n  blue: {colour: [0, 0, 255]}\n"
      "groups:\n"
      "  leg: [{shape: box, size: [0.1, 0.1, 1]}]\n"
      "  pair:\n"
      "    - {shape: use, group: leg, at: [1, 0, 0]}\n"
      "    - {shape: use, group: leg, at: [-1, 0, 0], material: blue}\n"
      "shapes:\n" +
      kFloor +
      "  - {shape: use, group: pair, at: [0, 0, 0.5], yaw_deg: 90, material: red, scale: 0.5,"
      " count: 2, step: [0, 0, 2]}\n");
  ASSERT_EQ(scene.mesh.triangles.size(), 12U * 5U);
  const auto colour_of = [&](std::size_t box) {
    return scene.materials[scene.mesh.material_of_triangle[12 * box]].name;
  };
  EXPECT_EQ(colour_of(0), "default");
  EXPECT_EQ(colour_of(1), "red");   // inherited from the use
  EXPECT_EQ(colour_of(2), "blue");  // its own
  const Eigen::AlignedBox3f bounds = BoundsOf(scene.mesh);
  EXPECT_NEAR(bounds.max().z(), 0.5 + 2.0 + 0.5, 1e-6);
  const Eigen::Vector3f corner = scene.mesh.vertices[8];  // (0.95, -0.05, 0) of the first leg
  EXPECT_TRUE(corner.isApprox(Eigen::Vector3f(0.025F, 0.475F, 0.5F), 1e-5F)) << corner.transpose();
}

TEST_F(SceneFiles, MeshFilesAndIncludesAreRelativeToTheFile) {
  Write("sub/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  Write("sub/parts.yaml",
        "materials: {green: {colour: [0, 255, 0]}}\n"
        "groups: {tile: [{shape: mesh, file: sub/t.obj, at: [0, 0, 1], scale: 2}]}\n");
  const Scene scene = Load("include: sub/parts.yaml\nshapes:\n" + kFloor +
                           "  - {shape: use, group: tile}\n"
                           "  - {shape: mesh, file: sub/t.obj, up: y, material: green}\n");
  EXPECT_EQ(scene.mesh.triangles.size(), 14U);
  EXPECT_EQ(scene.mesh.vertices[8 + 1], Eigen::Vector3f(2, 0, 1));
  EXPECT_EQ(scene.mesh.vertices[8 + 3 + 2], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(scene.materials[scene.mesh.material_of_triangle[13]].name, "green");
}

TEST_F(SceneFiles, ColoursLightsAndPathsAreRead) {
  const Scene scene = Load(
      "name: hall\nmaterials:\n"
      "  m: {colour: [255, 0, 0], texture: tiles, scale_m: 0.3, grain: z, gloss: 0.5, glow: 2}\n"
      "lighting:\n  ambient: [0, 0, 0]\n  lights: [{at: [1, 2, 3], strength: 4}]\n"
      "trajectories:\n  a: {kind: planar, waypoints: [{at: [0, 0]}, {at: [1, 0]}]}\n"
      "  b: {waypoints: [{at: [0, 0, 1], look_at: [1, 0, 1]}, {at: [1, 0, 1], look_at: [2, 0, "
      "1]}]}\n"
      "shapes:\n" +
      kFloor);
  EXPECT_EQ(scene.name, "hall");
  const Material& m = scene.materials.at(1);
  EXPECT_EQ(m.colour, Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(m.second_colour, Eigen::Vector3f(0.6F, 0, 0));
  EXPECT_EQ(m.texture, TextureKind::kTiles);
  EXPECT_EQ(m.grain, Axis::kZ);
  EXPECT_EQ(scene.lighting.ambient, Eigen::Vector3f::Zero());
  ASSERT_EQ(scene.lighting.lights.size(), 1U);
  EXPECT_EQ(scene.lighting.lights[0].at, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(scene.lighting.lights[0].intensity, Eigen::Vector3f(4, 4, 4));
  EXPECT_EQ(scene.trajectories.size(), 2U);
}

TEST_F(SceneFiles, NamesMayHoldDots) {
  const Scene scene = Load(
      "materials: {oak.dark: {colour: [255, 0, 0]}}\n"
      "groups: {stool.small: [{shape: box, material: oak.dark}]}\n"
      "trajectories:\n  tour.1: {kind: planar, waypoints: [{at: [0, 0]}, {at: [1, 0]}]}\n"
      "shapes:\n" +
      kFloor + "  - {shape: use, group: stool.small}\n");
  EXPECT_EQ(scene.materials.at(1).name, "oak.dark");
  EXPECT_EQ(scene.materials.at(1).colour, Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(scene.mesh.triangles.size(), 24U);  // the floor's and the stool's
  EXPECT_EQ(scene.trajectories.count("tour.1"), 1U);
}

TEST_F(SceneFiles, ErrorsAreOneLineWithPlaceAndRule) {
  EXPECT_EQ(ErrorOf(""), "~/s.yaml: is empty");
  EXPECT_EQ(ErrorOf("name: x\n"), "~/s.yaml: the scene has no triangles");
  EXPECT_EQ(ErrorOf("shapes: 3\n"), "~/s.yaml:1: 'shapes' must be a list");
  EXPECT_EQ(ErrorOf("shapes: [3]\n"), "~/s.yaml:1: each item of 'shapes' must be a map");
  EXPECT_EQ(ErrorOf("shape:\n  - {shape: box}\n"),
            "~/s.yaml:1: unknown key 'shape', did you mean 'shapes'?");
  EXPECT_THAT(ErrorOf("shapes:\n  - {size: [1, 1, 1]}\n"),
              HasSubstr("~/s.yaml:2: 'shape' is missing, must be one of box, cylinder"));
  EXPECT_THAT(ErrorOf("shapes:\n  - {shape: bx}\n"), HasSubstr("did you mean 'box'?"));
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: []}\n"), "~/s.yaml:2: shape is '[]', must be a text");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: [box]}\n"),
            "~/s.yaml:2: shape is '[box]', must be a text");
  EXPECT_EQ(ErrorOf("include: []\n"),
            "~/s.yaml:1: include is '[]', must be a file or a list of them");
  EXPECT_EQ(ErrorOf("shapes:\n" + kFloor + "  - {shape: box, sise: [1, 1, 1]}\n"),
            "~/s.yaml:3: unknown key 'sise', did you mean 'size'?");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: box, size: [1, 1]}\n"),
            "~/s.yaml:2: size is '[1, 1]', must be a list of 3 numbers");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: box, size: [1, 1, .nan]}\n"),
            "~/s.yaml:2: size is '.nan', must be from 0.0001 to 2000");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: box, radius_m: 0.7}\n"),
            "~/s.yaml:2: radius_m is '0.7', must be less than half the smallest side, 0.5");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: torus, tube_radius_m: 0.6}\n"),
            "~/s.yaml:2: tube_radius_m is '0.6', must be less than radius_m, 0.5");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: prism, outline: [[0, 0], [1, 1], [1, 0], [0, 1]]}\n"),
            "~/s.yaml:2: outline must have three corners or more and not cross itself");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: lathe, outline: [[-1, 0], [1, 1], [0, 1]]}\n"),
            "~/s.yaml:2: outline has the radius '-1', must be at least 0");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: tube, path: [[0, 0, 0]]}\n"),
            "~/s.yaml:2: path has 1 points, must have at least 2");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: wall, to: [0, 0]}\n"),
            "~/s.yaml:2: the wall's from and to coincide");
  EXPECT_EQ(ErrorOf("shapes:\n  - shape: wall\n    to: [3, 0]\n    openings:\n"
                    "      - {along_m: 2.5, width_m: 0.9}\n"),
            "~/s.yaml:5: the opening ends 3.4 m along and 2 m up, must lie within the wall of 3 x "
            "2.5 m");
}

TEST_F(SceneFiles, ErrorsOfReferencesNameTheNearest) {
  const std::string materials = "materials: {oak: {}}\n";
  EXPECT_EQ(ErrorOf(materials + "shapes:\n  - {shape: box, material: oac}\n"),
            "~/s.yaml:3: material 'oac' is not in 'materials', did you mean 'oak'?");
  EXPECT_EQ(ErrorOf("groups: {chair: []}\nshapes:\n  - {shape: use, group: chiar}\n"),
            "~/s.yaml:3: group 'chiar' is not in 'groups', did you mean 'chair'?");
  EXPECT_EQ(ErrorOf("groups: {a: [{shape: use, group: b}], b: [{shape: use, group: a}]}\n"
                    "shapes: [{shape: use, group: a}]\n"),
            "~/s.yaml:1: group 'a' uses itself");
  EXPECT_EQ(ErrorOf("include: parts.yaml\nshapes: []\n"),
            "~/s.yaml:1: include is 'parts.yaml': no such file");
  Write("parts.yaml", "shapes: []\n");
  const std::string rule = "unknown key 'shapes': an included file holds only materials and groups";
  EXPECT_EQ(ErrorOf("include: parts.yaml\n"), "~/parts.yaml:1: " + rule);
  Write("parts.yaml", materials + "shapes:\n  - {shape: box}\n");
  EXPECT_EQ(ErrorOf("include: parts.yaml\n"), "~/parts.yaml:2: " + rule);
  Write("parts.yaml", materials);
  EXPECT_EQ(ErrorOf("include: parts.yaml\n" + materials),
            "~/s.yaml:2: material 'oak' is given twice");
  EXPECT_EQ(ErrorOf("include: parts.yaml\nmaterials:\n  elm: {}\n  oak: {}\n"),
            "~/s.yaml:4: material 'oak' is given twice");
  Write("parts.yaml", "groups: {stool: []}\n");
  EXPECT_EQ(ErrorOf("include: parts.yaml\ngroups:\n  chair: []\n  stool: []\n"),
            "~/s.yaml:4: group 'stool' is given twice");
  EXPECT_EQ(ErrorOf("materials:\n  oak: {}\n  default: {}\n"),
            "~/s.yaml:3: material name 'default' is reserved for shapes without a material; choose "
            "another name");
  EXPECT_EQ(ErrorOf("shapes: [{shape: mesh, file: none.obj}]\n"),
            "~/s.yaml:1: file is 'none.obj': no such file");
  EXPECT_EQ(ErrorOf("shapes: [{shape: mesh}]\n"), "~/s.yaml:1: 'file' is missing");
  EXPECT_EQ(ErrorOf("materials: {a: {texture: wod}}\n"),
            "~/s.yaml:1: materials.a.texture is 'wod', must be one of plain, wood, checker, "
            "stripes, fabric, plaster, tiles, planks, carpet, paper, painting, stone (did you mean "
            "'wood'?)");
}

TEST_F(SceneFiles, ScenesOfInsaneSizeAreRefused) {
  EXPECT_EQ(
      ErrorOf("shapes:\n" + kFloor + "  - {shape: box, at: [2000, 0, 0], scale: 10}\n"),
      "~/s.yaml: the scene is 2007 m across, must be at most 2000 m; is it in other units than "
      "metres? A shape's scale changes them");
  EXPECT_EQ(ErrorOf("shapes:\n  - {shape: sphere, segments: 512, count: 10000}\n"),
            "~/s.yaml:2: more than 20000000 triangles");
  // Ten levels of ten: ten thousand million boxes.
  std::string nested = "groups:\n  g0: [{shape: box}]\n";
  for (int i = 1; i <= 10; ++i) {
    nested += "  g" + std::to_string(i) + ": [{shape: use, group: g" + std::to_string(i - 1) +
              ", count: 10}]\n";
  }
  EXPECT_THAT(ErrorOf(nested + "shapes: [{shape: use, group: g10}]\n"),
              HasSubstr("more than 20000000 triangles"));
}

TEST_F(SceneFiles, StepsNeedACount) {
  const auto with = [&](const std::string& keys) {
    return ErrorOf("groups:\n  g:\n    - {shape: box, " + keys +
                   "}\nshapes:\n  - {shape: use, group: g}\n" + kFloor);
  };
  EXPECT_EQ(with("step: [0, 2, 0]"), "~/s.yaml:3: step needs count");
  EXPECT_EQ(with("step_yaw_deg: 20"), "~/s.yaml:3: step_yaw_deg needs count");
  EXPECT_EQ(with("count: 2, step: [0, 2, 0], step_yaw_deg: 20"), "no error");
  EXPECT_EQ(with("count: 1, step: [0, 2, 0]"), "no error");
}

TEST_F(SceneFiles, AFloorIsStatedOrFound) {
  EXPECT_EQ(Load("shapes:\n" + kFloor).floor_z_m, 0.0);
  EXPECT_EQ(ErrorOf("floor_z_m: 0.3\nshapes:\n" + kFloor),
            "~/s.yaml: floor_z_m is '0.3', but no level surface facing up covers a quarter of "
            "the scene there (x -2.00 to 2.00, y -2.00 to 2.00, z -0.50 to 0.00 m)");
  // A mesh whose floor faces down has the one it is found to have.
  Write("down.obj", "v 0 0 0\nv 0 4 0\nv 4 0 0\nf 1 2 3\n");
  EXPECT_EQ(Load("floor_z_m: 0\nshapes: [{shape: mesh, file: down.obj}]\n").floor_z_m, 0.0);
  // A room that is the inside of a box.
  EXPECT_EQ(Load("shapes: [{shape: box, size: [5, 4, 2.5], at: [0, 0, 0.5]}]\n").floor_z_m, 0.5);
  // Thick walls and a roof, but nothing to stand on.
  EXPECT_THAT(
      ErrorOf("shapes:\n"
              "  - {shape: wall, to: [2, 0], thickness_m: 0.5, count: 2, step: [0, 2, 0]}\n"
              "  - {shape: box, size: [3, 3, 0.1], at: [1, 1, 2.5]}\n"),
      AllOf(HasSubstr("has no floor"), HasSubstr("z 0.00 to 2.60 m); in a scene file a box")));
}

TEST_F(SceneFiles, FarFromTheOriginAreRefused) {
  const auto plate_at = [&](const std::string& x0, const std::string& x1) {
    Write("plate.obj", "v " + x0 + " 0 0\nv " + x1 + " 0 0\nv " + x1 + " 4 0\nf 1 2 3\n");
    return ErrorOf("shapes: [{shape: mesh, file: plate.obj}]\n");
  };
  EXPECT_EQ(plate_at("9990", "9995"), "no error");
  EXPECT_EQ(
      plate_at("500000", "500005"),
      "~/s.yaml: the scene has a coordinate of 500005 m, must be at most 10000 m: beyond, single "
      "precision is coarser than a millimetre; move the mesh to the origin");
}

TEST(Files, OfOtherKindsAreNotScenes) {
  EXPECT_THROW(LoadScene("nowhere.yaml"), InputError);
  EXPECT_THROW(LoadScene("scene.txt"), InputError);
  EXPECT_THROW(LoadScene(std::string(kSourceFolder) + "/scenes/"), InputError);
}

TriangleMesh Plate(double width, double depth, double z, bool facing_up) {
  TriangleMesh mesh;
  const auto a = mesh.AddVertex({0, 0, z});
  const auto b = mesh.AddVertex({width, 0, z});
  const auto c = mesh.AddVertex({width, depth, z});
  const auto d = mesh.AddVertex({0, depth, z});
  facing_up ? mesh.AddQuad(a, b, c, d) : mesh.AddQuad(a, d, c, b);
  return mesh;
}

TEST(Floors, TheLowestLargeSurfaceFacingUpIsTheFloor) {
  TriangleMesh room = Plate(10, 10, -3.0, true);  // the floor
  Append(room, Plate(10, 10, -0.4, false));       // the ceiling
  Append(room, Plate(1, 1, -4.0, true));          // a pit, too small
  Append(room, Plate(3, 3, -2.2, true));          // a table
  Append(room, Plate(10, 10, -0.2, true));        // the roof
  EXPECT_EQ(FindFloor(room), -3.0);
  EXPECT_NEAR(FindCeiling(room, -3.0).value(), -0.4, 1e-7);
  EXPECT_TRUE(HasFloorAt(room, -3.0));
  EXPECT_FALSE(HasFloorAt(room, -2.5));
  EXPECT_FALSE(FindCeiling(Plate(10, 10, 0, true), 0.0).has_value());
  EXPECT_EQ(FindFloor(Plate(5, 5, 0.25, false)), 0.25);  // the wrong way round, and all there is
}

TEST(Floors, ACeilingIsThatOfTheStorey) {
  TriangleMesh house = Plate(10, 10, 0, true);
  Append(house, Plate(10, 10, 2.5, false));
  Append(house, Plate(10, 10, 2.65, true));
  Append(house, Plate(10, 10, 5.15, false));
  EXPECT_NEAR(FindCeiling(house, 0.0).value(), 2.5, 1e-6);
  EXPECT_NEAR(FindCeiling(house, 2.65).value(), 5.15, 1e-6);
  Append(house, Plate(10, 10, 5.25, true));
  EXPECT_NEAR(FindCeiling(house, 2.65).value(), 5.15, 1e-6);
  // A shelf's top has no ceiling below it.
  TriangleMesh hall = Plate(10, 10, 0, true);
  Append(hall, Plate(6, 6, 2, true));
  Append(hall, Plate(10, 10, 5, false));
  EXPECT_NEAR(FindCeiling(hall, 0.0).value(), 5.0, 1e-6);
}

TEST(Floors, UnevenTilesCountTogether) {
  TriangleMesh tiles;
  for (int i = 0; i < 20; ++i) {
    Eigen::Affine3d at = Eigen::Affine3d::Identity();
    at.translation() = Eigen::Vector3d(i, 0, 0.002 * (i % 5));
    Append(tiles, Transformed(Plate(1, 20, 0, true), at));
  }
  EXPECT_NEAR(FindFloor(tiles).value(), 0.004, 1e-6);  // the middle one
}

}  // namespace
}  // namespace depthgrid
