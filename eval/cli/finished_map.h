// What `depthgrid map --map DIR` does with the finished map: where the sequence begins in it,
// whether it still is there later on, and the map that is handed on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/cli/map_settings.h"
#include "eval/output/output_folder.h"
#include "eval/run/mapping_run.h"
#include "mapper/map_start.h"

namespace depthgrid::cli {

// The map of the run's folder that the request names; nothing where it names none.
std::optional<PriorMap> OpenPrior(const MapRequest& request);

// Finds where in it `source` begins, or takes what the request says of it, prints that, and adds
// what is doubtful of it to `warnings`. `options` become such that the mapper can go on from it.
MapStart BeginIn(PriorMap& prior, const MapRequest& request, FrameSource& source,
                 MapperOptions& options, std::vector<std::string>& warnings);

// What the run says later on of where it began, and of the map.
std::vector<std::string> DoubtsOfPlace(const MapRequest& request, const MapStart& start,
                                       const MappingRun& run);

// Where the last drive that added to the map had its camera at another height.
std::optional<std::string> DoubtOfHeight(const MapRequest& request, const MappingRun& run);

// What was only localised in is handed on as it is, byte for byte: the map in `folder`, and its
// scans, give way to it. But for a map whose image is missing or called otherwise, which stays the
// one that was drawn of its scans.
void KeepMap(const std::string& map, const OutputFolder& folder);
// Where its map.yaml is such a one, or not what its scans give: `drawn`.
std::vector<std::string> DoubtsOfKeptMap(const MapRequest& request, const OccupancyMap& drawn);

// The map of a run.yaml that is mapped again was made anew since. `hash`: its by now.
std::optional<std::string> DoubtOfMapRecord(const MapArguments& given, const MapRequest& request,
                                            const std::string& hash);

}  // namespace depthgrid::cli
