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
  // Those whose pixel has another depth in the second image, as has, in the first one, the pixel
  // they are compared with. The floor before a robot's level camera, the robot itself or somebody
  // who keeps ahead of it stays as it is however the robot drives; the latter hide what is behind.
  kChanged,
};

// The median distance of the surfaces in one image from those in the other, as a share of depth,
// over what both show; kNothingShared with next to no overlap or next to no such points.
double MisfitOf(const ImagePair& pair, const PinholeCamera& camera, const Pose3& second_from_first,
                DepthMeaning meaning = DepthMeaning::kZ, PairPoints which = PairPoints::kAll);

// Pixels that keep their depth from one image of a pair to the other (to 5 %) while others change:
// what moves along with the camera, or floor and walls that it moves along.
struct KeptDepth {
  double share = 0.0;    // of the pixels with a depth
  double depth_m = 0.0;  // median
  // Columns and rows between which seven in ten of them lie.
  int first_column_px = 0, last_column_px = 0;
  int first_row_px = 0, last_row_px = 0;
};
// Over all pairs that show motion; a share of 0 where none does.
KeptDepth KeptDepthIn(std::span<const ImagePair> pairs);

}  // namespace depthgrid
