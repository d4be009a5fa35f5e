#include "sim/colour/colour_shaders.h"

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr const char* kVersion = "#version 450 core\n";

// Transforms of points and normals from the mesh's axes to the world's.
constexpr const char* kStandingAxes = R"glsl(
vec3 ToWorld(vec3 p) { return p; }
vec3 TurnToWorld(vec3 n) { return n; }
vec3 FromWorld(vec3 p) { return p; }
vec3 TurnFromWorld(vec3 n) { return n; }
)glsl";

constexpr const char* kMovingAxes = R"glsl(
layout(location = 69) uniform mat4 world_from_mover;
vec3 ToWorld(vec3 p) { return (world_from_mover * vec4(p, 1.0)).xyz; }
vec3 TurnToWorld(vec3 n) { return mat3(world_from_mover) * n; }
vec3 FromWorld(vec3 p) { return transpose(mat3(world_from_mover)) * (p - world_from_mover[3].xyz); }
vec3 TurnFromWorld(vec3 n) { return transpose(mat3(world_from_mover)) * n; }
)glsl";

constexpr const char* kVertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint material;
layout(location = 0) uniform mat4 camera_from_world;
layout(location = 1) uniform mat4 clip_from_camera;
out vec3 point_in_world;
out vec3 normal_in_world;
out float z_m;
flat out uint material_index;
void main() {
  point_in_world = ToWorld(position);
  vec4 point_in_camera = camera_from_world * vec4(point_in_world, 1.0);
  normal_in_world = TurnToWorld(normal);
  z_m = point_in_camera.z;
  material_index = material;
  gl_Position = clip_from_camera * point_in_camera;
}
)glsl";

constexpr const char* kDepthFragment = R"glsl(
in float z_m;
layout(location = 0) out float depth_m;
void main() { depth_m = z_m; }
)glsl";

constexpr const char* kInterface = R"glsl(
struct Material {
  vec4 colour;         // w: scale_m
  vec4 second_colour;  // w: gloss
  vec4 other;          // x: glow, y: grain axis
};
layout(std430, binding = 0) readonly buffer Materials { Material materials[]; };
layout(location = 2) uniform vec3 eye_in_world;
layout(location = 3) uniform vec3 ambient;
layout(location = 4) uniform int light_count;
layout(location = 5) uniform vec3 light_at[32];
layout(location = 37) uniform vec3 light_intensity[32];
in vec3 point_in_world;
in vec3 normal_in_world;
flat in uint material_index;
layout(location = 0) out vec4 rgba;
)glsl";

// Hashed lattice noise (integer hash of Wang's kind), 0..1, and sums of octaves of it. Octaves
// finer than a pixel are replaced by their mean to avoid aliasing.
constexpr const char* kNoise = R"glsl(
uint Mix(uint h) {
  h = (h ^ 61u) ^ (h >> 16);
  h *= 9u;
  h ^= h >> 4;
  h *= 0x27d4eb2du;
  return h ^ (h >> 15);
}
float Hash(ivec3 cell) {
  uint h = Mix(uint(cell.x) + Mix(uint(cell.y) + Mix(uint(cell.z))));
  return float(h >> 8) / 16777216.0;
}
float Noise(vec3 p) {
  vec3 base = floor(p);
  ivec3 c = ivec3(base);
  vec3 f = p - base;
  f = f * f * (3.0 - 2.0 * f);
  vec4 low = vec4(Hash(c), Hash(c + ivec3(1, 0, 0)), Hash(c + ivec3(0, 1, 0)),
                  Hash(c + ivec3(1, 1, 0)));
  vec4 high = vec4(Hash(c + ivec3(0, 0, 1)), Hash(c + ivec3(1, 0, 1)), Hash(c + ivec3(0, 1, 1)),
                   Hash(c + ivec3(1, 1, 1)));
  vec4 across = mix(low, high, f.z);
  vec2 up = mix(across.xy, across.zw, f.y);
  return mix(up.x, up.y, f.x);
}
// What is left of a pattern of period `period` when a pixel covers `footprint` of it.
float Visible(float footprint, float period) {
  return clamp(1.6 - 2.0 * footprint / period, 0.0, 1.0);
}
// Noise of a period, in -1..1, faded where a pixel is coarser.
float Grain(vec3 p, float period, float footprint) {
  return (2.0 * Noise(p / period) - 1.0) * Visible(footprint, period);
}
// The two coordinates within the axis plane the surface is closest to.
vec2 Planar(vec3 p, vec3 n) {
  vec3 a = abs(n);
  if (a.z >= a.x && a.z >= a.y) return p.xy;
  return a.x >= a.y ? p.yz : p.xz;
}
// The coordinate along the grain first.
vec3 AlongGrain(vec3 p, float axis) {
  return axis < 0.5 ? p : (axis < 1.5 ? p.yzx : p.zxy);
}
)glsl";

// One function per texture: the surface's colour at a world point.
constexpr const char* kPlain = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) { return m.colour.rgb; }
)glsl";

constexpr const char* kWood = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  float scale = m.colour.w;
  vec3 q = AlongGrain(p, m.other.y);
  float warp = Grain(q * vec3(0.12, 1.0, 1.0), 2.0 * scale, footprint);
  float rings = sin(6.2832 * (length(q.yz + 0.31) / scale + 1.6 * warp));
  float fibre = Grain(q * vec3(0.06, 1.0, 1.0), 0.08 * scale, footprint) +
                Grain(q * vec3(0.06, 1.0, 1.0), 0.3 * scale, footprint);
  float share = 0.35 + 0.13 * rings * Visible(footprint, scale) + 0.16 * warp + 0.2 * fibre;
  return mix(m.colour.rgb, m.second_colour.rgb, clamp(share, 0.0, 1.0));
}
)glsl";

constexpr const char* kChecker = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  vec2 cell = floor(Planar(p, n) / m.colour.w);
  float odd = mod(cell.x + cell.y, 2.0);
  return mix(m.colour.rgb, m.second_colour.rgb, mix(0.5, odd, Visible(footprint, m.colour.w)));
}
)glsl";

constexpr const char* kStripes = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  float across = AlongGrain(p, m.other.y).x;
  float wave = fract(across / m.colour.w);
  float odd = smoothstep(0.48, 0.52, wave) - smoothstep(0.98, 1.0, wave);
  vec3 c = mix(m.colour.rgb, m.second_colour.rgb, mix(0.5, odd, Visible(footprint, m.colour.w)));
  return c * (1.0 + 0.06 * Grain(p, 0.004, footprint));
}
)glsl";

constexpr const char* kFabric = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  float scale = m.colour.w;
  vec2 thread = Planar(p, n) * 3.1416 / scale;
  float weave = sin(thread.x) * sin(thread.y) * Visible(footprint, scale);
  float worn = Grain(p, 24.0 * scale, footprint) + 0.6 * Grain(p, 3.0 * scale, footprint);
  float share = 0.3 + 0.25 * weave + 0.22 * worn;
  return mix(m.colour.rgb, m.second_colour.rgb, clamp(share, 0.0, 1.0));
}
)glsl";

constexpr const char* kPlaster = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  float scale = m.colour.w;
  float bumps = 0.5 * Grain(p, scale, footprint) + 0.3 * Grain(p, 0.3 * scale, footprint) +
                0.4 * Grain(p, 20.0 * scale, footprint);
  return mix(m.colour.rgb, m.second_colour.rgb, clamp(0.15 + 0.16 * bumps, 0.0, 1.0));
}
)glsl";

constexpr const char* kTiles = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  const float joint = 0.03;
  vec2 q = Planar(p, n) / m.colour.w;
  vec2 cell = floor(q);
  vec2 edge = min(q - cell, 1.0 - (q - cell));
  float line = 1.0 - smoothstep(0.5 * joint, 0.8 * joint, min(edge.x, edge.y));
  float tone = Hash(ivec3(cell, 7)) - 0.5 + 0.5 * Grain(p, 0.15 * m.colour.w, footprint);
  vec3 tile = m.colour.rgb * (1.0 + 0.14 * tone);
  return mix(tile, m.second_colour.rgb, line * Visible(footprint, 0.1 * m.colour.w));
}
)glsl";

constexpr const char* kPlanks = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  const float boards_long = 9.0;
  float width = m.colour.w;
  vec3 q = AlongGrain(p, m.other.y);
  // Across the boards: the level axis on floors, the upright one on walls.
  float across = abs(n.z) > 0.7 ? (m.other.y < 0.5 ? p.y : p.x) : (m.other.y > 1.5 ? p.x + p.y : p.z);
  float row = floor(across / width);
  float shifted = q.x / (boards_long * width) + Hash(ivec3(int(row), 3, 5));
  float board = floor(shifted);
  float tone = Hash(ivec3(int(row), int(board), 11));
  float edge_m = min(min(fract(across / width), 1.0 - fract(across / width)) * width,
                     min(fract(shifted), 1.0 - fract(shifted)) * boards_long * width);
  float gap = (1.0 - smoothstep(0.0008, 0.0030, edge_m)) * Visible(footprint, 0.012);
  vec3 fibre_at = vec3(q.x * 0.06, q.yz) + 3.7 * tone;
  float fibre = 0.6 * Grain(fibre_at, 0.05 * width, footprint) +
                0.6 * Grain(fibre_at, 0.25 * width, footprint);
  vec3 wood = mix(m.colour.rgb, m.second_colour.rgb,
                  clamp(0.1 + 0.55 * tone + 0.25 * fibre, 0.0, 1.0));
  return wood * (1.0 - 0.6 * gap);
}
)glsl";

constexpr const char* kCarpet = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  float scale = m.colour.w;
  float pile = 0.6 * Grain(p, scale, footprint) + 0.4 * Grain(p, 0.4 * scale, footprint) +
               0.5 * Grain(p, 9.0 * scale, footprint);
  return mix(m.colour.rgb, m.second_colour.rgb, clamp(0.4 + 0.5 * pile, 0.0, 1.0));
}
)glsl";

constexpr const char* kPaper = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  vec2 q = Planar(p, n) / m.colour.w;
  float row = floor(q.y);
  float letter = floor(3.0 * q.x);
  float word = Hash(ivec3(int(floor(q.x * 0.7 + 0.37 * row)), int(row), 1));
  float indent = Hash(ivec3(int(row), 17, int(floor(0.05 * q.x))));
  float ink = step(0.3, word) * step(0.15, indent) * step(0.35, fract(q.y)) *
              (0.5 + 0.5 * Hash(ivec3(int(letter), int(row), 2)));
  return mix(m.second_colour.rgb, m.colour.rgb, mix(0.3, ink, Visible(footprint, m.colour.w)));
}
)glsl";

constexpr const char* kPainting = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  vec3 q = p / m.colour.w;
  vec3 warp = vec3(Noise(q + 5.2), Noise(q + 1.3), Noise(q + 9.7));
  float a = Noise(q * 1.3 + 2.0 * warp);
  float b = Noise(q * 2.1 - 2.5 * warp + 17.0);
  vec3 third = 0.45 * mix(m.colour.rgb, m.second_colour.rgb, 0.5) + 0.55 * m.colour.grb;
  vec3 c = mix(m.colour.rgb, m.second_colour.rgb, smoothstep(0.4, 0.6, a));
  c = mix(c, third, smoothstep(0.58, 0.64, b));
  return c * (1.0 + 0.12 * Grain(p * vec3(1.0, 1.0, 0.4), 0.006, footprint));
}
)glsl";

constexpr const char* kStone = R"glsl(
vec3 Albedo(Material m, vec3 p, vec3 n, float footprint) {
  float scale = m.colour.w;
  float cloud = Grain(p, scale, footprint) + 0.5 * Grain(p + 3.1, 0.45 * scale, footprint);
  float vein = 1.0 - abs(sin(4.0 * (p.x + 0.7 * p.y + 0.4 * p.z) / scale + 3.0 * cloud));
  float share = 0.25 + 0.2 * cloud + 0.55 * vein * vein * vein;
  return mix(m.colour.rgb, m.second_colour.rgb, clamp(share, 0.0, 1.0));
}
)glsl";

// Diffuse shading by point lights and ambient light (more from above), a specular highlight, then a
// tone curve with a soft shoulder towards white and the sRGB curve.
constexpr const char* kMain = R"glsl(
vec3 Display(vec3 light) {
  const float white = 2.2;  // the brightness that becomes full white
  vec3 c = light * (1.0 + light / (white * white)) / (1.0 + 0.55 * light);
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
void main() {
  Material m = materials[material_index];
  vec3 to_eye = normalize(eye_in_world - point_in_world);
  vec3 n = normalize(normal_in_world);
  if (dot(n, to_eye) < 0.0) n = -n;
  vec3 spread = fwidth(point_in_world);
  float footprint = max(spread.x, max(spread.y, spread.z));
  vec3 albedo = Albedo(m, FromWorld(point_in_world), TurnFromWorld(n), footprint);
  vec3 light = ambient * (0.78 + 0.22 * n.z);
  vec3 highlight = vec3(0.0);
  for (int i = 0; i < light_count; ++i) {
    vec3 to_light = light_at[i] - point_in_world;
    float distance_2 = max(dot(to_light, to_light), 0.04);
    vec3 direction = to_light * inversesqrt(distance_2);
    vec3 arriving = light_intensity[i] / distance_2;
    light += arriving * max(0.15 + 0.85 * dot(n, direction), 0.0);
    float mirror = max(dot(n, normalize(direction + to_eye)), 0.0);
    highlight += arriving * pow(mirror, 60.0);
  }
  vec3 given_off = m.other.x * albedo;
  rgba = vec4(Display(albedo * light + m.second_colour.w * highlight + given_off), 1.0);
}
)glsl";

const char* TextureSource(TextureKind texture) {
  switch (texture) {
    case TextureKind::kPlain:
      return kPlain;
    case TextureKind::kWood:
      return kWood;
    case TextureKind::kChecker:
      return kChecker;
    case TextureKind::kStripes:
      return kStripes;
    case TextureKind::kFabric:
      return kFabric;
    case TextureKind::kPlaster:
      return kPlaster;
    case TextureKind::kTiles:
      return kTiles;
    case TextureKind::kPlanks:
      return kPlanks;
    case TextureKind::kCarpet:
      return kCarpet;
    case TextureKind::kPaper:
      return kPaper;
    case TextureKind::kPainting:
      return kPainting;
    case TextureKind::kStone:
      return kStone;
  }
  Broken("a texture has its shader");
}

const char* AxesOf(Drawn drawn) { return drawn == Drawn::kStanding ? kStandingAxes : kMovingAxes; }

}  // namespace

std::string VertexShader(Drawn drawn) { return std::string(kVersion) + AxesOf(drawn) + kVertex; }

std::string DepthFragmentShader() {
  std::string shader = kVersion;
  shader += kDepthFragment;  // adding the two in one expression triggers a false warning of GCC 12
  return shader;
}

std::string ColourFragmentShader(TextureKind texture, Drawn drawn) {
  return std::string(kVersion) + AxesOf(drawn) + kInterface + kNoise + TextureSource(texture) +
         kMain;
}

}  // namespace depthgrid
