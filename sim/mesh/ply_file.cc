#include "sim/mesh/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>

#include "mapper/core/error.h"
#include "mapper/core/plus_sign.h"
#include "mapper/io/file.h"
#include "sim/mesh/face_triangles.h"
#include "sim/mesh/ply_header.h"
#include "sim/mesh/scene_limits.h"

namespace depthgrid {
namespace {

// Reads the file's text from front to back.
class PlyParser {
 public:
  PlyParser(const std::string& path, std::string text) : path_(path), text_(std::move(text)) {}

  TriangleMesh Parse() {
    const PlyHeader header = ReadPlyHeader(text_, path_);
    at_ = header.bytes;
    encoding_ = header.encoding;
    for (const PlyElement& element : header.elements) {
      element_ = &element;
      RequireRoomFor(element);
      if (element.name == "vertex") {
        ReadVertices(element);
      } else if (element.name == "face") {
        ReadFaces(element);
      } else {
        for (index_ = 0; index_ < element.count; ++index_) Skip(element);
      }
    }
    CutFaces();
    return std::move(mesh_);
  }

 private:
  // About the line that announces an element.
  [[noreturn]] void FailElement(const PlyElement& element, const std::string& rule) const {
    throw InputError(fmt::format("{}:{}", path_, element.line),
                     fmt::format("element '{}' {}", element.name, rule));
  }

  // About what is being read; elements are counted from 0, as the indices of faces do. Only text
  // has lines.
  [[noreturn]] void FailHere(const std::string& message) const {
    std::string place = path_;
    if (encoding_ == PlyEncoding::kAscii) {
      const auto end = text_.begin() + static_cast<std::ptrdiff_t>(at_);
      place += fmt::format(":{}", 1 + std::count(text_.begin(), end, '\n'));
    }
    throw InputError(place, fmt::format("{} {} {}", element_->name, index_, message));
  }

  [[noreturn]] void FailFace(std::size_t face, const std::string& message) const {
    throw InputError(path_, fmt::format("face {} {}", face, message));
  }

  // Prevents a wrong count in the header from allocating more memory than the file has data.
  void RequireRoomFor(const PlyElement& element) const {
    std::size_t least_bytes = 0;
    for (const PlyProperty& p : element.properties) {
      const std::size_t stored = p.count ? p.count->bytes : p.value.bytes;
      least_bytes += encoding_ == PlyEncoding::kAscii ? 1 : stored;
    }
    if (least_bytes == 0 && element.count > 0) {
      FailElement(element, "has no properties, must have some");
    }
    const std::size_t left_bytes = text_.size() - at_;
    if (element.count > 0 && element.count > left_bytes / least_bytes) {
      FailElement(element, fmt::format("has {} entries of at least {} bytes each, must fit into "
                                       "the {} bytes behind the header and what is before it",
                                       element.count, least_bytes, left_bytes));
    }
  }

  [[noreturn]] void FailCutOff() const {
    throw InputError(path_, fmt::format("ends within {} {}, must have {} of them (line {})",
                                        element_->name, index_, element_->count, element_->line));
  }

  double Number(const PlyType& type) {
    return encoding_ == PlyEncoding::kAscii ? AsciiNumber() : BinaryNumber(type);
  }

  double AsciiNumber() {
    while (at_ < text_.size() && IsPlySpace(text_[at_])) ++at_;
    if (at_ >= text_.size()) FailCutOff();
    const char* begin = WithoutPlus(std::string_view(text_).substr(at_)).data();
    const char* end = text_.data() + text_.size();
    double number = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, number);
    // Overflow or underflow: from_chars does not set the number; strtod gives infinity or 0.
    if (error == std::errc::result_out_of_range) number = std::strtod(begin, nullptr);
    if (error == std::errc::invalid_argument || (stop != end && !IsPlySpace(*stop))) {
      std::size_t word_end = at_;
      while (word_end < text_.size() && !IsPlySpace(text_[word_end]) && word_end - at_ < 32)
        ++word_end;
      FailHere(fmt::format("has '{}', must be a number", text_.substr(at_, word_end - at_)));
    }
    at_ = static_cast<std::size_t>(stop - text_.data());
    return number;
  }

  double BinaryNumber(const PlyType& type) {
    if (text_.size() - at_ < type.bytes) FailCutOff();
    std::array<unsigned char, 8> raw{};
    const bool is_little = encoding_ == PlyEncoding::kLittleEndian;
    const bool is_native = is_little == (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < type.bytes; ++i) {
      raw[is_native ? i : type.bytes - 1 - i] = static_cast<unsigned char>(text_[at_ + i]);
    }
    at_ += type.bytes;
    switch (type.kind) {
      case PlyNumber::kFloat:
        return type.bytes == 4 ? As<float>(raw) : As<double>(raw);
      case PlyNumber::kSigned:
        return type.bytes == 1   ? As<std::int8_t>(raw)
               : type.bytes == 2 ? As<std::int16_t>(raw)
                                 : As<std::int32_t>(raw);
      case PlyNumber::kUnsigned:
        break;
    }
    return type.bytes == 1   ? As<std::uint8_t>(raw)
           : type.bytes == 2 ? As<std::uint16_t>(raw)
                             : As<std::uint32_t>(raw);
  }

  template <typename T>
  static double As(const std::array<unsigned char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return static_cast<double>(value);
  }

  std::size_t ListLength(const PlyProperty& property) {
    const double length = Number(*property.count);
    if (!(length >= 0.0) || length > static_cast<double>(text_.size())) {
      FailHere(
          fmt::format("has {} values of '{}', must be from 0 to {}: the file has no more bytes",
                      length, property.name, text_.size()));
    }
    return static_cast<std::size_t>(length);
  }

  void SkipProperty(const PlyProperty& property) {
    const std::size_t values = property.count ? ListLength(property) : 1;
    for (std::size_t i = 0; i < values; ++i) Number(property.value);
  }

  void Skip(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) SkipProperty(property);
  }

  void ReadVertices(const PlyElement& element) {
    for (const char* name : {"x", "y", "z"}) {
      if (std::none_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& p) { return p.name == name && !p.count; })) {
        FailElement(element, fmt::format("has no property '{}', must have x, y and z", name));
      }
    }
    for (index_ = 0; index_ < element.count; ++index_) {
      Eigen::Vector3d point = Eigen::Vector3d::Zero();
      for (const PlyProperty& property : element.properties) {
        const bool is_coordinate = !property.count && property.name.size() == 1 &&
                                   property.name[0] >= 'x' && property.name[0] <= 'z';
        if (is_coordinate) {
          point[property.name[0] - 'x'] = Number(property.value);
        } else {
          SkipProperty(property);
        }
      }
      mesh_.AddVertex(point);
      if (!mesh_.vertices.back().allFinite()) {
        FailHere(fmt::format("is ({:g}, {:g}, {:g}), must be finite in 32 bits", point.x(),
                             point.y(), point.z()));
      }
    }
  }

  void ReadFaces(const PlyElement& element) {
    for (index_ = 0; index_ < element.count; ++index_) {
      for (const PlyProperty& property : element.properties) {
        const bool is_polygon = property.count && (property.name == "vertex_indices" ||
                                                   property.name == "vertex_index");
        if (is_polygon) {
          ReadPolygon(property);
        } else {
          SkipProperty(property);
        }
      }
    }
  }

  void ReadPolygon(const PlyProperty& property) {
    const std::size_t corners = ListLength(property);
    triangles_ += std::max<std::size_t>(corners, 2) - 2;
    if (triangles_ > kMaxSceneTriangles) {
      FailHere(
          fmt::format("is one too many: must be at most {} triangles in all", kMaxSceneTriangles));
    }
    faces_.push_back(static_cast<std::uint32_t>(corners));
    for (std::size_t k = 0; k < corners; ++k) faces_.push_back(VertexIndex(Number(property.value)));
  }

  std::uint32_t VertexIndex(double number) const {
    if (!(number >= 0.0) || number != std::floor(number) || number > 4294967295.0) {
      FailHere(fmt::format("uses vertex '{}', must be a whole number from 0", number));
    }
    return static_cast<std::uint32_t>(number);
  }

  // Called at the end, as faces may come before vertices.
  void CutFaces() {
    std::size_t face = 0;
    for (std::size_t at = 0; at < faces_.size(); ++face) {
      const std::size_t corners = faces_[at];
      CutFace(face, std::span(faces_).subspan(at + 1, corners));
      at += 1 + corners;
    }
  }

  void CutFace(std::size_t index, std::span<const std::uint32_t> face) {
    for (const std::uint32_t vertex : face) {
      if (vertex < mesh_.vertices.size()) continue;
      FailFace(index, fmt::format("uses vertex {}, must be below their number, {}", vertex,
                                  mesh_.vertices.size()));
    }
    if (face.size() < 3) return;
    if (face.size() == 3) return mesh_.AddTriangle(face[0], face[1], face[2]);
    std::vector<Eigen::Vector3d> corners;
    for (const std::uint32_t vertex : face) {
      corners.push_back(mesh_.vertices[vertex].cast<double>());
    }
    const auto triangles = TrianglesOfFace(corners);
    if (!triangles) {
      FailFace(index, fmt::format("is not convex and has {} corners, must have at most {}",
                                  face.size(), kMostConcaveCorners));
    }
    for (const auto& [a, b, c] : *triangles) mesh_.AddTriangle(face[a], face[b], face[c]);
  }

  std::string path_;
  std::string text_;
  std::size_t at_ = 0;
  PlyEncoding encoding_ = PlyEncoding::kAscii;
  const PlyElement* element_ = nullptr;  // being read, and which of its kind
  std::size_t index_ = 0;
  std::vector<std::uint32_t> faces_;  // of each face the number of its corners, then their indices
  std::size_t triangles_ = 0;         // of all faces
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh ReadPly(const std::string& path) { return PlyParser(path, ReadFile(path)).Parse(); }

}  // namespace depthgrid
