// The whole chain where a scan sees only two parallel walls.
#include <gtest/gtest.h>

#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

TEST(Corridor, KalmanTakesTheWayAlongItFromSlamAndTheRestFromTheMatch) {
  const PlanarWorld corridor = StraightCorridor();
  const PlanarLaser laser{.beams = 320, .sigma_of_range = 0.01};
  MapperOptions options;
  options.method = MapperMethod::kPaper;
  options.fusion.mode = FusionMode::kKalman;
  IncrementalMapper mapper(options, std::nullopt);
  constexpr int kFrames = 200;
  double along_m = 0.0;
  double across_m = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const Pose2 truth{0.01 * i, 0.0, 0.0};
    const Pose2 slam{0.011 * i, 0.001 * i, 0.0};  // 10 % too far, and sideways
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.scan =
        std::make_shared<Scan>(ScanOf(corridor, truth, laser, 3, static_cast<unsigned>(i)));
    frame.slam_from_camera = CameraOf(slam, 1.0);
    const Pose2 estimate = BaseOf(*mapper.AddFrame(frame).map_from_camera);
    along_m = std::max(along_m, std::abs(estimate.x_m - slam.x_m));
    across_m = std::max(across_m, std::abs(estimate.y_m - truth.y_m));
  }
  EXPECT_LT(along_m, 0.03);   // SLAM's, although it is off by 0.2 m at the end
  EXPECT_LT(across_m, 0.06);  // the match's, although SLAM is off by 0.2 m at the end
}

}  // namespace
}  // namespace depthgrid
