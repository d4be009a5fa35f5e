#include "mapper/io/pose_misfit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

const PinholeCamera kMisfitCamera{80, 60, 60.2, 60.0, 39.5, 29.5, {}};

// The images of these pairs, as first and second stamp.
std::vector<std::pair<double, double>> StampsOfPairs(const std::vector<RecordedImage>& images) {
  std::vector<std::pair<double, double>> stamps_s;
  for (std::size_t i = 0; i + 1 < images.size(); i += 2) {
    stamps_s.emplace_back(images[i].stamp_s, images[i + 1].stamp_s);
  }
  return stamps_s;
}

// 24 images, a pause of 5 s, 24 images: every second one has a partner four images later, but for
// the last four of either half.
TEST(PoseMisfit, NoPairLiesAcrossAPause) {
  constexpr double kStepS = 0.125;
  std::vector<RecordedImage> images;
  std::vector<std::pair<double, double>> expected;
  for (const double begin_s : {0.0, 24 * kStepS + 5.0}) {
    for (int i = 0; i < 24; ++i) images.push_back({begin_s + i * kStepS, "", 0});
    for (int i = 0; i < 20; i += 2) {
      expected.emplace_back(begin_s + i * kStepS, begin_s + i * kStepS + 0.5);
    }
  }
  EXPECT_EQ(StampsOfPairs(PairsAmong(images)), expected);
}

// Stamped 1, 2, 3 as ICL-NUIM's poses are: a second is not time enough to tell poses by.
TEST(PoseMisfit, NumberedImagesAreFifteenApart) {
  std::vector<RecordedImage> images;
  for (int i = 1; i <= 24; ++i) images.push_back({1.0 * i, "", 0});
  const auto pairs = StampsOfPairs(PairsAmong(images));
  ASSERT_EQ(pairs.size(), 9U);
  EXPECT_EQ(pairs.front(), std::pair(1.0, 16.0));
  EXPECT_EQ(pairs.back(), std::pair(9.0, 24.0));
}

TEST(PoseMisfit, ImagesThatAreAlwaysFarApartArePairedWithTheNext) {
  std::vector<RecordedImage> images;
  for (const double stamp_s : {0.0, 3.0, 6.0, 9.0, 21.0, 24.0}) {
    images.push_back({stamp_s, "", 0});
  }
  EXPECT_EQ(
      StampsOfPairs(PairsAmong(images)),
      (std::vector<std::pair<double, double>>{{0.0, 3.0}, {3.0, 6.0}, {6.0, 9.0}, {21.0, 24.0}}));
  EXPECT_TRUE(PairsAmong({}).empty());
}

TEST(PoseMisfit, MisfitIsTheShareOfDepthThatSurfacesAreApart) {
  AnalyticRoom room;
  const Pose3 first = TiltedCamera({-1.0, 0.0, 0.0}, 1.2, 0.0, 0.0);
  ImagePair pair;
  pair.first = pair.second = std::make_shared<DepthImage>(room.Render(kMisfitCamera, first));
  EXPECT_NEAR(MisfitOf(pair, kMisfitCamera, {}), 0.0, 1e-6);
  // The wall 4 m ahead, said to be 0.2 m farther; it is most of what is seen.
  Pose3 back;
  back.translation.z() = 0.2;
  EXPECT_NEAR(MisfitOf(pair, kMisfitCamera, back), 0.05, 0.005);
  Pose3 behind;
  behind.rotation = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY());
  EXPECT_EQ(MisfitOf(pair, kMisfitCamera, behind), 1.0);
}

// The lower half of the image shows something that moves along.
TEST(PoseMisfit, WhatHasNotChangedCanBeLeftOut) {
  const AnalyticRoom room;
  const Pose3 first = TiltedCamera({-1.0, 0.0, 0.0}, 1.2, 0.0, 0.0);
  const Pose3 second = TiltedCamera({-0.6, 0.0, 0.0}, 1.2, 0.0, 0.0);
  auto before = std::make_shared<DepthImage>(room.Render(kMisfitCamera, first));
  auto after = std::make_shared<DepthImage>(room.Render(kMisfitCamera, second));
  for (int v = 20; v < kMisfitCamera.height_px; ++v) {
    std::fill_n(before->Row(v), kMisfitCamera.width_px, 0.5F);
    std::fill_n(after->Row(v), kMisfitCamera.width_px, 0.5F);
  }
  const ImagePair pair{0.0, 0.5, before, after};
  const auto misfit = [&](const Pose3& second_from_first, PairPoints which) {
    return MisfitOf(pair, kMisfitCamera, second_from_first, DepthMeaning::kZ, which);
  };
  const Pose3 right = Between(second, first), standing;
  EXPECT_LT(misfit(standing, PairPoints::kAll), 0.01);
  EXPECT_GT(misfit(standing, PairPoints::kChanged), 0.08);
  EXPECT_LT(misfit(right, PairPoints::kChanged), 0.01);
  const ImagePair same{0.0, 0.5, before, before};
  EXPECT_EQ(MisfitOf(same, kMisfitCamera, standing, DepthMeaning::kZ, PairPoints::kChanged),
            kNothingShared);
}

// Somebody who keeps ahead hides most of a wall, and other parts of it in the second image.
TEST(PoseMisfit, WhatIsHiddenByWhatMovesAlongIsLeftOut) {
  const AnalyticRoom room;
  const Pose3 first = TiltedCamera({-1.0, 0.0, 0.0}, 1.2, 0.0, 0.0);
  const Pose3 second = TiltedCamera({-0.6, 0.1, 0.15}, 1.2, 0.0, 0.0);
  auto before = std::make_shared<DepthImage>(room.Render(kMisfitCamera, first));
  auto after = std::make_shared<DepthImage>(room.Render(kMisfitCamera, second));
  for (int v = 0; v < kMisfitCamera.height_px; ++v) {
    std::fill_n(before->Row(v) + 10, 45, 0.7F);
    std::fill_n(after->Row(v) + 12, 45, 0.71F);
  }
  const std::vector<ImagePair> pairs = {{0.0, 0.5, before, after}};
  const Pose3 right = Between(second, first);
  const auto misfit = [&](PairPoints which) {
    return MisfitOf(pairs.front(), kMisfitCamera, right, DepthMeaning::kZ, which);
  };
  EXPECT_GT(misfit(PairPoints::kAll), 0.2);
  EXPECT_LT(misfit(PairPoints::kChanged), 0.02);
  const KeptDepth kept = KeptDepthIn(pairs);
  EXPECT_GT(kept.share, 0.5);
  EXPECT_NEAR(kept.depth_m, 0.7, 0.01);
  EXPECT_NEAR(kept.first_column_px, 15, 5);  // seven in ten are between these
  EXPECT_NEAR(kept.last_column_px, 52, 5);
  EXPECT_LT(kept.first_row_px, 12);
  EXPECT_GT(kept.last_row_px, 47);
  EXPECT_EQ(KeptDepthIn({}).share, 0.0);
  const std::vector<ImagePair> still = {{0.0, 0.5, before, before}};
  EXPECT_EQ(KeptDepthIn(still).share, 0.0);
}

}  // namespace
}  // namespace depthgrid
