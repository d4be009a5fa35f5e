// OpenGL functions of OSMesa. The library is loaded at the first use of colour: it depends on LLVM,
// and loading both takes four times as long as loading the rest of the program.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <GL/osmesa.h>

namespace depthgrid {

// The functions in use: glAttachShader() is Gl().AttachShader(), OSMesaMakeCurrent() is
// OsMesa().MakeCurrent().
// clang-format off
#define DEPTHGRID_GL_FUNCTIONS(_) \
  _(AttachShader) _(BindBuffer) _(BindBufferBase) _(BindFramebuffer) \
  _(BindRenderbuffer) _(BindVertexArray) _(BlitFramebuffer) _(BufferData) \
  _(CheckFramebufferStatus) _(ClearBufferfv) _(CompileShader) _(CreateProgram) \
  _(CreateShader) _(DeleteShader) _(DepthFunc) _(DrawArrays) \
  _(Enable) _(EnableVertexAttribArray) _(FramebufferRenderbuffer) _(GenBuffers) \
  _(GenFramebuffers) _(GenRenderbuffers) _(GenVertexArrays) _(GetError) \
  _(GetProgramInfoLog) _(GetProgramiv) _(GetShaderInfoLog) _(GetShaderiv) \
  _(LinkProgram) _(PixelStorei) _(ProgramUniform1i) _(ProgramUniform3fv) \
  _(ProgramUniformMatrix4fv) _(ReadPixels) _(RenderbufferStorageMultisample) _(ShaderSource) \
  _(UseProgram) _(VertexAttribIPointer) _(VertexAttribPointer) _(Viewport)

#define DEPTHGRID_OSMESA_FUNCTIONS(_) \
  _(CreateContextAttribs) _(DestroyContext) _(GetProcAddress) _(MakeCurrent)
// clang-format on

struct GlFunctions {
#define DEPTHGRID_GL_POINTER(name) decltype(&gl##name) name;
  DEPTHGRID_GL_FUNCTIONS(DEPTHGRID_GL_POINTER)
#undef DEPTHGRID_GL_POINTER
};

struct OsMesaFunctions {
#define DEPTHGRID_OSMESA_POINTER(name) decltype(&OSMesa##name) name;
  DEPTHGRID_OSMESA_FUNCTIONS(DEPTHGRID_OSMESA_POINTER)
#undef DEPTHGRID_OSMESA_POINTER
};

// Both throw std::runtime_error if the library or a function is missing.
const GlFunctions& Gl();
const OsMesaFunctions& OsMesa();

}  // namespace depthgrid
