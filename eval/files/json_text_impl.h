// JSON as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace depthgrid {

// Names of folders, titles and warnings may be no UTF-8, which JSON has to be: the library throws
// then, when all the work is done. What cannot be read stands as U+FFFD.
template <typename Json>
std::string JsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace depthgrid
