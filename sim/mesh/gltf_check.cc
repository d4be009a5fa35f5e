#include "sim/mesh/gltf_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "sim/mesh/scene_limits.h"

namespace depthgrid {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kRequired = "extensionsRequired";

// Extensions (prefixes) that do not matter, as only positions are read, not materials or lights.
// For Draco assimp itself reports whether it can read it.
constexpr std::array<std::string_view, 7> kHarmless = {"KHR_materials_",
                                                       "KHR_texture_",
                                                       "EXT_texture_",
                                                       "MSFT_texture_",
                                                       "KHR_lights_",
                                                       "EXT_lights_",
                                                       "KHR_draco_mesh_compression"};

// The JSON text: the whole file, or for a GLB its first chunk, which begins with its length.
std::string_view GltfText(std::string_view file) {
  constexpr std::size_t kLengthAt = 12;
  constexpr std::size_t kChunkAt = 20;
  if (!file.starts_with("glTF")) return file;
  if (file.size() < kChunkAt) return {};
  std::size_t bytes = 0;
  for (std::size_t i = 4; i-- > 0;) {
    bytes = bytes << 8U | static_cast<unsigned char>(file[kLengthAt + i]);
  }
  const std::string_view chunk = file.substr(kChunkAt, bytes);
  return chunk.substr(0, chunk.find('\0'));  // some files pad with zeros
}

// Parses the text, keeping only the key extensionsRequired.
Json RequiredOf(std::string_view text, const std::string& path) {
  const auto keep = [](int depth, Json::parse_event_t event, const Json& key) {
    return depth != 1 || event != Json::parse_event_t::key || key == kRequired;
  };
  try {
    const Json root = Json::parse(text, keep);
    return root.is_object() ? root.value(kRequired, Json::array()) : Json::array();
  } catch (const Json::parse_error& error) {
    throw InputError(
        path, fmt::format("byte {} of its JSON is wrong, must be whole JSON in UTF-8", error.byte));
  }
}

}  // namespace

void RequireKnownExtensions(const std::string& gltf_path) {
  const std::string file = ReadFile(gltf_path, kMaxMeshFileBytes);
  for (const Json& entry : RequiredOf(GltfText(file), gltf_path)) {
    if (!entry.is_string()) continue;
    const auto name = entry.get<std::string>();
    const bool is_harmless =
        std::any_of(kHarmless.begin(), kHarmless.end(),
                    [&](std::string_view known) { return name.starts_with(known); });
    if (is_harmless) continue;
    throw InputError(gltf_path, fmt::format("{} has '{}', which is not supported: save the mesh "
                                            "without it",
                                            kRequired, name));
  }
}

}  // namespace depthgrid
