#include "prt/relight/gl/shaders.hpp"

namespace plumbline::relight::gl {
namespace {

// The dot product of the paper ("A gentle introduction to precomputed radiance transfer", section 6), once a vertex. It
// adds many terms of both signs: in float their rounding is that of the largest partial sum, 1e-5 and more of the result
// where little light arrives. Where the driver has doubles, the sum is rounded once.
constexpr const char* kVertexPass = R"(
uniform samplerBuffer transfer;   // four coefficients a texel
uniform usamplerBuffer lighting;  // three texels a coefficient: r, g as doubles; b as double; r, g, b as floats
#ifdef HAS_RANGES
uniform samplerBuffer offsets;
uniform samplerBuffer scales;
#endif
uniform int texels;
uniform int channels;
out vec4 unit_radiance;

#ifdef SUMS_IN_DOUBLE
#define SUM3 dvec3
dvec3 light(int i) {
  uvec4 rg = texelFetch(lighting, 3 * i);
  uvec4 b = texelFetch(lighting, 3 * i + 1);
  return dvec3(packDouble2x32(rg.xy), packDouble2x32(rg.zw), packDouble2x32(b.xy));
}
#else
#define SUM3 vec3
vec3 light(int i) { return uintBitsToFloat(texelFetch(lighting, 3 * i + 2).rgb); }
#endif

vec4 coefficients(int channel, int texel) {
  vec4 stored = texelFetch(transfer, (gl_VertexID * channels + channel) * texels + texel);
#ifdef HAS_RANGES
  int place = channel * texels + texel;
  stored = texelFetch(offsets, place) + stored * texelFetch(scales, place);
#endif
  return stored;
}

void main() {
  SUM3 sum = SUM3(0.0);
  for (int k = 0; k < texels; ++k) {
    vec4 r = coefficients(0, k);
    vec4 g = r;
    vec4 b = r;
    if (channels == 3) {
      g = coefficients(1, k);
      b = coefficients(2, k);
    }
    for (int j = 0; j < 4; ++j) sum += SUM3(r[j], g[j], b[j]) * light(4 * k + j);
  }
  unit_radiance = vec4(vec3(sum), 1.0);
}
)";

// Depth only decides what is clipped: the fragment shader says what is nearest.
constexpr const char* kViewVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform vec3 eye;
uniform mat4 to_clip;
void main() { gl_Position = to_clip * vec4(position - eye, 1.0); }
)";

// Interpolated inputs are good to some 1e-5 at best: drivers set them up in float from places rounded to 1/256 pixel. So each
// fragment fetches its triangle and evaluates relight::ScreenTriangle, with the operations of weights_at() and of
// scene::albedo_at() in the same order. `precise` keeps the compiler from reordering them.
constexpr const char* kViewFragment = R"(#version 330 core
#extension GL_ARB_gpu_shader5 : enable
#ifdef GL_ARB_gpu_shader5
#define EXACT precise
#else
#define EXACT
#endif
uniform samplerBuffer planes;         // three texels a triangle: (a, x), (b, y), (c, front)
uniform usamplerBuffer corners;       // one texel a triangle: three vertices, material
uniform samplerBuffer vertex_values;  // unit_radiance of the vertex pass
uniform samplerBuffer texcoords;
uniform samplerBuffer colors;
uniform samplerBuffer materials;      // albedo, texture or -1
uniform usamplerBuffer textures;      // first texel, width, height, wrap of u + 4 x wrap of v
uniform samplerBuffer texels;
uniform int has_texcoords;
uniform int has_colors;
uniform ivec2 first_sample;
uniform float nearest;
layout(location = 0) out vec4 radiance;
layout(location = 1) out vec4 albedo;
layout(location = 2) out uint triangle;

const int kMirror = 1;
const int kClamp = 2;

int wrapped(int texel, int size, int wrap) {
  if (wrap == kClamp) return clamp(texel, 0, size - 1);
  int period = wrap == kMirror ? 2 * size : size;
  int inside = texel < 0 ? texel + period : texel >= period ? texel - period : texel;
  return inside < size ? inside : period - 1 - inside;
}

void footprint(float coordinate, int size, int wrap, out int low, out int high, out float weight_high) {
  EXACT float period = wrap == kMirror ? 2.0 : 1.0;
  EXACT float turns = floor(coordinate / period);
  EXACT float near_zero = wrap == kClamp ? clamp(coordinate, 0.0, 1.0) : coordinate - period * turns;
  EXACT float position = near_zero * float(size) - 0.5;
  EXACT float below = floor(position);
  low = wrapped(int(below), size, wrap);
  high = wrapped(int(below) + 1, size, wrap);
  EXACT float rest = position - below;
  weight_high = rest;
}

vec3 mixed(vec3 low, vec3 high, float weight) {
  EXACT float other = 1.0 - weight;
  EXACT vec3 result = low * other + high * weight;
  return result;
}

vec3 bilinear(int index, vec2 uv) {
  uvec4 head = texelFetch(textures, index);
  int first = int(head.x);
  int width = int(head.y);
  int left, right, top, bottom;
  float wx, wy;
  footprint(uv.x, width, int(head.w & 3u), left, right, wx);
  footprint(uv.y, int(head.z), int(head.w >> 2u), top, bottom, wy);
  vec3 upper = mixed(texelFetch(texels, first + top * width + left).rgb,
                     texelFetch(texels, first + top * width + right).rgb, wx);
  vec3 lower = mixed(texelFetch(texels, first + bottom * width + left).rgb,
                     texelFetch(texels, first + bottom * width + right).rgb, wx);
  return mixed(upper, lower, wy);
}

void main() {
  vec4 a = texelFetch(planes, 3 * gl_PrimitiveID);
  vec4 b = texelFetch(planes, 3 * gl_PrimitiveID + 1);
  vec4 c = texelFetch(planes, 3 * gl_PrimitiveID + 2);
  uvec4 corner = texelFetch(corners, gl_PrimitiveID);
  EXACT vec2 d = vec2(ivec2(gl_FragCoord.xy) + first_sample) - vec2(a.w, b.w);
  EXACT vec3 over_depth = a.xyz + b.xyz * d.x + c.xyz * d.y;
  EXACT float inverse_depth = over_depth.x + over_depth.y + over_depth.z;
  if (!(inverse_depth > 0.0)) discard;
  gl_FragDepth = inverse_depth * nearest;
  triangle = uint(gl_PrimitiveID);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  albedo = vec4(0.0);
  if (c.w == 0.0) return;  // from behind

  EXACT float depth = 1.0 / inverse_depth;
  EXACT vec3 w = over_depth * depth;
  EXACT vec3 unit = w.x * texelFetch(vertex_values, int(corner.x)).rgb +
                    w.y * texelFetch(vertex_values, int(corner.y)).rgb +
                    w.z * texelFetch(vertex_values, int(corner.z)).rgb;
  EXACT float first = 1.0 - w.y - w.z;
  vec4 material = texelFetch(materials, int(corner.w));
  EXACT vec3 reflected = material.rgb;
  if (has_texcoords != 0 && material.a >= 0.0) {
    EXACT vec2 uv = texelFetch(texcoords, int(corner.x)).rg * first +
                    texelFetch(texcoords, int(corner.y)).rg * w.y + texelFetch(texcoords, int(corner.z)).rg * w.z;
    reflected = reflected * bilinear(int(material.a), uv);
  }
  if (has_colors != 0) {
    EXACT vec3 color = texelFetch(colors, int(corner.x)).rgb * first + texelFetch(colors, int(corner.y)).rgb * w.y +
                       texelFetch(colors, int(corner.z)).rgb * w.z;
    reflected = reflected * color;
  }
  EXACT vec3 product = reflected * unit;
  radiance = vec4(product, 1.0);
  albedo = vec4(reflected, 1.0);
}
)";

}  // namespace

ProgramSource vertex_pass_source(bool sums_in_double, bool has_ranges) {
  std::string head = "#version 330 core\n";
  if (sums_in_double) head += "#extension GL_ARB_gpu_shader_fp64 : require\n#define SUMS_IN_DOUBLE\n";
  if (has_ranges) head += "#define HAS_RANGES\n";
  return {"light times transfer", head + kVertexPass, "", {"unit_radiance"}};
}

ProgramSource view_source() {
  return {"view", kViewVertex, kViewFragment, {}};
}

}  // namespace plumbline::relight::gl
