#include "mapper/io/pose_misfit.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/median.h"
#include "mapper/core/usual_step.h"

namespace depthgrid {
namespace {

// Time between the images of a pair: they overlap much, and the camera's rotation exceeds SLAM's
// error.
constexpr std::size_t kCheckedPairs = 24;
constexpr double kPairApartS = 0.5;
// The same if stamps are image numbers (ICL-NUIM): the number of images in that time at 30 Hz.
constexpr double kPairApartImages = 15.0;
// Images farther apart than this factor of it are across a pause and may not overlap.
constexpr double kMostApart = 2.0;

constexpr int kPointsAcross = 40;  // points per image row that are compared
// A smaller share of common points is not enough.
constexpr double kLeastShared = 0.2;
// A pixel's depth has changed if it differs by more than this share, which is more than any
// sensor's noise at 4 m; pairs in which fewer points have changed show no motion. Chosen, not
// measured.
constexpr double kChange = 0.05;
constexpr int kLeastChanged = 30;

bool IsUnchanged(double z, double then) {
  return !(std::abs(then - z) > kChange * z) || !(then > 0.0);
}

double PairApartS(std::span<const RecordedImage> images, double usual_s) {
  const bool numbered = std::all_of(images.begin(), images.end(), [](const RecordedImage& image) {
    return image.stamp_s == std::floor(image.stamp_s);
  });
  return numbered && usual_s == 1.0 ? kPairApartImages : kPairApartS;
}

}  // namespace

std::vector<RecordedImage> PairsAmong(std::span<const RecordedImage> images) {
  std::vector<RecordedImage> pairs;
  const double usual_s = UsualStepBetween(images, &RecordedImage::stamp_s);
  const double apart_s = PairApartS(images, usual_s);
  const double most_apart_s = kMostApart * std::max(apart_s, usual_s);
  const std::size_t every = std::max<std::size_t>(1, images.size() / kCheckedPairs);
  std::size_t second = 0;
  for (std::size_t first = 0; first < images.size(); first += every) {
    const double first_s = images[first].stamp_s;
    while (second < images.size() && images[second].stamp_s < first_s + apart_s) ++second;
    if (second == images.size()) break;
    if (images[second].stamp_s - first_s > most_apart_s) continue;
    pairs.push_back(images[first]);
    pairs.push_back(images[second]);
  }
  return pairs;
}

bool IsMostlyCut(const DepthImage& image) {
  const float largest_m = *std::max_element(image.z_m.begin(), image.z_m.end());
  std::size_t measured = 0, held = 0;
  for (const float z_m : image.z_m) {
    measured += z_m != kInvalidDepth ? 1 : 0;
    held += z_m != kInvalidDepth && z_m == largest_m ? 1 : 0;
  }
  return 2 * held > measured;
}

double MisfitOf(const ImagePair& pair, const PinholeCamera& camera, const Pose3& second_from_first,
                DepthMeaning meaning, PairPoints which) {
  const DepthImage& first = *pair.first;
  const DepthImage& second = *pair.second;
  const int step_px = std::max(1, first.width_px / kPointsAcross);
  const auto z_m = [&](const DepthImage& image, int u, int v) {
    const double depth = image.At(u, v);
    return meaning == DepthMeaning::kZ ? depth : depth / Unproject(camera, u, v, 1.0).norm();
  };
  const auto unchanged = [&](int u, int v) {
    return which == PairPoints::kChanged && IsUnchanged(z_m(first, u, v), z_m(second, u, v));
  };
  std::vector<double> misfits;
  int points = 0;
  for (int v = step_px / 2; v < first.height_px; v += step_px) {
    for (int u = step_px / 2; u < first.width_px; u += step_px) {
      const double z = z_m(first, u, v);
      if (!(z > 0.0) || unchanged(u, v)) continue;
      ++points;
      const Eigen::Vector3d there = second_from_first * Unproject(camera, u, v, z);
      if (!(there.z() > 0.0)) continue;
      const Eigen::Vector2d pixel = Project(camera, there).array().round();
      const bool inside = pixel.x() >= 0.0 && pixel.x() < second.width_px && pixel.y() >= 0.0 &&
                          pixel.y() < second.height_px;
      if (!inside) continue;
      const int seen_u = static_cast<int>(pixel.x()), seen_v = static_cast<int>(pixel.y());
      const double seen = z_m(second, seen_u, seen_v);
      if (seen > 0.0 && !unchanged(seen_u, seen_v))
        misfits.push_back(std::abs(there.z() - seen) / seen);
    }
  }
  if (which == PairPoints::kChanged && points < kLeastChanged) return kNothingShared;
  if (points == 0 || static_cast<double>(misfits.size()) < kLeastShared * points) {
    return kNothingShared;
  }
  return UpperMedian(misfits);
}

namespace {

struct KeptPixels {
  std::vector<double> columns_px, rows_px, depths_m;
  int changed = 0;

  void Append(const KeptPixels& more) {
    columns_px.insert(columns_px.end(), more.columns_px.begin(), more.columns_px.end());
    rows_px.insert(rows_px.end(), more.rows_px.begin(), more.rows_px.end());
    depths_m.insert(depths_m.end(), more.depths_m.begin(), more.depths_m.end());
    changed += more.changed;
  }
};

KeptPixels KeptPixelsIn(const ImagePair& pair) {
  const DepthImage& first = *pair.first;
  const int step_px = std::max(1, first.width_px / kPointsAcross);
  KeptPixels kept;
  for (int v = step_px / 2; v < first.height_px; v += step_px) {
    for (int u = step_px / 2; u < first.width_px; u += step_px) {
      const double z_m = first.At(u, v), then_m = pair.second->At(u, v);
      if (!(z_m > 0.0) || !(then_m > 0.0)) continue;
      if (!IsUnchanged(z_m, then_m)) {
        ++kept.changed;
        continue;
      }
      kept.columns_px.push_back(u);
      kept.rows_px.push_back(v);
      kept.depths_m.push_back(z_m);
    }
  }
  return kept;
}

// The value below which this share of them lies.
int QuantilePx(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<int>(*at);
}

}  // namespace

KeptDepth KeptDepthIn(std::span<const ImagePair> pairs) {
  KeptPixels all;
  for (const ImagePair& pair : pairs) {
    const KeptPixels kept = KeptPixelsIn(pair);
    if (kept.changed >= kLeastChanged) all.Append(kept);
  }
  KeptDepth result;
  if (all.depths_m.empty()) return result;
  const auto count = static_cast<double>(all.depths_m.size());
  constexpr double kLow = 0.15, kHigh = 0.85;
  result.share = count / (count + all.changed);
  result.depth_m = UpperMedian(all.depths_m);
  result.first_column_px = QuantilePx(all.columns_px, kLow);
  result.last_column_px = QuantilePx(all.columns_px, kHigh);
  result.first_row_px = QuantilePx(all.rows_px, kLow);
  result.last_row_px = QuantilePx(all.rows_px, kHigh);
  return result;
}

}  // namespace depthgrid
