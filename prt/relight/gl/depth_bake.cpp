#include "prt/relight/gl/depth_bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prt/relight/gl/object.hpp"
#include "prt/sh/basis.hpp"
#include "prt/transfer/directions.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::relight::gl {
namespace {

constexpr int kMostLayers = 16;
constexpr std::int64_t kMostTexels = std::int64_t{1} << 24;  // of all depth maps of a batch: 64 MiB
constexpr int kMostDirections = 1 << 24;                     // a float counts them
constexpr int kHeadTexels = 3;  // of a direction's row, before its basis functions

// Orthographic, seen from the light: x and y in [-1, 1] across the bounding sphere, depth 0 at the side of the light.
constexpr const char* kPlaces = R"(
uniform vec3 centre;
vec3 place(vec3 position, vec3 right, vec3 up, vec3 towards_light) {
  vec3 p = position - centre;  // the axes are divided by the radius
  return vec3(dot(p, right), dot(p, up), 0.5 - 0.5 * dot(p, towards_light));
}
)";

constexpr const char* kDepthVertex = R"(
layout(location = 0) in vec3 position;
uniform vec3 right;
uniform vec3 up;
uniform vec3 towards_light;
void main() {
  vec3 p = place(position, right, up, towards_light);
  gl_Position = vec4(p.xy, 2.0 * p.z - 1.0, 1.0);
}
)";
constexpr const char* kDepthFragment = "#version 330 core\nvoid main() {}\n";

// The course's inner loop: all points in parallel, a few directions a pass. What the pass before has summed comes from one
// buffer, and goes to another by transform feedback: 2005's ping-pong.
constexpr const char* kGather = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;     // over the radius
layout(location = 2) in vec3 geometric;
uniform samplerBuffer before;      // TEXELS a vertex
uniform samplerBuffer directions;  // rows of right, up, towards_light (over the radius), and 4 y_i / N
uniform sampler2DArray depths;
uniform int first;
uniform int count;
uniform int resolution;
uniform float offset;
uniform float radius;
out vec4 sums[TEXELS];
void main() {
  vec4 total[TEXELS];
  for (int k = 0; k < TEXELS; ++k) total[k] = texelFetch(before, gl_VertexID * TEXELS + k);
  for (int layer = 0; layer < count; ++layer) {
    int row = (first + layer) * (3 + TEXELS);
    vec3 towards_light = texelFetch(directions, row + 2).xyz;
    float cosine = radius * dot(normal, towards_light);
    if (!(cosine > 0.0) || !(dot(geometric, towards_light) > 0.0)) continue;
    vec3 p = place(position, texelFetch(directions, row).xyz, texelFetch(directions, row + 1).xyz, towards_light);
    ivec2 texel = clamp(ivec2((0.5 * p.xy + 0.5) * float(resolution)), ivec2(0), ivec2(resolution - 1));
    if (p.z - offset > texelFetch(depths, ivec3(texel, layer), 0).r) continue;
    for (int k = 0; k < TEXELS; ++k) total[k] += cosine * texelFetch(directions, row + 3 + k);
  }
  for (int k = 0; k < TEXELS; ++k) sums[k] = total[k];
}
)";

struct Sphere {
  Vec3 centre{0.0F};
  double radius = 0.0;
};

// Around the middle of the box, a little wider: so that what rounding does at the rim stays inside the depth map.
Sphere bounding_sphere(const scene::Scene& scene) {
  const scene::Bounds box = scene::bounds(scene);
  Sphere sphere{0.5F * box.low + 0.5F * box.high, 0.0};
  for (const Vec3& p : scene.positions)
    sphere.radius = std::max(sphere.radius, glm::length(Vec3d(p) - Vec3d(sphere.centre)));
  sphere.radius *= 1.001;
  return sphere;
}

void require_valid(const Context& context, const scene::Scene& scene, const DepthBakeSettings& settings) {
  scene::refuse_primitives(scene, "depth bake");
  const int components = context.integer(GL_MAX_TRANSFORM_FEEDBACK_INTERLEAVED_COMPONENTS);
  const int largest = context.integer(GL_MAX_TEXTURE_SIZE);
  const auto most_bands = static_cast<int>(std::sqrt(static_cast<double>(components)));
  if (settings.bands < 1 || settings.bands > most_bands)
    throw InputError(fmt::format("depth bake: bands: expected 1 to {}, got {}", most_bands, settings.bands));
  if (settings.directions < 1 || settings.directions > kMostDirections)
    throw InputError(fmt::format("depth bake: directions: expected 1 to {}, got {}", kMostDirections,
                                 settings.directions));
  if (settings.resolution < 1 || settings.resolution > largest)
    throw InputError(
        fmt::format("depth bake: resolution: expected 1 to {}, got {}", largest, settings.resolution));
  if (!(settings.offset >= 0.0) || !std::isfinite(settings.offset))
    throw InputError(fmt::format("depth bake: offset: expected at least 0, got {}", settings.offset));
}

/// Unit vectors across a direction.
std::array<Vec3d, 2> axes_across(const Vec3d& direction) {
  const Vec3d away = std::abs(direction.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d right = glm::normalize(glm::cross(away, direction));
  return {right, glm::cross(direction, right)};
}

class DepthBaker {
 public:
  DepthBaker(const Context& context, const scene::Scene& scene, const DepthBakeSettings& settings)
      : context_(context),
        scene_(scene),
        settings_(settings),
        sphere_(bounding_sphere(scene)),
        texels_((sh::coefficient_count(settings.bands) + 3) / 4),
        layers_(static_cast<int>(std::clamp<std::int64_t>(
            kMostTexels / (std::int64_t{settings.resolution} * settings.resolution), 1, kMostLayers))),
        directions_(shared_directions(settings.directions, settings.seed)) {
    make_programs();
    upload_mesh();
    upload_points();
    upload_directions();
    make_depth_maps();
  }

  [[nodiscard]] std::vector<float> run() {
    for (int first = 0; first < settings_.directions; first += layers_) {
      const int count = std::min(layers_, settings_.directions - first);
      for (int layer = 0; layer < count; ++layer) draw_depth(first + layer, layer);
      gather(first, count);
      std::swap(sums_[0], sums_[1]);
    }
    const Functions& gl = context_.gl();
    std::vector<float> padded(scene_.positions.size() * static_cast<std::size_t>(4 * texels_));
    gl.BindBuffer(GL_TEXTURE_BUFFER, sums_[0].buffer.name());
    gl.GetBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(padded.size() * sizeof(float)),
                        padded.data());
    context_.require_no_error("reading the transfer back");
    return padded;
  }

  [[nodiscard]] std::size_t padded_count() const { return static_cast<std::size_t>(4 * texels_); }

 private:
  void make_programs() {
    const std::string head = fmt::format("#version 330 core\n#define TEXELS {}\n", texels_);
    depth_ = make_program(context_, {"depth map", head + kPlaces + kDepthVertex, kDepthFragment, {}});
    ProgramSource source{"transfer from depth maps", head + kPlaces + kGather, "", {}};
    for (int k = 0; k < texels_; ++k) source.feedback.push_back(fmt::format("sums[{}]", k));
    gather_ = make_program(context_, source);
  }

  void upload(const Object& buffer, GLenum target, const void* data, std::size_t bytes) {
    context_.gl().BindBuffer(target, buffer.name());
    context_.gl().BufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  }

  void upload_mesh() {
    const Functions& gl = context_.gl();
    mesh_ = make_vertex_array(context_);
    positions_ = make_buffer(context_);
    elements_ = make_buffer(context_);
    gl.BindVertexArray(mesh_.name());
    upload(positions_, GL_ARRAY_BUFFER, scene_.positions.data(), scene_.positions.size() * sizeof(Vec3));
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    upload(elements_, GL_ELEMENT_ARRAY_BUFFER, scene_.triangles.data(),
           scene_.triangles.size() * sizeof(glm::uvec3));
  }

  // The very points that rays start from in the other bake.
  void upload_points() {
    const Functions& gl = context_.gl();
    std::vector<Vec3> rows;
    for (const trace::SurfacePoint& point : trace::vertex_points(scene_))
      rows.insert(rows.end(), {point.position, point.shading_normal, point.geometric_normal});
    points_ = make_vertex_array(context_);
    point_rows_ = make_buffer(context_);
    gl.BindVertexArray(points_.name());
    upload(point_rows_, GL_ARRAY_BUFFER, rows.data(), rows.size() * sizeof(Vec3));
    for (GLuint k = 0; k < 3; ++k) {
      gl.VertexAttribPointer(k, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(Vec3),
                             reinterpret_cast<const void*>(k * sizeof(Vec3)));
      gl.EnableVertexAttribArray(k);
    }
    const std::vector<glm::vec4> zeros(scene_.positions.size() * static_cast<std::size_t>(texels_),
                                       glm::vec4(0.0F));
    for (TextureBuffer& sums : sums_) {
      sums = make_texture_buffer(context_, "transfer", GL_RGBA32F, sizeof(glm::vec4),
                                 std::as_bytes(std::span(zeros)));
    }
  }

  void upload_directions() {
    std::vector<double> values(static_cast<std::size_t>(sh::coefficient_count(settings_.bands)));
    const sh::Basis<double> basis(settings_.bands);
    std::vector<float> rows;
    for (const Vec3d& w : directions_) {
      const auto [right, up] = axes_across(w);
      std::vector<float> row;
      for (const Vec3d& axis : {right, up, w}) {
        for (int c = 0; c < 3; ++c) row.push_back(static_cast<float>(axis[c] / sphere_.radius));
        row.push_back(0.0F);
      }
      basis.evaluate(w.x, w.y, w.z, values);
      for (const double value : values) row.push_back(static_cast<float>(4.0 * value / settings_.directions));
      row.resize(static_cast<std::size_t>(4 * (kHeadTexels + texels_)), 0.0F);
      rows.insert(rows.end(), row.begin(), row.end());
    }
    direction_rows_ = make_texture_buffer(context_, "directions", GL_RGBA32F, sizeof(glm::vec4),
                                          std::as_bytes(std::span(rows)));
    axes_ = std::move(rows);
  }

  void make_depth_maps() {
    const Functions& gl = context_.gl();
    depths_ = make_texture(context_);
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, depths_.name());
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, settings_.resolution, settings_.resolution,
                  layers_, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    framebuffer_ = make_framebuffer(context_);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    constexpr GLenum kNone[] = {GL_NONE};
    gl.DrawBuffers(1, kNone);
    gl.ReadBuffer(GL_NONE);
    context_.require_no_error("depth maps");
  }

  void draw_depth(int direction, int layer) {
    const Functions& gl = context_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depths_.name(), 0, layer);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw DeviceError("OpenGL: the driver cannot draw depth maps of 32-bit floats");
    gl.Viewport(0, 0, settings_.resolution, settings_.resolution);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    constexpr float kFar[] = {1.0F};
    gl.ClearBufferfv(GL_DEPTH, 0, kFar);
    gl.UseProgram(depth_.name());
    gl.BindVertexArray(mesh_.name());
    set_vector(depth_, "centre", sphere_.centre);
    const float* row = axes_.data() + static_cast<std::size_t>(direction) *
                                          static_cast<std::size_t>(4 * (kHeadTexels + texels_));
    set_vector(depth_, "right", {row[0], row[1], row[2]});
    set_vector(depth_, "up", {row[4], row[5], row[6]});
    set_vector(depth_, "towards_light", {row[8], row[9], row[10]});
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * scene_.triangles.size()), GL_UNSIGNED_INT,
                    nullptr);
    context_.require_no_error("drawing depth");
  }

  void gather(int first, int count) {
    const Functions& gl = context_.gl();
    gl.UseProgram(gather_.name());
    gl.BindVertexArray(points_.name());
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, depths_.name());
    gl.Uniform1i(gl.GetUniformLocation(gather_.name(), "depths"), 0);
    bind(context_, gather_, "before", 1, sums_[0]);
    bind(context_, gather_, "directions", 2, direction_rows_);
    set_vector(gather_, "centre", sphere_.centre);
    gl.Uniform1i(gl.GetUniformLocation(gather_.name(), "first"), first);
    gl.Uniform1i(gl.GetUniformLocation(gather_.name(), "count"), count);
    gl.Uniform1i(gl.GetUniformLocation(gather_.name(), "resolution"), settings_.resolution);
    // A texel is 2 radii / resolution wide, and depth 1 is 2 radii away.
    gl.Uniform1f(gl.GetUniformLocation(gather_.name(), "offset"),
                 static_cast<float>(settings_.offset / settings_.resolution));
    gl.Uniform1f(gl.GetUniformLocation(gather_.name(), "radius"), static_cast<float>(sphere_.radius));
    feed_back(context_, sums_[1], scene_.positions.size(), "transfer from depth maps");
  }

  void set_vector(const Object& program, const char* name, const Vec3& v) const {
    context_.gl().Uniform3f(context_.gl().GetUniformLocation(program.name(), name), v.x, v.y, v.z);
  }

  const Context& context_;
  const scene::Scene& scene_;
  DepthBakeSettings settings_;
  Sphere sphere_;
  int texels_;
  int layers_;
  std::vector<Vec3d> directions_;
  std::vector<float> axes_;  // the rows of `directions` in the shader
  Object depth_, gather_, mesh_, positions_, elements_, points_, point_rows_, depths_, framebuffer_;
  TextureBuffer direction_rows_;
  TextureBuffer sums_[2];  // so far; next
};

transfer::Transfer empty_transfer(const scene::Scene& scene, const DepthBakeSettings& settings) {
  transfer::Transfer result;
  result.bands = settings.bands;
  result.kind = transfer::Kind::shadowed;
  result.vertices = scene.positions.size();
  result.samples = settings.directions;
  result.seed = settings.seed;
  result.coefficients.resize(result.vertices *
                             static_cast<std::size_t>(sh::coefficient_count(settings.bands)));
  return result;
}

}  // namespace

std::vector<Vec3d> shared_directions(int count, std::uint64_t seed) {
  const glm::dvec2 shift = transfer::random_shift(seed, 0, 0);
  std::vector<Vec3d> result;
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 u = transfer::shifted_sequence_point(static_cast<std::uint64_t>(i), shift);
    const double z = 1.0 - 2.0 * u.y;
    const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
    result.emplace_back(across * std::cos(2.0 * kPi * u.x), across * std::sin(2.0 * kPi * u.x), z);
  }
  return result;
}

transfer::Transfer bake_from_depth(const Context& context, const scene::Scene& scene,
                                   const DepthBakeSettings& settings) {
  require_valid(context, scene, settings);
  DepthBaker baker(context, scene, settings);
  const std::vector<float> padded = baker.run();
  transfer::Transfer result = empty_transfer(scene, settings);
  const auto count = static_cast<std::size_t>(sh::coefficient_count(settings.bands));
  for (std::size_t v = 0; v < result.vertices; ++v) {
    std::copy_n(padded.begin() + static_cast<std::ptrdiff_t>(v * baker.padded_count()), count,
                result.coefficients.begin() + static_cast<std::ptrdiff_t>(v * count));
  }
  return result;
}

// (1 / pi) (4 pi / N) sum over uniform directions.
transfer::Transfer bake_along(const scene::Scene& scene, const DepthBakeSettings& settings) {
  scene::refuse_primitives(scene, "depth bake");
  transfer::Transfer result = empty_transfer(scene, settings);
  const auto count = static_cast<std::size_t>(sh::coefficient_count(settings.bands));
  const sh::Basis<double> basis(settings.bands);
  const std::vector<Vec3d> directions = shared_directions(settings.directions, settings.seed);
  std::vector<double> values(directions.size() * count);
  for (std::size_t j = 0; j < directions.size(); ++j)
    basis.evaluate(directions[j].x, directions[j].y, directions[j].z,
                   std::span(values).subspan(j * count, count));
  const trace::RayCaster caster(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  parallel_for(result.vertices, 0, [&](std::size_t v) {
    std::vector<double> sums(count, 0.0);
    for (std::size_t j = 0; j < directions.size(); ++j) {
      const double cosine = glm::dot(Vec3d(points[v].shading_normal), directions[j]);
      const Vec3 w = glm::normalize(Vec3(directions[j]));
      if (!(cosine > 0.0) || !(glm::dot(points[v].geometric_normal, w) > 0.0F)) continue;
      if (caster.is_occluded({trace::ray_origin(points[v], w), w})) continue;
      for (std::size_t i = 0; i < count; ++i) sums[i] += cosine * values[j * count + i];
    }
    for (std::size_t i = 0; i < count; ++i)
      result.coefficients[v * count + i] = static_cast<float>(4.0 * sums[i] / settings.directions);
  });
  return result;
}

}  // namespace plumbline::relight::gl
