#include "mapper/io/pgm.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr int kMaxSizePx = 65535;
constexpr int kMaxValue = 65535;

bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

class Cursor {
 public:
  Cursor(std::string_view bytes, const std::string& place) : rest_(bytes), place_(place) {}

  // The next number of the header or of a P2 raster, comments skipped.
  int Number(const char* what, int max) {
    SkipSpaceAndComments();
    int value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{} || value < 0 || value > max) {
      throw InputError(place_, fmt::format("PGM {} is '{}', must be a whole number of at most {}",
                                           what, Word(), max));
    }
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  // Skips the single white space between header and binary raster, which a text tool may have made
  // a two-byte line end.
  void SkipHeaderEnd(std::size_t raster_bytes) {
    constexpr std::string_view kTwoBytes = "\r\n";
    const bool has_both =
        rest_.starts_with(kTwoBytes) && rest_.size() >= kTwoBytes.size() + raster_bytes;
    Skip(has_both ? kTwoBytes.size() : 1);
  }
  // The format allows a line end and further images at the end; anything else suggests that the
  // pixels were read from the wrong place.
  void RequireEnd() {
    const std::size_t surplus = rest_.size();
    SkipSpaceAndComments();
    if (rest_.empty() || IsPgm(rest_)) return;
    throw InputError(place_, fmt::format("PGM has {} after its pixels, must end with them or "
                                         "with a line end",
                                         Counted(surplus, "byte")));
  }
  void Skip(std::size_t count) { rest_.remove_prefix(std::min(count, rest_.size())); }
  std::string_view rest() const { return rest_; }

 private:
  // The next word, truncated for error messages.
  std::string_view Word() const {
    constexpr std::size_t kMostShown = 20;
    const auto end = std::find_if(rest_.begin(), rest_.end(), IsSpace);
    return rest_.substr(0, std::min(kMostShown, static_cast<std::size_t>(end - rest_.begin())));
  }
  void SkipSpaceAndComments() {
    while (!rest_.empty() && (IsSpace(rest_.front()) || rest_.front() == '#')) {
      Skip(rest_.front() == '#' ? std::min(rest_.find('\n'), rest_.size() - 1) + 1 : 1);
    }
  }

  std::string_view rest_;
  const std::string& place_;
};

void RequireBytes(std::size_t have, std::size_t need, const std::string& place) {
  if (have < need) {
    throw InputError(place, fmt::format("PGM is truncated: {} of {} bytes of pixels", have, need));
  }
}

void ReadBinary(Cursor& cursor, const std::string& place, PgmImage& image) {
  const std::size_t sample_bytes = image.max_value > 255 ? 2 : 1;
  const std::size_t raster_bytes = image.values.size() * sample_bytes;
  cursor.SkipHeaderEnd(raster_bytes);
  const std::string_view raster = cursor.rest();
  RequireBytes(raster.size(), raster_bytes, place);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(raster[k]); };
    image.values[i] = sample_bytes == 1
                          ? byte(i)
                          : static_cast<std::uint16_t>(byte(2 * i) << 8U | byte(2 * i + 1));
    if (image.values[i] > image.max_value) {
      throw InputError(place, fmt::format("PGM pixel {} is above the stated maximum {}",
                                          image.values[i], image.max_value));
    }
  }
  cursor.Skip(raster_bytes);
}

}  // namespace

bool IsPgm(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == '2' || bytes[1] == '5') &&
         (IsSpace(bytes[2]) || bytes[2] == '#');
}

PgmImage DecodePgm(std::string_view bytes, const std::string& place) {
  if (!IsPgm(bytes)) throw InputError(place, "is not a PGM image (P2 or P5)");
  const bool text = bytes[1] == '2';
  Cursor cursor(bytes, place);
  cursor.Skip(2);
  PgmImage image;
  image.width_px = cursor.Number("width", kMaxSizePx);
  image.height_px = cursor.Number("height", kMaxSizePx);
  image.max_value = cursor.Number("maximum", kMaxValue);
  if (image.width_px == 0 || image.height_px == 0 || image.max_value == 0) {
    throw InputError(place, "PGM width, height and maximum must be positive");
  }
  const auto pixels =
      static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  // Checked before allocating: after one white space, each pixel needs at least one byte.
  RequireBytes(cursor.rest().size() - std::min<std::size_t>(cursor.rest().size(), 1), pixels,
               place);
  image.values.resize(pixels);
  if (text) {
    for (auto& value : image.values) {
      value = static_cast<std::uint16_t>(cursor.Number("pixel", image.max_value));
    }
  } else {
    ReadBinary(cursor, place, image);
  }
  cursor.RequireEnd();
  return image;
}

std::string EncodePgm(const GreyImage& image) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", image.width_px, image.height_px);
  bytes.append(image.grey.begin(), image.grey.end());
  return bytes;
}

}  // namespace depthgrid
