// Which sources the program was built from, for the provenance of what it writes.
#pragma once

#include <string>

namespace depthgrid {

// The commit in 12 digits, "-dirty" behind it where files were changed since; "unknown" where the
// sources lay in no git checkout.
std::string BuildId();

// "0.1.0 (f623e4dbb7e7)"
std::string VersionText();

}  // namespace depthgrid
