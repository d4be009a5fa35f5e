// The header of a PLY file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };
enum class PlyNumber { kSigned, kUnsigned, kFloat };

struct PlyType {
  PlyNumber kind = PlyNumber::kFloat;
  std::size_t bytes = 4;
};

struct PlyProperty {
  std::string name;
  std::optional<PlyType> count;  // type of a list's length; empty for a single number
  PlyType value;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;  // that announces it, from 1
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  // length of the header: the data begins here
};

bool IsPlySpace(char c);

// Throws InputError naming `path` and the line.
PlyHeader ReadPlyHeader(std::string_view text, const std::string& path);

}  // namespace depthgrid
