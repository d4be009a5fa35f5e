#include "tests/fuzz/targets.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "eval/files/csv_table.h"
#include "mapper/core/error.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/camera_mount.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/config.h"
#include "mapper/io/icl_folder.h"
#include "mapper/io/loop_events.h"
#include "mapper/io/map_file.h"
#include "mapper/io/pgm.h"
#include "mapper/io/png.h"
#include "mapper/io/pose_file.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/scan_file.h"
#include "mapper/io/sequence.h"
#include "mapper/io/slam_jumps.h"
#include "mapper/io/tum_folder.h"
#include "sim/mesh/ply_file.h"
#include "sim/scene/scene_file.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// For parsers of files: a folder of this process.
class Scratch {
 public:
  Scratch() {
    folder_ = fs::temp_directory_path() / ("depthgrid_fuzz." + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string Put(const std::string& name, std::string_view bytes) const {
    std::ofstream(folder_ / name, std::ios::binary | std::ios::trunc) << bytes;
    return (folder_ / name).string();
  }

 private:
  fs::path folder_;
};

const Scratch& TheScratch() {
  static const Scratch scratch;
  return scratch;
}

template <typename Parse>
bool Accepts(Parse parse) {
  try {
    parse();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

const std::vector<double>& Stamps() {
  static const std::vector<double> stamps = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  return stamps;
}

bool TryDepthPng(std::string_view bytes) {
  return Accepts([&] { DecodeDepthPng(bytes, {}, "x"); });
}

bool TryColourPng(std::string_view bytes) {
  const bool rgb = Accepts([&] { DecodeRgbPng(bytes, "x"); });
  return Accepts([&] { DecodeRgbaPng(bytes, "x"); }) || rgb;
}

// What is accepted must also survive what is done with it next.
bool TryTrajectory(std::string_view bytes) {
  return Accepts([&] {
    std::vector<std::string> warnings;
    SlamOutput slam = SlamOutputOf(ParsePoses(std::string(bytes), "x", {Stamps()}, warnings).poses);
    const std::vector<int> jumps = FindJumps(slam.live, slam.final);
    LoopsFromRevision(slam.live, slam.final, jumps);
    StartEpochs(jumps, slam.live);
  });
}

bool TryLoopEvents(std::string_view bytes) {
  return Accepts([&] { ParseSlamEvents(std::string(bytes), "x", {Stamps()}, 0.02); });
}

bool TryCamera(std::string_view bytes) {
  return Accepts([&] { ParseCameraDescription(std::string(bytes), "x"); });
}

bool TryCameraMount(std::string_view bytes) {
  return Accepts([&] { Said(ParseCameraMount(std::string(bytes), "x")); });
}

bool TryFileList(std::string_view bytes) {
  return Accepts([&] { ParseFileList(std::string(bytes), "x"); });
}

bool TryRayLengths(std::string_view bytes) {
  static const PinholeCamera camera{4, 3, 3.0, 3.0, 1.5, 1.0, {}};
  return Accepts([&] { ParseRayLengths(std::string(bytes), camera, "x"); });
}

bool TryCarmen(std::string_view bytes) {
  return Accepts([&] {
    const auto source = OpenCarmenLog(TheScratch().Put("x.log", bytes));
    while (source->Next()) continue;
  });
}

bool TryPgm(std::string_view bytes) {
  return Accepts([&] { DecodePgm(bytes, "x"); });
}

// The YAML text, a line `====`, the image.
bool TryMap(std::string_view bytes) {
  constexpr std::string_view kSeparator = "\n====\n";
  const std::size_t end = std::min(bytes.find(kSeparator), bytes.size());
  const std::string yaml = TheScratch().Put("x.yaml", bytes.substr(0, end));
  TheScratch().Put("x.pgm", bytes.substr(std::min(end + kSeparator.size(), bytes.size())));
  return Accepts([&] { AlignedMap(ReadMap(yaml)); });
}

struct SomeOptions {
  SlamOptions slam;
  SequenceOptions sequence;
  void Visit(OptionsVisitor& v) {
    v.Group("slam", slam, "how SLAM errs");
    v.Group("sequence", sequence, "the sequence");
  }
};

// All that is asked of a tree, whether its keys are known or not.
void AskOf(const Config& config) {
  for (const ConfigEntry& entry : config.Entries()) {
    if (entry.map) AskOf(*entry.map);
    Accepts([&] { config.Text(entry.key); });
    Accepts([&] { config.List(entry.key); });
    Accepts([&] { Config(config).TakeMaps(entry.key); });
    Accepts([&] { Config(config).Set(entry.key, entry.text); });
  }
  Accepts([&] { Config::FromText(config.ToYaml(), "written"); });
}

bool TrySettings(std::string_view bytes) {
  return Accepts([&] {
    const Config config = Config::FromText(std::string(bytes), "x");
    AskOf(config);
    SomeOptions options;
    config.Read(options);
    Config::FromText(ToYaml(options), "written").Read(options);
  });
}

bool TryScans(std::string_view bytes) {
  return Accepts([&] {
    const std::string path = TheScratch().Put("x.bin", bytes);
    const std::vector<StoredScan> scans = ReadScans(path);
    WriteScans(path, scans);
    if (ReadScans(path) != scans) throw std::logic_error("scans change when they are written");
    GridOptions coarse;  // scans of damaged numbers reach far
    coarse.resolution_m = 1.0;
    MapDrawing drawing(coarse);
    for (const StoredScan& stored : scans) drawing.Add(*stored.scan, stored.map_from_base);
    drawing.Map();
  });
}

bool TryCsv(std::string_view bytes) {
  return Accepts([&] { ReadCsv(TheScratch().Put("x.csv", bytes)); });
}

bool TrySceneYaml(std::string_view bytes) {
  return Accepts([&] { ReadSceneFile(TheScratch().Put("x.yaml", bytes)); });
}

bool TryPly(std::string_view bytes) {
  return Accepts([&] { ReadPly(TheScratch().Put("x.ply", bytes)); });
}

}  // namespace

const std::vector<FuzzTarget>& FuzzTargets() {
  static const std::vector<FuzzTarget> targets = {{"depth_png", TryDepthPng},
                                                  {"colour_png", TryColourPng},
                                                  {"trajectory", TryTrajectory},
                                                  {"loop_events", TryLoopEvents},
                                                  {"camera", TryCamera},
                                                  {"camera_mount", TryCameraMount},
                                                  {"file_list", TryFileList},
                                                  {"ray_lengths", TryRayLengths},
                                                  {"carmen", TryCarmen},
                                                  {"pgm", TryPgm},
                                                  {"map", TryMap},
                                                  {"settings", TrySettings},
                                                  {"scans", TryScans},
                                                  {"csv", TryCsv},
                                                  {"scene", TrySceneYaml},
                                                  {"ply", TryPly}};
  return targets;
}

const FuzzTarget& FuzzTargetNamed(const std::string& name) {
  for (const FuzzTarget& target : FuzzTargets()) {
    if (target.name == name) return target;
  }
  throw std::out_of_range("no fuzz target " + name);
}

}  // namespace depthgrid
