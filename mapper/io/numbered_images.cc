#include "mapper/io/numbered_images.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace depthgrid {
namespace {

std::optional<long> TrailingNumber(const std::string& stem) {
  const std::size_t begin = stem.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
  long number = 0;
  const char* end = stem.data() + stem.size();
  const auto [stop, error] = std::from_chars(stem.data() + begin, end, number);
  if (begin == stem.size() || error != std::errc{} || stop != end) return {};
  return number;
}

}  // namespace

std::vector<NumberedImage> NumberedImagesIn(const std::filesystem::path& folder,
                                            const std::string& ending) {
  std::vector<NumberedImage> images;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(ending)) continue;
    const std::string stem = name.substr(0, name.size() - ending.size());
    if (const auto number = TrailingNumber(stem)) {
      images.push_back({*number, entry.path(), folder / stem});
    }
  }
  std::sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
    return a.number != b.number ? a.number < b.number : a.path < b.path;
  });
  return images;
}

}  // namespace depthgrid
