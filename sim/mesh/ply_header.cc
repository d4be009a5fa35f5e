#include "sim/mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "mapper/core/error.h"
#include "mapper/io/config_text.h"

namespace depthgrid {
namespace {

std::optional<PlyType> TypeNamed(std::string_view name) {
  if (name == "char" || name == "int8") return PlyType{PlyNumber::kSigned, 1};
  if (name == "uchar" || name == "uint8") return PlyType{PlyNumber::kUnsigned, 1};
  if (name == "short" || name == "int16") return PlyType{PlyNumber::kSigned, 2};
  if (name == "ushort" || name == "uint16") return PlyType{PlyNumber::kUnsigned, 2};
  if (name == "int" || name == "int32") return PlyType{PlyNumber::kSigned, 4};
  if (name == "uint" || name == "uint32") return PlyType{PlyNumber::kUnsigned, 4};
  if (name == "float" || name == "float32") return PlyType{PlyNumber::kFloat, 4};
  if (name == "double" || name == "float64") return PlyType{PlyNumber::kFloat, 8};
  return {};
}

std::vector<std::string> Words(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && IsPlySpace(line[i])) ++i;
    const std::size_t start = i;
    while (i < line.size() && !IsPlySpace(line[i])) ++i;
    if (i > start) words.emplace_back(line.substr(start, i - start));
  }
  return words;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  PlyHeader Read() {
    PlyHeader header;
    if (Words(NextLine()) != std::vector<std::string>{"ply"}) FailAll("does not begin with 'ply'");
    bool has_format = false;
    while (true) {
      const std::string_view line = NextLine();
      const auto words = Words(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3) {
        header.encoding = EncodingNamed(words[1]);
        has_format = true;
      } else if (words[0] == "element" && words.size() == 3) {
        header.elements.push_back({words[1], CountIn(words[2]), {}, line_});
      } else if (words[0] == "property" && !header.elements.empty()) {
        header.elements.back().properties.push_back(PropertyIn(words, line));
      } else {
        FailValue(line,
                  "must be a format, comment, obj_info, element, property or end_header line");
      }
    }
    if (!has_format) FailAll("has no 'format' line");
    header.bytes = at_;
    return header;
  }

 private:
  std::string_view NextLine() {
    if (at_ >= text_.size()) FailAll("ends within its header");
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line(text_.data() + at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return line;
  }

  [[noreturn]] void FailValue(std::string_view value, const std::string& rule) const {
    while (!value.empty() && IsPlySpace(value.back())) value.remove_suffix(1);
    throw InputError(fmt::format("{}:{}", path_, line_),
                     fmt::format("'{}' {}", Shortened(std::string(value)), rule));
  }

  PlyEncoding EncodingNamed(const std::string& name) const {
    if (name == "ascii") return PlyEncoding::kAscii;
    if (name == "binary_little_endian") return PlyEncoding::kLittleEndian;
    if (name == "binary_big_endian") return PlyEncoding::kBigEndian;
    FailValue(name, "is no format, must be ascii, binary_little_endian or binary_big_endian");
  }

  std::size_t CountIn(const std::string& word) const {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size()) {
      FailValue(word, "is no number of elements, must be a whole number");
    }
    return count;
  }

  PlyProperty PropertyIn(const std::vector<std::string>& words, std::string_view line) const {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) {
      FailValue(line, "must be property TYPE NAME or property list TYPE TYPE NAME");
    }
    PlyProperty property;
    property.name = words.back();
    if (is_list) property.count = TypeIn(words[2]);
    property.value = TypeIn(words[words.size() - 2]);
    return property;
  }

  PlyType TypeIn(const std::string& word) const {
    const auto type = TypeNamed(word);
    if (!type) {
      FailValue(word, "is no type of numbers, must be one such as float, double, uchar or int");
    }
    return *type;
  }

  [[noreturn]] void FailAll(const std::string& message) const { throw InputError(path_, message); }

  std::string_view text_;
  std::string path_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace

bool IsPlySpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

PlyHeader ReadPlyHeader(std::string_view text, const std::string& path) {
  return HeaderReader(text, path).Read();
}

}  // namespace depthgrid
