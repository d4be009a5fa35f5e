// Serialises JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace depthgrid {

// Names of folders, titles and warnings may not be valid UTF-8, for which the library would throw
// when all the work is done. Invalid bytes become U+FFFD.
template <typename Json>
std::string JsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace depthgrid
