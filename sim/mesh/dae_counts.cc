#include "sim/mesh/dae_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";
constexpr std::string_view kCommentBegin = "<!--";
constexpr std::string_view kCommentEnd = "-->";
constexpr std::string_view kDataBegin = "<![CDATA[";
constexpr std::string_view kDataEnd = "]]>";

// Elements that contain lists of whole numbers.
constexpr std::array<std::string_view, 8> kListOwners = {"lines",     "linestrips",    "polygons",
                                                         "polylist",  "triangles",     "trifans",
                                                         "tristrips", "vertex_weights"};
constexpr std::array<std::string_view, 4> kLists = {"p", "h", "v", "vcount"};

bool IsOneOf(std::string_view name, const auto& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The value of an attribute; empty when the tag does not have it.
std::string_view AttributeOf(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || kSpaces.find(tag[at - 1]) == std::string_view::npos) continue;
    const std::size_t equals = tag.find_first_not_of(kSpaces, at + name.size());
    if (equals == std::string_view::npos || tag[equals] != '=') continue;
    const std::size_t quote = tag.find_first_not_of(kSpaces, equals + 1);
    if (quote == std::string_view::npos) continue;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end != std::string_view::npos) return tag.substr(quote + 1, end - quote - 1);
  }
  return {};
}

std::optional<std::uint64_t> WholeNumber(std::string_view word) {
  std::uint64_t number = 0;
  const char* const last = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), last, number);
  return error == std::errc() && stop == last ? std::optional(number) : std::nullopt;
}

struct Accessor {
  std::string place;
  std::string_view array;  // its name
  std::uint64_t count;
  std::uint64_t stride;
  std::uint64_t offset;
};

class Reader {
 public:
  Reader(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  void Check() {
    if (text_.find('\0') != std::string_view::npos) {
      throw InputError(path_, "has a zero byte, must be text in UTF-8");
    }
    std::size_t after = 0;  // end of the previous tag
    for (std::size_t at = text_.find('<'); at < text_.size(); at = text_.find('<', after)) {
      ReadText(after, at);
      if (text_.substr(at).starts_with(kCommentBegin)) {
        after = Find(kCommentEnd, at + kCommentBegin.size()) + kCommentEnd.size();
      } else if (text_.substr(at).starts_with(kDataBegin)) {
        const std::size_t end = Find(kDataEnd, at + kDataBegin.size());
        ReadText(at + kDataBegin.size(), end);
        after = end + kDataEnd.size();
      } else {
        const std::size_t end = EndOfTag(at);
        CountLinesTo(at);
        Read(text_.substr(at + 1, end - at - 1));
        after = end + 1;
      }
    }
    for (const Accessor& accessor : accessors_) RequireWithin(accessor);
  }

 private:
  std::size_t Find(std::string_view mark, std::size_t from) const {
    return std::min(text_.find(mark, from), text_.size());
  }

  // The position of the tag's '>', ignoring those within quotes.
  std::size_t EndOfTag(std::size_t from) const {
    char quote = '\0';
    for (std::size_t at = from; at < text_.size(); ++at) {
      const char c = text_[at];
      if (quote == '\0' && c == '>') return at;
      if (quote == '\0' && (c == '"' || c == '\'')) {
        quote = c;
      } else if (c == quote) {
        quote = '\0';
      }
    }
    return text_.size();
  }

  void CountLinesTo(std::size_t at) {
    line_ += std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                        text_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    counted_ = at;
  }

  void Read(std::string_view tag) {
    if (tag.starts_with('/')) return ReadEnd(tag.substr(1, tag.find_first_of(kSpaces) - 1));
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    const std::uint64_t count = Number(tag, name, "count", 0);
    if (name == "input") {
      offsets_ = std::max(offsets_, Number(tag, name, "offset", 0) + 1);
    }
    if (name.ends_with("_array")) arrays_[AttributeOf(tag, "id")] = count;
    if (!tag.ends_with('/')) ReadListTag(name, count);
    if (name != "accessor") return;
    const std::string_view source = AttributeOf(tag, "source");
    accessors_.push_back({Place(), source.substr(std::min<std::size_t>(1, source.size())), count,
                          Number(tag, name, "stride", 1), Number(tag, name, "offset", 0)});
  }

  void ReadListTag(std::string_view name, std::uint64_t count) {
    if (IsOneOf(name, kListOwners)) {
      owner_ = name;
      offsets_ = 1;
      corners_ = name == "triangles" ? 3 * count : name == "lines" ? 2 * count : 0;
    }
    if (!owner_.empty() && IsOneOf(name, kLists)) list_ = name;
  }

  void ReadEnd(std::string_view name) {
    if (name == list_) list_ = {};
    if (name != owner_) return;
    owner_ = {};
    // Each index takes at least one byte. Division avoids overflow of the product.
    if (corners_ <= text_.size() / offsets_) return;
    throw InputError(Place(), fmt::format("{} states {} corners of {} indices each, must be {} "
                                          "indices at most: the file has no more bytes",
                                          name, corners_, offsets_, text_.size()));
  }

  // Assimp loops forever on a word in a list that is not a number.
  void ReadText(std::size_t begin, std::size_t end) {
    if (list_.empty()) return;
    for (std::size_t at = text_.find_first_not_of(kSpaces, begin); at < end;) {
      const std::size_t after = std::min(text_.find_first_of(kSpaces, at), end);
      CountLinesTo(at);
      const std::uint64_t value = ListValue(text_.substr(at, after - at));
      if (list_ == "vcount") corners_ += value;
      at = text_.find_first_not_of(kSpaces, after);
    }
  }

  // Values are indices or counts of items, so they cannot exceed the file's size in bytes.
  std::uint64_t ListValue(std::string_view word) const {
    constexpr std::string_view kNoBone = "-1";  // only in lists of bones
    if (list_ == "v" && word == kNoBone) return 0;
    const auto number = WholeNumber(word);
    if (number && *number <= text_.size()) return *number;
    throw InputError(Place(), fmt::format("<{}> has '{}', must be a whole number from 0 to {}: the "
                                          "file has no more bytes",
                                          list_, word.substr(0, 40), text_.size()));
  }

  // Each item takes at least one byte.
  std::uint64_t Number(std::string_view tag, std::string_view element, std::string_view attribute,
                       std::uint64_t otherwise) const {
    const std::string_view value = AttributeOf(tag, attribute);
    if (value.empty()) return otherwise;
    const auto number = WholeNumber(value);
    if (number && *number <= text_.size()) return *number;
    throw InputError(Place(), fmt::format("{} of {} is '{}', must be a whole number, and at most "
                                          "{}: the file has no more bytes",
                                          attribute, element, value, text_.size()));
  }

  void RequireWithin(const Accessor& accessor) const {
    const auto array = arrays_.find(accessor.array);
    if (array == arrays_.end() || accessor.count == 0) return;  // left to assimp
    const std::uint64_t last = accessor.offset + (accessor.count - 1) * accessor.stride;
    if (last < array->second) return;
    throw InputError(accessor.place, fmt::format("accessor uses value {} of {}, which has {}", last,
                                                 accessor.array, array->second));
  }

  std::string Place() const { return fmt::format("{}:{}", path_, line_); }

  const std::string& path_;
  std::string_view text_;
  std::size_t counted_ = 0;  // position up to which lines are counted
  std::ptrdiff_t line_ = 1;
  std::map<std::string_view, std::uint64_t> arrays_;  // number of values of each
  std::vector<Accessor> accessors_;
  std::string_view owner_;  // the element whose lists are being read
  std::string_view list_;
  std::uint64_t corners_ = 0;  // stated by the owner
  std::uint64_t offsets_ = 1;  // indices per corner
};

}  // namespace

void RequireSoundCounts(const std::string& dae_path) {
  const std::string text = ReadFile(dae_path);
  Reader(dae_path, text).Check();
}

}  // namespace depthgrid
