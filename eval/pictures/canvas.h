// Draws into an image, for maps with trajectories and the report's pictures.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mapper/core/rgb_image.h"

namespace depthgrid {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Colour&) const = default;
};

inline void SetPixel(RgbImage& image, int u_px, int v_px, Colour colour) {
  std::uint8_t* const pixel = image.At(u_px, v_px);
  pixel[0] = colour.red;
  pixel[1] = colour.green;
  pixel[2] = colour.blue;
}

// Coordinates are pixels, (0, 0) the centre of the top left one. Parts outside are clipped.
class Canvas {
 public:
  Canvas(int width_px, int height_px, Colour background);
  explicit Canvas(RgbImage image) : image_(std::move(image)) {}

  void Fill(int left_px, int top_px, int width_px, int height_px, Colour colour);
  // Round-ended and anti-aliased.
  void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px, Colour colour);
  void Polyline(const std::vector<Eigen::Vector2d>& points, double width_px, Colour colour);
  void Disc(const Eigen::Vector2d& centre, double radius_px, Colour colour);
  // Printable ASCII in a 5x7 font, each of its pixels `scale` wide; others are drawn as '?'.
  void Text(int left_px, int top_px, std::string_view text, int scale, Colour colour);
  static int TextWidth(std::string_view text, int scale);
  static int TextHeight(int scale);

  const RgbImage& image() const { return image_; }

 private:
  void Blend(int u_px, int v_px, Colour colour, double alpha);

  RgbImage image_;
};

}  // namespace depthgrid
