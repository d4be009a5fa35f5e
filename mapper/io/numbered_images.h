// Image files told apart by the number at the end of their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace depthgrid {

struct NumberedImage {
  long number = 0;
  std::filesystem::path path;
  std::filesystem::path stem;  // the path less its ending
};

// The folder's files with this ending and a number before it, in order of their numbers.
std::vector<NumberedImage> NumberedImagesIn(const std::filesystem::path& folder,
                                            const std::string& ending);

}  // namespace depthgrid
