#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/surfel/debias.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/skyline_matrix.h"
#include "mapper/surfel/surfel_map.h"
#include "mapper/surfel/surfel_matcher.h"
#include "mapper/surfel/surfel_store.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

// A room with a box in it, seen from inside.
PlanarWorld Room() {
  PlanarWorld world = RectangleWorld(-2.0, -2.5, 3.0, 2.5);
  for (const Wall& wall : RectangleWorld(1.5, 0.4, 2.2, 1.1)) world.push_back(wall);
  return world;
}

PlanarLaser NoisyLaser(double sigma_of_range) {
  PlanarLaser laser;
  laser.sigma_of_range = sigma_of_range;
  return laser;
}

SurfelStore MapOf(const std::vector<Surfel>& surfels, const Pose2& map_from_base) {
  SurfelStore map;
  for (const Surfel& surfel : surfels) map.Add(Motion2(map_from_base) * surfel);
  return map;
}

TEST(RangeNoise, LearnsSigmaInSpiteOfCorners) {
  for (const double sigma : {0.003, 0.01, 0.03}) {
    RangeNoise noise;
    for (int frame = 0; frame < 20; ++frame) {
      noise.Add(ScanOf(Room(), {0.0, 0.0, 0.3 * frame}, NoisyLaser(sigma), 7,
                       static_cast<std::uint32_t>(frame)));
    }
    EXPECT_NEAR(noise.RelativeSigma(2.5) / sigma, 1.0, 0.1) << sigma;
  }
}

TEST(SurfelMatcher, FindsTheWayBackAndIsAsSureAsItSays) {
  RangeNoise noise;
  ScanSurfelMaker maker({});
  const Scan clean = ScanOf(Room(), {}, {});
  for (std::uint32_t i = 0; i < 5; ++i) noise.Add(ScanOf(Room(), {}, NoisyLaser(0.01), 5, i));
  SurfelStore map = MapOf(maker.Make(clean, noise), {});
  // A map much better than the scan: the same surfel many times.
  for (int i = 0; i < 100; ++i) {
    for (const Surfel& s : maker.Make(clean, noise)) map.Merge(s, {0.03, 0.05, 0.7});
  }
  SurfelMatcher matcher({});
  Prediction prediction;
  prediction.map_from_base = {0.04, -0.03, 0.02};
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  double chi2 = 0.0;
  int cases = 0;
  for (std::uint32_t frame = 0; frame < 200; ++frame, ++cases) {
    const std::vector<Surfel> pieces =
        maker.Make(ScanOf(Room(), {}, NoisyLaser(0.01), 6, frame), noise);
    const MatchResult match = matcher.Match(pieces, map, prediction);
    ASSERT_TRUE(match.found);
    const Eigen::Vector3d error = match.map_from_base.vector();
    EXPECT_LT(error.head<2>().norm(), 0.03);
    chi2 += error.dot(match.information * error);
  }
  EXPECT_EQ(cases, 200);
  EXPECT_NEAR(chi2 / cases, 3.0, 1.0);  // three degrees of freedom
}

TEST(SurfelMatcher, InACorridorTheAxisStaysUnseen) {
  const PlanarWorld corridor = {{{-20, 1}, {20, 1}}, {{-20, -1}, {20, -1}}};
  RangeNoise noise;
  ScanSurfelMaker maker({});
  for (std::uint32_t i = 0; i < 5; ++i) noise.Add(ScanOf(corridor, {}, NoisyLaser(0.01), 5, i));
  const SurfelStore map =
      MapOf(maker.Make(ScanOf(corridor, {}, NoisyLaser(0.01), 5, 9), noise), {});
  Prediction prediction;
  prediction.map_from_base = {0.3, 0.02, 0.0};
  prediction.covariance = Eigen::Vector3d(0.04, 0.01, 0.001).asDiagonal();
  const MatchResult match = SurfelMatcher({}).Match(
      maker.Make(ScanOf(corridor, {}, NoisyLaser(0.01), 5, 10), noise), map, prediction);
  ASSERT_TRUE(match.found);
  EXPECT_GT(match.information(1, 1), 100.0 * match.information(0, 0));
  EXPECT_NEAR(match.map_from_base.y_m, 0.0, 0.02);
}

// What many scans agree on may be what noise hides from each, such as a shallow recess.
TEST(SurfelMatcher, BelievesNoNormalMuchMoreThanOneScanTellsIt) {
  SurfelStore map;
  std::vector<Surfel> pieces;
  for (int i = 0; i < 40; ++i) {
    const double x_m = 0.1 * i;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const Eigen::Vector2d point(x_m, side);
    const Eigen::Vector2d askew = Eigen::Vector2d(-0.05, -side).normalized();
    map.Add({point, askew, 1e6, 1e6});
    pieces.push_back({point, askew, 1e4, 1.0 / (0.1 * 0.1)});
  }
  Prediction prediction;
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  SurfelMatchOptions options;
  EXPECT_LT(SurfelMatcher(options).Match(pieces, map, prediction).information(0, 0), 10.0);
  options.normal_floor_share = 0.0;
  EXPECT_GT(SurfelMatcher(options).Match(pieces, map, prediction).information(0, 0), 500.0);
}

TEST(Debias, TakesAwayWhatNormalsFeignAndNothingElse) {
  NormalEquations equations;
  equations.h = Eigen::Vector3d(1000.0, 2.0, 500.0).asDiagonal();
  equations.g = {10.0, 1.0, 5.0};
  equations.false_h = Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal();
  const NormalEquations debiased = Debiased(equations, 3.0);
  EXPECT_NEAR(debiased.h(0, 0), 997.0, 1e-3);  // h (1 - 3 / 1000)
  EXPECT_NEAR(debiased.h(1, 1), 0.0, 1e-9);    // lambda 2 < 3
  EXPECT_NEAR(debiased.g[1], 0.0, 1e-9);
  EXPECT_NEAR(debiased.g[0] / debiased.h(0, 0), 0.01, 1e-6);  // the step stays
  EXPECT_EQ(Debiased(equations, 0.0).h, equations.h);
}

// Rows begin anywhere, or in threes (a pose's) at a multiple of three.
void ExpectSolvesAsDenseCholeskyDoes(int step) {
  RandomStream random(12, RandomStage::kTest);
  constexpr int kSize = 42;
  std::vector<int> first;
  for (int i = 0; i < kSize; i += step) {
    const auto column = random.Below(static_cast<std::uint64_t>(i / step) + 1);
    first.insert(first.end(), static_cast<std::size_t>(step), step * static_cast<int>(column));
  }
  SkylineMatrix skyline(first);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd b(kSize);
  for (int i = 0; i < kSize; ++i) {
    b[i] = random.Normal();
    for (int j = first[static_cast<std::size_t>(i)]; j <= i; ++j) {
      const double value = i == j ? 50.0 : random.Normal();
      *skyline.At(i, j) = value;
      dense(i, j) = dense(j, i) = value;
    }
  }
  ASSERT_TRUE(skyline.Factor());
  EXPECT_LT((dense * skyline.Solve(b) - b).norm(), 1e-10);
}

TEST(SkylineMatrix, SolvesAsDenseCholeskyDoes) {
  ExpectSolvesAsDenseCholeskyDoes(1);
  ExpectSolvesAsDenseCholeskyDoes(3);
}

TEST(SkylineMatrix, TellsWhatIsNotPositiveDefinite) {
  for (const int size : {2, 3}) {
    SkylineMatrix indefinite(std::vector<int>(static_cast<std::size_t>(size), 0));
    for (int i = 0; i < size; ++i) *indefinite.At(i, i) = 1.0;
    *indefinite.At(1, 0) = 2.0;
    EXPECT_FALSE(indefinite.Factor());
  }
}

TEST(GroupLinks, NormalEquationsAreThoseOfNumericDerivatives) {
  const std::vector<Pose2> poses = {{0.3, -0.2, 0.4}, {1.1, 0.5, 1.0}};
  // Near its measurement, where the error is linear.
  GroupLink link{
      0, 1, Between(poses[0], poses[1]) * Pose2{1e-4, -2e-4, 1e-4}, {0.1, 0.2, 0.05}, 0.0};
  Eigen::Matrix<double, 3, 6> jacobian;
  for (int k = 0; k < 6; ++k) {
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    step[k % 3] = 1e-6;
    std::vector<Pose2> moved = poses;
    Pose2& pose = moved[static_cast<std::size_t>(k / 3)];
    pose = pose * Pose2::FromVector(step);
    jacobian.col(k) = (LinkError(link, moved) - LinkError(link, poses)) / 1e-6;
  }
  const Eigen::Matrix3d weight = link.sigma.cwiseProduct(link.sigma).cwiseInverse().asDiagonal();
  const Eigen::MatrixXd expected = jacobian.transpose() * weight * jacobian;
  SkylineMatrix h({0, 0, 0, 0, 0, 0});
  Eigen::VectorXd g = Eigen::VectorXd::Zero(6);
  AddLink(link, poses, h, g);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) EXPECT_NEAR(*h.At(i, j), expected(i, j), 0.5) << i << j;
  }
  EXPECT_LT((g + jacobian.transpose() * weight * LinkError(link, poses)).norm(), 1e-3);
}

// What is asked of a scan that came before teaches the map nothing.
TEST(SurfelMap, ALookAtAnEarlierScanChangesNoMatch) {
  const auto scan_at = [](int i) {
    return std::make_shared<const Scan>(ScanOf(Room(), {-1.0 + 0.02 * i, 0.0, 0.0},
                                               NoisyLaser(0.01), 3, static_cast<std::uint32_t>(i)));
  };
  const Prediction prediction{{-0.9, 0.0, 0.0}, 1e-3 * Eigen::Matrix3d::Identity()};
  std::vector<MatchResult> matches;
  for (const bool looks : {false, true}) {
    SurfelMap map((SurfelOptions()));
    const auto first = scan_at(0);
    map.Insert(first, {-1.0, 0.0, 0.0}, Eigen::Matrix3d::Zero());
    const auto next = scan_at(5);
    map.Match(next, prediction);
    for (int k = 0; looks && k < 5; ++k) map.ShareSeenBefore(first, {-1.0, 0.0, 0.0}, 0);
    matches.push_back(map.Match(next, prediction));
  }
  EXPECT_EQ(matches[0].map_from_base, matches[1].map_from_base);
  EXPECT_EQ(matches[0].information, matches[1].information);
}

// Two frames, with which a group begins, see nothing where SLAM jumps by 6 cm; the third sees the
// room again. Unless they move along, the group is that far off within itself.
TEST(SurfelMap, WhatCameJustBeforeMovesWithACorrection) {
  SurfelMap map((SurfelOptions()));
  std::vector<MappedFrame> frames;
  for (int i = 0; i < 48; ++i) {
    const bool blind = i == 24 || i == 25;
    const Pose2 truth{-1.0 + 0.02 * i, 0.0, 0.0};
    const Pose2 drifted{truth.x_m, 0.06, 0.0};
    const auto scan =
        std::make_shared<const Scan>(ScanOf(blind ? PlanarWorld() : Room(), truth,
                                            NoisyLaser(0.003), 3, static_cast<std::uint32_t>(i)));
    MappedFrame frame;
    frame.frame = i;
    frame.map_from_base = blind ? drifted : truth;
    if (i > 0) {
      frame.slam_motion = Pose2{0.02, i == 24 ? 0.06 : 0.0, 0.0};
      const Pose2 previous = frames.back().map_from_base;
      map.Corrected(previous, i == 26 ? Pose2{previous.x_m, 0.0, 0.0} : previous);
    }
    map.Insert(scan, frame.map_from_base, Eigen::Matrix3d::Zero());
    frames.push_back(frame);
  }
  const Adjustment adjusted = map.Adjust(frames, {}, AdjustEffort::kCloseLoops, {});
  EXPECT_LT(std::abs(adjusted.map_from_base[25].y_m), 0.01);
  EXPECT_LT(std::abs(adjusted.map_from_base[26].y_m), 0.01);
}

// Twenty frames of the room were drawn at poses all over the place, then one saw another room. Put
// right, the room has far fewer surfels, and those of the last frame are new to it still.
TEST(SurfelMap, WhatAFrameSawFirstIsNewToItAfterTheMapMoved) {
  const Pose2 elsewhere{20.0, 0.0, 0.0};
  PlanarWorld other = RectangleWorld(18.5, -1.5, 22.0, 1.8);
  SurfelMap map((SurfelOptions()));
  std::vector<MappedFrame> frames;
  std::shared_ptr<const Scan> scan;
  for (int i = 0; i <= 20; ++i) {
    const bool is_last = i == 20;
    MappedFrame frame;
    frame.frame = i;
    frame.map_from_base = is_last ? elsewhere : Pose2{0.02 * i, 0.0, 0.0};
    scan =
        std::make_shared<const Scan>(ScanOf(is_last ? other : Room(), frame.map_from_base,
                                            NoisyLaser(0.003), 3, static_cast<std::uint32_t>(i)));
    const Pose2 wrong = is_last ? Pose2{} : Pose2{0.3 * (i % 5), 0.3 * (i % 3), 0.0};
    map.Insert(scan, wrong * frame.map_from_base, Eigen::Matrix3d::Zero());
    frames.push_back(frame);
  }
  const int drawn = map.surfels().size();
  map.Rebuild(frames);
  ASSERT_LT(map.surfels().size(), drawn / 2);
  EXPECT_EQ(map.ShareSeenBefore(scan, elsewhere, 20), 0.0);
}

// Once round the room with an odometry that turns a little too much.
TEST(SurfelMethod, UndoesTheDriftOfItsPrior) {
  MapperOptions options;
  options.method = MapperMethod::kSurfel;
  options.fusion.mode = FusionMode::kLearned;
  IncrementalMapper mapper(options, std::nullopt);
  std::vector<Pose2> truth;
  Pose2 odometry;
  double prior_error_m = 0.0;
  constexpr int kFrames = 200;
  for (int i = 0; i < kFrames; ++i) {
    const double angle_rad = 2.0 * kPi * i / kFrames;
    truth.push_back({0.5 * std::sin(angle_rad), -0.5 * std::cos(angle_rad), WrapAngle(angle_rad)});
    odometry = i == 0 ? truth[0]
                      : odometry * Between(truth[truth.size() - 2], truth.back()) *
                            Pose2{0.003, -0.0015, 0.0024};
    prior_error_m += (odometry.translation() - truth.back().translation()).norm() / kFrames;
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf(odometry, 0.0);
    frame.scan = std::make_shared<Scan>(
        ScanOf(Room(), truth.back(), NoisyLaser(0.01), 8, static_cast<std::uint32_t>(i)));
    mapper.AddFrame(frame);
  }
  const MapperResult result = mapper.Finish();
  double error_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose2 estimate = BaseOf(*result.map_from_camera[i]);
    error_m += (estimate.translation() - truth[i].translation()).norm() / kFrames;
  }
  EXPECT_GT(prior_error_m, 0.1);
  // The map's frame is that of the first pose.
  EXPECT_LT(Separation(BaseOf(*result.map_from_camera[0]), truth[0]), 1e-9);
  // Between corners only one plain wall is in view, and the way along it is the prior's.
  EXPECT_LT(error_m, 0.25 * prior_error_m);
}

// A frame that was mapped has its match as the scan told it, whatever SLAM predicted: before a wall
// nothing of the way along it, where in axes of the turned prediction there is some.
TEST(SurfelMapping, AMappedFramesMatchIsInAxesOfTheMatch) {
  const PlanarWorld wall = {{{2.0, -20.0}, {2.0, 20.0}}};
  IncrementalMapper mapper(MapperOptions(), std::nullopt);
  FrameReport report;
  for (int i = 0; i < 2; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.slam_from_camera = CameraOf({0.0, 0.0, 0.05 * i}, 1.0);
    // Not the same scan again, which would be a hung driver's.
    frame.scan = std::make_shared<Scan>(ScanOf(wall, {1e-4 * i, 0.0, 0.0}, {}));
    report = mapper.AddFrame(frame);
  }
  const auto along = [](const Eigen::Matrix3d& information) {
    return information(1, 1) / information(0, 0);
  };
  ASSERT_TRUE(report.match.found);
  EXPECT_NEAR(report.match.map_from_base.yaw_rad, 0.0, 1e-3);
  EXPECT_GT(along(report.match.information), 1e-3);
  EXPECT_LT(along(mapper.CurrentMapped().back().match.information), 1e-4);
}

}  // namespace
}  // namespace depthgrid
