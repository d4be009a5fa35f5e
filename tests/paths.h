// Where this build's source tree and program are; defined by the build (tests/CMakeLists.txt).
#pragma once

#include <string>

namespace depthgrid {

extern const char* const kSourceFolder;
extern const char* const kProgramFile;

inline std::string ShippedSceneFile(const std::string& name) {
  return std::string(kSourceFolder) + "/scenes/" + name + ".yaml";
}

}  // namespace depthgrid
