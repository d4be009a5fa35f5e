// Handling of the finished map in `depthgrid map --map DIR`: where the sequence starts in it,
// whether it remains in it, and the map that is output.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/cli/map_settings.h"
#include "eval/output/output_folder.h"
#include "eval/run/mapping_run.h"
#include "mapper/map_start.h"

namespace depthgrid::cli {

// The map of the run's folder that the request names; empty if it names none.
std::optional<PriorMap> OpenPrior(const MapRequest& request);

// Finds, or takes from the request, where `source` starts in the map, prints it, and adds doubts
// about it to `warnings`. Changes `options` so that the mapper can continue from the map.
MapStart BeginIn(PriorMap& prior, const MapRequest& request, FrameSource& source,
                 MapperOptions& options, std::vector<std::string>& warnings);

// Warnings from the finished run about its start and about the map.
std::vector<std::string> DoubtsOfPlace(const MapRequest& request, const MapStart& start,
                                       const MappingRun& run);

// Warns if the last run that added to the map had its camera at another height.
std::optional<std::string> DoubtOfHeight(const MapRequest& request, const MappingRun& run);

// After localisation only, copies the prior map and its scans byte by byte over those in `folder`.
// If that map's image is missing or has another name, the map drawn from its scans is kept.
void KeepMap(const std::string& map, const OutputFolder& folder);
// Warns if the prior map.yaml could not be copied for that reason, or differs from `drawn`, the map
// drawn from its scans.
std::vector<std::string> DoubtsOfKeptMap(const MapRequest& request, const OccupancyMap& drawn);

// Warns if the prior map named in a run.yaml that is repeated has changed since. `hash`: its
// present hash.
std::optional<std::string> DoubtOfMapRecord(const MapArguments& given, const MapRequest& request,
                                            const std::string& hash);

}  // namespace depthgrid::cli
