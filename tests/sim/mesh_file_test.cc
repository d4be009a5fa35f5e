#include "sim/mesh/mesh_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "mapper/core/error.h"
#include "sim/scene/scene.h"
#include "tests/refusal.h"
#include "tests/sim/mesh_files.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A tetrahedron with legs 1, 2, 3 along x, y, z, seen counter-clockwise from outside.
constexpr const char* kObj =
    "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
constexpr const char* kStl =
    "solid t\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 2 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 3\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 3\nvertex 0 2 0\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 2 0\nvertex 0 0 3\nendloop\nendfacet\n"
    "endsolid t\n";

// A Collada tetrahedron, its node moved 10 units along the file's x and mirrored there.
std::string Dae(const std::string& up, const std::string& metres_per_unit) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset><unit meter=\"" +
         metres_per_unit + "\"/><up_axis>" + up +
         "</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<float_array id=\"a\" count=\"12\">0 0 0 1 0 0 0 2 0 0 0 3</float_array>"
         "<technique_common><accessor source=\"#a\" count=\"4\" stride=\"3\">"
         "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
         "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
         "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
         "<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
         "<matrix>-1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

std::string Base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : digits[block >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

std::string TetrahedronBytes() {
  std::string bytes;
  for (const float f : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 2.F, 0.F, 0.F, 0.F, 3.F}) Put(bytes, f);
  for (const int i : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) {
    Put(bytes, static_cast<std::uint16_t>(i));
  }
  return bytes;
}

std::string GltfJson(const std::string& uri) {
  return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
         "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
         "\"indices\":1}]}],\"buffers\":[{" +
         uri +
         "\"byteLength\":72}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
         "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"accessors\":[{\"bufferView\":0,"
         "\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,2,3]},"
         "{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}]}";
}

std::string Gltf() {
  return GltfJson("\"uri\":\"data:application/octet-stream;base64," + Base64(TetrahedronBytes()) +
                  "\",");
}

std::string Glb() {
  std::string json = GltfJson("");
  while (json.size() % 4 != 0) json += ' ';
  const std::string data = TetrahedronBytes();
  std::string glb = "glTF";
  Put(glb, std::uint32_t{2});
  Put(glb, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + data.size()));
  Put(glb, static_cast<std::uint32_t>(json.size()));
  glb += "JSON" + json;
  Put(glb, static_cast<std::uint32_t>(data.size()));
  glb += std::string("BIN\0", 4) + data;
  return glb;
}

void ExpectTetrahedron(const TriangleMesh& mesh, const Eigen::Vector3f& low,
                       const Eigen::Vector3f& high) {
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.vertices.size(), 4U);  // joined
  EXPECT_TRUE(BoundsOf(mesh).min().isApprox(low, 1e-5F)) << BoundsOf(mesh).min().transpose();
  EXPECT_TRUE(BoundsOf(mesh).max().isApprox(high, 1e-5F)) << BoundsOf(mesh).max().transpose();
  EXPECT_NEAR(test::SignedVolume(mesh), (high - low).prod() / 6.0F, 1e-5);  // faces outward
}

TEST_F(MeshFiles, EachFormatGivesTheSameSolid) {
  for (const auto& [name, text] : {std::pair{"t.obj", kObj}, {"t.ply", kPly}, {"T.STL", kStl}}) {
    SCOPED_TRACE(name);
    ExpectTetrahedron(ReadMeshFile(Write(name, text)).mesh, {0, 0, 0}, {1, 2, 3});
  }
  ExpectTetrahedron(ReadMeshFile(Write("l.ply", BinaryPly(false))).mesh, {0, 0, 0}, {1, 2, 3});
  ExpectTetrahedron(ReadMeshFile(Write("b.ply", BinaryPly(true))).mesh, {0, 0, 0}, {1, 2, 3});
  // +y up in the file: its y becomes z, its z becomes -y.
  ExpectTetrahedron(ReadMeshFile(Write("t.gltf", Gltf())).mesh, {0, -3, 0}, {1, 0, 2});
  ExpectTetrahedron(ReadMeshFile(Write("t.glb", Glb())).mesh, {0, -3, 0}, {1, 0, 2});
}

TEST_F(MeshFiles, ColladaSaysItsUpAxisAndUnitAndPlacesItsNodes) {
  ExpectTetrahedron(ReadMeshFile(Write("z.dae", Dae("Z_UP", "1"))).mesh, {9, 0, 0}, {10, 2, 3});
  ExpectTetrahedron(ReadMeshFile(Write("y.dae", Dae("Y_UP", "1"))).mesh, {9, -3, 0}, {10, 0, 2});
  ExpectTetrahedron(ReadMeshFile(Write("cm.dae", Dae("Z_UP", "0.5"))).mesh, {4.5, 0, 0},
                    {5, 1, 1.5});
  // Said otherwise by hand: the file's y is up whatever it states.
  ExpectTetrahedron(ReadMeshFile(Write("u.dae", Dae("Z_UP", "1")), 1.0, UpAxis::kY).mesh,
                    {9, -3, 0}, {10, 0, 2});
}

TEST_F(MeshFiles, ScaleAndUpAxisAreTheCallers) {
  const std::string path = Write("t.obj", kObj);
  ExpectTetrahedron(ReadMeshFile(path, 0.5).mesh, {0, 0, 0}, {0.5, 1, 1.5});
  ExpectTetrahedron(ReadMeshFile(path, 1.0, UpAxis::kY).mesh, {0, -3, 0}, {1, 0, 2});
  ExpectTetrahedron(ReadMeshFile(path, 1.0, UpAxis::kX).mesh, {0, 0, 0}, {2, 3, 1});
}

TEST_F(MeshFiles, QuadsAreCutAndMaterialsKept) {
  Write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.5 0.5 0.5\n");
  const MeshFile file = ReadMeshFile(
      Write("q.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\n"));
  EXPECT_EQ(file.mesh.triangles.size(), 2U);
  const Material& material = file.materials.at(file.mesh.material_of_triangle.at(0));
  EXPECT_EQ(material.name, "red");
  EXPECT_EQ(material.colour, Eigen::Vector3f(1, 0, 0));
}

TEST_F(MeshFiles, ErrorsAreOneLineNamingTheFile) {
  EXPECT_EQ(ErrorOf("e.ply", ""), "is empty");
  EXPECT_EQ(ErrorOf("t.xyz", kObj), "is not a mesh file (.obj .ply .stl .gltf .glb .dae)");
  EXPECT_EQ(ErrorOf("points.ply",
                    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                    "property float z\nend_header\n0 0 0\n"),
            "has no triangles");
  EXPECT_THAT(ErrorOf("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("vertex 0 is not finite"));
  std::string cut = kPly;
  cut.resize(cut.size() / 2);
  int broken = 0;
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"a.ply", "no ply at all"},
                                   {"b.obj", "\x01\x02\x03"},
                                   {"c.stl", "solid but cut off"},
                                   {"d.gltf", "{\"asset\":"},
                                   {"e.glb", "glTF"},
                                   {"f.dae", "<COLLADA>"},
                                   {"g.dae", "not xml"},
                                   {"h.ply", cut},
                                   {"i.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"}}) {
    EXPECT_NE(ErrorOf(name, text), "no error") << name;
    ++broken;
  }
  EXPECT_EQ(broken, 9);
  EXPECT_THROW(ReadMeshFile(Path("missing.obj")), InputError);
  EXPECT_THROW(ReadMeshFile(folder_), InputError);
}

// Assimp would take all memory for some of these and read beyond its own for others.
TEST_F(MeshFiles, CountsThatADaeCannotHoldAreRefused) {
  const std::string sound = Dae("Z_UP", "1");
  const auto edited = [&](const std::string& from, const std::string& to) {
    std::string text = sound;
    return ErrorOf("a.dae", text.replace(text.find(from), from.size(), to));
  };
  const std::string rule = fmt::format(
      "', must be a whole number, and at most {}: the file has no more bytes", sound.size() + 8);
  EXPECT_EQ(edited("count=\"12\"", "count=\"4000000000\""),
            "1: count of float_array is '4000000000" + rule);
  EXPECT_EQ(edited("count=\"4\">", "count=\"400000000\">"),
            "1: count of triangles is '400000000" + rule);
  EXPECT_EQ(edited("offset=\"0\"", "offset=\"400000000\""),
            "1: offset of input is '400000000" + rule);
  EXPECT_EQ(edited("stride=\"3\"", "stride = '300000000'"),
            "1: stride of accessor is '300000000', must be a whole number, and at most " +
                std::to_string(sound.size() + 10) + ": the file has no more bytes");
  EXPECT_THAT(edited("count=\"4\">", "count=\"-4\">"), StartsWith("1: count of triangles is '-4'"));
  EXPECT_EQ(edited("stride=\"3\"", "stride=\"90\""),
            "1: accessor uses value 270 of a, which has 12");
  EXPECT_EQ(edited("<technique_common><accessor source=\"#a\" count=\"4\"",
                   "\n\n<technique_common><accessor source=\"#a\" count=\"6\""),
            "3: accessor uses value 15 of a, which has 12");
  EXPECT_EQ(ErrorOf("a.dae", sound), "no error");
}

// Assimp never gets past what is no number, and takes memory all the while.
TEST_F(MeshFiles, IndicesOfADaeThatAreNoNumbersAreRefused) {
  const std::string sound = Dae("Z_UP", "1");
  const std::string list = "<p>0 2 1";
  const auto with = [&](const std::string& to) {
    std::string text = sound;
    return text.replace(text.find(list), list.size(), to);
  };
  for (const std::string word : {"nan", "inf", "abc", "1e3", "1.0", "-1", "+1", "1,2", "&#48;"}) {
    EXPECT_THAT(ErrorOf("a.dae", with("<p>0\n2 " + word)),
                StartsWith("2: <p> has '" + word + "', must be a whole number from 0 to "));
  }
  EXPECT_THAT(ErrorOf("a.dae", with("<p>0 2 99999999999")), StartsWith("1: <p> has '99999999999'"));
  EXPECT_THAT(ErrorOf("a.dae", with("<p><![CDATA[0 2 x]]>")), StartsWith("1: <p> has 'x'"));
  EXPECT_THAT(ErrorOf("a.dae", with("<p name='>'>0 2 x")), StartsWith("1: <p> has 'x'"));
  EXPECT_EQ(ErrorOf("a.dae", with("<!-- <p>0 2 x</p> --><p>0 2 1")), "no error");
  EXPECT_EQ(ErrorOf("a.dae", with("<p>\r\n\t0 2 1")), "no error");
  EXPECT_EQ(ErrorOf("a.dae", sound + std::string(1, '\0')),
            "has a zero byte, must be text in UTF-8");
}

// Each number fits, all of them together do not.
TEST_F(MeshFiles, CornersThatADaeCannotHoldAreRefused) {
  const auto with = [](const std::string& vcount) {
    std::string text = Dae("Z_UP", "1");
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"<triangles", "<polylist"},
                                   {"</triangles", "</polylist"},
                                   {"<p>", "<vcount>" + vcount + "</vcount><p>"}}) {
      text.replace(text.find(from), from.size(), to);
    }
    return text;
  };
  EXPECT_EQ(ErrorOf("a.dae", with("3 3 3 3")), "no error");
  EXPECT_THAT(ErrorOf("a.dae", with("3 3 x 3")), StartsWith("1: <vcount> has 'x'"));
  EXPECT_THAT(ErrorOf("a.dae", with("900 900 900 900")),
              StartsWith("1: polylist states 3600 corners of 1 indices each, must be "));
  std::string text = with("300 300 300 300");
  text.replace(text.find("offset=\"0\""), 10, "offset=\"9\"");
  EXPECT_THAT(ErrorOf("a.dae", text), StartsWith("1: polylist states 1200 corners of 10 indices"));
}

// Cut off anywhere, a file of any format is refused or gives what is whole, and never hangs.
TEST_F(MeshFiles, FilesCutOffAnywhereAreSurvived) {
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"t.ply", kPly},
                                   {"t.ply", BinaryPly(false)},
                                   {"t.obj", kObj},
                                   {"t.stl", kStl},
                                   {"t.dae", Dae("Z_UP", "1")},
                                   {"t.gltf", Gltf()},
                                   {"t.glb", Glb()}}) {
    for (std::size_t tenth = 1; tenth < 10; ++tenth) {
      ErrorOf(name, text.substr(0, text.size() * tenth / 10));
    }
  }
}

TEST_F(MeshFiles, AMeshFileIsASceneWhenItHasAFloor) {
  const std::string room = "v 0 0 1\nv 4 0 1\nv 4 3 1\nv 0 3 1\nf 1 2 3 4\n";
  EXPECT_EQ(LoadScene(Write("room.obj", room)).floor_z_m, 1.0);
  const auto error_of = [&](const std::string& text) {
    return RefusalOf([&] { LoadScene(Write("s.obj", text)); });
  };
  EXPECT_THAT(error_of("v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nf 1 2 3 4\n"), HasSubstr("no floor"));
  EXPECT_THAT(error_of("v 0 0 0\nv 4000 0 0\nv 4000 3000 0\nf 1 2 3\n"),
              HasSubstr("4000 m across, must be at most 2000"));
}

// Assimp quotes all that is left of the file.
TEST_F(MeshFiles, AMessageStaysShort) {
  std::string text = kStl;
  text.replace(text.find("vertex 0 0 0"), 12, "vertex x 0 0");
  for (int i = 0; i < 3; ++i) text += text;
  Write("long.stl", text);
  const std::string refusal =
      RefusalOf([&] { ReadMeshFile(Path("long.stl"), 1.0, UpAxis::kAuto); });
  EXPECT_THAT(Short(refusal), StartsWith("~/long.stl: is not a readable mesh: "));
  EXPECT_LT(Short(refusal).size(), 300U);
}

}  // namespace
}  // namespace depthgrid
