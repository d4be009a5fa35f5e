// Image files with a number at the end of their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace depthgrid {

struct NumberedImage {
  long number = 0;
  std::filesystem::path path;
  std::filesystem::path stem;          // the path without its extension
  std::optional<double> stamp_s = {};  // if names have a fraction
};

// The folder's files with this ending and a number before it, in order of their numbers. If all
// names are seconds with a fraction (1305031102.160407, as TUM's) or milliseconds since 1970 with
// one, they are sorted by these and numbered from 0.
std::vector<NumberedImage> NumberedImagesIn(const std::filesystem::path& folder,
                                            const std::string& ending);

}  // namespace depthgrid
