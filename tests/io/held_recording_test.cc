// Poses of a recording that are held while its images move (mapper/io/held_frames.h), as frames.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "mapper/io/recording.h"

namespace depthgrid {
namespace {

constexpr int kRecorded = 60;
constexpr int kHeldFrom = 21, kHeldEnd = 40;  // frames with the pose of the one before

double WayM(int frame) { return 0.02 * frame; }

// Towards a wall at 2 cm and 1/30 s a frame; after the poses were held they go on at `back_m`.
std::unique_ptr<FrameSource> Open(double back_m, std::size_t begin = 0) {
  Recording recording;
  recording.name = "seq";
  recording.camera.camera = PinholeCamera{64, 48, 60.0, 60.0, 31.5, 23.5, {}};
  recording.part.begin = begin;
  SlamOutput slam;
  for (int i = 0; i < kRecorded; ++i) {
    const double stamp_s = i / 30.0;
    recording.images.push_back({stamp_s, std::to_string(i), i});
    const bool is_held = i >= kHeldFrom && i < kHeldEnd;
    const double at_m = is_held ? WayM(kHeldFrom - 1) : WayM(i) + (i < kHeldEnd ? 0.0 : back_m);
    slam.live.push_back({stamp_s, Pose3{Eigen::Quaterniond::Identity(), {0.0, 0.0, at_m}}, 0});
  }
  return OpenRecording(recording, slam, {}, [](const std::string& path) {
    DepthImage image(64, 48);
    image.z_m.assign(image.z_m.size(), static_cast<float>(5.0 - WayM(std::stoi(path))));
    return image;
  });
}

TEST(HeldRecording, IsInterpolatedBetweenItsNeighbours) {
  const auto frames = Open(0.0);
  while (const auto frame = frames->Next()) {
    ASSERT_TRUE(frame->slam_from_camera) << frame->index;
    const double off_m = frame->slam_from_camera->translation.z() - WayM(frame->index);
    // Where it began to be held is known to half of 5 cm and the noise.
    const bool is_held = frame->index >= kHeldFrom && frame->index < kHeldEnd;
    EXPECT_NEAR(off_m, 0.0, is_held ? 0.07 : 1e-9) << frame->index;
  }
  ASSERT_EQ(frames->Warnings().size(), 1U);
  EXPECT_NE(frames->Warnings()[0].find("frames interpolated, 0 taken for lost"), std::string::npos)
      << frames->Warnings()[0];
}

TEST(HeldRecording, IsLostWhereNobodyGoesThatFast) {
  const auto frames = Open(5.0);
  while (const auto frame = frames->Next()) {
    if (frame->index < kHeldFrom + 4) continue;
    EXPECT_EQ(frame->slam_from_camera.has_value(), frame->index >= kHeldEnd) << frame->index;
  }
}

// A part that begins amid them has the poses that it has in the whole.
TEST(HeldRecording, GivesAPartThePosesOfTheWhole) {
  const auto whole = Open(0.0), part = Open(0.0, kHeldFrom + 9);
  while (const auto frame = whole->Next()) {
    if (frame->index < kHeldFrom + 9) continue;
    EXPECT_EQ(part->Next()->slam_from_camera, frame->slam_from_camera) << frame->index;
  }
}

}  // namespace
}  // namespace depthgrid
