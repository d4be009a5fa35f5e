// Measures how badly two depth images fit their poses.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"
#include "mapper/io/recording.h"

namespace depthgrid {

// Two images, near in time, with much overlap.
struct ImagePair {
  double first_s = 0.0;
  double second_s = 0.0;
  std::shared_ptr<const DepthImage> first;
  std::shared_ptr<const DepthImage> second;
};

// Image pairs for checking poses, spread over the recording: each image with the first one half a
// second later, or with the 15th next if stamps are only numbers (integers one apart). None across
// a pause.
std::vector<RecordedImage> PairsAmong(std::span<const RecordedImage> images);

// Whether most of an image has its largest depth, as from a sensor or simulator that clamps what is
// farther: such surfaces are not where the depth says, and are useless for checking poses.
bool IsMostlyCut(const DepthImage& image);

// What the values of a depth image mean.
enum class DepthMeaning { kZ, kRayLength };

constexpr double kNothingShared = 1.0;

// Which points of a pair are compared.
enum class PairPoints {
  kAll,
  // Those whose pixel has another depth in the second image. The floor before a robot's level
  // camera, or the robot itself, stays as it is however the robot drives.
  kChanged,
};

// The median distance of the surfaces in one image from those in the other, as a share of depth,
// over what both show; kNothingShared with next to no overlap or next to no such points.
double MisfitOf(const ImagePair& pair, const PinholeCamera& camera, const Pose3& second_from_first,
                DepthMeaning meaning = DepthMeaning::kZ, PairPoints which = PairPoints::kAll);

}  // namespace depthgrid
