#include "mapper/io/body_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapper/io/sequence.h"
#include "mapper/io/tum_folder.h"
#include "tests/io/temporary_folder.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kTurn = 12;  // views a round
constexpr double kTiltRad = 0.35;

CameraFile SmallCamera() { return {{80, 60, 60.2, 60.0, 39.5, 29.5, {}}, 5000.0}; }

// A rectangle of the image, half open.
struct Part {
  int first_column, end_column, first_row, end_row;
  bool Has(int u, int v) const {
    return first_column <= u && u < end_column && first_row <= v && v < end_row;
  }
};
constexpr Part kGripper = {30, 50, 40, 60};

void Paint(const Part& part, float depth_m, DepthImage& image) {
  for (int v = part.first_row; v < part.end_row; ++v) {
    std::fill(image.Row(v) + part.first_column, image.Row(v) + part.end_column, depth_m);
  }
}

// What a camera `height_m` above the floor sees of a room with a box in it, half turned away.
DepthImage ViewOf(int i, double height_m) {
  AnalyticRoom room;
  room.boxes = {{{1.2, -1.0, 0.0}, {2.4, 0.6, 0.45}}};
  const Pose2 pose{0.3 * std::cos(i), 0.0, 2.0 * kPi * i / kTurn};
  return room.Render(SmallCamera().camera, TiltedCamera(pose, height_m, kTiltRad, 0.0));
}

std::optional<BodyMask> Found(const std::vector<DepthImage>& views) {
  BodyFinder finder;
  for (const DepthImage& view : views) finder.Add(view);
  return finder.Find();
}

std::vector<DepthImage> Views(int count = kTurn, double height_m = 1.2) {
  std::vector<DepthImage> views;
  for (int i = 0; i < count; ++i) views.push_back(ViewOf(i, height_m));
  return views;
}

// What a level camera sees that turns round once.
std::vector<DepthImage> LevelViews(const AnalyticRoom& room, double height_m) {
  std::vector<DepthImage> views;
  for (int i = 0; i < kTurn; ++i) {
    const Pose2 pose{0.2 * std::cos(i), 0.0, 2.0 * kPi * i / kTurn};
    views.push_back(room.Render(SmallCamera().camera, TiltedCamera(pose, height_m, 0.0, 0.0)));
  }
  return views;
}

TEST(BodyFinder, FindsWhatStaysWhileTheCameraTurns) {
  std::vector<DepthImage> views = Views();
  EXPECT_FALSE(Found(views));
  for (std::size_t i = 0; i < views.size(); ++i) {
    Paint(kGripper, 0.4F + 0.002F * static_cast<float>(i % 5), views[i]);
  }
  const auto body = Found(views);
  ASSERT_TRUE(body);
  EXPECT_NEAR(body->depth_m, 0.404, 1e-6);
  EXPECT_EQ(body->first_column, 30);
  EXPECT_EQ(body->last_column, 49);
  EXPECT_EQ(body->first_row, 40);
  EXPECT_EQ(body->last_row, 59);
  EXPECT_NEAR(body->share, 26 * 23 / 4800.0, 1e-9);  // with three pixels around
  DepthImage dropped = views[3];
  body->Drop(dropped);
  constexpr Part kWithEdge = {27, 53, 37, 60};
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 80; ++u) {
      ASSERT_EQ(dropped.At(u, v), kWithEdge.Has(u, v) ? kInvalidDepth : views[3].At(u, v));
    }
  }
}

// Too near for a sensor's comfort it is measured now and then; but then nothing else is.
TEST(BodyFinder, MayBeMissedInHalfOfTheViews) {
  for (const float otherwise_m : {kInvalidDepth, 2.5F}) {
    std::vector<DepthImage> views = Views();
    for (std::size_t i = 0; i < views.size(); ++i) {
      Paint(kGripper, i % 2 == 0 ? 0.3F : otherwise_m, views[i]);
    }
    EXPECT_EQ(Found(views).has_value(), otherwise_m == kInvalidDepth);
  }
}

// What is nearer than it hides it at times.
TEST(BodyFinder, IsWhatNothingIsSeenBehind) {
  for (const float otherwise_m : {0.7F, 0.9F}) {
    std::vector<DepthImage> views = Views(24);
    for (std::size_t i = 0; i < views.size(); ++i) {
      Paint(kGripper, i % 3 == 0 ? otherwise_m : 0.8F, views[i]);
    }
    EXPECT_EQ(Found(views).has_value(), otherwise_m < 0.8F);
  }
}

TEST(BodyFinder, NeedsViewsAndLeavesMostOfTheImage) {
  std::vector<DepthImage> views = Views();
  for (DepthImage& view : views) Paint(kGripper, 0.4F, view);
  views.resize(kFewestBodyViews);
  EXPECT_TRUE(Found(views));
  views.pop_back();
  EXPECT_FALSE(Found(views));
  views = Views();
  for (DepthImage& view : views) Paint({0, 80, 0, 31}, 0.4F, view);
  EXPECT_FALSE(Found(views));
  // Nor is what is farther than 1 m.
  views = Views();
  for (DepthImage& view : views) Paint(kGripper, 1.05F, view);
  EXPECT_FALSE(Found(views));
}

// A low camera sees the floor nearer than 1 m, always at the same place.
TEST(BodyFinder, IsNotTheFloor) {
  constexpr double kLowM = 0.5;
  std::vector<DepthImage> views = Views(kTurn, kLowM);
  EXPECT_LT(views[0].At(40, 55), 0.8F);
  EXPECT_EQ(views[0].At(40, 55), views[3].At(40, 55));
  EXPECT_FALSE(Found(views));
  // A wheel that stands on it is.
  for (DepthImage& view : views) Paint(kGripper, 0.45F, view);
  const auto body = Found(views);
  ASSERT_TRUE(body);
  EXPECT_NEAR(body->share, 26 * 23 / 4800.0, 1e-9);
}

// A vacuum cleaner's camera in a small room sees no floor farther than 1 m in most views.
TEST(BodyFinder, IsNotTheFloorCloseBelowTheCamera) {
  AnalyticRoom room;
  room.walls = {{-0.9, -0.9, 0.0}, {0.9, 0.9, 2.5}};
  std::vector<DepthImage> views = LevelViews(room, 0.12);
  EXPECT_LT(views[0].At(40, 55), 0.4F);
  EXPECT_FALSE(Found(views));
  for (DepthImage& view : views) Paint(kGripper, 0.2F, view);
  const auto body = Found(views);
  ASSERT_TRUE(body);
  EXPECT_NEAR(body->share, 26 * 23 / 4800.0, 1e-9);
}

// Level as a floor is, but the floor is seen beyond it.
TEST(BodyFinder, IsTheDeckBelowTheCamera) {
  constexpr double kAboveDeckM = 0.12, kEndM = 0.4;
  std::vector<DepthImage> views = LevelViews({}, 0.3);
  for (DepthImage& view : views) {
    for (int row = 30; row < view.height_px; ++row) {
      const double depth_m = kAboveDeckM * 60.0 / (row - 29.5);
      if (depth_m < kEndM) Paint({0, 80, row, row + 1}, static_cast<float>(depth_m), view);
    }
  }
  const auto body = Found(views);
  ASSERT_TRUE(body);
  EXPECT_EQ(body->first_row, 48);
  EXPECT_EQ(body->last_row, 59);
}

class BodyInFolder : public TemporaryFolderTest {
 protected:
  void Write(int frames) const {
    const TumFolderWriter writer(folder_, SmallCamera());
    Trajectory truth;
    std::vector<double> stamps_s;
    for (int i = 0; i < frames; ++i) {
      const Pose2 pose{0.3 * std::cos(i), 0.0, 2.0 * kPi * i / kTurn};
      DepthImage view = ViewOf(i, 1.2);
      Paint(kGripper, 0.4F, view);
      writer.WriteFrame(0.125 * i, view, nullptr);
      stamps_s.push_back(0.125 * i);
      truth.push_back({0.125 * i, TiltedCamera(pose, 1.2, kTiltRad, 0.0)});
    }
    writer.Finish(stamps_s, false, truth);
  }
};

TEST_F(BodyInFolder, IsLeftOutAndNamed) {
  Write(100);
  const Sequence sequence = OpenSequence(folder_);
  EXPECT_THAT(sequence.source->Warnings(),
              Contains(folder_ +
                       ": 12.5 % of the depth image stay the same while the camera turns (0.40 m, "
                       "columns 30 to 49, rows 40 to 59): taken for parts of the robot and left "
                       "out (sequence.recording.drop_body=false keeps them)"));
  EXPECT_EQ(sequence.source->Next()->depth->At(40, 50), kInvalidDepth);
  SequenceOptions options;
  options.recording.drop_body = false;
  const Sequence whole = OpenSequence(folder_, options);
  EXPECT_THAT(whole.source->Warnings(), IsEmpty());
  EXPECT_NEAR(whole.source->Next()->depth->At(40, 50), 0.4F, 1e-4F);
}

TEST_F(BodyInFolder, IsNotToldOfLessThanHalfATurn) {
  Write(8);
  const Sequence sequence = OpenSequence(folder_);
  EXPECT_NEAR(sequence.source->Next()->depth->At(40, 50), 0.4F, 1e-4F);
}

}  // namespace
}  // namespace depthgrid
