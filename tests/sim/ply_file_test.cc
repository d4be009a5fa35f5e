// What is wrong with a PLY file, and where. How it is read: mesh_file_test.cc.
#include "sim/mesh/ply_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/sim/mesh_files.h"

namespace depthgrid {
namespace {

using ::testing::StartsWith;

class PlyFiles : public MeshFiles {};

TEST_F(PlyFiles, ErrorsNameTheElementAndItsLine) {
  const auto edited = [](const std::string& from, const std::string& to) {
    std::string text = kPly;
    return text.replace(text.find(from), from.size(), to);
  };
  // Of faces that come before the vertices only the end shows whether they have them.
  EXPECT_EQ(ErrorOf("a.ply", edited("3 1 2 3", "3 1 2 4")),
            "face 3 uses vertex 4, must be below their number, 4");
  EXPECT_EQ(ErrorOf("a.ply", edited("3 0 1 3", "3 0 1.5 3")),
            "15: face 1 uses vertex '1.5', must be a whole number from 0");
  EXPECT_EQ(ErrorOf("a.ply", edited("3 1 2 3", "3 1 2 -1")),
            "17: face 3 uses vertex '-1', must be a whole number from 0");
  EXPECT_EQ(ErrorOf("a.ply", edited("3 1 2 3", "9 1 2 3")),
            "ends within face 3, must have 4 of them (line 7)");
  EXPECT_EQ(ErrorOf("a.ply", edited("3 1 2 3", "-3 1 2 3")),
            fmt::format("17: face 3 has -3 values of 'vertex_indices', must be from 0 to {}: the "
                        "file has no more bytes",
                        std::strlen(kPly) + 1));
  EXPECT_EQ(ErrorOf("a.ply", edited("0 0 3\n", "0 0 nan\n")),
            "13: vertex 3 is (0, 0, nan), must be finite in 32 bits");
  EXPECT_EQ(ErrorOf("a.ply", edited("0 2 0\n", "0 2 1e999\n")),
            "12: vertex 2 is (0, 2, inf), must be finite in 32 bits");
  EXPECT_EQ(ErrorOf("a.ply", edited("0 0 3\n", "0 0 x\n")),
            "13: vertex 3 has 'x', must be a number");
  EXPECT_EQ(ErrorOf("a.ply", edited("0 0 3\n", "0 0 +-3\n")),
            "13: vertex 3 has '+-3', must be a number");
  EXPECT_EQ(ErrorOf("a.ply", edited("0 0 3\n", "0 0 +3\n")), "no error");
  EXPECT_THAT(ErrorOf("a.ply", edited("vertex 4", "vertex 4000000000")),
              StartsWith("3: element 'vertex' has 4000000000 entries of at least 3 bytes each, "
                         "must fit into the "));
  EXPECT_EQ(ErrorOf("a.ply", edited("float z", "float w")),
            "3: element 'vertex' has no property 'z', must have x, y and z");
  EXPECT_EQ(ErrorOf("a.ply", edited("element face", "element edge 1\nelement face")),
            "7: element 'edge' has no properties, must have some");
}

TEST_F(PlyFiles, ErrorsInABinaryOneNameTheElement) {
  std::string text = BinaryPly(false);
  const std::size_t data = text.find("end_header\n") + 11;
  const std::string cut = text.substr(0, text.size() - 5);
  EXPECT_EQ(ErrorOf("b.ply", cut), "ends within vertex 3, must have 4 of them (line 9)");
  text.replace(text.size() - 4, 4, "\xff\xff\xff\xff");
  EXPECT_EQ(ErrorOf("b.ply", text), "vertex 3 is (0, -nan, 3), must be finite in 32 bits");
  text = BinaryPly(false);
  text[data + 1] = 9;
  EXPECT_EQ(ErrorOf("b.ply", text), "face 0 uses vertex 9, must be below their number, 4");
}

TEST_F(PlyFiles, ErrorsInTheHeaderQuoteTheLineOrWord) {
  const auto error_of = [&](const std::string& from, const std::string& to) {
    std::string text = kPly;
    return ErrorOf("a.ply", text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(error_of("ascii", "utf8"),
            "2: 'utf8' is no format, must be ascii, binary_little_endian or binary_big_endian");
  EXPECT_EQ(error_of("float z", "flaot z"),
            "6: 'flaot' is no type of numbers, must be one such as float, double, uchar or int");
  EXPECT_EQ(error_of("uchar int", "uchar integer"),
            "8: 'integer' is no type of numbers, must be one such as float, double, uchar or int");
  EXPECT_EQ(error_of("vertex 4", "vertex four"),
            "3: 'four' is no number of elements, must be a whole number");
  EXPECT_EQ(error_of("property float z", "property z\r"),
            "6: 'property z' must be property TYPE NAME or property list TYPE TYPE NAME");
  EXPECT_EQ(error_of("property float x", "propertie float x"),
            "4: 'propertie float x' must be a format, comment, obj_info, element, property or "
            "end_header line");
}

}  // namespace
}  // namespace depthgrid
