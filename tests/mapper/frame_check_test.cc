// Frames as a live system may bring them, refused by name and without a trace.
#include "mapper/frame_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;

const PinholeCamera kCamera{64, 48, 60.0, 60.0, 31.5, 23.5, {}};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Frame CheckedFrame(int index) {
  Frame frame;
  frame.index = index;
  frame.stamp_s = index / 30.0;
  frame.slam_from_camera = CameraOf({0.0, 0.0, 0.02 * index}, 1.1);
  frame.depth =
      std::make_shared<DepthImage>(AnalyticRoom{}.Render(kCamera, *frame.slam_from_camera));
  return frame;
}

LoopClosure LoopOf(const Frame& frame) {
  LoopClosure loop;
  loop.reported_at_frame = frame.index;
  loop.second_frame = frame.index;
  return loop;
}

std::string WhyRefused(const Frame& frame) {
  try {
    RequireSound(frame, kCamera);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

struct Case {
  std::function<void(Frame&)> spoil;
  std::string why;
};

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases = {
      {[](Frame& f) { f.index = -5; }, "frame -5: must have a number from 0 on"},
      {[](Frame& f) { f.stamp_s = kNan; }, "its stamp is nan"},
      {[](Frame& f) { f.slam_from_camera->translation.z() = kNan; }, "its pose lies at (0.0"},
      {[](Frame& f) { f.slam_from_camera->translation.x() = 2e7; }, "must lie within 10,000 km"},
      {[](Frame& f) { f.slam_from_camera->rotation.x() = kNan; }, "quaternion has the norm nan"},
      {[](Frame& f) { f.slam_from_camera->rotation.coeffs().setZero(); }, "norm 0.0"},
      {[](Frame& f) { f.depth = std::make_shared<DepthImage>(32, 48); },
       "has 32 x 48 pixels, must have the camera's 64 x 48"},
      {[](Frame& f) {
         auto image = std::make_shared<DepthImage>(*f.depth);
         image->z_m.resize(7);
         f.depth = image;
       },
       "holds 7 values, must hold 3072"},
      {[](Frame& f) {
         auto image = std::make_shared<DepthImage>(*f.depth);
         for (std::size_t i = 0; i < image->z_m.size(); ++i) {
           image->z_m[i] = 1500.0F + static_cast<float>(i);
         }
         f.depth = image;
       },
       "must be metres: are these millimetres?"},
      {[](Frame& f) { f.scan = std::make_shared<Scan>(); }, "a depth image and a scan"},
      {[](Frame& f) { f.matched_scan = std::make_shared<Scan>(); }, "a matched_scan, but no scan"},
      {[](Frame& f) { f.stand = CameraStand{}; }, "a stand, but no scan that it belongs to"},
      {[](Frame& f) {
         f.depth.reset();
         f.scan = std::make_shared<Scan>();
         f.stand = CameraStand{.height_m = kNan};
       },
       "its stand lies at (0.0"},
      {[](Frame& f) {
         f.depth.reset();
         f.scan = std::make_shared<Scan>(Scan{.beams = {}, .max_range_m = kNan});
       },
       "its scan's max_range_m is nan, must be 0 (unknown) or more"},
      {[](Frame& f) {
         f.depth.reset();
         f.scan = std::make_shared<Scan>();
         f.slam_from_camera = Lift({1.0, 2.0, 0.5});
       },
       "looks straight up or down, so that it has no heading: the pose of a laser must be "
       "CameraOf"},
      {[](Frame& f) {
         f.loops = {LoopOf(f)};
         f.loops[0].sigma_rotation_rad = 0.0;
       },
       "the loop closure of frames 0 and 10 has a sigma of 0.0"},
      {[](Frame& f) {
         f.loops = {LoopOf(f)};
         f.loops[0].first_from_second.translation.y() = kNan;
       },
       "the loop closure of frames 0 and 10 lies at"}};
  return cases;
}

TEST(FrameCheck, SaysWhichFrameAndWhatIsWrongWithIt) {
  EXPECT_EQ(WhyRefused(CheckedFrame(10)), "");
  for (const Case& c : Cases()) {
    Frame frame = CheckedFrame(10);
    c.spoil(frame);
    const std::string why = WhyRefused(frame);
    EXPECT_THAT(why, HasSubstr(c.why));
    EXPECT_THAT(why, HasSubstr("frame " + std::to_string(frame.index) + ": "));
  }
}

// As of a depth camera under a ceiling.
TEST(FrameCheck, AnImageAndAScanOfOneMayBeTakenStraightDown) {
  Frame frame = CheckedFrame(4);
  const auto nod = [&](double down_rad) {
    frame.slam_from_camera->rotation *=
        Eigen::Quaterniond(Eigen::AngleAxisd(-down_rad, Eigen::Vector3d::UnitX()));
  };
  nod(kPi / 2.0);
  EXPECT_TRUE(LooksUpOrDown(*frame.slam_from_camera));
  EXPECT_EQ(WhyRefused(frame), "");
  frame.depth.reset();
  EXPECT_EQ(WhyRefused(frame), "");
  frame.scan = std::make_shared<Scan>();
  frame.stand = StandOf(*frame.slam_from_camera, 0.0);
  EXPECT_EQ(WhyRefused(frame), "");
  frame.stand.reset();
  EXPECT_THAT(WhyRefused(frame), HasSubstr("has no heading"));
  // 11 degrees from it is enough.
  nod(-RadFromDeg(11.0));
  EXPECT_EQ(WhyRefused(frame), "");
}

TEST(FrameCheck, PosesOfFloatsAndFramesThatLackAllButANumberAreSound) {
  Frame frame = CheckedFrame(3);
  frame.slam_from_camera->rotation = frame.slam_from_camera->rotation.cast<float>().cast<double>();
  EXPECT_EQ(WhyRefused(frame), "");
  EXPECT_EQ(WhyRefused(Frame{}), "");
  EXPECT_NO_THROW(RequireSound(Frame{}, std::nullopt));
  EXPECT_THROW(RequireSound(frame, std::nullopt), InputError);
}

// What a renderer draws where nothing is, however far, and one near pixel among far ones.
TEST(FrameCheck, AFarPlaneIsNoMillimetres) {
  Frame frame = CheckedFrame(0);
  auto image = std::make_shared<DepthImage>(*frame.depth);
  std::fill(image->z_m.begin(), image->z_m.end(), 1000.0F);
  frame.depth = image;
  EXPECT_EQ(WhyRefused(frame), "");
  image->z_m[1] = 1200.0F;
  EXPECT_EQ(WhyRefused(frame), "");
}

TEST(FrameCheck, APriorMapIsGivenOnceAndFirst) {
  IncrementalMapper mapper({}, kCamera);
  mapper.StartFrom({});
  EXPECT_THROW(mapper.StartFrom({}), InputError);
  IncrementalMapper begun({}, kCamera);
  begun.AddFrame(CheckedFrame(0));
  EXPECT_THROW(begun.StartFrom({}), InputError);
}

// The mapper goes on as if the frame had never come.
TEST(FrameCheck, ARefusedFrameLeavesNoTrace) {
  IncrementalMapper undisturbed({}, kCamera), disturbed({}, kCamera);
  for (int i = 0; i < 30; ++i) {
    for (const Case& c : Cases()) {
      Frame spoilt = CheckedFrame(i);
      c.spoil(spoilt);
      EXPECT_THROW(disturbed.AddFrame(spoilt), InputError);
    }
    EXPECT_EQ(undisturbed.AddFrame(CheckedFrame(i)).map_from_camera,
              disturbed.AddFrame(CheckedFrame(i)).map_from_camera);
  }
  const MapperResult expected = undisturbed.Finish(), result = disturbed.Finish();
  EXPECT_EQ(result.map_from_camera, expected.map_from_camera);
  ASSERT_GT(expected.map.occupied_prob.size(), 0U);
  EXPECT_EQ(StatesOf(result.map).states, StatesOf(expected.map).states);
}

// A node may be stopped before SLAM is there, or the first image.
TEST(IncrementalMapper, EndsWithoutAnythingMapped) {
  for (const MapperMethod method : {MapperMethod::kPaper, MapperMethod::kSurfel}) {
    MapperOptions options;
    options.method = method;
    IncrementalMapper mapper(options, kCamera);
    EXPECT_TRUE(mapper.Finish().map_from_camera.empty());
    Frame no_image = CheckedFrame(0), no_pose = CheckedFrame(1);
    no_image.depth.reset();
    no_pose.slam_from_camera.reset();
    mapper.AddFrame(no_image);
    mapper.AddFrame(no_pose);
    const MapperResult result = mapper.Finish();
    ASSERT_EQ(result.map_from_camera.size(), 2U);
    EXPECT_EQ(result.map_from_camera[0], no_image.slam_from_camera);
    EXPECT_FALSE(result.map_from_camera[1]);
    EXPECT_EQ(result.map.geometry.size(), 0U);
  }
}

std::string WhyNotMade(const MapperOptions& options, const PinholeCamera& camera) {
  try {
    const IncrementalMapper mapper(options, camera);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(IncrementalMapper, IsNotMadeOfOptionsOutOfRangeNorOfACameraThatIsNone) {
  MapperOptions options;
  EXPECT_EQ(WhyNotMade(options, kCamera), "");
  options.grid.resolution_m = 0.0;
  EXPECT_EQ(WhyNotMade(options, kCamera),
            "mapper.grid.resolution_m: is 0, must be from 0.005 to 1");
  PinholeCamera camera = kCamera;
  camera.fx_px = kNan;
  EXPECT_THAT(WhyNotMade({}, camera), HasSubstr("camera: fx is nan"));
  camera = kCamera;
  camera.distortion[0] = 0.1;
  EXPECT_THAT(WhyNotMade({}, camera), HasSubstr("camera: has distortion"));
  camera = kCamera;
  camera.width_px = 1;
  EXPECT_EQ(WhyNotMade({}, camera), "camera: is 1 x 48 pixels, must be 2 x 2 or more");
}

TEST(IncrementalMapper, IsNotMadeOfAChoiceThatIsNone) {
  MapperOptions options;
  options.method = static_cast<MapperMethod>(7);
  EXPECT_EQ(WhyNotMade(options, kCamera), "mapper.method: is none of its values, paper, surfel");
}

TEST(IncrementalMapper, SaysWhatIsWrongWithSlamsFinalTrajectory) {
  IncrementalMapper mapper({}, kCamera);
  const Frame frame = CheckedFrame(0);
  mapper.AddFrame(frame);
  const auto why = [&](const std::vector<std::optional<Pose3>>& slam_final) -> std::string {
    try {
      mapper.Finish(slam_final);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why({}), "");
  EXPECT_EQ(why({frame.slam_from_camera}), "");
  EXPECT_EQ(why({std::nullopt}), "");
  EXPECT_EQ(why({{}, {}}),
            "slam_final: has 2 poses, must have one for each of the 1 frames, or none");
  Pose3 nowhere = *frame.slam_from_camera;
  nowhere.translation.x() = kNan;
  EXPECT_THAT(why({nowhere}), HasSubstr("slam_final: entry 0 lies at (nan"));
}

TEST(IncrementalMapper, AnotherOneTakesItsPlace) {
  IncrementalMapper mapper({}, kCamera);
  mapper.AddFrame(CheckedFrame(0));
  mapper = IncrementalMapper({}, kCamera);
  EXPECT_NO_THROW(mapper.AddFrame(CheckedFrame(0)));
  EXPECT_EQ(mapper.Finish().map_from_camera.size(), 1U);
}

}  // namespace
}  // namespace depthgrid
