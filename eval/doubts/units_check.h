// Whether a scene's mesh may be in other units than metres.
#pragma once

#include <optional>
#include <string>

#include "sim/scene/scene.h"

namespace depthgrid {

// A warning about a scene that is as large as no building, with a height to match, as rooms in
// centimetres are. LoadScene() refuses what is larger still, as rooms in millimetres.
std::optional<std::string> DoubtOfUnits(const Scene& scene);

}  // namespace depthgrid
