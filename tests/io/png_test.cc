#include "mapper/io/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/png_codec.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

DepthImage Ramp() {
  DepthImage image(37, 23);
  for (std::size_t i = 0; i < image.z_m.size(); ++i) {
    image.z_m[i] = static_cast<float>(i) * 0.01234F;  // first pixel invalid, 10.5 m at the end
  }
  return image;
}

std::string DepthPngRefusal(std::string_view png) {
  return RefusalOf([&] { DecodeDepthPng(png, {}, "d.png"); });
}

TEST(DepthPng, ReadsBackExactlyTheQuantisedImage) {
  const DepthImage image = Ramp();
  for (const double scale : {5000.0, 1000.0, 1234.5}) {
    const DepthPngFormat format{scale, {}};
    const DepthImage quantised = QuantiseDepth(image, format);
    EXPECT_EQ(DecodeDepthPng(EncodeDepthPng(image, scale), format, "x").z_m, quantised.z_m);
    EXPECT_EQ(DecodeDepthPng(EncodeDepthPng(quantised, scale), format, "x").z_m, quantised.z_m);
    for (std::size_t i = 0; i < image.z_m.size(); ++i) {
      EXPECT_NEAR(quantised.z_m[i], image.z_m[i], 0.5 / scale + 1e-6);
    }
  }
}

TEST(DepthPng, KeepsTooNearTooFarAndInvalidApart) {
  EXPECT_EQ(DepthUnits(0.0F, 5000.0), 0);
  EXPECT_EQ(DepthUnits(-1.0F, 5000.0), 0);
  EXPECT_EQ(DepthUnits(std::numeric_limits<float>::quiet_NaN(), 5000.0), 0);
  EXPECT_EQ(DepthUnits(1e-6F, 5000.0), 1);
  EXPECT_EQ(DepthUnits(1.0F, 5000.0), 5000);
  EXPECT_EQ(DepthUnits(20.0F, 5000.0), 65534);
  EXPECT_EQ(DepthUnits(std::numeric_limits<float>::infinity(), 5000.0), 65534);
  DepthImage image(4, 1);
  image.z_m = {kInvalidDepth, 0.007F, 100.0F, 1.5F};
  EXPECT_EQ(QuantiseDepth(image, {1000.0, {65534, 7}}).z_m,
            (std::vector<float>{kInvalidDepth, kInvalidDepth, kInvalidDepth, 1.5F}));
}

TEST(DepthPng, SameBytesEachTime) {
  EXPECT_EQ(EncodeDepthPng(Ramp(), 5000.0), EncodeDepthPng(Ramp(), 5000.0));
}

TEST(DepthPng, EveryTruncationIsOneError) {
  const std::string png = EncodeDepthPng(Ramp(), 5000.0);
  int errors = 0;
  for (std::size_t size = 0; size < png.size(); ++size) {
    const std::string error = DepthPngRefusal(std::string_view(png).substr(0, size));
    EXPECT_THAT(error, HasSubstr("d.png: is "));
    EXPECT_EQ(error.find('\n'), std::string::npos);
    ++errors;
  }
  EXPECT_EQ(errors, static_cast<int>(png.size()));
  EXPECT_EQ(DepthPngRefusal(""), "d.png: is empty, must be a PNG image");
  EXPECT_EQ(DepthPngRefusal("P5 1 1 255\n"), "d.png: is not a PNG image");
}

TEST(DepthPng, DamagedBytesNeverCrash) {
  const std::string png = EncodeDepthPng(Ramp(), 5000.0);
  RandomStream random(1, RandomStage::kTest);
  int refused = 0;
  constexpr int kCases = 2000;
  for (int i = 0; i < kCases; ++i) {
    std::string damaged = png;
    damaged[random.Below(png.size())] ^= static_cast<char>(1U << random.Below(8));
    refused += DepthPngRefusal(damaged) != "no error" ? 1 : 0;
  }
  EXPECT_GE(refused, kCases * 9 / 10);  // the rest: bits of ancillary fields that nothing reads
}

std::string GreyPng(int width_px, int height_px, const std::vector<std::uint8_t>& grey) {
  return internal::EncodePng({internal::PngKind::kGrey8, width_px, height_px, grey});
}

TEST(DepthPng, RefusesOtherKinds) {
  EXPECT_EQ(DepthPngRefusal(GreyPng(2, 1, {1, 2})),
            "d.png: is a PNG of 8-bit grey, must be 16-bit grey");
  RgbImage rgb(2, 1);
  EXPECT_EQ(DepthPngRefusal(EncodeRgbPng(rgb)),
            "d.png: is a PNG of 8-bit colour, must be 16-bit grey");
}

TEST(ColourPng, RoundTrip) {
  RgbImage rgb(5, 3);
  for (std::size_t i = 0; i < rgb.rgb.size(); ++i) rgb.rgb[i] = static_cast<std::uint8_t>(17 * i);
  EXPECT_EQ(DecodeRgbPng(EncodeRgbPng(rgb), "x"), rgb);
  const std::string grey = GreyPng(3, 2, {0, 1, 2, 253, 254, 255});
  const RgbImage converted = DecodeRgbPng(grey, "x");
  EXPECT_EQ(converted.At(2, 1)[1], 255);
  const RgbaImage rgba = DecodeRgbaPng(grey, "x");
  EXPECT_THAT(std::vector<int>(rgba.rgba.begin(), rgba.rgba.begin() + 8),
              testing::ElementsAre(0, 0, 0, 255, 1, 1, 1, 255));
}

TEST(DepthPng, Files) {
  const std::string path = ScratchPath() + ".png";
  WriteDepthPng(path, Ramp());
  EXPECT_EQ(ReadDepthPng(path).z_m, QuantiseDepth(Ramp()).z_m);
  std::filesystem::remove(path);
  EXPECT_THROW(ReadDepthPng(path), InputError);
}

}  // namespace
}  // namespace depthgrid
