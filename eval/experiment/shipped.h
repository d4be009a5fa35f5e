// Scenes and experiments that come with the program.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/scene.h"

namespace depthgrid {

enum class ShippedKind { kScene, kExperiment, kSweep };

// Whether a name is that of a file rather than of something shipped: it contains a '/' or ends in
// an extension (.yaml, or a mesh file's).
bool IsFileName(const std::string& name);

// The file of that name: the name itself, or a shipped file. A relative file name is relative to
// `base_folder`; if that is empty, to the current folder. Throws InputError with the nearest
// shipped name.
std::string ResolveName(const std::string& name, ShippedKind kind,
                        const std::string& base_folder = "");

// The same for a name given in another file at `place`, with which error messages begin.
std::string ResolveNameAt(const std::string& place, const std::string& name, ShippedKind kind,
                          const std::string& base_folder = "");

// The scene of that name, as ResolveName(); it may include the parts of the shipped scenes.
Scene LoadNamedScene(const std::string& name);

// Names of all shipped files of a kind, sorted. Throws InputError when there are none.
std::vector<std::string> ShippedNames(ShippedKind kind);

// ../share/depthgrid/scenes beside the folder of the running executable: the build tree links it to
// the source tree, an installation copies it there.
std::string ShippedFolder(ShippedKind kind);

}  // namespace depthgrid
