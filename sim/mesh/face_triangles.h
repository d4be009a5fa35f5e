// Triangulates a face with any number of corners in space.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace depthgrid {

// Ear clipping is cubic in the worst case: a few seconds at this size.
constexpr std::size_t kMostConcaveCorners = 2000;

// Triangles (corner indices, in the face's orientation): a fan if the face, seen along its normal,
// is convex or has no area, else by ear clipping. A face that is not flat or crosses itself gives
// some triangles. Nothing for a face that is not convex and has more than kMostConcaveCorners
// corners.
std::optional<std::vector<std::array<std::uint32_t, 3>>> TrianglesOfFace(
    std::span<const Eigen::Vector3d> corners);

}  // namespace depthgrid
