#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "sim/colour/gl_functions_impl.h"

namespace depthgrid {
namespace {

constexpr const char* kLibrary = "libOSMesa.so.8";

// Never closed: the library's threads may run until the program ends.
void* Library() {
  static void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw std::runtime_error(
        fmt::format("{}, which draws colour, does not load: {}", kLibrary, dlerror()));
  }
  return library;
}

template <typename Function>
Function Named(const char* name) {
  void* const function = dlsym(Library(), name);
  if (function == nullptr) throw std::runtime_error(fmt::format("{} has no {}", kLibrary, name));
  return reinterpret_cast<Function>(function);
}

GlFunctions LoadGl() {
  GlFunctions gl{};
#define DEPTHGRID_GL_LOAD(name) gl.name = Named<decltype(gl.name)>("gl" #name);
  DEPTHGRID_GL_FUNCTIONS(DEPTHGRID_GL_LOAD)
#undef DEPTHGRID_GL_LOAD
  return gl;
}

OsMesaFunctions LoadOsMesa() {
  OsMesaFunctions os_mesa{};
#define DEPTHGRID_OSMESA_LOAD(name) os_mesa.name = Named<decltype(os_mesa.name)>("OSMesa" #name);
  DEPTHGRID_OSMESA_FUNCTIONS(DEPTHGRID_OSMESA_LOAD)
#undef DEPTHGRID_OSMESA_LOAD
  return os_mesa;
}

}  // namespace

const GlFunctions& Gl() {
  static const GlFunctions gl = LoadGl();
  return gl;
}

const OsMesaFunctions& OsMesa() {
  static const OsMesaFunctions os_mesa = LoadOsMesa();
  return os_mesa;
}

}  // namespace depthgrid
