#include "mapper/io/icl_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/io/png.h"
#include "mapper/io/sequence.h"
#include "tests/io/open_as_written.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

constexpr double kWallZ = 3.0;    // a wall ahead of the first camera
constexpr double kFloorY = -1.0;  // and a floor below, in ICL's world: y up

// A small camera in ICL's convention: fy negative, so that rows grow against the world's y.
class IclFolderTest : public TemporaryFolderTest {
 protected:
  std::unique_ptr<FrameSource> Open() const { return OpenAsWritten(folder_, SequenceFormat::kIcl); }
  static constexpr int kWidth = 32, kHeight = 24;
  static constexpr double kF = 24.0, kCx = 15.5, kCy = 11.5;

  void WriteCamera(double fy) const {
    Write("camera.yaml", fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\n",
                                     kWidth, kHeight, kF, fy, kCx, kCy));
  }
  // The camera at (x, y, 0), pitched down by the angle about ICL's x axis.
  static Eigen::Matrix3d RotationOf(double pitch_rad) {
    return Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  }
  // Ray lengths or z of the wall and the floor, by ICL's own projection with fy = -kF.
  static std::vector<double> Depths(const Eigen::Vector3d& position, double pitch_rad,
                                    bool ray_length) {
    std::vector<double> depths;
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const Eigen::Vector3d ray((u - kCx) / kF, (v - kCy) / -kF, 1.0);
        const Eigen::Vector3d direction = RotationOf(pitch_rad) * ray;
        double z = (kWallZ - position.z()) / direction.z();
        if (direction.y() < 0.0) z = std::min(z, (kFloorY - position.y()) / direction.y());
        depths.push_back(ray_length ? z * ray.norm() : z);
      }
    }
    return depths;
  }
  void WritePng(int number, const Eigen::Vector3d& position, double pitch_rad) const {
    std::filesystem::create_directories(Path("depth"));
    DepthImage image(kWidth, kHeight);
    const auto depths = Depths(position, pitch_rad, false);
    std::transform(depths.begin(), depths.end(), image.z_m.begin(),
                   [](double z) { return static_cast<float>(z); });
    WriteDepthPng(Path(fmt::format("depth/{}.png", number)), image);
  }
  void WriteRays(int number, const Eigen::Vector3d& position, double pitch_rad,
                 double scale) const {
    std::string text;
    for (const double d : Depths(position, pitch_rad, true)) text += fmt::format("{} ", d * scale);
    Write(fmt::format("scene_00_{:04}.depth", number), text);
  }
  // Largest distance of the frames' points from the wall and the floor, in the world after FlipY.
  static double WorstResidual(FrameSource& source) {
    double worst_m = 0.0;
    int points = 0;
    while (const auto frame = source.Next()) {
      if (!frame->slam_from_camera || !frame->depth) continue;
      for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
          const Eigen::Vector3d point =
              *frame->slam_from_camera * Unproject(*source.Camera(), u, v, frame->depth->At(u, v));
          // FlipY turns the floor at y = -1 into y = +1.
          worst_m = std::max(worst_m,
                             std::min(std::abs(point.z() - kWallZ), std::abs(point.y() + kFloorY)));
          ++points;
        }
      }
    }
    EXPECT_GT(points, kWidth * kHeight);
    return worst_m;
  }
  std::string Freiburg(int id, const Eigen::Vector3d& p, double pitch_rad) const {
    const Eigen::Quaterniond q(RotationOf(pitch_rad));
    return fmt::format("{} {} {} {} {} {} {} {}\n", id, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                       q.w());
  }
  std::string Sim(const Eigen::Vector3d& p, double pitch_rad) const {
    const Eigen::Matrix3d r = RotationOf(pitch_rad);
    std::string text;
    for (int i = 0; i < 3; ++i) {
      text += fmt::format("{} {} {} {}\n", r(i, 0), r(i, 1), r(i, 2), p[i]);
    }
    return text + "\n";
  }
};

const Eigen::Vector3d kFirst(0, 0.1, 0), kSecond(0.3, 0.25, 0.5);
constexpr double kFirstPitch = 0.1, kSecondPitch = 0.35;

TEST_F(IclFolderTest, PngAndFreiburgPosesFallOnTheWalls) {
  WriteCamera(-kF);
  WritePng(0, kFirst, 0.0);  // has no truth
  WritePng(1, kFirst, kFirstPitch);
  WritePng(2, kSecond, kSecondPitch);
  Write("livingRoom0.gt.freiburg",
        Freiburg(1, kFirst, kFirstPitch) + Freiburg(2, kSecond, kSecondPitch));
  ASSERT_TRUE(IsIclFolder(folder_));
  const auto source = Open();
  EXPECT_EQ(source->FrameCount(), 3);
  EXPECT_LT(WorstResidual(*source), 0.001);
  EXPECT_THAT(source->Warnings(), testing::ElementsAre(HasSubstr("1 of 3 frames has no pose")));
}

// As the commands read it: its world has y up, the map's z.
TEST_F(IclFolderTest, AsASequenceItIsLevelWithTheFloorBelow) {
  WriteCamera(-kF);
  WritePng(1, kFirst, kFirstPitch);
  WritePng(2, kSecond, kSecondPitch);
  Write("livingRoom0.gt.freiburg",
        Freiburg(1, kFirst, kFirstPitch) + Freiburg(2, kSecond, kSecondPitch));
  for (const bool own_camera : {true, false}) {
    SequenceOptions options;
    if (!own_camera) {
      std::filesystem::rename(Path("camera.yaml"), Path("other.yaml"));
      options.camera = Path("other.yaml");
    }
    const Sequence sequence = OpenSequence(folder_, options);
    EXPECT_EQ(sequence.kind, "ICL-NUIM folder");
    EXPECT_EQ(sequence.source->FrameCount(), 2);
    double worst_m = 0.0;
    int points = 0;
    while (const auto frame = sequence.source->Next()) {
      for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u, ++points) {
          const Eigen::Vector3d point =
              *frame->slam_from_camera *
              Unproject(*sequence.source->Camera(), u, v, frame->depth->At(u, v));
          worst_m = std::max(worst_m,
                             std::min(std::abs(point.y() - kWallZ), std::abs(point.z() - kFloorY)));
        }
      }
    }
    EXPECT_EQ(points, 2 * kWidth * kHeight);
    EXPECT_LT(worst_m, 0.001);
  }
}

TEST_F(IclFolderTest, OfACameraOfSeveralSizesThatOfTheImagesIsTaken) {
  std::string listing;
  for (const int times : {2, 1}) {
    listing += fmt::format(
        "Intrinsic of \"Depth\" / {0}x{1} / {{Z16}}\nWidth: {0}\nHeight: {1}\nPPX: 7\nPPY: 6\n"
        "Fx: 30\nFy: 31\nDistortion: None\nCoeffs: 0 0 0 0 0\n\n",
        times * kWidth, times * kHeight);
  }
  Write("listing.txt", listing);
  Write("a.gt.freiburg", Freiburg(1, kFirst, 0.0));
  SequenceOptions options;
  options.camera = Path("listing.txt");
  WriteRays(1, kFirst, 0.0, 1.0);
  const auto error = [&] { return Short(RefusalOf([&] { OpenSequence(folder_, options); })); };
  EXPECT_EQ(error(),
            "~/listing.txt: lists the depth stream at 2 sizes, must list it at one: ~ has no "
            "readable PNG image that tells which");
  WritePng(1, kFirst, 0.0);
  const PinholeCamera camera = *OpenSequence(folder_, options).source->Camera();
  EXPECT_EQ(camera, (PinholeCamera{kWidth, kHeight, 30.0, 31.0, 7.0, 6.0, {}}));
}

// The counter-example: the same folder read with the other sign of fy does not fall together.
TEST_F(IclFolderTest, TheWrongSignOfFyIsVisiblyWrong) {
  WriteCamera(kF);
  WritePng(1, kFirst, kFirstPitch);
  WritePng(2, kSecond, kSecondPitch);
  Write("livingRoom0.gt.freiburg",
        Freiburg(1, kFirst, kFirstPitch) + Freiburg(2, kSecond, kSecondPitch));
  EXPECT_GT(WorstResidual(*Open()), 0.3);
}

TEST_F(IclFolderTest, RayLengthsInMetresAndCentimetresWithSimPoses) {
  WriteCamera(-kF);
  Write("livingRoom0n.gt.sim", Sim(kFirst, kFirstPitch) + Sim(kSecond, kSecondPitch));
  for (const double scale : {1.0, 100.0}) {
    WriteRays(0, kFirst, kFirstPitch, scale);
    WriteRays(1, kSecond, kSecondPitch, scale);
    ASSERT_TRUE(IsIclFolder(folder_));
    EXPECT_LT(WorstResidual(*Open()), 0.001) << scale;
  }
  // Taken for z, the ray lengths bend the wall.
  const auto lengths = Depths(kFirst, 0.0, true);
  const auto depths = Depths(kFirst, 0.0, false);
  EXPECT_GT(lengths.front() - depths.front(), 0.3);
}

// A wall nearer than half a metre, or an image that is mostly empty, says nothing of the unit.
TEST_F(IclFolderTest, TheFirstImageTellsTheUnitOfAllRays) {
  WriteCamera(-kF);
  Write("a.gt.sim", Sim(kFirst, 0.0) + Sim(kFirst, 0.0) + Sim(kFirst, 0.0));
  const std::size_t pixels = Depths(kFirst, 0.0, true).size();
  const auto constant = [&](const std::string& length) {
    std::string text;
    for (std::size_t i = 0; i < pixels; ++i) text += length + " ";
    return text;
  };
  Write("scene_00_0000.depth", constant("nan"));
  WriteRays(1, kFirst, 0.0, 100.0);
  Write("scene_00_0002.depth", constant("40"));
  const auto source = Open();
  source->Next();
  source->Next();
  const std::optional<Frame> near = source->Next();
  ASSERT_TRUE(near && near->depth);
  const auto [least, most] = std::minmax_element(near->depth->z_m.begin(), near->depth->z_m.end());
  EXPECT_GT(*least, 0.2F);
  EXPECT_LE(*most, 0.4F);
}

TEST_F(IclFolderTest, SimPosesMayLackTheFirstFrame) {
  WriteCamera(-kF);
  WriteRays(0, kFirst, 0.0, 1.0);
  WriteRays(1, kFirst, kFirstPitch, 1.0);
  WriteRays(2, kSecond, kSecondPitch, 1.0);
  Write("a.gt.sim", Sim(kFirst, kFirstPitch) + Sim(kSecond, kSecondPitch));
  EXPECT_LT(WorstResidual(*Open()), 0.001);
}

TEST_F(IclFolderTest, WithoutACameraFileItIsIclNuims) {
  std::vector<std::string> warnings;
  const CameraDescription camera = IclCamera(folder_, warnings);
  EXPECT_TRUE(camera.y_up);
  EXPECT_EQ(camera.file.camera, PinholeCamera{});
}

TEST_F(IclFolderTest, OneClearLineForEachFault) {
  const auto error = [&] { return Short(RefusalOf([&] { Open(); })); };
  EXPECT_FALSE(IsIclFolder(folder_));
  EXPECT_EQ(error(), "~: holds neither depth/<n>.png nor *_<n>.depth");
  WriteCamera(-kF);
  Write("scene_00_0000.depth", "1 2 3\n");
  EXPECT_EQ(error(), "~: holds no poses (*.gt.freiburg or *.gt.sim)");
  Write("a.gt.sim", Sim(kFirst, 0.0));
  EXPECT_EQ(error(), "~/scene_00_0000.depth: holds 3 ray lengths, must hold 768 (32x24)");
  Write("scene_00_0000.depth", "1 2\nx\n");
  EXPECT_EQ(error(), "~/scene_00_0000.depth:2: 'x' is not a number");
  Write("scene_00_0001.depth", "1");
  Write("scene_00_0002.depth", "1");
  EXPECT_EQ(error(), "~/a.gt.sim: holds 1 pose for 3 images");
}

}  // namespace
}  // namespace depthgrid
