// File access for assimp, adding what it does not handle: percent-encoded URIs in glTF files and
// text with a byte order mark. Uses assimp's types, so only .cc files include it.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <string>

namespace depthgrid {

// "my data.bin" from "my%20data.bin"; invalid escapes are kept.
std::string PercentDecoded(const std::string& uri);

class MeshStreams : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* path) const override;
  Assimp::IOStream* Open(const char* path, const char* mode) override;

 private:
  std::string NameOnDisk(const char* path) const;
};

}  // namespace depthgrid
