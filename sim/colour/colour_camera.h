// The colour camera: what a person, or a visual SLAM system, would see of a scene.
#pragma once

#include <memory>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"
#include "mapper/core/rgb_image.h"
#include "sim/scene/mover_scene.h"
#include "sim/scene/scene.h"

namespace depthgrid {

struct ColourFrame {
  RgbImage rgb;      // sRGB, antialiased with four samples per pixel
  DepthImage depth;  // z through each pixel's centre; kInvalidDepth where there is no surface
};

// Draws with OSMesa, Mesa's software renderer: no display or graphics card needed. Each camera owns
// its context; use one camera per thread. Surfaces nearer than 1 cm are not drawn.
class ColourCamera {
 public:
  // Keeps a copy of what it draws; the scene need not outlive it. Throws InputError for a camera
  // with distortion (rendering is pinhole) or of a size that cannot be drawn.
  ColourCamera(const Scene& scene, const PinholeCamera& camera);
  ColourCamera(ColourCamera&&) noexcept;
  ColourCamera& operator=(ColourCamera&&) noexcept;
  ~ColourCamera();

  // Draws the static scene and the given movers.
  ColourFrame Render(const Pose3& world_from_camera, const std::vector<MoverPlace>& movers = {});

 private:
  struct Renderer;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace depthgrid
