#include "mapper/io/map_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/map_image.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using internal::ShadeImage;
using internal::ShadeRule;

// Origins are printed with six decimals or more, so a smaller offset from the cell lattice is
// rounding.
constexpr double kOriginRoundingM = 1e-6;
constexpr double kMaxOriginCells = 2.1e9;  // so that indices are within int

struct MapYaml {
  std::string image;
  double resolution_m = 0.0;
  std::vector<double> origin = {0.0, 0.0, 0.0};
  std::string negate = "0";
  ShadeRule rule;

  void Visit(OptionsVisitor& v) {
    v.Text("image", image, "image file, relative to this one");
    v.Number("resolution", resolution_m, {1e-6, 1e4}, "metres a pixel");
    v.Numbers("origin", origin, {-kFarthestMapM, kFarthestMapM},
              "x, y, yaw of the lower left pixel's corner");
    v.Text("negate", negate, "white is occupied");
    v.Number("occupied_thresh", rule.thresholds.occupied_prob, {0.0, 1.0}, "occupied above");
    v.Number("free_thresh", rule.thresholds.free_prob, {0.0, 1.0}, "free below");
    v.Choice("mode", rule.mode,
             {{MapMode::kTrinary, "trinary"}, {MapMode::kScale, "scale"}, {MapMode::kRaw, "raw"}},
             "meaning of the shades");
  }
};

MapYaml ReadYaml(const std::string& path) {
  // Nav2's files may have keys for other nodes (map_type).
  const Config config = Config::FromFile(path).Only(
      {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"});
  for (const char* key : {"image", "resolution", "origin"}) {
    if (!config.Has(key)) throw InputError(path, fmt::format("key '{}' is missing", key));
  }
  MapYaml yaml;
  config.Read(yaml);
  if (yaml.image.empty()) throw InputError(path, "image is empty, must name a file");
  if (yaml.origin.size() != 2 && yaml.origin.size() != 3) {
    throw InputError(path, fmt::format("origin has {}, must be [x, y, yaw]",
                                       Counted(yaml.origin.size(), "number")));
  }
  yaml.origin.resize(3, 0.0);
  if (yaml.negate != "0" && yaml.negate != "1" && yaml.negate != "true" && yaml.negate != "false") {
    throw InputError(path, fmt::format("negate is '{}', must be 0 or 1", yaml.negate));
  }
  yaml.rule.negate = yaml.negate == "1" || yaml.negate == "true";
  const auto& [occupied, free] = yaml.rule.thresholds;
  if (free > occupied) {
    throw InputError(path,
                     fmt::format("free_thresh {} is above occupied_thresh {}", free, occupied));
  }
  const double origin_cells = std::hypot(yaml.origin[0], yaml.origin[1]) / yaml.resolution_m;
  if (origin_cells > kMaxOriginCells) {
    throw InputError(path,
                     fmt::format("origin is {:.3g} cells of {} m from zero, must be at most {:.3g}",
                                 origin_cells, yaml.resolution_m, kMaxOriginCells));
  }
  return yaml;
}

std::vector<std::string> DoubtsOf(const MapYaml& yaml, const std::string& path) {
  // Cells of navigation maps are centimetres in size, outdoors decimetres.
  constexpr double kLargestCellM = 1.0;
  std::vector<std::string> doubts;
  if (yaml.resolution_m > kLargestCellM) {
    doubts.push_back(fmt::format(
        "{}: resolution is {:g}, cells of so many metres: is it in millimetres ({:g}) or "
        "centimetres ({:g})?",
        path, yaml.resolution_m, 1e-3 * yaml.resolution_m, 1e-2 * yaml.resolution_m));
  }
  if (const double yaw = yaml.origin[2]; std::abs(yaw) > 2.0 * kPi) {
    doubts.push_back(fmt::format(
        "{}: origin has a yaw of {:g} rad, more than a turn: is it in degrees ({:.4g} rad)?", path,
        yaw, RadFromDeg(yaw)));
  }
  return doubts;
}

// The lattice cell of the image's lower-left pixel, and how the lattice lies in the world.
void Place(const MapYaml& yaml, MapFile& file) {
  const Pose2 world_from_corner{yaml.origin[0], yaml.origin[1], WrapAngle(yaml.origin[2])};
  const Pose2 level_from_corner = Pose2{0, 0, -world_from_corner.yaw_rad} * world_from_corner;
  GridGeometry& geometry = file.map.geometry;
  geometry.resolution_m = yaml.resolution_m;
  geometry.min_cell = {static_cast<int>(std::lround(level_from_corner.x_m / yaml.resolution_m)),
                       static_cast<int>(std::lround(level_from_corner.y_m / yaml.resolution_m))};
  const Eigen::Vector2d corner_in_grid = geometry.OriginM();
  file.world_from_grid =
      world_from_corner * Inverse(Pose2{corner_in_grid.x(), corner_in_grid.y(), 0.0});
  if (world_from_corner.yaw_rad == 0.0 &&
      file.world_from_grid.translation().cwiseAbs().maxCoeff() < kOriginRoundingM) {
    file.world_from_grid = Pose2{};
  }
}

// Expresses the map in `world_from_frame`, on its lattice if the origins differ by whole cells up
// to rounding.
void PutInto(const Pose2& world_from_frame, const std::string& yaml_path, MapFile& file) {
  if (world_from_frame == Pose2{}) return;
  GridGeometry& geometry = file.map.geometry;
  const double r = geometry.resolution_m;
  Pose2& pose = file.world_from_grid;
  pose = Inverse(world_from_frame) * pose;
  const Eigen::Vector2d corner_m = geometry.OriginM();
  const double away_cells = (pose * corner_m).norm() / r;
  if (away_cells > kMaxOriginCells) {
    throw InputError(
        yaml_path,
        fmt::format(
            "lies {:.3g} cells from where the other map has its zero, must be at most {:.3g}",
            away_cells, kMaxOriginCells));
  }
  const double reach_m =
      corner_m.norm() + r * std::hypot(geometry.width_cells, geometry.height_cells);
  if (std::abs(pose.yaw_rad) * reach_m > kOriginRoundingM) return;
  const Eigen::Array2d cells = (pose.translation() / r).array().round();
  geometry.min_cell.x += static_cast<int>(cells.x());
  geometry.min_cell.y += static_cast<int>(cells.y());
  pose = {pose.x_m - cells.x() * r, pose.y_m - cells.y() * r, 0.0};
  if (pose.translation().cwiseAbs().maxCoeff() < kOriginRoundingM) pose = Pose2{};
}

// The axis-aligned bounding rectangle of a map, which may be rotated.
GridGeometry AlignedGeometry(const MapFile& file) {
  const GridGeometry& source = file.map.geometry;
  const double r = source.resolution_m;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const int x : {0, source.width_cells}) {
    for (const int y : {0, source.height_cells}) {
      const Eigen::Vector2d corner =
          file.world_from_grid * Eigen::Vector2d(source.OriginM() + r * Eigen::Vector2d(x, y));
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  const Cell min_cell = CellOf(low, r);
  const Cell max_cell = CellOf(high, r);
  return {r, min_cell, max_cell.x - min_cell.x + 1, max_cell.y - min_cell.y + 1};
}

// The bounding rectangle of a long rotated image may be too large.
void RequireAlignable(const MapFile& file, const std::string& yaml_path) {
  const double yaw_rad = file.world_from_grid.yaw_rad;
  const GridGeometry aligned = AlignedGeometry(file);
  if (aligned.size() <= kMaxMapCells) return;
  throw InputError(
      yaml_path,
      fmt::format("origin turns the map's {} x {} cells by {:.3g} rad, so that it spans {} x {}; "
                  "a map may have {}",
                  file.map.geometry.width_cells, file.map.geometry.height_cells, yaw_rad,
                  aligned.width_cells, aligned.height_cells, kMaxMapCells));
}

const char* NameOf(MapMode mode) {
  if (mode == MapMode::kScale) return "scale";
  return mode == MapMode::kRaw ? "raw" : "trinary";
}

}  // namespace

MapFile ReadMap(const std::string& yaml_path, const Pose2& world_from_frame) {
  const std::string extension = fs::path(yaml_path).extension().string();
  if (extension == ".pgm" || extension == ".png") {
    throw InputError(yaml_path, "is a map's image; the map is the YAML file that names it");
  }
  const MapYaml yaml = ReadYaml(yaml_path);
  const fs::path image_path = fs::path(yaml_path).parent_path() / yaml.image;
  std::error_code ignored;  // such as for a name that is too long
  if (!fs::exists(image_path, ignored)) {
    throw InputError(yaml_path, "image is '" + yaml.image + "': no such file");
  }
  const ShadeImage image = internal::ReadShades(image_path.string(), yaml.rule.mode);
  MapFile file;
  file.negate = yaml.rule.negate;
  file.doubts = DoubtsOf(yaml, yaml_path);
  Place(yaml, file);
  file.map.geometry.width_cells = image.width_px;
  file.map.geometry.height_cells = image.height_px;
  PutInto(world_from_frame, yaml_path, file);
  if (file.world_from_grid != Pose2{}) RequireAlignable(file, yaml_path);
  file.map.occupied_prob.reserve(file.map.geometry.size());
  for (int v = image.height_px - 1; v >= 0; --v) {
    for (int u = 0; u < image.width_px; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width_px) +
                            static_cast<std::size_t>(u);
      file.map.occupied_prob.push_back(
          internal::OccupiedProb(image.shade[i], image.opaque[i], yaml.rule));
    }
  }
  return file;
}

OccupancyMap AlignedMap(const MapFile& file) {
  if (file.world_from_grid == Pose2{}) return file.map;
  const double r = file.map.geometry.resolution_m;
  OccupancyMap aligned(AlignedGeometry(file));
  const Pose2 grid_from_world = Inverse(file.world_from_grid);
  // If origins differ by half a cell, centres lie on cell boundaries. All of them then go to the
  // upper cell, rather than to either by rounding.
  const Eigen::Vector2d above = Eigen::Vector2d::Constant(kOriginRoundingM);
  for (std::size_t i = 0; i < aligned.occupied_prob.size(); ++i) {
    const Eigen::Vector2d centre = CellCentre(aligned.geometry.CellAt(i), r);
    aligned.occupied_prob[i] = file.map.At(CellOf(grid_from_world * centre + above, r));
  }
  return aligned;
}

StateMap ReadStates(const std::string& path, const Pose2& world_from_frame) {
  return StatesOf(AlignedMap(ReadMap(path, world_from_frame)));
}

CellSet ReadFreeCells(const std::string& path) {
  const StateMap states = ReadStates(path);
  CellSet free(states.geometry);
  for (std::size_t i = 0; i < states.states.size(); ++i) {
    free.members[i] = states.states[i] == CellState::kFree;
  }
  return free;
}

std::string MapImageOf(const std::string& yaml_path, MapMode mode) {
  const char* ending = mode == MapMode::kScale ? ".scale.png" : ".pgm";
  return fs::path(yaml_path).replace_extension(ending).string();
}

OccupancyMap MapToWrite(const OccupancyMap& map) {
  if (map.geometry.size() > 0) return map;
  return OccupancyMap(OnlyCell(map.geometry.min_cell, map.geometry.resolution_m));
}

void WriteMap(const std::string& yaml_path, const OccupancyMap& map, MapMode mode) {
  if (map.geometry.size() == 0) return WriteMap(yaml_path, MapToWrite(map), mode);
  Require(map.occupied_prob.size() == map.geometry.size(), "a map has a value for each cell");
  const fs::path image_path = MapImageOf(yaml_path, mode);
  if (image_path == fs::path(yaml_path)) {
    throw InputError(yaml_path, "is the name that the map's image has, must be the YAML file's");
  }
  const StateThresholds written = internal::WrittenThresholds(mode);
  const Eigen::Vector2d origin = map.geometry.OriginM();
  // Fifteen digits: enough for a lattice corner anywhere on earth, without a double's rounding
  // errors.
  WriteFileToDisk(image_path.string(), internal::EncodeMapImage(map, mode));
  WriteFileToDisk(
      yaml_path,
      fmt::format("image: {}\nmode: {}\nresolution: {:.15g}\norigin: [{:.15g}, {:.15g}, 0]\n"
                  "negate: 0\noccupied_thresh: {}\nfree_thresh: {}\n",
                  image_path.filename().string(), NameOf(mode), map.geometry.resolution_m,
                  origin.x(), origin.y(), written.occupied_prob, written.free_prob));
}

void WriteMap(const std::string& yaml_path, const StateMap& map) {
  WriteMap(yaml_path, CertainMap(map));
}

}  // namespace depthgrid
