// Pictures of a few frames of a run: frames/<frame>_depth.png with its beams, and _colour.png.
#pragma once

#include <string>

#include "eval/mapping_run.h"
#include "eval/world.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// `world` may be null: recorded data has no colour to render.
void WriteSamplePictures(const std::string& folder, const MappingRun& run,
                         const ScanOptions& options, const World* world);

}  // namespace depthgrid
