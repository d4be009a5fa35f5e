// An off-screen OpenGL 4.5 core context. GL types stay out of this header.
#pragma once

#include <memory>
#include <string>

namespace depthgrid {

class GlContext {
 public:
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  // Makes this the current context of the calling thread.
  void MakeCurrent();

  // Depth of 0..1 in clip space instead of -1..1 (GL 4.5's glClipControl, which the library does
  // not export by name).
  void UseZeroToOneDepth();

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

// A linked program from GLSL sources (the #version line included). Throws std::runtime_error with
// the compiler's message.
unsigned CompileProgram(const std::string& vertex_source, const std::string& fragment_source);

// Throws std::runtime_error naming `step` when GL has reported an error since the last call.
void RequireNoGlError(const char* step);

}  // namespace depthgrid
