#include "sim/dae_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";

// What stands between the quotes of an attribute; empty when the tag has none of that name.
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
    for (std::size_t at = text_.find('<'); at < text_.size(); at = text_.find('<', at + 1)) {
      const std::size_t end = std::min(text_.find('>', at), text_.size());
      line_ += std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                          text_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      counted_ = at;
      Read(text_.substr(at + 1, end - at - 1));
    }
    for (const Accessor& accessor : accessors_) RequireWithin(accessor);
  }

 private:
  void Read(std::string_view tag) {
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    const std::uint64_t count = Number(tag, name, "count", 0);
    if (name == "input") Number(tag, name, "offset", 0);
    if (name.ends_with("_array")) arrays_[AttributeOf(tag, "id")] = count;
    if (name != "accessor") return;
    const std::string_view source = AttributeOf(tag, "source");
    accessors_.push_back({Place(), source.substr(std::min<std::size_t>(1, source.size())), count,
                          Number(tag, name, "stride", 1), Number(tag, name, "offset", 0)});
  }

  // A byte at least is what each item takes.
  std::uint64_t Number(std::string_view tag, std::string_view element, std::string_view attribute,
                       std::uint64_t otherwise) const {
    const std::string_view value = AttributeOf(tag, attribute);
    if (value.empty()) return otherwise;
    std::uint64_t number = 0;
    const char* const last = value.data() + value.size();
    const auto [stop, error] = std::from_chars(value.data(), last, number);
    if (error == std::errc() && stop == last && number <= text_.size()) return number;
    throw InputError(Place(), fmt::format("{} of {} is '{}', must be a whole number, and at most "
                                          "{}: the file has no more bytes",
                                          attribute, element, value, text_.size()));
  }

  void RequireWithin(const Accessor& accessor) const {
    const auto array = arrays_.find(accessor.array);
    if (array == arrays_.end() || accessor.count == 0) return;  // assimp's to say
    const std::uint64_t last = accessor.offset + (accessor.count - 1) * accessor.stride;
    if (last < array->second) return;
    throw InputError(accessor.place, fmt::format("accessor uses value {} of {}, which has {}", last,
                                                 accessor.array, array->second));
  }

  std::string Place() const { return fmt::format("{}:{}", path_, line_); }

  const std::string& path_;
  std::string_view text_;
  std::size_t counted_ = 0;  // up to here `line_` counts
  std::ptrdiff_t line_ = 1;
  std::map<std::string_view, std::uint64_t> arrays_;  // how many values each has
  std::vector<Accessor> accessors_;
};

}  // namespace

void RequireSoundCounts(const std::string& dae_path) {
  const std::string text = ReadFile(dae_path);
  Reader(dae_path, text).Check();
}

}  // namespace depthgrid
