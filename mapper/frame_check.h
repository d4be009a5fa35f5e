// Validation of frames and other inputs of the mapper.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/incremental_mapper.h"

namespace depthgrid {

// Throws InputError, "frame 40: ...", for a frame that the mapper cannot use (see
// IncrementalMapper::AddFrame). `camera`: of the depth images, if any.
void RequireSound(const Frame& frame, const std::optional<PinholeCamera>& camera);
// Throws InputError, "slam_final: ..." or "prior map: ...", as Finish() and StartFrom() say.
void RequireSoundFinal(const std::vector<std::optional<Pose3>>& slam_final, std::size_t frames);
void RequireSound(const PriorMap& prior);
// "start in the map: ...", as FindStartNear() says.
void RequireSoundStart(const Pose2& map_from_base, double within_m);

}  // namespace depthgrid
