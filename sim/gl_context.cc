#include "sim/gl_context.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace depthgrid {
namespace {

GLuint CompileShader(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  throw std::runtime_error(fmt::format("a shader does not compile: {}", log.data()));
}

}  // namespace

struct GlContext::Handle {
  OSMesaContext context = nullptr;
  std::array<unsigned char, 4> window{};  // OSMesa wants a window; drawing goes to framebuffers
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
  handle_->context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (handle_->context == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 4.5 context");
  MakeCurrent();
}

GlContext::~GlContext() { OSMesaDestroyContext(handle_->context); }

void GlContext::MakeCurrent() {
  if (OSMesaMakeCurrent(handle_->context, handle_->window.data(), GL_UNSIGNED_BYTE, 1, 1) == 0) {
    throw std::runtime_error("OSMesa cannot make its context current");
  }
}

void GlContext::UseZeroToOneDepth() {
  const auto clip_control =
      reinterpret_cast<PFNGLCLIPCONTROLPROC>(OSMesaGetProcAddress("glClipControl"));
  if (clip_control == nullptr) throw std::runtime_error("OSMesa has no glClipControl");
  clip_control(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

unsigned CompileProgram(const std::string& vertex_source, const std::string& fragment_source) {
  const GLuint vertex = CompileShader(GL_VERTEX_SHADER, vertex_source);
  const GLuint fragment = CompileShader(GL_FRAGMENT_SHADER, fragment_source);
  const GLuint program = glCreateProgram();
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(program, log.size(), nullptr, log.data());
  throw std::runtime_error(fmt::format("a shader program does not link: {}", log.data()));
}

void RequireNoGlError(const char* step) {
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) {
    throw std::runtime_error(fmt::format("OpenGL error {:#x} while {}", error, step));
  }
}

}  // namespace depthgrid
