#include "mapper/map_start.h"

#include <gmock/gmock.h>

#include <deque>
#include <limits>
#include <memory>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

// A hall of 26 x 4 m that looks the same from either end, but for shelves on the left of its
// middle.
PlanarWorld Hall() {
  PlanarWorld world = RectangleWorld(-1.0, -2.0, 25.0, 2.0);
  const auto add = [&](double x0, double x1, double depth_m) {
    for (const double side : {-1.0, 1.0}) {
      for (const Wall& wall : RectangleWorld(x0, side * 2.0, x1, side * (2.0 - depth_m))) {
        world.push_back(wall);
      }
    }
  };
  add(3.0, 3.4, 0.5);  // pillars
  add(20.6, 21.0, 0.5);
  add(7.8, 11.8, 1.5);
  return world;
}

PriorMap MapOfHall() {
  const PlanarWorld world = Hall();
  PlanarLaser laser;
  laser.field_of_view_rad = RadFromDeg(270.0);
  ScanArchive archive;
  PriorMap prior;
  for (int i = 0; i <= 240; ++i) {
    MappedFrame frame;
    frame.frame = i - 241;
    frame.stamp_s = 0.1 * i;
    frame.map_from_base = {0.1 * i, 0.0, i % 2 == 0 ? 0.0 : kPi};
    frame.scan = archive.Keep(ScanOf(world, frame.map_from_base, laser));
    frame.obstacles = frame.scan;
    prior.frames.push_back(frame);
  }
  return prior;
}

// A robot that goes `way_m` straight ahead; SLAM's frame is where it begins.
class WalkThroughHall final : public FrameSource {
 public:
  WalkThroughHall(const Pose2& begin, double way_m, const PlanarWorld& world = Hall()) {
    for (int i = 0; i * 0.1 <= way_m; ++i) {
      const Pose2 slam_from_base{0.1 * i, 0.0, 0.0};
      Frame frame;
      frame.index = i;
      frame.stamp_s = 0.1 * i;
      frame.scan = std::make_shared<const Scan>(ScanOf(world, begin * slam_from_base,
                                                       PlanarLaser{.sigma_of_range = 0.01}, 1,
                                                       static_cast<std::uint32_t>(i)));
      frame.slam_from_camera = CameraOf(slam_from_base, 0.0);
      frames_.push_back(frame);
    }
  }
  std::optional<Frame> Next() override {
    if (frames_.empty()) return {};
    Frame frame = frames_.front();
    frames_.pop_front();
    return frame;
  }
  std::optional<PinholeCamera> Camera() const override { return {}; }
  int FrameCount() const override { return static_cast<int>(frames_.size()); }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  std::deque<Frame> frames_;
};

// The first views fit at both ends, and SLAM's frame being the map's speaks for the wrong one.
TEST(FindStart, TriesPlacesThatLookAlike) {
  const Pose2 begin{24.0, 0.0, kPi};
  WalkThroughHall walk(begin, 12.0);
  const auto start = FindStart(MapOfHall(), walk, MapperOptions{});
  ASSERT_TRUE(start);
  ASSERT_TRUE(start->trial);
  EXPECT_GE(start->trial->places, 2);
  EXPECT_GE(start->trial->frames, 60);  // six metres
  EXPECT_GT(start->trial->agreement, start->trial->agreement_next);
  EXPECT_FALSE(start->contradicted());
  const Pose2 off = Between(begin, start->place.map_from_slam);
  EXPECT_LT(off.translation().norm(), 0.5);  // matching finds the rest
  EXPECT_LT(std::abs(off.yaw_rad), 0.05);
}

// Nothing that is seen tells the ends apart, and that is said.
TEST(FindStart, SaysThatItIsUncertain) {
  WalkThroughHall walk({24.0, 0.0, kPi}, 1.0);
  const auto start = FindStart(MapOfHall(), walk, MapperOptions{});
  ASSERT_TRUE(start);
  EXPECT_TRUE(start->uncertain());
}

// A corridor: wherever it is laid over the hall, a wall of it stands in free space.
TEST(FindStart, SaysThatTheMapIsOfAnotherPlace) {
  WalkThroughHall walk({}, 5.0, RectangleWorld(-1.0, -0.8, 9.0, 0.8));
  const auto start = FindStart(MapOfHall(), walk, MapperOptions{});
  ASSERT_TRUE(start);
  EXPECT_TRUE(start->contradicted()) << start->trial->against;
}

MapStart StartOf(double score, double second_score, const StartTrial& trial) {
  MapStart start;
  start.place.score = score;
  start.place.second_score = second_score;
  start.trial = trial;
  return start;
}

// As measured: drives that began in the next room or in another building.
TEST(MapStart, SaysSoWhenLittleAgrees) {
  EXPECT_TRUE(StartOf(0.65, 0.65, {5, 142, 5.0, 0.65, 0.45, 0.29}).contradicted());
  const MapStart building = StartOf(0.70, 0.67, {8, 328, 6.0, 0.66, 0.52, 0.07});
  EXPECT_FALSE(building.contradicted());
  EXPECT_TRUE(building.fits_badly());
  EXPECT_TRUE(building.uncertain());
  // Another building that agrees well by chance, as it fits elsewhere.
  EXPECT_TRUE(StartOf(0.68, 0.67, {8, 120, 2.5, 0.83, 0.73, 0.06}).uncertain());
}

TEST(MapStart, IsSureOfRightStarts) {
  // At the door to a room that the map does not have; among furniture that was moved; of alike
  // offices; on the way out.
  for (const MapStart& start : {StartOf(0.66, 0.53, {2, 100, 5.0, 0.89, 0.51, 0.01}),
                                StartOf(0.88, 0.73, {3, 146, 4.0, 0.81, 0.70, 0.10}),
                                StartOf(0.98, 0.94, {8, 340, 6.0, 0.91, 0.78, 0.00}),
                                StartOf(0.69, 0.59, {7, 120, 6.0, 0.83, 0.52, 0.02})}) {
    EXPECT_FALSE(start.uncertain()) << start.place.score;
    EXPECT_FALSE(start.contradicted()) << start.place.score;
  }
}

TEST(MapStart, AsksForMoreOfARobotThatHardlyMoved) {
  StartTrial trial{2, 40, 2.0, 0.91, 0.75, 0.0};
  EXPECT_FALSE(StartOf(0.98, 0.80, trial).uncertain());
  trial.reach_m = 0.9;
  EXPECT_TRUE(StartOf(0.98, 0.80, trial).uncertain());
  trial.agreement_next = 0.6;
  MapStart start = StartOf(0.98, 0.80, trial);
  EXPECT_FALSE(start.uncertain());
  start.place.unsure = UnsureAlong{0.0, 1.0};
  EXPECT_TRUE(start.uncertain());
  start.known = true;  // somebody said where
  EXPECT_FALSE(start.uncertain());
  start.place.second_score = 1.0;
  start.place.score = 0.84;
  EXPECT_TRUE(start.uncertain());
}

// Before the plain wall of the hall, and it does not move.
TEST(FindStart, SaysThatARobotThatStandsIsUncertain) {
  WalkThroughHall walk({15.0, 0.0, 0.5 * kPi}, 0.0);
  const Frame frame = *walk.Next();
  std::vector<Frame> frames;
  for (int i = 0; i < 20; ++i) {
    frames.push_back(frame);
    frames.back().index = i;
    frames.back().stamp_s = 0.1 * i;
  }
  const auto start = FindStart(MapOfHall(), frames, {}, MapperOptions{});
  ASSERT_TRUE(start);
  EXPECT_TRUE(start->hardly_moved());
  EXPECT_TRUE(start->uncertain());
}

// Where it is said to be, though nothing that is seen tells the ends apart.
TEST(FindStartNear, TakesThePlaceThatIsGiven) {
  const PriorMap map = MapOfHall();
  for (const Pose2& begin : {Pose2{24.0, 0.0, kPi}, Pose2{0.0, 0.0, 0.0}}) {
    WalkThroughHall walk(begin, 1.0);
    const Pose2 said = begin * Pose2{0.3, -0.2, 0.1};
    const auto start = FindStartNear(map, said, walk, MapperOptions{});
    ASSERT_TRUE(start);
    EXPECT_FALSE(AreApart(begin, start->place.map_from_slam, 0.05, 0.02));
    EXPECT_TRUE(start->known);
    EXPECT_FALSE(start->uncertain());
    EXPECT_FALSE(start->contradicted());
  }
}

// It fits there as well as anywhere near, or whoever says it knows.
TEST(FindStartNear, APlaceThatIsKnownExactlyIsLeftAsItIs) {
  const PriorMap map = MapOfHall();
  const Pose2 begin{24.0, 0.0, kPi};
  WalkThroughHall walk(begin, 1.0);
  const auto right = FindStartNear(map, begin, walk, MapperOptions{});
  ASSERT_TRUE(right);
  EXPECT_FALSE(AreApart(begin, right->map_from_base, 0.02, 0.01));
  const Pose2 off = begin * Pose2{0.1, 0.05, 0.02};
  for (const double within_m : {0.0, 0.05, 0.3}) {
    WalkThroughHall again(begin, 1.0);
    const auto start = FindStartNear(map, off, again, MapperOptions{}, within_m);
    ASSERT_TRUE(start);
    if (within_m == 0.0) {
      EXPECT_FALSE(AreApart(off, start->map_from_base, 1e-9, 1e-9));
    } else if (within_m == 0.05) {
      EXPECT_FALSE(AreApart(off, start->map_from_base, 0.05, 0.2));
    } else {
      EXPECT_FALSE(AreApart(begin, start->map_from_base, 0.03, 0.01));
    }
  }
}

TEST(FindStartNear, SaysThatAWrongPlaceDoesNotFit) {
  WalkThroughHall walk({24.0, 0.0, kPi}, 1.0);
  const auto start = FindStartNear(MapOfHall(), {12.5, 0.0, 0.5 * kPi}, walk, MapperOptions{});
  ASSERT_TRUE(start);
  EXPECT_TRUE(start->uncertain() || start->contradicted()) << start->trial->agreement;
}

TEST(FindStartNear, TakesFramesThatWereCollected) {
  const Pose2 begin{24.0, 0.0, kPi};
  WalkThroughHall walk(begin, 1.0);
  std::vector<Frame> frames;
  while (auto frame = walk.Next()) frames.push_back(std::move(*frame));
  const auto start = FindStartNear(MapOfHall(), begin, frames, {}, MapperOptions{});
  ASSERT_TRUE(start);
  EXPECT_FALSE(AreApart(begin, start->place.map_from_slam, 0.05, 0.02));
  EXPECT_FALSE(FindStartNear(MapOfHall(), begin, {}, {}, MapperOptions{}));
}

TEST(FindStart, TakesFramesThatWereCollected) {
  const Pose2 begin{24.0, 0.0, kPi};
  WalkThroughHall walk(begin, 12.0);
  std::vector<Frame> frames;
  while (auto frame = walk.Next()) frames.push_back(std::move(*frame));
  WalkThroughHall again(begin, 12.0);
  const PriorMap map = MapOfHall();
  const auto expected = FindStart(map, again, MapperOptions{});
  const auto start = FindStart(map, frames, {}, MapperOptions{});
  ASSERT_TRUE(expected && start);
  EXPECT_EQ(start->place.map_from_slam, expected->place.map_from_slam);
  EXPECT_FALSE(AreApart(begin, start->place.map_from_slam, 0.5, 0.05));
}

// Half a minute at 30 Hz before it leaves its charger: no more is kept than of one that leaves.
TEST(FindStart, TakesARobotThatStandsForLong) {
  const Pose2 begin{24.0, 0.0, kPi};
  WalkThroughHall walk(begin, 12.0);
  std::vector<Frame> frames;
  while (auto frame = walk.Next()) frames.push_back(std::move(*frame));
  constexpr int kStanding = 900;
  frames.insert(frames.begin(), kStanding, frames.front());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = static_cast<int>(i);
    frames[i].stamp_s = 0.1 * static_cast<double>(i);
  }
  const auto start = FindStart(MapOfHall(), frames, {}, MapperOptions{});
  ASSERT_TRUE(start && start->trial);
  EXPECT_FALSE(AreApart(begin, start->place.map_from_slam, 0.5, 0.05));  // matching finds the rest
  EXPECT_LT(start->trial->frames, 130);  // 9 m of the way, one each 0.1 m
  EXPECT_GT(start->trial->reach_m, 8.0);
}

// As a mapper refuses them, with the same words.
TEST(FindStart, RefusesWhatIsNotSound) {
  const auto error_of = [](const PriorMap& prior, const Frame& frame,
                           const std::optional<PinholeCamera>& camera) -> std::string {
    try {
      FindStart(prior, std::vector{frame}, camera, MapperOptions{});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  WalkThroughHall walk({24.0, 0.0, kPi}, 1.0);
  const Frame frame = *walk.Next();
  PriorMap without_scans = MapOfHall();
  without_scans.frames[2].obstacles = {};
  EXPECT_EQ(error_of(without_scans, frame, {}),
            "prior map, entry 2: has no scans of its own, must have both");
  EXPECT_FALSE(FindStart(PriorMap{}, std::vector{frame}, {}, MapperOptions{}));
  const PriorMap map = MapOfHall();
  Frame image = frame;
  image.scan.reset();
  image.depth = std::make_shared<DepthImage>(4, 2);
  EXPECT_EQ(error_of(map, image, {}),
            "frame 0: has a depth image, but the mapper was made without a camera");
  const PinholeCamera camera{
      .width_px = 4, .height_px = 3, .fx_px = 3, .fy_px = 3, .cx_px = 1.5, .cy_px = 1};
  EXPECT_EQ(error_of(map, image, camera),
            "frame 0: its depth image has 4 x 2 pixels, must have the camera's 4 x 3 pixels");
}

TEST(FindStartNear, RefusesWhatIsNoPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const PriorMap map = MapOfHall();
  WalkThroughHall walk({24.0, 0.0, kPi}, 1.0);
  const auto error_of = [&](const Pose2& begin, double within_m) -> std::string {
    try {
      FindStartNear(map, begin, walk, MapperOptions{}, within_m);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      error_of({nan, 0.0, 0.0}, 1.0),
      "start in the map: map_from_base is (nan, 0.000000, 0.000000), must be finite and within "
      "10,000 km");
  for (const double within_m : {nan, -1.0, 5.1}) {
    EXPECT_THAT(error_of({}, within_m), testing::HasSubstr("start in the map: within_m is "));
  }
}

TEST(FindStart, IsNothingWithoutFrames) {
  WalkThroughHall walk({24.0, 0.0, kPi}, -1.0);
  EXPECT_FALSE(FindStart(MapOfHall(), walk, MapperOptions{}));
}

}  // namespace
}  // namespace depthgrid
