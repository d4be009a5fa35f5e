#include "mapper/io/realsense_listing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/camera_values.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

constexpr std::string_view kTitle = "Intrinsic of \"";
constexpr std::string_view kDepth = "Depth";
constexpr std::string_view kNumbers[] = {"Width", "Height", "PPX", "PPY", "Fx", "Fy"};

// The lines of one stream at one size: `Fx:   384.2` and so on below a title,
// ` Intrinsic of "Depth" / 640x480 / {Z16}`.
struct Block {
  std::string stream;
  std::string size;  // "640x480"
  int line = 0;
  std::map<std::string, TextRow, std::less<>> rows;  // by key, without the colon

  std::string Name() const { return fmt::format("\"{}\" at {}", stream, size); }
};

std::optional<Block> BlockTitled(const TextRow& row) {
  const std::string title(RestOf(row, 0));
  if (!title.starts_with(kTitle)) return {};
  const std::size_t end = title.find('"', kTitle.size());
  if (end == std::string::npos) return {};
  Block block;
  block.stream = title.substr(kTitle.size(), end - kTitle.size());
  block.line = row.line;
  const auto slash = std::find(row.fields.begin(), row.fields.end(), "/");
  if (slash != row.fields.end() && slash + 1 != row.fields.end()) block.size = *(slash + 1);
  return block;
}

std::string KeyOf(const TextRow& row) {
  const std::string_view first = row.fields.front();
  return first.ends_with(':') ? std::string(first.substr(0, first.size() - 1)) : "";
}

bool IsKey(std::string_view key) {
  return key == "Distortion" || key == "Coeffs" ||
         std::find(std::begin(kNumbers), std::end(kNumbers), key) != std::end(kNumbers);
}

// The list is followed by other sections, each line of which ends a block.
std::vector<Block> BlocksIn(const std::string& text, const std::string& place) {
  std::vector<Block> blocks;
  bool inside = false;
  for (const TextRow& row : SplitRows(text)) {
    if (auto block = BlockTitled(row)) {
      blocks.push_back(*std::move(block));
      inside = true;
      continue;
    }
    const std::string key = KeyOf(row);
    inside = inside && IsKey(key);
    if (inside && !blocks.back().rows.emplace(key, row).second) {
      throw InputError(
          PlaceOfLine(place, row.line),
          fmt::format("{} is given twice for {}, must be once", key, blocks.back().Name()));
    }
  }
  return blocks;
}

const TextRow& RowOf(const Block& block, std::string_view key, const std::string& place) {
  const auto row = block.rows.find(key);
  if (row != block.rows.end()) return row->second;
  throw InputError(PlaceOfLine(place, block.line),
                   fmt::format("{} has no {}, must be followed by its {}, Distortion and Coeffs",
                               block.Name(), key, fmt::join(kNumbers, ", ")));
}

std::vector<double> NumbersOfRow(const Block& block, const std::string& key, std::size_t count,
                                 const std::string& place) {
  const TextRow& row = RowOf(block, key, place);
  const std::string place_of_line = PlaceOfLine(place, row.line);
  if (row.fields.size() != count + 1) {
    throw InputError(place_of_line, fmt::format("{} has {}, must have {}", key,
                                                Counted(row.fields.size() - 1, "value"), count));
  }
  return NumbersOf({row.fields.begin() + 1, row.fields.end()}, key, place_of_line);
}

PinholeCamera CameraOf(const Block& block, const std::string& place) {
  PinholeCamera camera;
  const auto number = [&](const char* key) { return NumbersOfRow(block, key, 1, place).front(); };
  const auto pixels = [&](const char* key) {
    return PixelsOf(number(key), key, PlaceOfLine(place, RowOf(block, key, place).line));
  };
  camera.width_px = pixels("Width");
  camera.height_px = pixels("Height");
  camera.cx_px = number("PPX");
  camera.cy_px = number("PPY");
  camera.fx_px = number("Fx");
  camera.fy_px = number("Fy");
  const TextRow& coeffs = RowOf(block, "Coeffs", place);
  SetDistortion(NumbersOfRow(block, "Coeffs", camera.distortion.size(), place),
                PlaceOfLine(place, coeffs.line), camera);
  const TextRow& model = RowOf(block, "Distortion", place);
  RequireRealSenseModel(model.fields.size() < 2 ? "missing" : std::string(RestOf(model, 1)),
                        camera.HasDistortion(), "Distortion", PlaceOfLine(place, model.line));
  Validate(camera, PlaceOfLine(place, block.line));
  if (const auto size = fmt::format("{}x{}", camera.width_px, camera.height_px);
      size != block.size) {
    throw InputError(
        PlaceOfLine(place, block.line),
        fmt::format("is titled {}, must be {} by its Width and Height", block.Name(), size));
  }
  return camera;
}

std::string NoDepthIn(const std::set<std::string>& streams) {
  if (streams.empty()) {
    return "lists no intrinsics, must be what rs-enumerate-devices -c prints (with -c)";
  }
  return fmt::format(
      "has intrinsics of \"{}\", must have those of \"Depth\"; of depth images that were aligned "
      "to another stream, give its numbers as one line: Fx Fy PPX PPY Width Height",
      fmt::join(streams, "\", \""));
}

}  // namespace

bool IsRealSenseListing(std::string_view text) {
  return text.find(kTitle) != std::string_view::npos ||
         text.find("Stream Profiles supported by ") != std::string_view::npos;
}

CameraDescription ParseRealSenseListing(const std::string& text, const std::string& place) {
  CameraDescription description;
  description.kind = "RealSense listing";
  description.has_depth_scale = false;
  std::map<std::string, int> lines;  // by size
  std::set<std::string> streams;
  for (const Block& block : BlocksIn(text, place)) {
    if (block.rows.empty()) continue;  // "Intrinsic NOT available!"
    streams.insert(block.stream);
    if (block.stream != kDepth) continue;
    description.sizes.push_back(CameraOf(block, place));
    const auto [first, is_new] = lines.emplace(block.size, block.line);
    if (!is_new) {
      throw InputError(PlaceOfLine(place, block.line),
                       fmt::format("{} is given again after line {}, must be once: keep that of "
                                   "the images' camera and format",
                                   block.Name(), first->second));
    }
  }
  if (description.sizes.empty()) throw InputError(place, NoDepthIn(streams));
  if (streams.size() > 1) {
    description.taken =
        "of several streams \"Depth\" is taken; depth images that were aligned to another need "
        "its numbers, as one line: Fx Fy PPX PPY Width Height";
  }
  description.has_size = description.sizes.size() == 1;
  if (description.has_size) {
    description.file.camera = description.sizes.front();
    description.sizes.clear();
  }
  return description;
}

void RequireRealSenseModel(std::string model, bool distorts, std::string_view key,
                           const std::string& place) {
  // The coefficients of the inverse and the modified model mean something else than those of
  // plumb_bob.
  constexpr const char* kPlumbBob[] = {"brown_conrady", "Brown Conrady", "4"};
  constexpr const char* kPinholes[] = {"none",
                                       "None",
                                       "0",
                                       "modified_brown_conrady",
                                       "Modified Brown Conrady",
                                       "1",
                                       "inverse_brown_conrady",
                                       "Inverse Brown Conrady",
                                       "2"};
  if (model.starts_with("distortion.")) model.erase(0, std::string("distortion.").size());
  const auto is_one_of = [&](const auto& names) {
    return std::find(std::begin(names), std::end(names), model) != std::end(names);
  };
  const bool is_pinhole = is_one_of(kPinholes);
  if (is_one_of(kPlumbBob) || (is_pinhole && !distorts)) return;
  throw InputError(place, fmt::format("{} is {}, must be {}{}", key, model, kPlumbBob[0],
                                      is_pinhole ? ", or all coeffs 0" : ""));
}

}  // namespace depthgrid
