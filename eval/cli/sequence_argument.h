// A rendered or recorded sequence as named on the command line.
#pragma once

#include <string>
#include <vector>

namespace depthgrid::cli {

// The stamps of a sequence folder's frames.
std::vector<double> FrameStamps(const std::string& folder);

}  // namespace depthgrid::cli
