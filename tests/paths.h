// Where this build's source tree and program are; defined by the build (tests/CMakeLists.txt).
#pragma once

namespace depthgrid {

extern const char* const kSourceFolder;
extern const char* const kProgramFile;

}  // namespace depthgrid
