// Marks a folder while a command replaces the result in it: if it is killed meanwhile, the folder
// has files of both results.
#pragma once

#include <string>

namespace depthgrid {

// Throws std::runtime_error when the folder cannot be written.
void MarkAsReplaced(const std::string& folder);
void UnmarkAsReplaced(const std::string& folder);
// Throws InputError when the folder is marked, or the one that it lies in.
void RequireOneResult(const std::string& folder);

}  // namespace depthgrid
