// How assimp opens the files of a mesh where it does not do so itself: names that a glTF writes as
// percent-encoded URIs, and text that begins with a byte order mark. Of assimp's types, so only .cc
// files include it.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <string>

namespace depthgrid {

// "my data.bin" of "my%20data.bin"; what is no such code stays.
std::string PercentDecoded(const std::string& uri);

class MeshStreams : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* path) const override;
  Assimp::IOStream* Open(const char* path, const char* mode) override;

 private:
  std::string NameOnDisk(const char* path) const;
};

}  // namespace depthgrid
