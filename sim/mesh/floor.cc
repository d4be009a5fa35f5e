#include "sim/mesh/floor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

constexpr double kLevelLimitDeg = 5.0;           // steeper than uneven ground, less than a ramp
constexpr double kSlabM = 0.05;                  // surfaces within this height count as one
constexpr double kFloorShareOfFootprint = 0.25;  // more than a rug, less than an L-shaped floor
constexpr double kFloorShareOfLargest = 0.25;    // below that it is a pit, not the floor
constexpr double kCeilingShareOfFootprint = 0.25;
constexpr double kStandingRoomM = 1.5;
constexpr double kFloorToleranceM = 0.02;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Facing { kUp, kDown };

// A level triangle: its height and the area it covers seen from above.
struct LevelPatch {
  double z_m = 0.0;
  double area_m2 = 0.0;
};

std::vector<LevelPatch> LevelPatches(const TriangleMesh& mesh, Facing facing) {
  const double least_cosine = std::cos(RadFromDeg(kLevelLimitDeg));
  std::vector<LevelPatch> patches;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3d normal = ScaledNormal(mesh, i);
    const double up = facing == Facing::kUp ? normal.z() : -normal.z();
    if (up <= 0.0 || up < least_cosine * normal.norm()) continue;
    double z_m = 0.0;
    for (const auto vertex : mesh.triangles[i]) z_m += mesh.vertices[vertex].z();
    patches.push_back({z_m / 3.0, 0.5 * up});
  }
  std::sort(patches.begin(), patches.end(),
            [](const LevelPatch& a, const LevelPatch& b) { return a.z_m < b.z_m; });
  return patches;
}

// For each patch, the total area of patches from its height up to kSlabM above it.
std::vector<double> SlabAreas(const std::vector<LevelPatch>& patches) {
  std::vector<double> below(patches.size() + 1, 0.0);
  for (std::size_t i = 0; i < patches.size(); ++i) below[i + 1] = below[i] + patches[i].area_m2;
  std::vector<double> areas;
  std::size_t end = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    while (end < patches.size() && patches[end].z_m <= patches[i].z_m + kSlabM) ++end;
    areas.push_back(below[end] - below[i]);
  }
  return areas;
}

// The height below which half of the slab's area lies: a height that occurs, not an average.
double MedianHeight(const std::vector<LevelPatch>& patches, std::size_t first, double slab_m2) {
  double seen_m2 = 0.0;
  for (std::size_t i = first; i < patches.size(); ++i) {
    seen_m2 += patches[i].area_m2;
    if (seen_m2 >= 0.5 * slab_m2) return patches[i].z_m;
  }
  return patches[first].z_m;
}

double FootprintM2(const TriangleMesh& mesh) {
  const Eigen::Vector3d size = BoundsOf(mesh).sizes().cast<double>();
  return size.x() * size.y();
}

// Floors lie in the lower half of the mesh, which excludes roofs and wall tops; a mesh too low to
// stand in has no roof.
double HighestFloorM(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f bounds = BoundsOf(mesh);
  const double height_m = bounds.sizes().z();
  return height_m < kStandingRoomM ? bounds.max().z() : bounds.min().z() + 0.5 * height_m;
}

std::optional<double> FloorAmong(std::vector<LevelPatch> patches, double footprint_m2,
                                 double highest_m) {
  std::erase_if(patches, [&](const LevelPatch& patch) { return patch.z_m > highest_m; });
  if (patches.empty()) return {};
  const std::vector<double> slabs_m2 = SlabAreas(patches);
  const double largest_m2 = *std::max_element(slabs_m2.begin(), slabs_m2.end());
  const double least_m2 =
      std::max(kFloorShareOfFootprint * footprint_m2, kFloorShareOfLargest * largest_m2);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (slabs_m2[i] >= least_m2) return MedianHeight(patches, i, slabs_m2[i]);
  }
  return {};
}

// The height of the highest large slab between two heights.
std::optional<double> HighestSlab(const std::vector<LevelPatch>& all, double lowest_m,
                                  double highest_m, double least_m2) {
  std::vector<LevelPatch> patches = all;
  std::erase_if(patches, [&](const LevelPatch& patch) {
    return patch.z_m < lowest_m || patch.z_m >= highest_m;
  });
  const std::vector<double> slabs_m2 = SlabAreas(patches);
  for (std::size_t i = patches.size(); i-- > 0;) {
    if (slabs_m2[i] >= least_m2) return MedianHeight(patches, i, slabs_m2[i]);
  }
  return {};
}

// The lowest height from `lowest_m` on where the next storey's floor may be; infinite without one.
double NextFloorM(const TriangleMesh& mesh, double lowest_m) {
  std::vector<LevelPatch> patches = LevelPatches(mesh, Facing::kUp);
  std::erase_if(patches, [&](const LevelPatch& patch) { return patch.z_m < lowest_m; });
  const std::vector<double> slabs_m2 = SlabAreas(patches);
  const double least_m2 = kFloorShareOfFootprint * FootprintM2(mesh);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (slabs_m2[i] >= least_m2) return patches[i].z_m;
  }
  return kInfinity;
}

}  // namespace

std::optional<double> FindFloor(const TriangleMesh& mesh) {
  const double footprint_m2 = FootprintM2(mesh);
  const double highest_m = HighestFloorM(mesh);
  const auto floor = FloorAmong(LevelPatches(mesh, Facing::kUp), footprint_m2, highest_m);
  return floor ? floor : FloorAmong(LevelPatches(mesh, Facing::kDown), footprint_m2, highest_m);
}

bool HasFloorAt(const TriangleMesh& mesh, double z_m) {
  const auto found = FindFloor(mesh);
  if (found && std::abs(*found - z_m) <= kFloorToleranceM) return true;  // also if inside out
  double area_m2 = 0.0;
  for (const LevelPatch& patch : LevelPatches(mesh, Facing::kUp)) {
    if (std::abs(patch.z_m - z_m) <= kFloorToleranceM) area_m2 += patch.area_m2;
  }
  return area_m2 > 0.0 && area_m2 >= kFloorShareOfFootprint * FootprintM2(mesh);
}

std::optional<double> FindCeiling(const TriangleMesh& mesh, double floor_z_m) {
  const double least_m2 = kCeilingShareOfFootprint * FootprintM2(mesh);
  const double lowest_m = floor_z_m + kStandingRoomM;
  const std::vector<LevelPatch> patches = LevelPatches(mesh, Facing::kDown);
  const auto in_storey = HighestSlab(patches, lowest_m, NextFloorM(mesh, lowest_m), least_m2);
  return in_storey ? in_storey : HighestSlab(patches, lowest_m, kInfinity, least_m2);
}

}  // namespace depthgrid
