// Checks, before the work, of single files that a command writes at a given path.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError when `path` is a folder, a device or a link, or is not in a writable folder,
// and (unless `force`) when the file exists, because it may be the user's only copy. `remedy`:
// advice for that case.
void RequireNewFile(const std::string& path, bool force,
                    const std::string& remedy = "choose another name, or --force to replace it");

// Throws InputError when nothing can be written into this folder; `remedy` ends the message.
void RequireWritable(const std::string& folder, const std::string& remedy = "");

}  // namespace depthgrid
