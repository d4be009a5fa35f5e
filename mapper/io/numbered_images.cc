#include "mapper/io/numbered_images.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "mapper/io/number_rows.h"

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

// The stamp in a name like "12.160407", also after a word such as "frame_" or "frame-". "1.12" may
// be the twelfth image of the first camera, so a stamp needs three decimals or must be a time since
// 1970. Milliseconds since 1970 may have a fraction, too (the RealSense viewer's).
std::optional<double> StampIn(const std::string& stem) {
  constexpr std::size_t kLeastDigits = 3;
  constexpr double kLeastSince1970S = 1e8;
  const std::size_t begin = stem.find_last_not_of("0123456789.") + 1;
  const std::size_t point = stem.find('.', begin);
  if (begin > 0 && stem[begin - 1] != '-' && stem[begin - 1] != '_') return {};
  if (point == begin || point == std::string::npos || point + 1 == stem.size()) return {};
  if (stem.find('.', point + 1) != std::string::npos) return {};
  const auto stamp_s = ParseNumber(std::string_view(stem).substr(begin));
  const bool is_stamp =
      stamp_s && (stem.size() - point > kLeastDigits || *stamp_s >= kLeastSince1970S);
  if (!is_stamp) return {};
  return *stamp_s / StampUnitsASecond(*stamp_s);
}

// Sets the stamps of all images if all names are stamps.
void TakeStamps(std::vector<NumberedImage>& images) {
  for (NumberedImage& image : images) image.stamp_s = StampIn(image.stem.filename().string());
  const bool all = std::all_of(images.begin(), images.end(),
                               [](const NumberedImage& image) { return image.stamp_s; });
  if (!all) {
    for (NumberedImage& image : images) image.stamp_s.reset();
    return;
  }
  std::sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
    return a.stamp_s != b.stamp_s ? a.stamp_s < b.stamp_s : a.path < b.path;
  });
  long number = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (i > 0 && images[i].stamp_s != images[i - 1].stamp_s) ++number;
    images[i].number = number;
  }
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
  TakeStamps(images);
  return images;
}

}  // namespace depthgrid
