// The sources that the program was built from, for provenance.
#pragma once

#include <string>

namespace depthgrid {

// The commit in 12 digits, followed by "-dirty" if files were changed since; "unknown" if the
// sources were not in a git checkout.
std::string BuildId();

// "0.1.0 (f623e4dbb7e7)"
std::string VersionText();

}  // namespace depthgrid
