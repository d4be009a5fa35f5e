// Single files that a command writes where its user says: checked before the work, not after.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError when `path` is a folder, a device or a link, or lies in no folder that can be
// written, and when there is such a file already, unless `force`: it may be somebody's only copy.
// `remedy`: what the user can do then.
void RequireNewFile(const std::string& path, bool force,
                    const std::string& remedy = "choose another name, or --force to replace it");

// Throws InputError when nothing can be written into this folder; `remedy` ends the message.
void RequireWritable(const std::string& folder, const std::string& remedy = "");

}  // namespace depthgrid
