// How badly two depth images fit the poses given for them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"
#include "mapper/io/recording.h"

namespace depthgrid {

// Two images that show much of the same, by their stamps.
struct ImagePair {
  double first_s = 0.0;
  double second_s = 0.0;
  std::shared_ptr<const DepthImage> first;
  std::shared_ptr<const DepthImage> second;
};

// The images to check poses by, two a pair, spread over the recording: each with the first one half
// a second later, or the 15th where whole stamps a second apart are but numbers. None across a
// pause.
std::vector<RecordedImage> PairsAmong(std::span<const RecordedImage> images);

// Whether most of an image holds its largest depth, as a sensor or simulator gives for all that is
// farther than it sees: those surfaces lie elsewhere, and tell nothing of poses.
bool IsMostlyCut(const DepthImage& image);

// What the numbers of a depth image are.
enum class DepthMeaning { kZ, kRayLength };

constexpr double kNothingShared = 1.0;

// How far the surfaces of one image lie from where the other one has them, as a share of their
// depth: the median over what both show, kNothingShared where that is next to nothing.
double MisfitOf(const ImagePair& pair, const PinholeCamera& camera, const Pose3& second_from_first,
                DepthMeaning meaning = DepthMeaning::kZ);

}  // namespace depthgrid
