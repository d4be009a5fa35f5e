// What `depthgrid map` maps and how: its options and settings, or a map's run.yaml in place of an
// input, which makes that map again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "mapper/core/pose2.h"
#include "mapper/io/config.h"
#include "mapper/io/sequence.h"
#include "mapper/mapper_options.h"
#include "mapper/match/find_place.h"

namespace depthgrid::cli {

struct MapSettings {
  std::string input;
  std::string poses;
  std::string final_poses;
  std::string loops;
  std::string map;
  std::string start;  // X,Y,YAW_DEG
  double start_within_m = kKnownWithinM;
  bool localise = false;
  SequenceOptions sequence;
  MapperOptions mapper;

  void Visit(OptionsVisitor& v);
};

struct MapRequest {
  MapArguments arguments;  // with the files of a run.yaml that the command line does not name anew
  Config config;
  // Files by absolute paths, so that run.yaml means the same from everywhere; sequence.camera as it
  // is given until it was read, for messages.
  MapSettings settings;
  // Where in the finished map the base is at first, where that is known.
  std::optional<Pose2> start;
  Config provenance;  // of a run.yaml
};
MapRequest ReadMapRequest(const MapArguments& given);

// "1.5,-2,90" is 1.5 m, -2 m and 90 degrees; nothing for what is not three finite numbers.
constexpr const char* kPlaceRule = "must be three finite numbers: X,Y,YAW_DEG";
std::optional<Pose2> PlaceOf(const std::string& text);

// A file's absolute path; none stays none.
std::string FromEverywhere(const std::string& path);

// The files and folders that it is read from, as they are named.
std::vector<std::string> InputsOf(const MapArguments& given, const MapRequest& request);

// What was set beside what makes it mean nothing.
std::vector<std::string> DoubtsOfSettings(const MapArguments& given, const MapRequest& request);

}  // namespace depthgrid::cli
