#include "eval/cli/finished_map.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "eval/cli/console.h"
#include "eval/doubts/place_check.h"
#include "eval/output/run_folder.h"
#include "eval/run/prior_run.h"
#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/core/median.h"
#include "mapper/io/mapped_files.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

// Why a start that was found is uncertain.
std::string WhyUncertain(const MapStart& start) {
  if (start.fits_badly()) {
    return "little of what is seen lies on it: the sequence may be of another place or begin "
           "outside of the map";
  }
  if (start.hardly_moved()) {
    return "the first views are from one place only: another place may fit as well";
  }
  return "another place fits nearly as well";
}

std::string Numbers(const Pose2& pose) {
  return fmt::format("{},{},{}", Number(pose.x_m, 2), Number(pose.y_m, 2),
                     Number(DegFromRad(pose.yaw_rad), 1));
}

// "elsewhere", with the place that fits better than the given one, in the form of --start.
std::string Elsewhere(const MapStart& start, const Pose2& base_from_laser) {
  const FoundPlace& place = start.place;
  if (!place.second || place.second_score <= place.score) return "elsewhere";
  const Pose2 slam_from_base = Inverse(place.map_from_slam) * start.map_from_base;
  return fmt::format("elsewhere (--start {} has fit {:.2f}, that one {:.2f})",
                     Numbers(*place.second * slam_from_base * Inverse(base_from_laser)),
                     place.second_score, place.score);
}

std::optional<std::string> DoubtOfStart(const std::string& map, const MapStart& start,
                                        const Pose2& base_from_laser) {
  if (start.contradicted()) {
    return fmt::format(
        "{}: {}, {:.0f} % of what the sequence's first metres show there is free or behind a wall "
        "in it: the sequence is of another place, begins {}, or much has changed",
        map, start.known ? "at the given start" : "where it fits it best",
        100.0 * start.trial->against,
        start.known ? Elsewhere(start, base_from_laser) : "outside of the map");
  }
  if (!start.uncertain()) return {};
  if (start.known) {
    const char* why = start.fits_badly()
                          ? "little of what the sequence's first metres show lies on it"
                          : "the sequence's first views fit worse than at another place";
    return fmt::format("{}: at the given start, {}: the sequence begins {}, or much has changed",
                       map, why, Elsewhere(start, base_from_laser));
  }
  return fmt::format("{}: where in it the sequence begins is uncertain, {} (--start says where)",
                     map, WhyUncertain(start));
}

void SayStart(const std::string& map, const PriorMap& prior, const MapStart& start, bool camera) {
  const Pose2& at = start.place.map_from_slam;
  fmt::print("{}: {}; {} frame lies at ({} m, {} m, {} degrees) of it, fit {:.2f}{}, ", map,
             Counted(prior.frames.size(), "scan"), camera ? "SLAM's" : "odometry's",
             Number(at.x_m, 2), Number(at.y_m, 2), Number(DegFromRad(at.yaw_rad), 1),
             start.place.score, start.known ? " at the given start" : "");
  fmt::print("elsewhere {:.2f}\n", start.place.second_score);
  if (!start.trial || start.trial->places < 2) return;
  fmt::print(
      "{} places tried on {}: the one taken agrees with the map by {:.2f}, the best other by "
      "{:.2f}\n",
      start.trial->places, Counted(start.trial->frames, "frame"), start.trial->agreement,
      start.trial->agreement_next);
}

std::string YamlOf(const std::string& map) { return (fs::path(map) / "map.yaml").string(); }

// Why the map cannot be copied under the file names of a run's folder; empty if it can.
std::optional<std::string> WhyNotKept(const std::string& map) {
  const std::string yaml = YamlOf(map);
  try {
    ReadMap(yaml);
    const std::string image = Config::FromFile(yaml).Text("image");
    if (image == "map.pgm" || image == "map.scale.png") return {};
    return fmt::format("{}: image is {}, must be map.pgm or map.scale.png to be kept", yaml, image);
  } catch (const InputError& error) {
    return error.what();
  }
}

// How the map's geometry differs from that drawn from the scans; empty if it does not.
std::string Difference(const MapFile& file, const GridGeometry& drawn) {
  const GridGeometry& g = file.map.geometry;
  if (g.resolution_m != drawn.resolution_m) {
    return fmt::format("has cells of {:g} m, they are of {:g} m", g.resolution_m,
                       drawn.resolution_m);
  }
  if (file.world_from_grid != Pose2{}) return "is turned or lies between their cells";
  if (g == drawn) return "";
  const auto text = [](const GridGeometry& of) {
    const Eigen::Vector2d origin_m = of.OriginM();
    return fmt::format("{} x {} cells from ({}, {}) on", of.width_cells, of.height_cells,
                       Number(origin_m.x(), 2), Number(origin_m.y(), 2));
  };
  return fmt::format("has {}, theirs {}", text(g), text(drawn));
}

}  // namespace

std::optional<PriorMap> OpenPrior(const MapRequest& request) {
  const MapArguments& arguments = request.arguments;
  if (arguments.map.empty()) return {};
  PriorMap prior = ReadPriorRun(arguments.map);
  prior.fixed = arguments.localise;
  return prior;
}

MapStart BeginIn(PriorMap& prior, const MapRequest& request, FrameSource& source,
                 MapperOptions& options, std::vector<std::string>& warnings) {
  const MapArguments& arguments = request.arguments;
  // The paper's method matches against the last two submaps only, so one must hold all scans. For
  // other methods the setting only determines over how many frames motions are reported and how
  // many scans are kept.
  if (options.method == MapperMethod::kPaper) options.submap.scans = kAllScansInOneSubmap;
  const double within_m = request.settings.start_within_m;
  // A given start is of the point that the poses are of (the base).
  const Pose2 base_from_laser = request.settings.sequence.laser.mount.base_from_laser();
  auto start = request.start ? FindStartNear(prior, *request.start * base_from_laser, source,
                                             options, within_m)
                             : FindStart(prior, source, options);
  if (!start) throw InputError(arguments.input, "shows nothing that could be found in the map");
  prior.map_from_slam = start->place.map_from_slam;
  SayStart(arguments.map, prior, *start, source.Camera().has_value());
  const auto doubt = DoubtOfStart(arguments.map, *start, base_from_laser);
  if (doubt) warnings.push_back(*doubt);
  return *std::move(start);
}

namespace {

// Why the finished run may lie at a wrong place of the map; empty if nothing says so. `against`:
// the share of what it shows of the earlier map that contradicts it.
std::optional<std::string> DoubtOfFoundPlace(const MapRequest& request, const MapStart& start,
                                             const MappingRun& run, double against) {
  const std::string& map = request.arguments.map;
  // A start in a finished map is uncertain until the scans confirm it.
  if (const auto lost = FramesLost(run, request.arguments.localise)) {
    return map + ": " + TextOf(*lost);
  }
  if (against > kMuchAgainst && !start.contradicted()) {
    return fmt::format(
        "{}: of what the sequence shows of the map as it was, {:.0f} % is free or behind a wall in "
        "it: the sequence was laid onto another place of it, went astray on the way, or much has "
        "changed",
        map, 100.0 * against);
  }
  return {};
}

std::optional<std::string> DoubtOfLine(const std::string& map, const MapStart& start,
                                       const MappingRun& run) {
  const auto& unsure = start.place.unsure;
  if (!unsure || SeesAlong(run, *unsure)) return {};
  return fmt::format(
      "{}: where in it the sequence begins is not known along a direction of {:.0f} degrees, it "
      "may be {:.1f} m off: nothing that was seen ends along it",
      map, DegFromRad(unsure->direction_rad), unsure->reach_m);
}

// What a doubtful place means for a map that was extended there. Of twelve extensions at right
// places (two rooms, lasers) .2 to .5 % contradicted the earlier map, with most furniture moved
// 20 %; of one 16 m off, onto rooms much alike, 16 %.
std::string DoubtOfExtension(const std::string& output, double against) {
  return fmt::format(
      "{}: if the sequence was laid onto a wrong place, this map shows two places on top of each "
      "other ({:.1f} % of what it shows of the earlier map contradicts it; less than 1 % where the "
      "place is right and nothing was moved): --start X,Y,YAW_DEG says where it begins, --localise "
      "leaves the map as it was",
      output, 100.0 * against);
}

// The start that is taken first is where the first views fit; what the whole run says of the first
// frame is more certain, so a given start is compared with that.
std::optional<std::string> DoubtOfGivenStart(const MapRequest& request, const MappingRun& run) {
  if (!request.start || request.settings.start_within_m == 0.0) return {};
  const auto moved = StartMoved(run, *request.start);
  if (!moved) return {};
  return fmt::format(
      "start {}: the sequence begins {:.2f} m and {:.1f} degrees from there, at {}, where the "
      "scans fit better (--start-within 0 takes the place as it is given)",
      Numbers(*request.start), moved->move.translation().norm(),
      std::abs(DegFromRad(moved->move.yaw_rad)), Numbers(moved->found));
}

}  // namespace

std::vector<std::string> DoubtsOfPlace(const MapRequest& request, const MapStart& start,
                                       const MappingRun& run) {
  std::vector<std::string> doubts;
  if (auto moved = DoubtOfGivenStart(request, run)) doubts.push_back(*std::move(moved));
  const MapperOptions& options = request.settings.mapper;
  if (options.fusion.TrustsSlamAlone()) return doubts;
  const bool extends = !request.arguments.localise;
  const double against = extends ? AgreementWithEarlier(run, options.grid).share_against() : 0.0;
  auto doubt = DoubtOfFoundPlace(request, start, run, against);
  const bool doubtful = doubt || start.uncertain() || start.contradicted();
  if (!doubt) doubt = DoubtOfLine(request.arguments.map, start, run);
  if (doubt) doubts.push_back(*std::move(doubt));
  if (extends && doubtful) {
    doubts.push_back(DoubtOfExtension(request.arguments.common.output, against));
  }
  return doubts;
}

std::optional<std::string> DoubtOfHeight(const MapRequest& request, const MappingRun& run) {
  const std::string& map = request.arguments.map;
  const MapperOptions& options = request.settings.mapper;
  if (options.fusion.TrustsSlamAlone() || options.scan.mode != ScanMode::kFull) return {};
  const auto of_map_m = CameraHeightOfPrior(map);
  std::vector<double> heights_m;
  for (const FrameReport& report : run.reports) {
    if (report.stand) heights_m.push_back(report.stand->height_m);
  }
  if (!of_map_m || heights_m.empty()) return {};
  const double height_m = UpperMedian(std::move(heights_m));
  // If farther apart, the two slices have nothing in common.
  const double slice_m = 2.0 * options.scan.slice_half_height_m;
  if (slice_m == 0.0 || std::abs(height_m - *of_map_m) <= slice_m) return {};
  return fmt::format(
      "{}: made with the camera {:.2f} m above the floor, which is {:.2f} m here: what is matched "
      "is what stands at the camera's height, and furniture differs there, so poses are less "
      "certain",
      map, *of_map_m, height_m);
}

void KeepMap(const std::string& map, const OutputFolder& folder) {
  const auto give_way = [&](const char* name, const fs::path& kept) {
    fs::remove(folder.File(name));
    if (fs::exists(kept)) fs::copy_file(kept, folder.File(name));
  };
  const fs::path prior = map;
  give_way("scans.bin", prior / "scans.bin");
  give_way("matched.bin", MatchedFileOf(map));
  if (WhyNotKept(map)) return;
  for (const char* name : {"map.yaml", "map.pgm", "map.scale.png"}) give_way(name, prior / name);
}

std::vector<std::string> DoubtsOfKeptMap(const MapRequest& request, const OccupancyMap& drawn) {
  const std::string& map = request.arguments.map;
  if (const auto why = WhyNotKept(map)) {
    return {*why + ": the map handed on is drawn from its scans"};
  }
  // With other grid settings that is expected, and already reported.
  if (DoubtOfPrior(map, request.settings.mapper, false)) return {};
  const std::string difference = Difference(ReadMap(YamlOf(map)), MapToWrite(drawn).geometry);
  if (difference.empty()) return {};
  return {fmt::format("{}: {}: it was edited, and the poses are in the frame of {}", YamlOf(map),
                      difference, (fs::path(map) / "scans.bin").string())};
}

std::optional<std::string> DoubtOfMapRecord(const MapArguments& given, const MapRequest& request,
                                            const std::string& hash) {
  if (!given.map.empty() || !request.provenance.Has("map_hash")) return {};
  const std::string recorded = request.provenance.Text("map_hash", hash);
  if (recorded == hash) return {};
  return fmt::format(
      "{}: map_hash is {}, but that of the map in {} is {} now: this run differs from the recorded "
      "one",
      given.input, recorded, request.arguments.map, hash);
}

}  // namespace depthgrid::cli
