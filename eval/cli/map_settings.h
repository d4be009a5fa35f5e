// Options and settings of `depthgrid map`. A run.yaml of a map as input repeats that run.
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
  MapArguments arguments;  // with files from a run.yaml where the command line names none
  Config config;
  // With absolute paths, so that run.yaml is valid from any folder; except sequence.camera and
  // camera_mount, which are as given until they have been read, for messages.
  MapSettings settings;
  // The base's initial pose in the finished map, if given.
  std::optional<Pose2> start;
  Config provenance;  // of a run.yaml
};
MapRequest ReadMapRequest(const MapArguments& given);

// "1.5,-2,90" is 1.5 m, -2 m and 90 degrees; empty unless three finite numbers.
constexpr const char* kPlaceRule = "must be three finite numbers: X,Y,YAW_DEG";
std::optional<Pose2> PlaceOf(const std::string& text);

// A file's absolute path; empty if `path` is.
std::string FromEverywhere(const std::string& path);

// The files and folders that the request reads, as named.
std::vector<std::string> InputsOf(const MapArguments& given, const MapRequest& request);

// Warnings about settings that others make meaningless.
std::vector<std::string> DoubtsOfSettings(const MapArguments& given, const MapRequest& request);

}  // namespace depthgrid::cli
