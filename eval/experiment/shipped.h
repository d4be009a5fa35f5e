// Scenes and experiments that come with the program.
#pragma once

#include <string>
#include <vector>

namespace depthgrid {

enum class ShippedKind { kScene, kExperiment, kSweep };

// Whether a command-line argument or a key means a file rather than something shipped: it holds a
// '/' or ends in an extension (.yaml, or a mesh file's).
bool IsFileName(const std::string& name);

// The file that it means: itself, or the shipped file of that name. `base_folder` is
// where a relative file name in another file starts; empty for the working directory. Throws
// InputError with the nearest shipped name.
std::string ResolveName(const std::string& name, ShippedKind kind,
                        const std::string& base_folder = "");

// The same for a name that another file gives at `place`, with which errors begin.
std::string ResolveNameAt(const std::string& place, const std::string& name, ShippedKind kind,
                          const std::string& base_folder = "");

// Names of all shipped files of a kind, sorted. Throws InputError when nothing shipped is there.
std::vector<std::string> ShippedNames(ShippedKind kind);

// ../share/depthgrid/scenes beside the folder of the running executable: the build tree links it to
// the source tree, an installation copies it there.
std::string ShippedFolder(ShippedKind kind);

}  // namespace depthgrid
