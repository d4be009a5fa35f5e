// Several mappers started in one finished map.
#include <gtest/gtest.h>

#include <limits>

#include "mapper/core/error.h"
#include "tests/mapper/prior_round.h"

namespace depthgrid {
namespace {

// Also when the mapper that the others were started by has long mapped something itself.
TEST(PriorMap, IsStartedInElsewhereAsIfGivenAnew) {
  for (const MapperMethod method : {MapperMethod::kSurfel, MapperMethod::kPaper}) {
    for (const bool fixed : {true, false}) {
      MapperOptions options;
      options.method = method;
      options.submap.scans = kPriorRound;
      PriorMap prior = FinishedRound();
      prior.fixed = fixed;
      IncrementalMapper first(options, std::nullopt);
      first.StartFrom(prior);
      const Pose2 elsewhere{0.04, -0.03, 0.02};
      IncrementalMapper moved = first.StartedAt(elsewhere);
      IncrementalMapper same = first.StartedAt(prior.map_from_slam);
      IncrementalMapper anew(options, std::nullopt);
      prior.map_from_slam = elsewhere;
      anew.StartFrom(prior);
      bool differ = false;
      for (int i = 0; i < 40; ++i) {
        const Frame frame = PriorFrameAt(i, PriorTruthAt(i));
        const auto at_first = first.AddFrame(frame).map_from_camera;
        const auto at_elsewhere = moved.AddFrame(frame).map_from_camera;
        differ = differ || at_first != at_elsewhere;
        ASSERT_EQ(at_elsewhere, anew.AddFrame(frame).map_from_camera) << i;
      }
      EXPECT_TRUE(differ);
      EXPECT_EQ(moved.Finish().map_from_camera, anew.Finish().map_from_camera);
      for (int i = 0; i < 40; ++i) same.AddFrame(PriorFrameAt(i, PriorTruthAt(i)));
      EXPECT_EQ(same.Finish().map_from_camera, first.Finish().map_from_camera);
    }
  }
}

TEST(PriorMap, IsStartedInElsewhereOnlyBeforeAFrame) {
  IncrementalMapper mapper({}, std::nullopt);
  EXPECT_THROW(mapper.StartedAt({}), InputError);
  mapper.StartFrom(FinishedRound());
  EXPECT_NO_THROW(mapper.StartedAt({}));
  EXPECT_THROW(mapper.StartedAt({.x_m = std::numeric_limits<double>::infinity()}), InputError);
  Frame frame = PriorFrameAt(0, PriorTruthAt(0));
  frame.slam_from_camera.reset();
  mapper.AddFrame(frame);
  EXPECT_THROW(mapper.StartedAt({}), InputError);
}

}  // namespace
}  // namespace depthgrid
