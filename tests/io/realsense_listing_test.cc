#include "mapper/io/realsense_listing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/refusal.h"

namespace depthgrid {
namespace {

std::string BlockOf(const std::string& stream, const std::string& size, double f_px,
                    const std::string& model = "Brown Conrady",
                    const std::string& coeffs = "0  \t0  \t0  \t0  \t0") {
  const std::size_t x = size.find('x');
  const std::string width = size.substr(0, x), height = size.substr(x + 1);
  return fmt::format(
      " Intrinsic of \"{}\" / {} / {{Z16}}\n  Width:      \t{}\n  Height:     \t{}\n"
      "  PPX:        \t{}.25\n  PPY:        \t{}.75\n  Fx:         \t{}\n  Fy:         \t{}\n"
      "  Distortion: \t{}\n  Coeffs:     \t{}  \n  FOV (deg):  \t79.58 x 63.98\n\n",
      stream, size, width, height, std::stoi(width) / 2, std::stoi(height) / 2, f_px, f_px + 1.0,
      model, coeffs);
}

// As the tool prints it: modes before, other streams, motion and extrinsics after.
std::string Listing(const std::string& blocks) {
  return "Device info: \n    Name                          : \tIntel RealSense D435\n\n"
         "Stream Profiles supported by Stereo Module\n Supported modes:\n"
         "    STREAM      RESOLUTION  FPS       FORMAT\n    Depth       640x480     @ 30Hz    "
         "Z16\n\n"
         "Intrinsic Parameters:\n\n" +
         blocks +
         "Motion Intrinsic Parameters:\n\nMotion Intrinsic of \"Gyro\"\t  MOTION_XYZ32F\n"
         "Bias Variances: \t0  0  0\n\nExtrinsic Parameters:\n"
         "Extrinsic from \"Depth\"\t  To\t  \"Color\" :\n Rotation Matrix:\n   1  0  0\n";
}

CameraDescription Listed(const std::string& text) { return ParseCameraDescription(text, "c"); }
std::string ListingRefusal(const std::string& text) {
  return RefusalOf([&] { Listed(text); });
}

const PinholeCamera kVga{640, 480, 384.5, 385.5, 320.25, 240.75, {}};

TEST(RealSenseListing, OneDepthBlockIsTheCamera) {
  const std::string windows =
      "\xEF\xBB\xBF Intrinsic of \"Depth\" / 640x480 / {Z16}\r\n"
      "  Width: 640\r\n  Height: 480\r\n  PPX: 320.25\r\n  PPY: 240.75\r\n"
      "  Fx: 384.5\r\n  Fy: 385.5\r\n  Distortion: None\r\n"
      "  Coeffs: 0 0 0 0 0\r\n";
  for (const std::string& text :
       {BlockOf("Depth", "640x480", 384.5), Listing(BlockOf("Depth", "640x480", 384.5)), windows}) {
    const CameraDescription camera = Listed(text);
    EXPECT_EQ(camera.kind, "RealSense listing");
    EXPECT_TRUE(camera.has_size);
    EXPECT_TRUE(camera.sizes.empty());
    EXPECT_FALSE(camera.has_depth_scale);
    EXPECT_EQ(camera.file.camera, kVga);
    EXPECT_EQ(camera.taken, "");
  }
  const auto distorted =
      Listed(BlockOf("Depth", "640x480", 384.5, "Brown Conrady", "0.1\t-0.2\t0.001\t0.002\t0"));
  EXPECT_EQ(distorted.file.camera.distortion[1], -0.2);
}

TEST(RealSenseListing, OfSeveralSizesThatOfTheImagesIsTaken) {
  const std::string text = Listing(
      BlockOf("Depth", "848x480", 424.0) +
      " Intrinsic of \"Depth\" / 256x144 / {Z16}\n"
      "Intrinsic NOT available!\n\n" +
      BlockOf("Depth", "640x480", 384.5) + BlockOf("Infrared 1", "640x480", 384.5) +
      BlockOf("Color", "640x480", 615.0, "Inverse Brown Conrady", "0.1\t-0.2\t0.001\t0.002\t0"));
  CameraDescription camera = Listed(text);
  EXPECT_FALSE(camera.has_size);
  ASSERT_EQ(camera.sizes.size(), 2u);
  EXPECT_NE(camera.taken, "");
  camera.path = "listing.txt";
  CameraDescription other = camera;
  TakeSize(640, 480, "a.png", camera);
  EXPECT_EQ(camera.file.camera, kVga);
  EXPECT_EQ(RefusalOf([&] { TakeSize(480, 640, "a.png", other); }),
            "listing.txt: lists the depth stream at 848x480, 640x480, must list it at 480x640, the "
            "size of a.png");
}

TEST(RealSenseListing, OneClearLineForEachFault) {
  const std::string block = BlockOf("Depth", "640x480", 384.5);
  const auto with = [&](const std::string& a, const std::string& b) {
    std::string text = block;
    text.replace(text.find(a), a.size(), b);
    return ListingRefusal(text);
  };
  EXPECT_EQ(ListingRefusal(block), "no error");
  EXPECT_EQ(with("  Fy:         \t385.5\n", ""),
            "c:1: \"Depth\" at 640x480 has no Fy, must be followed by its Width, Height, PPX, PPY, "
            "Fx, Fy, Distortion and Coeffs");
  EXPECT_EQ(ListingRefusal(block.substr(0, block.find("  Coeffs"))),
            "c:1: \"Depth\" at 640x480 has no Coeffs, must be followed by its Width, Height, PPX, "
            "PPY, Fx, Fy, Distortion and Coeffs");
  EXPECT_EQ(with("384.5", "x"), "c:6: 'Fx' holds x, must be a list of numbers");
  EXPECT_EQ(with("384.5", "384 5"), "c:6: Fx has 2 values, must have 1");
  EXPECT_EQ(with("384.5", "0"), "c:1: fx is 0, must be positive");
  EXPECT_EQ(with("\t640", "\t640.5"), "c:2: 'Width' is 640.5, must be a whole number of pixels");
  EXPECT_EQ(with("\t640", "\t848"),
            "c:1: is titled \"Depth\" at 640x480, must be 848x480 by its Width and Height");
  EXPECT_EQ(with("0  \t0", ""), "c:9: Coeffs has 3 values, must have 5");
  EXPECT_EQ(with("0  \t0", "0.1 \t0"), "no error");
  EXPECT_EQ(with("  Fy:", "  Fx:"),
            "c:7: Fx is given twice for \"Depth\" at 640x480, must be once");
  EXPECT_EQ(with("Brown Conrady", ""), "c:8: Distortion is missing, must be brown_conrady");
  EXPECT_EQ(ListingRefusal(
                BlockOf("Depth", "640x480", 384.5, "Inverse Brown Conrady", "0.1\t0\t0\t0\t0")),
            "c:8: Distortion is Inverse Brown Conrady, must be brown_conrady, or all coeffs 0");
}

TEST(RealSenseListing, TellsWhichStreamToGive) {
  const std::string vga = BlockOf("Depth", "640x480", 384.5);
  EXPECT_EQ(
      ListingRefusal(vga + BlockOf("Depth", "640x480", 380.5)),
      "c:12: \"Depth\" at 640x480 is given again after line 1, must be once: keep that of the "
      "images' camera and format");
  EXPECT_EQ(ListingRefusal(BlockOf("Color", "640x480", 615.0)),
            "c: has intrinsics of \"Color\", must have those of \"Depth\"; of depth images that "
            "were aligned to another stream, give its numbers as one line: Fx Fy PPX PPY Width "
            "Height");
  const std::string whole = Listing("");
  EXPECT_EQ(ListingRefusal(whole.substr(0, whole.find("Intrinsic"))),
            "c: lists no intrinsics, must be what rs-enumerate-devices -c prints (with -c)");
}

}  // namespace
}  // namespace depthgrid
