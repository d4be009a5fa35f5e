#include "sim/colour/gl_context.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "sim/colour/gl_functions_impl.h"

namespace depthgrid {
namespace {

GLuint CompileShader(GLenum kind, const std::string& source) {
  const GLuint shader = Gl().CreateShader(kind);
  const char* text = source.c_str();
  Gl().ShaderSource(shader, 1, &text, nullptr);
  Gl().CompileShader(shader);
  GLint ok = GL_FALSE;
  Gl().GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::array<char, 2048> log{};
  Gl().GetShaderInfoLog(shader, log.size(), nullptr, log.data());
  throw std::runtime_error(fmt::format("a shader does not compile: {}", log.data()));
}

}  // namespace

struct GlContext::Handle {
  OSMesaContext context = nullptr;
  std::array<unsigned char, 4> window{};  // required by OSMesa; drawing goes to framebuffers
};

GlContext::GlContext() : handle_(std::make_unique<Handle>()) {
  const std::array<int, 13> attributes = {OSMESA_FORMAT,
                                          OSMESA_RGBA,
                                          OSMESA_DEPTH_BITS,
                                          0,
                                          OSMESA_STENCIL_BITS,
                                          0,
                                          OSMESA_PROFILE,
                                          OSMESA_CORE_PROFILE,
                                          OSMESA_CONTEXT_MAJOR_VERSION,
                                          4,
                                          OSMESA_CONTEXT_MINOR_VERSION,
                                          5,
                                          0};
  handle_->context = OsMesa().CreateContextAttribs(attributes.data(), nullptr);
  if (handle_->context == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 4.5 context");
  MakeCurrent();
}

GlContext::~GlContext() { OsMesa().DestroyContext(handle_->context); }

void GlContext::MakeCurrent() {
  if (OsMesa().MakeCurrent(handle_->context, handle_->window.data(), GL_UNSIGNED_BYTE, 1, 1) == 0) {
    throw std::runtime_error("OSMesa cannot make its context current");
  }
}

void GlContext::UseZeroToOneDepth() {
  const auto clip_control =
      reinterpret_cast<PFNGLCLIPCONTROLPROC>(OsMesa().GetProcAddress("glClipControl"));
  if (clip_control == nullptr) throw std::runtime_error("OSMesa has no glClipControl");
  clip_control(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

unsigned CompileProgram(const std::string& vertex_source, const std::string& fragment_source) {
  const GLuint vertex = CompileShader(GL_VERTEX_SHADER, vertex_source);
  const GLuint fragment = CompileShader(GL_FRAGMENT_SHADER, fragment_source);
  const GLuint program = Gl().CreateProgram();
  Gl().AttachShader(program, vertex);
  Gl().AttachShader(program, fragment);
  Gl().LinkProgram(program);
  Gl().DeleteShader(vertex);
  Gl().DeleteShader(fragment);
  GLint ok = GL_FALSE;
  Gl().GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  std::array<char, 2048> log{};
  Gl().GetProgramInfoLog(program, log.size(), nullptr, log.data());
  throw std::runtime_error(fmt::format("a shader program does not link: {}", log.data()));
}

void RequireNoGlError(const char* step) {
  const GLenum error = Gl().GetError();
  if (error != GL_NO_ERROR) {
    throw std::runtime_error(fmt::format("OpenGL error {:#x} while {}", error, step));
  }
}

}  // namespace depthgrid
