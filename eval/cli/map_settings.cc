#include "eval/cli/map_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "eval/experiment/idle_settings.h"
#include "eval/experiment/shipped.h"
#include "eval/files/one_result.h"
#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::cli {
namespace {

// The settings of a map's run.yaml, which is given as input to repeat that run.
Config SettingsOf(const std::string& run_yaml) {
  Config config = Config::FromFile(run_yaml);
  if (config.Has("scene")) throw InputError(run_yaml, "is an experiment; `depthgrid run` takes it");
  if (!config.Has("input"))
    throw InputError(run_yaml, "key 'input' is missing: is no map's run.yaml");
  config.Take("provenance");
  return config;
}

bool IsSettingsFile(const std::string& input) { return input.ends_with(".yaml"); }

Config ConfigOf(const MapArguments& arguments, const std::vector<std::string>& overrides) {
  Config config = IsSettingsFile(arguments.input) ? SettingsOf(arguments.input) : Config();
  const auto set = [&config](const std::string& key, const std::string& option,
                             const std::string& value) {
    if (!value.empty()) config.Set(key, value, option + " " + value);
  };
  set("sequence.format", "--format", arguments.format);
  set("sequence.camera", "--camera", arguments.camera);
  set("sequence.world_up", "--up", arguments.world_up);
  set("start", "--start", arguments.start);
  set("start_within_m", "--start-within", arguments.start_within);
  for (const std::string& assignment : overrides) config.Set(assignment);
  return config;
}

// Rejects overrides of keys that run.yaml has for command-line options: with any other input they
// would have no effect.
void RequireOptionsFor(const std::vector<std::string>& overrides) {
  struct Named {
    const char* key;
    const char* instead;
  };
  Config config;
  for (const std::string& assignment : overrides) config.Set(assignment);
  for (const Named& named :
       {Named{"input", "the input is the command's argument"}, Named{"poses", "give --poses FILE"},
        Named{"final_poses", "give --final-poses FILE"}, Named{"loops", "give --loops FILE"},
        Named{"map", "give --map DIR"}, Named{"start", "give --map DIR --start X,Y,YAW_DEG"},
        Named{"start_within_m", "give --start X,Y,YAW_DEG --start-within M"},
        Named{"localise", "give --map DIR --localise"}}) {
    if (!config.Has(named.key)) continue;
    throw InputError(config.PlaceOfKey(named.key),
                     fmt::format("is for a map's run.yaml as input; {}", named.instead));
  }
}

// Rejects inputs or outputs of other commands.
void RefuseOtherInputs(const std::string& input, SequenceFormat format) {
  namespace fs = std::filesystem;
  const std::string shipped = ShippedFolder(ShippedKind::kExperiment);
  std::error_code error;  // such as of a name that is too long
  if (!IsFileName(input) && !fs::exists(input, error) &&
      fs::exists(fs::path(shipped) / (input + ".yaml"), error)) {
    throw InputError(input, "is a shipped experiment; `depthgrid run` takes it");
  }
  if (format != SequenceFormat::kAuto || !fs::exists(fs::path(input) / "run.yaml", error)) return;
  try {
    DetectFormat(input);
  } catch (const InputError&) {
    throw InputError(input,
                     "is the folder of a finished run, no recording; `--map` goes on in its map, "
                     "and the run.yaml in it makes it again");
  }
}

// Images of two renders do not fit their poses, nor SLAM's poses its events. A map beside them that
// was replaced in part is not read.
void RequireOneSequence(const MapArguments& arguments) {
  std::error_code error;  // such as: name too long
  if (std::filesystem::is_directory(arguments.input, error)) {
    RequireOneResult(arguments.input, {kMarkOfRender});
  }
  for (const std::string& file : {arguments.poses, arguments.final_poses, arguments.loops}) {
    RequireOneResultAround(file, {kMarkOfRender, kMarkOfSlam});
  }
}

// Adds the files of the run.yaml where the command line names none.
MapArguments WithFilesOf(const MapSettings& settings, MapArguments arguments) {
  if (!IsSettingsFile(arguments.input)) return arguments;
  arguments.input = settings.input;
  if (arguments.poses.empty()) arguments.poses = settings.poses;
  if (arguments.final_poses.empty()) arguments.final_poses = settings.final_poses;
  if (arguments.loops.empty()) arguments.loops = settings.loops;
  if (arguments.map.empty()) arguments.map = settings.map;
  arguments.localise = arguments.localise || settings.localise;
  return arguments;
}

// Rejects options that need a finished map if there is none.
void RequireMapFor(const MapRequest& request) {
  const MapArguments& arguments = request.arguments;
  const auto refuse = [&](const char* key, const std::string& what) {
    throw InputError(request.config.PlaceOfKey(key), what + " (--map DIR)");
  };
  if (arguments.map.empty() && arguments.localise) {
    refuse("localise", "localise is true, must be false without a map to localise in");
  }
  const std::string& start = request.settings.start;
  if (start.empty()) {
    if (arguments.start_within.empty()) return;
    refuse("start_within_m", "is how far off --start may be: give --start X,Y,YAW_DEG");
  }
  if (!request.start) refuse("start", fmt::format("start is '{}', {}", start, kPlaceRule));
  if (arguments.map.empty()) {
    refuse("start", fmt::format("start is '{}', must be empty without a map to begin in", start));
  }
}

// It would have no effect: that map is not redrawn.
void RefuseMapMode(const MapArguments& arguments) {
  if (!arguments.localise || arguments.output.map_mode == MapMode::kTrinary) return;
  const char* mode = arguments.output.map_mode == MapMode::kScale ? "scale" : "raw";
  throw InputError(fmt::format("--map-mode {}", mode),
                   "is for a map that is drawn; with --localise that of --map stays as it is");
}

}  // namespace

std::optional<Pose2> PlaceOf(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = ParseNumber(text.substr(begin, end - begin));
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  if (numbers.size() != 3) return {};
  return Pose2{numbers[0], numbers[1], WrapAngle(RadFromDeg(numbers[2]))};
}

std::string FromEverywhere(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) return path;
  std::error_code error;  // such as for a pipe, which has no path; reported when it is read
  const fs::path resolved = fs::weakly_canonical(fs::absolute(path), error);
  return (error ? fs::absolute(path) : resolved).string();
}

void MapSettings::Visit(OptionsVisitor& v) {
  v.Text("input", input, "the recorded sequence");
  v.Text("poses", poses, "SLAM's live poses");
  v.Text("final_poses", final_poses, "SLAM's poses after all corrections");
  v.Text("loops", loops, "SLAM's events");
  v.Text("map", map, "the finished run it went on from");
  v.Text("start", start, "where in that map it began, X,Y,YAW_DEG; empty: it was searched for");
  v.Number("start_within_m", start_within_m, {0.0, kMostWithinM},
           "how far off start may be, metres; 0: it is taken as it is");
  v.Flag("localise", localise, "whether that map was left as it is");
  v.Group("sequence", sequence, "how the recorded sequence is read");
  v.Group("mapper", mapper, "the mapper");
}

MapRequest ReadMapRequest(const MapArguments& given) {
  MapRequest request;
  if (!IsSettingsFile(given.input)) RequireOptionsFor(given.common.set);
  request.config = ConfigOf(given, given.common.set);
  if (IsSettingsFile(given.input)) {
    request.provenance = Config::FromFile(given.input).Take("provenance");
  }
  MapSettings& settings = request.settings;
  request.config.Read(settings);
  RequireInRange(settings, "",
                 [&](const std::string& key) { return PlaceOfKey({&request.config}, key); });
  request.arguments = WithFilesOf(settings, given);
  const MapArguments& arguments = request.arguments;
  RefuseOtherInputs(arguments.input, settings.sequence.format);
  RequireOneSequence(arguments);
  request.start = PlaceOf(settings.start);
  RequireMapFor(request);
  RefuseMapMode(arguments);
  settings.input = FromEverywhere(arguments.input);
  settings.poses = FromEverywhere(arguments.poses);
  settings.final_poses = FromEverywhere(arguments.final_poses);
  settings.loops = FromEverywhere(arguments.loops);
  settings.map = FromEverywhere(arguments.map);
  settings.localise = arguments.localise;
  return request;
}

std::vector<std::string> InputsOf(const MapArguments& given, const MapRequest& request) {
  namespace fs = std::filesystem;
  const MapArguments& named = request.arguments;
  const SequenceOptions& sequence = request.settings.sequence;
  std::vector<std::string> inputs = {given.input,          named.input, named.poses,
                                     named.final_poses,    named.loops, sequence.camera,
                                     sequence.camera_mount};
  if (!named.map.empty()) {
    for (const char* name : {"run.yaml", "scans.bin", "matched.bin", "matched.next.bin"}) {
      inputs.push_back((fs::path(named.map) / name).string());
    }
  }
  return inputs;
}

std::vector<std::string> DoubtsOfSettings(const MapArguments& given, const MapRequest& request) {
  const MapArguments& arguments = request.arguments;
  const MapSettings& settings = request.settings;
  const SequenceFormat format = FormatOf(arguments.input, settings.sequence);
  const std::string kind = NameOf(format);
  const std::string input_is =
      fmt::format("{} is {} {}", arguments.input, kind.starts_with('I') ? "an" : "a", kind);
  IdleSettingList idle = IdleSettings(settings.mapper);
  const IdleSettingList of_recording =
      IdleSettings(settings.sequence, format, input_is, !arguments.loops.empty());
  idle.insert(idle.end(), of_recording.begin(), of_recording.end());
  return DoubtsOfOverrides(given.common.set, idle, [&](const std::vector<std::string>& set) {
    MapSettings others;
    ConfigOf(given, set).Read(others);
    return ToYaml(others);
  });
}

}  // namespace depthgrid::cli
