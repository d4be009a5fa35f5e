#include "sim/colour/colour_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include "mapper/core/error.h"
#include "sim/colour/colour_shaders.h"
#include "sim/colour/gl_context.h"
#include "sim/colour/gl_functions_impl.h"
#include "sim/colour/shading_mesh.h"
#include "sim/depth/sensor_options.h"

namespace depthgrid {
namespace {

constexpr float kNearM = 0.01F;
constexpr int kSamples = 4;  // the maximum of llvmpipe
static_assert(kMaxImageSidePx <= 16384, "llvmpipe's limit");

// Uniform and storage locations of sim/colour/colour_shaders.cc, where array sizes are literals.
static_assert(kMaxLights == 32);
constexpr GLint kCameraFromWorld = 0;
constexpr GLint kClipFromCamera = 1;
constexpr GLint kEye = 2;
constexpr GLint kAmbient = 3;
constexpr GLint kLightCount = 4;
constexpr GLint kLightAt = 5;
constexpr GLint kLightIntensity = kLightAt + kMaxLights;
constexpr GLint kWorldFromMover = kLightIntensity + kMaxLights;
static_assert(kWorldFromMover == 69, "as the shaders have it");
constexpr GLuint kMaterialBinding = 0;

struct GpuMaterial {
  std::array<float, 4> colour;         // and scale_m
  std::array<float, 4> second_colour;  // and gloss
  std::array<float, 4> other;          // glow, grain axis
};

// Projection of pixel (u, v) to the centre of GL's pixel (u, v). Row 0 of the image is GL's row 0,
// so it is read back without flipping. Depth is near / z: reversed and without a far plane.
Eigen::Matrix4f ClipFromCamera(const PinholeCamera& camera) {
  const double width = camera.width_px;
  const double height = camera.height_px;
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 2.0 * camera.fx_px / width;
  clip(0, 2) = 2.0 * (camera.cx_px + 0.5) / width - 1.0;
  clip(1, 1) = 2.0 * camera.fy_px / height;
  clip(1, 2) = 2.0 * (camera.cy_px + 0.5) / height - 1.0;
  clip(2, 3) = kNearM;
  clip(3, 2) = 1.0;
  return clip.cast<float>();
}

Eigen::Matrix4f MatrixOf(const Pose3& a_from_b) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = a_from_b.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = a_from_b.translation;
  return matrix.cast<float>();
}

}  // namespace

// A framebuffer with one colour target and a 32-bit depth buffer. Not in an unnamed namespace, as
// it is a member of a type with external linkage.
class RenderTarget {
 public:
  RenderTarget(const PinholeCamera& camera, GLenum format, int samples) {
    Gl().GenFramebuffers(1, &framebuffer_);
    Gl().GenRenderbuffers(2, buffers_.data());
    Gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    const std::array<GLenum, 2> formats = {format, GL_DEPTH_COMPONENT32F};
    const std::array<GLenum, 2> places = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (std::size_t i = 0; i < 2; ++i) {
      Gl().BindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
      Gl().RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, formats[i], camera.width_px,
                                          camera.height_px);
      Gl().FramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, buffers_[i]);
    }
    if (Gl().CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw InputError("camera", fmt::format("images of {} x {} pixels cannot be drawn",
                                             camera.width_px, camera.height_px));
    }
  }
  GLuint framebuffer() const { return framebuffer_; }

  // Binds it for drawing; all pixels get this colour and infinite depth.
  void BindAndClear(const std::array<float, 4>& colour) const {
    constexpr float kInfinitelyFar = 0.0F;
    Gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    Gl().ClearBufferfv(GL_COLOR, 0, colour.data());
    Gl().ClearBufferfv(GL_DEPTH, 0, &kInfinitelyFar);
  }

 private:
  GLuint framebuffer_ = 0;
  std::array<GLuint, 2> buffers_{};
};

// Triangles in GL buffers, with a program for each of their textures. External linkage as above.
struct DrawnMesh {
  GLuint array = 0;
  GLsizei corner_count = 0;
  std::vector<TextureBatch> batches;
  std::vector<GLuint> colour_programs;  // one per batch
};

// GL objects are released with the context, which is the first member and so destroyed last.
struct ColourCamera::Renderer {
  Renderer(const Scene& scene, const PinholeCamera& pinhole)
      : camera(pinhole),
        depth_target(camera, GL_R32F, 0),
        sampled_target(camera, GL_RGBA8, kSamples),
        colour_target(camera, GL_RGBA8, 0),
        sky(SrgbFromLinear(scene.lighting.sky)) {
    context.UseZeroToOneDepth();
    Gl().Viewport(0, 0, camera.width_px, camera.height_px);
    Gl().Enable(GL_DEPTH_TEST);
    Gl().DepthFunc(GL_GREATER);
    Gl().PixelStorei(GL_PACK_ALIGNMENT, 1);
    UploadMaterials(scene);
    depth_program = NewProgram(DepthFragmentShader(), Drawn::kStanding);
    room = Upload(scene.mesh, Drawn::kStanding, scene);
    for (const Mover& mover : scene.movers) {
      movers.push_back(Upload(mover.mesh, Drawn::kMoving, scene));
    }
    if (!movers.empty()) {
      moving_depth_program = NewProgram(DepthFragmentShader(), Drawn::kMoving);
    }
    RequireNoGlError("setting up the colour camera");
  }

  // Compiles a program and sets the camera's projection.
  GLuint NewProgram(const std::string& fragment_shader, Drawn drawn) {
    const GLuint program = CompileProgram(VertexShader(drawn), fragment_shader);
    const Eigen::Matrix4f clip = ClipFromCamera(camera);
    Gl().ProgramUniformMatrix4fv(program, kClipFromCamera, 1, GL_FALSE, clip.data());
    programs.push_back(program);
    return program;
  }

  GLuint ColourProgram(TextureKind texture, Drawn drawn, const Lighting& lighting) {
    const auto [known, is_new] = colour_programs.try_emplace({drawn, texture}, 0);
    if (is_new) {
      known->second = NewProgram(ColourFragmentShader(texture, drawn), drawn);
      SetLights(known->second, lighting);
    }
    return known->second;
  }

  DrawnMesh Upload(const TriangleMesh& mesh, Drawn drawn, const Scene& scene) {
    const ShadingMesh shading = MakeShadingMesh(mesh, scene.materials);
    DrawnMesh uploaded;
    uploaded.array = UploadCorners(shading.corners);
    uploaded.corner_count = static_cast<GLsizei>(shading.corners.size());
    uploaded.batches = shading.batches;
    for (const TextureBatch& batch : shading.batches) {
      uploaded.colour_programs.push_back(ColourProgram(batch.texture, drawn, scene.lighting));
    }
    return uploaded;
  }

  static GLuint UploadCorners(const std::vector<ShadingCorner>& corners) {
    GLuint array = 0;
    GLuint buffer = 0;
    Gl().GenVertexArrays(1, &array);
    Gl().BindVertexArray(array);
    Gl().GenBuffers(1, &buffer);
    Gl().BindBuffer(GL_ARRAY_BUFFER, buffer);
    Gl().BufferData(GL_ARRAY_BUFFER,
                    static_cast<GLsizeiptr>(corners.size() * sizeof(ShadingCorner)), corners.data(),
                    GL_STATIC_DRAW);
    const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
    constexpr GLsizei kStride = sizeof(ShadingCorner);
    Gl().VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride,
                             offset(offsetof(ShadingCorner, position)));
    Gl().VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kStride,
                             offset(offsetof(ShadingCorner, normal)));
    Gl().VertexAttribIPointer(2, 1, GL_UNSIGNED_INT, kStride,
                              offset(offsetof(ShadingCorner, material)));
    for (GLuint i = 0; i < 3; ++i) Gl().EnableVertexAttribArray(i);
    return array;
  }

  void UploadMaterials(const Scene& scene) {
    std::vector<GpuMaterial> packed;
    for (const Material& m : scene.materials) {
      packed.push_back({{m.colour.x(), m.colour.y(), m.colour.z(), m.scale_m},
                        {m.second_colour.x(), m.second_colour.y(), m.second_colour.z(), m.gloss},
                        {m.glow, static_cast<float>(m.grain), 0.0F, 0.0F}});
    }
    GLuint buffer = 0;
    Gl().GenBuffers(1, &buffer);
    Gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, kMaterialBinding, buffer);
    Gl().BufferData(GL_SHADER_STORAGE_BUFFER,
                    static_cast<GLsizeiptr>(packed.size() * sizeof(GpuMaterial)), packed.data(),
                    GL_STATIC_DRAW);
  }

  static void SetLights(GLuint program, const Lighting& lighting) {
    Gl().ProgramUniform3fv(program, kAmbient, 1, lighting.ambient.data());
    const int count = std::min(static_cast<int>(lighting.lights.size()), kMaxLights);
    Gl().ProgramUniform1i(program, kLightCount, count);
    for (int i = 0; i < count; ++i) {
      const PointLight& light = lighting.lights[static_cast<std::size_t>(i)];
      Gl().ProgramUniform3fv(program, kLightAt + i, 1, light.at.data());
      Gl().ProgramUniform3fv(program, kLightIntensity + i, 1, light.intensity.data());
    }
  }

  void SetPose(const Pose3& world_from_camera) const {
    const Eigen::Matrix4f pose = MatrixOf(Inverse(world_from_camera));
    const Eigen::Vector3f eye = world_from_camera.translation.cast<float>();
    for (const GLuint program : programs) {
      Gl().ProgramUniformMatrix4fv(program, kCameraFromWorld, 1, GL_FALSE, pose.data());
    }
    for (const auto& [kind, program] : colour_programs) {
      Gl().ProgramUniform3fv(program, kEye, 1, eye.data());
    }
  }

  static void SetPlace(GLuint program, const MoverPlace& place) {
    const Eigen::Matrix4f pose = MatrixOf(place.world_from_mover);
    Gl().ProgramUniformMatrix4fv(program, kWorldFromMover, 1, GL_FALSE, pose.data());
  }

  DepthImage DrawDepth(const std::vector<MoverPlace>& places) const {
    depth_target.BindAndClear({kInvalidDepth, 0, 0, 0});
    DrawDepthOf(room, depth_program);
    for (const MoverPlace& place : places) {
      SetPlace(moving_depth_program, place);
      DrawDepthOf(movers[place.mover], moving_depth_program);
    }
    DepthImage depth(camera.width_px, camera.height_px);
    Gl().ReadPixels(0, 0, camera.width_px, camera.height_px, GL_RED, GL_FLOAT, depth.z_m.data());
    return depth;
  }

  static void DrawDepthOf(const DrawnMesh& mesh, GLuint program) {
    Gl().BindVertexArray(mesh.array);
    Gl().UseProgram(program);
    Gl().DrawArrays(GL_TRIANGLES, 0, mesh.corner_count);
  }

  RgbImage DrawColour(const std::vector<MoverPlace>& places) const {
    sampled_target.BindAndClear({sky.x(), sky.y(), sky.z(), 1.0F});
    DrawColourOf(room);
    for (const MoverPlace& place : places) {
      const DrawnMesh& mover = movers[place.mover];
      for (const GLuint program : mover.colour_programs) SetPlace(program, place);
      DrawColourOf(mover);
    }
    const int width = camera.width_px;
    const int height = camera.height_px;
    Gl().BindFramebuffer(GL_READ_FRAMEBUFFER, sampled_target.framebuffer());
    Gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, colour_target.framebuffer());
    Gl().BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    Gl().BindFramebuffer(GL_FRAMEBUFFER, colour_target.framebuffer());
    RgbImage image(width, height);
    Gl().ReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    return image;
  }

  static void DrawColourOf(const DrawnMesh& mesh) {
    Gl().BindVertexArray(mesh.array);
    for (std::size_t i = 0; i < mesh.batches.size(); ++i) {
      Gl().UseProgram(mesh.colour_programs[i]);
      Gl().DrawArrays(GL_TRIANGLES, mesh.batches[i].first_corner, mesh.batches[i].corner_count);
    }
  }

  GlContext context;
  PinholeCamera camera;
  RenderTarget depth_target;
  RenderTarget sampled_target;
  RenderTarget colour_target;
  Eigen::Vector3f sky;
  std::vector<GLuint> programs;  // all of them
  std::map<std::pair<Drawn, TextureKind>, GLuint> colour_programs;
  GLuint depth_program = 0;
  GLuint moving_depth_program = 0;
  DrawnMesh room;
  std::vector<DrawnMesh> movers;
};

ColourCamera::ColourCamera(const Scene& scene, const PinholeCamera& camera) {
  Validate(camera, "camera");
  if (camera.HasDistortion()) throw InputError("camera", "distortion cannot be drawn");
  if (std::max(camera.width_px, camera.height_px) > kMaxImageSidePx) {
    throw InputError("camera", fmt::format("images of {} x {} pixels cannot be drawn",
                                           camera.width_px, camera.height_px));
  }
  renderer_ = std::make_unique<Renderer>(scene, camera);
}

ColourCamera::ColourCamera(ColourCamera&&) noexcept = default;
ColourCamera& ColourCamera::operator=(ColourCamera&&) noexcept = default;
ColourCamera::~ColourCamera() = default;

ColourFrame ColourCamera::Render(const Pose3& world_from_camera,
                                 const std::vector<MoverPlace>& movers) {
  renderer_->context.MakeCurrent();
  renderer_->SetPose(world_from_camera);
  ColourFrame frame;
  frame.depth = renderer_->DrawDepth(movers);
  frame.rgb = renderer_->DrawColour(movers);
  RequireNoGlError("drawing a frame");
  return frame;
}

}  // namespace depthgrid
