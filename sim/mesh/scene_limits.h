// Limits of a scene: beyond these a file is broken or in other units.
#pragma once

#include <cstddef>

namespace depthgrid {

constexpr double kMaxSceneExtentM = 2000.0;             // the largest buildings and sites
constexpr double kMaxSceneCoordinateM = 10'000.0;       // where single precision has steps of 1 mm
constexpr std::size_t kMaxSceneTriangles = 20'000'000;  // about 2.5 GB with Embree's tree
constexpr std::size_t kMaxMeshFileBytes = std::size_t{1} << 30U;

}  // namespace depthgrid
