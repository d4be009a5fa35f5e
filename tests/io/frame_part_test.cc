// Parts of recordings, from which frames they are of to what of other files is theirs.
#include "mapper/io/frame_part.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/io/pose_file.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/sequence.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"
#include "tests/io/log_text.h"
#include "tests/io/temporary_folder.h"
#include "tests/mapper/analytic_room.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Four seconds and a frame, ten frames a second, by the clock of 1970.
std::vector<double> TenthsOfSeconds() {
  std::vector<double> stamps_s;
  for (int i = 0; i <= 40; ++i) stamps_s.push_back(1305031102.175304 + 0.1 * i);
  return stamps_s;
}

TEST(FramePart, PartsThatShareAnEndShareNoFrame) {
  const auto frames = [](double from_s, double to_s) {
    const FramePart part = FindPart({from_s, to_s}, TenthsOfSeconds(), "seq");
    return std::pair{part.begin, part.EndAmong(41)};
  };
  EXPECT_EQ(frames(0.0, 0.0), (std::pair<std::size_t, std::size_t>{0, 41}));
  EXPECT_EQ(frames(0.0, 1.3), (std::pair<std::size_t, std::size_t>{0, 13}));
  EXPECT_EQ(frames(1.3, 2.0), (std::pair<std::size_t, std::size_t>{13, 20}));
  EXPECT_EQ(frames(2.0, 0.0), (std::pair<std::size_t, std::size_t>{20, 41}));
  EXPECT_EQ(frames(2.0, 5.0), (std::pair<std::size_t, std::size_t>{20, 41}));
  EXPECT_EQ(frames(1.95, 2.05), (std::pair<std::size_t, std::size_t>{20, 21}));
  EXPECT_EQ(frames(4.0, 0.0), (std::pair<std::size_t, std::size_t>{40, 41}));
}

TEST(FramePart, OneClearLineForEachFault) {
  const auto refusal = [](double from_s, double to_s) {
    return RefusalOf([&] { FindPart({from_s, to_s}, TenthsOfSeconds(), "seq"); });
  };
  EXPECT_EQ(refusal(2.0, 1.0), "sequence.from_s: is 2, must be below to_s, 1");
  EXPECT_EQ(refusal(2.0, 2.0), "sequence.from_s: is 2, must be below to_s, 2");
  EXPECT_EQ(refusal(-1.0, 0.0), "sequence.from_s: is -1, must be from 0 to 10000000000");
  EXPECT_EQ(refusal(4.5, 0.0),
            "sequence.from_s: is 4.5, must be at most 4.000: seq is 4.000 s long");
  EXPECT_EQ(refusal(1.0, 5.5),
            "sequence.to_s: is 5.5, must be at most 5.000: seq is 4.000 s long; 0 is its end");
  EXPECT_EQ(refusal(1.02, 1.08),
            "sequence.from_s: is 1.02, but seq has no frame from there to 1.08 s");
}

// Twelve frames of a room, an eighth of a second apart, in a world of camera axes.
class PartOfASequence : public TemporaryFolderTest {
 protected:
  void SetUp() override {
    TemporaryFolderTest::SetUp();
    AnalyticRoom room;
    const CameraFile camera = {{80, 60, 60.2, 60.0, 39.5, 29.5, {}}, 5000.0};
    const TumFolderWriter writer(Path("seq"), camera);
    std::vector<double> stamps_s;
    for (int i = 0; i < 12; ++i) {
      const Pose3 pose = TiltedCamera({0.3 * std::cos(i), 0.0, kPi * i / 6.0}, 1.2, 0.35, 0.1);
      stamps_s.push_back(0.125 * i);
      writer.WriteFrame(stamps_s.back(), room.Render(camera.camera, pose), nullptr);
      poses_.push_back({stamps_s.back(), pose});
    }
    const Pose3 slam_from_world = Inverse(poses_[0].world_from_camera);
    for (StampedPose& pose : poses_) {
      pose.world_from_camera = slam_from_world * pose.world_from_camera;
    }
    writer.Finish(stamps_s, false, poses_);
    options_.part = {0.5, 1.0};  // frames 4 to 7
  }
  void RemoveImagesBut(std::size_t begin, std::size_t end) const {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (i >= begin && i < end) continue;
      std::filesystem::remove(Path(fmt::format("seq/depth/{:.6f}.png", poses_[i].stamp_s)));
    }
  }
  Trajectory poses_;
  SequenceOptions options_;
};

TEST_F(PartOfASequence, FramesAreThoseOfTheWhole) {
  const std::vector<Frame> all = ReadAll(*OpenSequence(Path("seq")).source);
  const Sequence part = OpenSequence(Path("seq"), options_);
  EXPECT_EQ(part.source->FrameCount(), 4);
  EXPECT_THAT(part.notes,
              Contains("the part of it: frames 4 to 7 of 12, 0.500 to 0.875 s of 1.375"));
  const std::vector<Frame> frames = ReadAll(*part.source);
  ASSERT_EQ(frames.size(), 4U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, static_cast<int>(i) + 4);
    EXPECT_EQ(frames[i].stamp_s, all[i + 4].stamp_s);
    EXPECT_EQ(frames[i].slam_from_camera, all[i + 4].slam_from_camera);  // of one level world
    EXPECT_EQ(frames[i].depth->z_m, all[i + 4].depth->z_m);
  }
}

// Of the images outside only those that say which way is up are looked at, and not missed.
TEST_F(PartOfASequence, WhatIsOutsideIsNotMissed) {
  RemoveImagesBut(0, 4);
  options_.part = {0.0, 0.5};
  poses_.resize(4);  // SLAM was given the part
  const Sequence part = OpenSequence(Path("seq"), options_, SlamOutputOf(poses_));
  EXPECT_THAT(part.notes, Contains(HasSubstr("the camera is 1.2")));
  EXPECT_EQ(ReadAll(*part.source).size(), 4U);
  EXPECT_THAT(part.source->Warnings(), IsEmpty());
}

TEST_F(PartOfASequence, FramesWithoutAPoseAreThoseOfThePart) {
  Trajectory poses = poses_;
  poses.erase(poses.begin() + 5);
  poses.erase(poses.begin(), poses.begin() + 3);
  const Sequence part = OpenSequence(Path("seq"), options_, SlamOutputOf(poses));
  EXPECT_THAT(part.source->Warnings(), ElementsAre(HasSubstr("seq: 1 of 4 frames has no pose")));
  poses.erase(poses.begin(), poses.begin() + 4);  // 8 to 11
  EXPECT_THAT(
      Short(RefusalOf([&] { OpenSequence(Path("seq"), options_, SlamOutputOf(poses)); })),
      HasSubstr("images from 0.000 to 1.375 s, the part's from 0.500 to 0.875 s, poses from "
                "1.000 to 1.375 s; none are of the part"));
}

TEST_F(PartOfASequence, LoopsThatLeaveItAreCountedInANote) {
  WriteTrajectory(Path("slam.txt"), poses_);
  const std::string pose = " 0 0 0 0 0 0 1\n";
  Write("loops.txt", "0 0.5" + pose + "0.5 0.875" + pose + "0.625 1.25" + pose + "0.5 7" + pose);
  const FrameNames names = SequenceFrames(Path("seq"), options_);
  EXPECT_EQ(names.stamps_s.size(), 12U);
  const SlamInput slam = ReadSlamFiles({Path("slam.txt"), "", Path("loops.txt")}, names);
  EXPECT_THAT(slam.notes, Contains("2 loop closures with an end outside the part, left out"));
  EXPECT_THAT(slam.warnings, ElementsAre(HasSubstr("1 event of frames that the recording does")));
  const Sequence part = OpenSequence(Path("seq"), options_, slam.slam);
  std::vector<LoopClosure> loops;
  for (const Frame& frame : ReadAll(*part.source)) {
    loops.insert(loops.end(), frame.loops.begin(), frame.loops.end());
  }
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].first_frame, 4);
  EXPECT_EQ(loops[0].second_frame, 7);
  EXPECT_THAT(part.source->Warnings(), IsEmpty());
}

// Whoever gives the poses need not leave them out.
TEST_F(PartOfASequence, LoopsThatLeaveItAreNotGiven) {
  SlamOutput slam = SlamOutputOf(poses_);
  for (const auto& [first, second] : {std::pair(0, 5), std::pair(4, 6), std::pair(5, 9)}) {
    LoopClosure loop;
    loop.first_frame = first;
    loop.second_frame = loop.reported_at_frame = second;
    slam.loops.push_back(loop);
  }
  std::vector<LoopClosure> given;
  for (const Frame& frame : ReadAll(*OpenSequence(Path("seq"), options_, slam).source)) {
    given.insert(given.end(), frame.loops.begin(), frame.loops.end());
  }
  ASSERT_EQ(given.size(), 1U);
  EXPECT_EQ(given[0].first_frame, 4);
}

// A matrix a frame of the recording, or of the part if SLAM was given no more.
TEST_F(PartOfASequence, MatricesPairWithEither) {
  const FrameNames names = SequenceFrames(Path("seq"), options_);
  std::string text;
  for (const int count : {4, 12}) {
    text.clear();
    for (int i = 0; i < count; ++i) text += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", i);
    std::vector<std::string> warnings;
    const Trajectory poses = ParsePoses(text, "x", names, warnings).poses;
    EXPECT_THAT(warnings, IsEmpty());
    ASSERT_EQ(poses.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(poses[0].stamp_s, count == 4 ? 0.5 : 0.0);
  }
}

TEST_F(PartOfASequence, HardlyAnyPosesAreSaidOfThePart) {
  const FrameNames names = SequenceFrames(Path("seq"), options_);
  poses_.resize(5);  // all of the frames before, one of it
  WriteTrajectory(Path("slam.txt"), poses_);
  EXPECT_THAT(ReadSlamFiles({Path("slam.txt"), "", ""}, names).warnings,
              ElementsAre(HasSubstr("slam.txt: gives 1 of 4 frames a pose: images from 0.000")));
  poses_.erase(poses_.begin(), poses_.end() - 1);
  options_.part = {0.5, 0.6};
  EXPECT_THAT(
      ReadSlamFiles({Path("slam.txt"), "", ""}, SequenceFrames(Path("seq"), options_)).warnings,
      IsEmpty());
}

// A second apart, the first of them ten seconds after 1970.
std::string ScanText(int number, double x_m) {
  return fmt::format("FLASER 2 1 1.5 {0} 0 0 {0} 0 0 {1} h 1\n", x_m, 10 + number);
}

TEST(PartOfALog, ScansKeepTheirNumbersAndEpochs) {
  const TextFile file(ScanText(0, 0) + ScanText(1, 90) + ScanText(2, 90.1) + ScanText(3, 90.2) +
                      ScanText(4, 90.3));
  const std::vector<Frame> all = ReadAll(*OpenCarmenLog(file.path()));
  const CarmenLog log =
      OpenCarmenLog(file.path(), {}, {{3, 2, 3, {}}, {3, 0, 3, {}}, {4, 2, 3, {}}}, {2.0, 4.0});
  EXPECT_EQ(log.source->FrameCount(), 2);
  EXPECT_EQ(PartShown(log.names), "frames 2 to 3 of 5, 2.000 to 3.000 s of 4.000");
  const std::vector<Frame> frames = ReadAll(*log.source);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(frames[i].index, static_cast<int>(i) + 2);
    EXPECT_EQ(frames[i].slam_epoch, 1);
    EXPECT_EQ(frames[i].slam_from_camera, all[i + 2].slam_from_camera);
    EXPECT_EQ(frames[i].scan->beams, all[i + 2].scan->beams);
  }
  EXPECT_TRUE(frames[0].loops.empty());
  ASSERT_EQ(frames[1].loops.size(), 1U);
  EXPECT_EQ(frames[1].loops[0].first_frame, 2);
}

TEST(PartOfALog, WarningsAreOfThePart) {
  const std::string damaged = "FLASER 2 1 x\n";
  const TextFile file(damaged + ScanText(0, 0) + damaged + ScanText(1, 900) + ScanText(2, 900) +
                      damaged + ScanText(3, 900) + ScanText(1, 900) + ScanText(0, 900) +
                      ScanText(4, 1800) + damaged + damaged);
  const auto warnings = [&](const PartOptions& part) {
    return OpenCarmenLog(file.path(), {}, {}, part).source->Warnings();
  };
  EXPECT_THAT(warnings({}), Contains(HasSubstr(":1: FLASER with damaged readings: number 2 of 2 is "
                                               "'x', must be a number (5 such lines)")));
  const auto angles = HasSubstr(":5: FLASER with 2 readings states no angles");
  EXPECT_THAT(warnings({2.0, 4.0}), ElementsAre(HasSubstr(":6: FLASER with damaged readings"),
                                                HasSubstr(":8: a scan"), angles));
  EXPECT_THAT(warnings({3.0, 4.0}), Contains(HasSubstr("2 of 3 scans are earlier than one")));
  EXPECT_THAT(warnings({2.0, 3.0}),
              ElementsAre(HasSubstr(":6: FLASER with damaged readings"), angles));
  EXPECT_THAT(RefusalOf([&] {
                warnings({7.0, 0.0});
              }),
              HasSubstr("sequence.from_s: is 7, must be at most 4.000: " + file.path() +
                        " is 4.000 s long"));
}

}  // namespace
}  // namespace depthgrid
