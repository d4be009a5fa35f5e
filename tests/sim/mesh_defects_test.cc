// Mesh files that were read as something else than they hold, and sound ones that were refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "sim/mesh/mesh_file.h"
#include "sim/mesh/triangle_mesh.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

class MeshDefects : public TemporaryFolderTest {
 protected:
  TriangleMesh MeshOf(const std::string& name, const std::string& text) {
    Write(name, text);
    return ReadMeshFile(Path(name)).mesh;
  }
  std::string Refusal(const std::string& name, const std::string& text) {
    return Short(RefusalOf([&] { MeshOf(name, text); }));
  }
};

std::string LittleEndian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xFFU);
  return text;
}

// One triangle of 1 by 2 in its plane, the corners in `uri`, the indices left out.
std::string TriangleJson(const std::string& uri, const std::string& more) {
  return "{\"asset\":{\"version\":\"2.0\"}," + more +
         "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{"
         "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"buffers\":[{" +
         uri +
         "\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{"
         "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
         "\"max\":[1,2,0]}]}";
}

std::string TriangleBytes() {
  std::string bytes(36, '\0');
  bytes.replace(12, 4, std::string("\0\0\x80\x3F", 4));  // 1 in x of the second
  bytes.replace(28, 4, std::string("\0\0\0\x40", 4));    // 2 in y of the third
  return bytes;
}

std::string TriangleGlb(const std::string& more, char padding = ' ') {
  std::string json = TriangleJson("", more);
  while (json.size() % 4 != 0) json += padding;
  const std::string data = TriangleBytes();
  return "glTF" + LittleEndian(2, 4) + LittleEndian(12 + 8 + json.size() + 8 + data.size(), 4) +
         LittleEndian(json.size(), 4) + "JSON" + json + LittleEndian(data.size(), 4) +
         std::string("BIN\0", 4) + data;
}

std::string Requiring(const std::string& names) {
  return "\"extensionsUsed\":[" + names + "],\"extensionsRequired\":[" + names + "],";
}

TEST_F(MeshDefects, RequiredExtensionsThatChangeTheGeometryAreRefused) {
  Write("corners.bin", TriangleBytes());
  const auto gltf = [](const std::string& more) {
    return TriangleJson("\"uri\":\"corners.bin\",", more);
  };
  for (const std::string name : {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
                                 "EXT_meshopt_compression", "X_of_nobody"}) {
    const std::string more = Requiring("\"KHR_materials_unlit\",\"" + name + "\"");
    const std::string rule =
        ": extensionsRequired has '" + name + "', which is not supported: save the mesh without it";
    EXPECT_EQ(Refusal("t.gltf", gltf(more)), "~/t.gltf" + rule);
    EXPECT_EQ(Refusal("t.glb", TriangleGlb(more)), "~/t.glb" + rule);
  }
  for (const std::string& more :
       {std::string(), std::string("\"extensionsUsed\":[\"X_of_nobody\"],"),
        std::string("\"extras\":{\"extensionsRequired\":[\"X_of_nobody\"]},"),
        Requiring("\"KHR_materials_unlit\",\"KHR_texture_transform\"")}) {
    EXPECT_EQ(Refusal("t.gltf", gltf(more)), "no error") << more;
    EXPECT_EQ(Refusal("t.glb", TriangleGlb(more)), "no error") << more;
  }
  EXPECT_EQ(Refusal("t.glb", TriangleGlb("", '\0')), "no error");
  EXPECT_EQ(Refusal("t.gltf", "{\"asset\": x}"),
            "~/t.gltf: byte 11 of its JSON is wrong, must be whole JSON in UTF-8");
}

TEST_F(MeshDefects, NamesInAGltfMayBePercentEncoded) {
  Write("cörners 1.bin", TriangleBytes());
  for (const std::string name : {"c%C3%B6rners%201.bin", "cörners 1.bin", "c%c3%b6rners 1.bin"}) {
    const TriangleMesh mesh = MeshOf("t.gltf", TriangleJson("\"uri\":\"" + name + "\",", ""));
    EXPECT_EQ(mesh.triangles.size(), 1U);
    EXPECT_NEAR(BoundsOf(mesh).max().z(), 2.0F, 1e-6F);
  }
  // A name that is on the disk as it stands is that file's.
  Write("a%20b.bin", TriangleBytes());
  EXPECT_EQ(Refusal("t.gltf", TriangleJson("\"uri\":\"a%20b.bin\",", "")), "no error");
  EXPECT_THAT(Refusal("t.gltf", TriangleJson("\"uri\":\"%zz%2\",", "")),
              HasSubstr("is not a readable mesh"));
}

TEST_F(MeshDefects, TextMayBeginWithAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  Write("m.mtl", mark + "newmtl red\nKd 1 0 0\n");
  const std::string text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nusemtl red\nf 1 2 3\n";
  Write("t.obj", mark + text.substr(text.find('v')));
  const TriangleMesh first_line_is_a_vertex = ReadMeshFile(Path("t.obj")).mesh;
  EXPECT_NEAR(BoundsOf(first_line_is_a_vertex).max().y(), 2.0F, 1e-6F);
  Write("t.obj", mark + text);
  const MeshFile file = ReadMeshFile(Path("t.obj"));
  EXPECT_EQ(file.materials.at(file.mesh.material_of_triangle.at(0)).name, "red");
  Write("corners.bin", TriangleBytes());
  EXPECT_EQ(Refusal("t.gltf", mark + TriangleJson("\"uri\":\"corners.bin\",", "")), "no error");
}

// A vertex that is not equal to itself is lost where equal ones are joined.
TEST_F(MeshDefects, AVertexThatIsNotFiniteIsAlwaysRefused) {
  for (const std::string wild : {"nan", "inf", "-inf", "1e999"}) {
    for (const std::string face : {"f 1 2 3", "f 1 2 3 4", "f 4 3 2", "f 1 2 3 4 5"}) {
      EXPECT_EQ(Refusal("t.obj",
                        "v 0 0 0\nv " + wild + " 0 0\nv 6 5 0\nv 0 5 0\nv -1 1 0\n" + face + "\n"),
                fmt::format("~/t.obj: vertex {} is not finite", face == "f 4 3 2" ? 2 : 1));
    }
  }
}

std::string AsciiStl(int facets) {
  std::string text = "solid endsolid\n";
  for (int i = 0; i < facets; ++i) {
    text += fmt::format(
        "facet normal 0 0 1\nouter loop\nvertex {0} 0 0\nvertex {0} 1 0\nvertex 0 1 {0}\n"
        "endloop\nendfacet\n",
        i + 1);
  }
  return text;
}

TEST_F(MeshDefects, AnStlThatWasCutOffIsRefused) {
  const std::string whole = AsciiStl(4);
  for (const std::string end : {"endsolid", "endsolid facet\n", "  endsolid solid\r\n\r\n"}) {
    EXPECT_EQ(MeshOf("t.stl", whole + end).triangles.size(), 4U);
  }
  EXPECT_EQ(MeshOf("t.stl", whole + "endsolid a\n" + AsciiStl(2) + "endsolid b\n").triangles.size(),
            6U);
  const std::string refusal = "~/t.stl: ends without 'endsolid': it was cut off";
  EXPECT_EQ(Refusal("t.stl", whole), refusal);
  EXPECT_EQ(Refusal("t.stl", whole.substr(0, whole.size() / 2)), refusal);
  EXPECT_EQ(Refusal("t.stl", whole + "endsolid a\n" + AsciiStl(2)), refusal);
}

TEST_F(MeshDefects, ABinaryStlHasTheSizeThatItStates) {
  int heads = 0;
  for (const std::string head : {"made by a test", "solid made by a test"}) {
    std::string stl = head + std::string(80 - head.size(), ' ') + LittleEndian(2, 4);
    for (int i = 0; i < 2; ++i) {
      stl += std::string(12, '\0') + TriangleBytes() + std::string(2, '\0');
    }
    EXPECT_EQ(MeshOf("t.stl", stl).triangles.size(), 2U);
    const std::string rule = " bytes, must be 184 for the 2 triangles that its header states";
    EXPECT_EQ(Refusal("t.stl", stl.substr(0, 150)), "~/t.stl: is 150" + rule);
    EXPECT_EQ(Refusal("t.stl", stl + "more"), "~/t.stl: is 188" + rule);
    EXPECT_EQ(Refusal("t.stl", stl.substr(0, 83)),
              "~/t.stl: is 83 bytes, must be at least the 84 of a binary STL's header");
    ++heads;
  }
  EXPECT_EQ(heads, 2);
}

}  // namespace
}  // namespace depthgrid
