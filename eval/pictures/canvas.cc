#include "eval/pictures/canvas.h"

#include <algorithm>
#include <cmath>

#include "eval/pictures/bitmap_font.h"

namespace depthgrid {
namespace {

constexpr int kGlyphGapPx = 1;

// Distance from a point to the segment.
double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length_squared = along.squaredNorm();
  const double t =
      length_squared > 0.0 ? std::clamp((point - from).dot(along) / length_squared, 0.0, 1.0) : 0.0;
  return (point - from - t * along).norm();
}

std::uint8_t Mix(std::uint8_t below, std::uint8_t above, double alpha) {
  return static_cast<std::uint8_t>(std::lround(below + alpha * (above - below)));
}

}  // namespace

Canvas::Canvas(int width_px, int height_px, Colour background) : image_(width_px, height_px) {
  Fill(0, 0, width_px, height_px, background);
}

void Canvas::Blend(int u_px, int v_px, Colour colour, double alpha) {
  if (u_px < 0 || v_px < 0 || u_px >= image_.width_px || v_px >= image_.height_px) return;
  std::uint8_t* pixel = image_.At(u_px, v_px);
  pixel[0] = Mix(pixel[0], colour.red, alpha);
  pixel[1] = Mix(pixel[1], colour.green, alpha);
  pixel[2] = Mix(pixel[2], colour.blue, alpha);
}

void Canvas::Fill(int left_px, int top_px, int width_px, int height_px, Colour colour) {
  for (int v = std::max(top_px, 0); v < std::min(top_px + height_px, image_.height_px); ++v) {
    for (int u = std::max(left_px, 0); u < std::min(left_px + width_px, image_.width_px); ++u) {
      Blend(u, v, colour, 1.0);
    }
  }
}

void Canvas::Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px,
                  Colour colour) {
  if (!from.allFinite() || !to.allFinite()) return;
  const double radius = 0.5 * width_px;
  const double reach = radius + 1.0;
  const auto first = [&](double a, double b) { return std::floor(std::min(a, b) - reach); };
  const auto last = [&](double a, double b) { return std::ceil(std::max(a, b) + reach); };
  const auto within = [](double value, int size) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(size)));
  };
  const int u_end = within(last(from.x(), to.x()), image_.width_px);
  const int v_end = within(last(from.y(), to.y()), image_.height_px);
  for (int v = within(first(from.y(), to.y()), image_.height_px); v <= v_end; ++v) {
    for (int u = within(first(from.x(), to.x()), image_.width_px); u <= u_end; ++u) {
      const double distance = DistanceToSegment(Eigen::Vector2d(u, v), from, to);
      // Coverage of the pixel, to first order.
      const double alpha = std::clamp(radius + 0.5 - distance, 0.0, 1.0);
      if (alpha > 0.0) Blend(u, v, colour, alpha);
    }
  }
}

void Canvas::Polyline(const std::vector<Eigen::Vector2d>& points, double width_px, Colour colour) {
  for (std::size_t i = 1; i < points.size(); ++i) Line(points[i - 1], points[i], width_px, colour);
}

void Canvas::Disc(const Eigen::Vector2d& centre, double radius_px, Colour colour) {
  Line(centre, centre, 2.0 * radius_px, colour);
}

void Canvas::Text(int left_px, int top_px, std::string_view text, int scale, Colour colour) {
  int left = left_px;
  for (const char character : text) {
    const auto glyph = GlyphOf(character);
    for (int column = 0; column < kGlyphWidthPx; ++column) {
      for (int row = 0; row < kGlyphHeightPx; ++row) {
        if ((glyph[static_cast<std::size_t>(column)] >> row & 1) == 0) continue;
        Fill(left + column * scale, top_px + row * scale, scale, scale, colour);
      }
    }
    left += (kGlyphWidthPx + kGlyphGapPx) * scale;
  }
}

int Canvas::TextWidth(std::string_view text, int scale) {
  return static_cast<int>(text.size()) * (kGlyphWidthPx + kGlyphGapPx) * scale;
}

int Canvas::TextHeight(int scale) { return kGlyphHeightPx * scale; }

}  // namespace depthgrid
