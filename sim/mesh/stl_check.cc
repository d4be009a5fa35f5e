#include "sim/mesh/stl_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "sim/mesh/scene_limits.h"

namespace depthgrid {
namespace {

// Binary layout: 80 arbitrary bytes, the number of triangles in 4 bytes, then 50 bytes per
// triangle.
constexpr std::size_t kStlCountAt = 80;
constexpr std::size_t kStlHeaderBytes = 84;
constexpr std::size_t kStlTriangleBytes = 50;

void RequireStatedSize(std::string_view file, const std::string& path) {
  if (file.size() < kStlHeaderBytes) {
    throw InputError(path, fmt::format("is {}, must be at least the {} of a binary STL's header",
                                       Counted(file.size(), "byte"), kStlHeaderBytes));
  }
  std::uint64_t triangles = 0;
  for (std::size_t i = 4; i-- > 0;) {
    triangles = triangles << 8U | static_cast<unsigned char>(file[kStlCountAt + i]);
  }
  const std::uint64_t bytes = kStlHeaderBytes + kStlTriangleBytes * triangles;
  if (file.size() == bytes) return;
  throw InputError(path, fmt::format("is {} bytes, must be {} for the {} that its header states",
                                     file.size(), bytes, Counted(triangles, "triangle")));
}

std::string_view FirstWordOf(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin);
  return line.substr(0, line.find_first_of(kBlanks));
}

void RequireSolidsClosed(std::string_view text, const std::string& path) {
  bool is_open = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view word = FirstWordOf(text.substr(0, end));
    if (word == "solid") is_open = true;
    if (word == "endsolid") is_open = false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (is_open) throw InputError(path, "ends without 'endsolid': it was cut off");
}

}  // namespace

void RequireWholeStl(const std::string& stl_path) {
  const std::string file = ReadFile(stl_path, kMaxMeshFileBytes);
  // Text has no zero byte; each triangle of a binary file ends in two, whatever its header says.
  const bool is_binary = file.find('\0') != std::string::npos;
  is_binary ? RequireStatedSize(file, stl_path) : RequireSolidsClosed(file, stl_path);
}

}  // namespace depthgrid
