#include "mapper/scan/bearing_lines.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "mapper/core/rng.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

// Forward, left and up of the ray through a pixel.
Eigen::Vector3d RayOf(const PinholeCamera& camera, const Eigen::Quaterniond& level, double u,
                      double v) {
  return level * Unproject(camera, u, v, 1.0);
}

struct Counts {
  int rows = 0, cut_lines = 0;
};

// Along the line the rays have the bearing, and range and height are as it says; the rows next to
// its ends are outside the image or look up or down too steeply.
void Check(const PinholeCamera& camera, const Eigen::Quaterniond& level, const Bearing& bearing,
           const BearingLine& line, Counts& counts) {
  const auto ray_at = [&](double v) { return RayOf(camera, level, line.u0 + line.u1 * v, v); };
  const auto along = [&](const Eigen::Vector3d& ray) {
    return bearing.cosine * ray.x() + bearing.sine * ray.y();
  };
  // `spare` for single precision.
  const auto takes_part = [&](int v, double spare) {
    const double u = line.u0 + line.u1 * static_cast<double>(v);
    return v >= 0 && v < camera.height_px && u >= -spare && u <= camera.width_px - 1.0 + spare &&
           along(ray_at(v)) >= 0.05 - spare;
  };
  constexpr double kSpare = 1e-4;
  if (line.first_row > line.last_row) return;
  counts.cut_lines += line.last_row - line.first_row < camera.height_px - 1 ? 1 : 0;
  for (const int v : {line.first_row, (line.first_row + line.last_row) / 2, line.last_row}) {
    ASSERT_TRUE(takes_part(v, kSpare)) << v;
    const Eigen::Vector3d ray = ray_at(v);
    const double across = bearing.cosine * ray.y() - bearing.sine * ray.x();
    ASSERT_NEAR(across, 0.0, 1e-4);
    ASSERT_NEAR(line.h0 + line.h1 * static_cast<float>(v), along(ray), 1e-4);
    ASSERT_NEAR(line.g0 + line.g1 * static_cast<float>(v), ray.z(), 1e-4);
    ++counts.rows;
  }
  ASSERT_FALSE(takes_part(line.first_row - 1, -kSpare)) << line.first_row;
  ASSERT_FALSE(takes_part(line.last_row + 1, -kSpare)) << line.last_row;
}

TEST(BearingLines, FollowTheBearingWithEveryInstructionSet) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 57.0, {}};
  RandomStream random(3, RandomStage::kTest);
  BearingFan fan;
  Counts counts;
  for (int i = 0; i < 60; ++i) {
    const double pitch_rad = random.Uniform(-1.0, 1.0) * (i % 3 == 0 ? 1.5 : 0.4);
    const double roll_rad = random.Uniform(-1.0, 1.0) * (i % 4 == 0 ? 0.7 : 0.2);
    const Eigen::Quaterniond level = LevelFromCamera(TiltedCamera({}, 1.15, pitch_rad, roll_rad));
    if (LinesRunAlongRows(camera, level)) continue;
    const std::vector<Bearing>& bearings = ScanBearings(camera, level, 1 + 33 * (i % 5), fan);
    std::vector<BearingLineTable> tables;
    for (const std::int64_t target : {std::int64_t{0}, std::int64_t{HWY_AVX2}}) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      tables.push_back(BearingLines(camera, level, bearings, false));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (std::size_t b = 0; b < tables[0].blocks.size(); ++b) {
      const BearingLineBlock &one = tables[0].blocks[b], &other = tables[1].blocks[b];
      for (const auto number : {&BearingLineBlock::u0, &BearingLineBlock::u1, &BearingLineBlock::h0,
                                &BearingLineBlock::h1, &BearingLineBlock::g0, &BearingLineBlock::g1,
                                &BearingLineBlock::first_row, &BearingLineBlock::last_row}) {
        ASSERT_EQ(one.*number, other.*number) << i;
      }
    }
    ASSERT_EQ(tables[0].size(), bearings.size());
    for (std::size_t k = 0; k < bearings.size(); ++k) {
      Check(camera, level, bearings[k], tables[0][k], counts);
    }
  }
  EXPECT_GE(counts.rows, 3000);
  EXPECT_GE(counts.cut_lines, 300);
}

}  // namespace
}  // namespace depthgrid
