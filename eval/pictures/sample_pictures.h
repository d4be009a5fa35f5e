// Pictures of a few frames of a run: frames/<frame>_depth.png with its beams, and _colour.png.
#pragma once

#include <string>

#include "eval/run/mapping_run.h"
#include "eval/run/world.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

void WriteDepthPictures(const std::string& folder, const MappingRun& run,
                        const ScanOptions& options);
// Writes the colour pictures beside them. Throws std::runtime_error when colour cannot be rendered.
void WriteColourPictures(const std::string& folder, const MappingRun& run, const World& world);

}  // namespace depthgrid
