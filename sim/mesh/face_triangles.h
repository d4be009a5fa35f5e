// A face of any number of corners in space as triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace depthgrid {

// Clipping ears may take the cube of it: a few seconds.
constexpr std::size_t kMostConcaveCorners = 2000;

// Triangles (corner indices, turning as the face does): a fan where the face, seen along its
// normal, is convex or has no area, else its ears. What is not flat or crosses itself gives some
// triangles. Nothing for a face that is not convex and has more corners than kMostConcaveCorners.
std::optional<std::vector<std::array<std::uint32_t, 3>>> TrianglesOfFace(
    std::span<const Eigen::Vector3d> corners);

}  // namespace depthgrid
