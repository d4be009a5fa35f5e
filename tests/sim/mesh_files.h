// Mesh files as texts, and what reading them says.
#pragma once

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <string>

#include "mapper/core/error.h"
#include "sim/mesh/mesh_file.h"
#include "tests/io/temporary_folder.h"

namespace depthgrid {

// A tetrahedron with legs 1, 2, 3 along x, y, z, seen counter-clockwise from outside.
inline constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

template <typename T>
void Put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

// The same in binary, faces before vertices, with properties nobody asked for.
inline std::string BinaryPly(bool big_endian) {
  std::string ply = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                    "_endian 1.0\ncomment made by a test\nelement face 4\n"
                    "property list uint8 uint16 vertex_index\nproperty uchar red\n"
                    "element edge 1\nproperty short v\nelement vertex 4\nproperty double z\n"
                    "property float x\nproperty list uchar int tags\nproperty float y\n"
                    "end_header\n";
  const auto put = [&](auto value) {
    std::string bytes;
    Put(bytes, value);
    big_endian ? ply.append(bytes.rbegin(), bytes.rend()) : ply.append(bytes);
  };
  for (const auto& face : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    put(std::uint8_t{3});
    for (const int corner : face) put(static_cast<std::uint16_t>(corner));
    put(std::uint8_t{255});
  }
  put(std::int16_t{-5});
  for (const auto& v :
       {std::array{0.F, 0.F, 0.F}, {1.F, 0.F, 0.F}, {0.F, 2.F, 0.F}, {0.F, 0.F, 3.F}}) {
    put(static_cast<double>(v[2]));
    put(v[0]);
    put(std::uint8_t{2});
    put(std::int32_t{-1});
    put(std::int32_t{7});
    put(v[1]);
  }
  return ply;
}

class MeshFiles : public TemporaryFolderTest {
 protected:
  // Returns the path.
  std::string Write(const std::string& name, const std::string& text) {
    TemporaryFolderTest::Write(name, text);
    return Path(name);
  }
  std::string ErrorOf(const std::string& name, const std::string& text) {
    const std::string path = Write(name, text);
    try {
      ReadMeshFile(path);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      EXPECT_THAT(what, ::testing::StartsWith(path + ":"));
      return what.substr(path.size() + (what[path.size() + 1] == ' ' ? 2 : 1));
    }
    return "no error";
  }
};

}  // namespace depthgrid
