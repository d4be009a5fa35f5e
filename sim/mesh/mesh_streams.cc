#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"
#include "sim/mesh/mesh_file.h"
#include "sim/mesh/mesh_streams_impl.h"
#include "sim/mesh/scene_limits.h"

namespace depthgrid {
namespace {

// Only for text formats: elsewhere these bytes may be data.
bool BeginsWithMark(const std::string& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension != ".obj" && extension != ".mtl" && extension != ".gltf") return false;
  std::array<char, 3> begin = {};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return WithoutByteOrderMark({begin.data(), begin.size()}).empty();
}

}  // namespace

std::string PercentDecoded(const std::string& uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char letter = 0;
    const char* const code = uri.data() + i + 1;
    const bool is_code = uri[i] == '%' && i + 2 < uri.size() &&
                         std::from_chars(code, code + 2, letter, 16).ptr == code + 2;
    name += is_code ? static_cast<char>(letter) : uri[i];
    if (is_code) i += 2;
  }
  return name;
}

std::string MeshStreams::NameOnDisk(const char* path) const {
  if (DefaultIOSystem::Exists(path)) return path;
  std::string decoded = PercentDecoded(path);
  return DefaultIOSystem::Exists(decoded.c_str()) ? decoded : path;
}

bool MeshStreams::Exists(const char* path) const {
  return DefaultIOSystem::Exists(NameOnDisk(path).c_str());
}

Assimp::IOStream* MeshStreams::Open(const char* path, const char* mode) {
  const std::string name = NameOnDisk(path);
  if (!BeginsWithMark(name)) return DefaultIOSystem::Open(name.c_str(), mode);
  const std::string whole_text = ReadFile(name, kMaxMeshFileBytes);
  const std::string_view text = WithoutByteOrderMark(whole_text);
  auto* const bytes = new std::uint8_t[text.size()];  // owned by the stream
  std::copy(text.begin(), text.end(), bytes);
  return new Assimp::MemoryIOStream(bytes, text.size(), true);
}

}  // namespace depthgrid
