#include "prt/relight/gl/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "prt/relight/gl/shaders.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::relight::gl {
namespace {

template <class Value>
std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
  return std::as_bytes(std::span<const Value>(values));
}

std::vector<glm::vec4> padded(const std::vector<Rgb>& values) {
  std::vector<glm::vec4> result;
  result.reserve(values.size());
  for (const Rgb& value : values) result.emplace_back(value, 0.0F);
  return result;
}

void require_matching(const scene::Scene& scene, const transfer::Transfer& transfer) {
  scene::refuse_primitives(scene, "OpenGL");
  transfer::validate(transfer, "OpenGL");
  if (transfer.vertices != scene.positions.size()) {
    throw InputError(fmt::format("OpenGL: transfer of {} vertices for a scene of {}", transfer.vertices,
                                 scene.positions.size()));
  }
}

std::array<std::uint32_t, 2> words(double value) {
  std::array<std::uint32_t, 2> result{};
  std::memcpy(result.data(), &value, sizeof value);
  return result;
}

std::uint32_t word(float value) {
  std::uint32_t result = 0;
  std::memcpy(&result, &value, sizeof value);
  return result;
}

// The layout of `lighting` in shaders.cpp, padded to whole texels of transfer.
std::vector<glm::uvec4> packed_lighting(const sh::ShRgb& lighting, std::size_t count,
                                        std::size_t padded_count) {
  std::vector<glm::uvec4> result(3 * padded_count, glm::uvec4(0U));
  for (std::size_t i = 0; i < count; ++i) {
    const RgbD l = lighting.coefficients[i];
    const auto r = words(l.x);
    const auto g = words(l.y);
    const auto b = words(l.z);
    result[3 * i] = {r[0], r[1], g[0], g[1]};
    result[3 * i + 1] = {b[0], b[1], 0U, 0U};
    result[3 * i + 2] = {word(static_cast<float>(l.x)), word(static_cast<float>(l.y)),
                         word(static_cast<float>(l.z)), 0U};
  }
  return result;
}

// Sample (X, Y) at the middle of the tile's fragment (X - x, Y - y). z is w less twice the least depth, so that only what
// lies nearer is clipped.
glm::mat4 clip_matrix(const SampleGrid& grid, const Tile& tile, float nearest) {
  const Vec3d forward = glm::normalize(glm::cross(grid.plane.right, grid.plane.down));
  const auto row = [&](const Vec3d& side, double first, int count) {
    const Vec3d axis = side / glm::dot(side, side);  // samples for a point of depth 1
    const double origin = glm::dot(grid.plane.corner, axis);
    return 2.0 / count * (axis - (origin + first + 0.5 * count) * forward);
  };
  const Vec3d x = row(grid.plane.right, tile.x, tile.columns);
  const Vec3d y = row(grid.plane.down, tile.y, tile.rows);
  glm::mat4 result(0.0F);
  for (int i = 0; i < 3; ++i) {
    result[i] = glm::vec4(static_cast<float>(x[i]), static_cast<float>(y[i]), static_cast<float>(forward[i]),
                          static_cast<float>(forward[i]));
  }
  result[3] = glm::vec4(0.0F, 0.0F, -2.0F * nearest, 0.0F);
  return result;
}

// Far below what is in sight, for the depth buffer holds nearest / depth, which floats resolve alike at any size.
float nearest_depth(const scene::Scene& scene, const SampleGrid& grid) {
  const scene::Bounds box = scene::bounds(scene);
  const Vec3d reach = glm::max(glm::abs(Vec3d(box.low) - grid.eye), glm::abs(Vec3d(box.high) - grid.eye));
  return static_cast<float>(1e-6 * glm::length(reach));
}

}  // namespace

std::string_view to_string(Target target) {
  return target == Target::f32 ? "f32" : "f16";
}

Target target_from_string(std::string_view text) {
  for (const Target target : {Target::f32, Target::f16}) {
    if (text == to_string(target)) return target;
  }
  throw InputError(fmt::format("OpenGL target: expected f32 or f16, got {}", text));
}

Renderer::Renderer(const Context& context, const scene::Scene& scene, const transfer::Transfer& transfer,
                   const RendererSettings& settings)
    : context_(context),
      scene_(scene),
      settings_(settings),
      sums_in_double_(settings.allows_double && context.has_extension("GL_ARB_gpu_shader_fp64")),
      bands_(transfer.bands),
      channels_(transfer.channels),
      has_ranges_(settings.storage == Storage::unorm16 || settings.storage == Storage::unorm8) {
  require_matching(scene, transfer);
  vertex_pass_ = make_program(context, vertex_pass_source(sums_in_double_, has_ranges_));
  view_ = make_program(context, view_source());
  no_attributes_ = make_vertex_array(context);
  upload_scene(scene);
  upload_materials(scene);
  upload_transfer(transfer, settings.storage);
  make_tile_buffers();
}

void Renderer::upload_scene(const scene::Scene& scene) {
  const Functions& gl = context_.gl();
  triangles_ = make_vertex_array(context_);
  positions_ = make_buffer(context_);
  elements_ = make_buffer(context_);
  gl.BindVertexArray(triangles_.name());
  gl.BindBuffer(GL_ARRAY_BUFFER, positions_.name());
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.positions.size() * sizeof(Vec3)),
                scene.positions.data(), GL_STATIC_DRAW);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl.EnableVertexAttribArray(0);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, elements_.name());
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.triangles.size() * sizeof(glm::uvec3)),
                scene.triangles.data(), GL_STATIC_DRAW);
  std::vector<glm::uvec4> corners(scene.triangles.size());
  for (std::size_t t = 0; t < corners.size(); ++t)
    corners[t] = glm::uvec4(scene.triangles[t], scene.triangle_materials[t]);
  corners_ = make_texture_buffer(context_, "triangles", GL_RGBA32UI, sizeof(glm::uvec4), bytes_of(corners));
  texcoords_ =
      make_texture_buffer(context_, "texture coordinates", GL_RG32F, sizeof(Vec2), bytes_of(scene.texcoords));
  colors_ = make_texture_buffer(context_, "vertex colours", GL_RGBA32F, sizeof(glm::vec4),
                                bytes_of(padded(scene.vertex_colors)));
  planes_ = make_texture_buffer(context_, "triangles of the view", GL_RGBA32F, sizeof(glm::vec4), {},
                                scene.triangles.size() * 3 * sizeof(glm::vec4));
  context_.require_no_error("uploading the scene");
}

void Renderer::upload_materials(const scene::Scene& scene) {
  std::vector<glm::vec4> materials;
  for (const scene::Material& material : scene.materials)
    materials.emplace_back(material.albedo, static_cast<float>(material.albedo_texture));
  std::vector<glm::uvec4> heads;
  std::vector<glm::vec4> texels;
  for (const scene::Texture& texture : scene.textures) {
    heads.emplace_back(
        static_cast<std::uint32_t>(texels.size()), static_cast<std::uint32_t>(texture.image.width),
        static_cast<std::uint32_t>(texture.image.height),
        static_cast<std::uint32_t>(texture.wrap_u) + 4U * static_cast<std::uint32_t>(texture.wrap_v));
    const std::vector<glm::vec4> pixels = padded(texture.image.pixels);
    texels.insert(texels.end(), pixels.begin(), pixels.end());
  }
  materials_ = make_texture_buffer(context_, "materials", GL_RGBA32F, sizeof(glm::vec4), bytes_of(materials));
  textures_ = make_texture_buffer(context_, "textures", GL_RGBA32UI, sizeof(glm::uvec4), bytes_of(heads));
  texels_of_textures_ = make_texture_buffer(context_, "texels of all textures", GL_RGBA32F, sizeof(glm::vec4),
                                            bytes_of(texels));
}

void Renderer::upload_transfer(const transfer::Transfer& transfer, Storage storage) {
  const PackedTransfer packed = pack(transfer, storage);
  texels_ = packed.texels;
  const std::size_t vectors = transfer.vertices * static_cast<std::size_t>(transfer.channels);
  transfer_ = make_texture_buffer(context_, "transfer", packed.format,
                                  packed.bytes.size() / std::max<std::size_t>(1, vectors * packed.texels),
                                  packed.bytes);
  if (has_ranges_) {
    offsets_ =
        make_texture_buffer(context_, "offsets", GL_RGBA32F, sizeof(glm::vec4), bytes_of(packed.offsets));
    scales_ = make_texture_buffer(context_, "scales", GL_RGBA32F, sizeof(glm::vec4), bytes_of(packed.scales));
  }
  vertex_values_ = make_texture_buffer(context_, "vertices", GL_RGBA32F, sizeof(glm::vec4), {},
                                       transfer.vertices * sizeof(glm::vec4));
  lighting_ = make_texture_buffer(context_, "lighting", GL_RGBA32UI, sizeof(glm::uvec4), {},
                                  texels_ * 12 * sizeof(glm::uvec4));
}

void Renderer::make_tile_buffers() {
  const Functions& gl = context_.gl();
  GLint viewport[2] = {0, 0};
  gl.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  tile_size_ = std::min(
      {settings_.largest_tile, context_.integer(GL_MAX_RENDERBUFFER_SIZE), viewport[0], viewport[1]});
  const GLenum colour = settings_.target == Target::f32 ? GL_RGBA32F : GL_RGBA16F;
  radiance_ = make_renderbuffer(context_, colour, tile_size_, tile_size_);
  albedo_ = make_renderbuffer(context_, colour, tile_size_, tile_size_);
  triangle_ = make_renderbuffer(context_, GL_R32UI, tile_size_, tile_size_);
  depth_ = make_renderbuffer(context_, GL_DEPTH_COMPONENT32F, tile_size_, tile_size_);
  framebuffer_ = make_framebuffer(context_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  const auto attach = [&](GLenum where, const Object& buffer) {
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer.name());
  };
  attach(GL_COLOR_ATTACHMENT0, radiance_);
  attach(GL_COLOR_ATTACHMENT1, albedo_);
  attach(GL_COLOR_ATTACHMENT2, triangle_);
  attach(GL_DEPTH_ATTACHMENT, depth_);
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw DeviceError(fmt::format("OpenGL: the driver cannot draw into {} images (status 0x{:x})",
                                  to_string(settings_.target), status));
  }
}

void Renderer::set_light(const sh::ShRgb& lighting) {
  if (lighting.bands < bands_) {
    throw InputError(
        fmt::format("lighting: {} bands are fewer than the transfer's {}", lighting.bands, bands_));
  }
  const Functions& gl = context_.gl();
  const std::vector<glm::uvec4> packed =
      packed_lighting(lighting, static_cast<std::size_t>(sh::coefficient_count(bands_)), 4 * texels_);
  gl.BindBuffer(GL_TEXTURE_BUFFER, lighting_.buffer.name());
  gl.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(packed.size() * sizeof(glm::uvec4)), packed.data(),
                GL_DYNAMIC_DRAW);
  gl.BindFramebuffer(GL_FRAMEBUFFER,
                     framebuffer_.name());  // none of its own without a surface, yet one must be whole
  gl.UseProgram(vertex_pass_.name());
  gl.BindVertexArray(no_attributes_.name());
  bind(context_, vertex_pass_, "transfer", 0, transfer_);
  bind(context_, vertex_pass_, "lighting", 1, lighting_);
  if (has_ranges_) {
    bind(context_, vertex_pass_, "offsets", 2, offsets_);
    bind(context_, vertex_pass_, "scales", 3, scales_);
  }
  gl.Uniform1i(gl.GetUniformLocation(vertex_pass_.name(), "texels"), static_cast<GLint>(texels_));
  gl.Uniform1i(gl.GetUniformLocation(vertex_pass_.name(), "channels"), channels_);
  feed_back(context_, vertex_values_, scene_.positions.size(), "light times transfer");
}

std::vector<Rgb> Renderer::unit_albedo_exit_radiance() const {
  const Functions& gl = context_.gl();
  std::vector<glm::vec4> values(scene_.positions.size());
  gl.BindBuffer(GL_TEXTURE_BUFFER, vertex_values_.buffer.name());
  gl.GetBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(values.size() * sizeof(glm::vec4)),
                      values.data());
  context_.require_no_error("reading back");
  return {values.begin(), values.end()};
}

void Renderer::set_view(const scene::Camera& camera, const ViewSettings& settings) {
  require_valid(settings);
  if (settings.grid > tile_size_) {
    throw InputError(fmt::format("size: {}x{} rays a pixel are more than a frame buffer of this driver holds",
                                 settings.grid, settings.grid));
  }
  grid_ = sample_grid(camera, settings.width, settings.height, settings.grid);
  samples_a_side_ = settings.grid;
  std::vector<glm::vec4> planes(3 * scene_.triangles.size());
  constexpr std::size_t kBlock = 1024;
  parallel_for((scene_.triangles.size() + kBlock - 1) / kBlock, settings.threads, [&](std::size_t block) {
    const std::size_t end = std::min(scene_.triangles.size(), (block + 1) * kBlock);
    for (std::size_t t = block * kBlock; t < end; ++t) {
      const ScreenTriangle s = screen_triangle(scene_, static_cast<std::uint32_t>(t), grid_);
      planes[3 * t] = glm::vec4(s.a, s.x);
      planes[3 * t + 1] = glm::vec4(s.b, s.y);
      planes[3 * t + 2] = glm::vec4(s.c, s.is_front ? 1.0F : 0.0F);
    }
  });
  const Functions& gl = context_.gl();
  gl.BindBuffer(GL_TEXTURE_BUFFER, planes_.buffer.name());
  gl.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(planes.size() * sizeof(glm::vec4)), planes.data(),
                GL_DYNAMIC_DRAW);
  context_.require_no_error("uploading the view");
}

void Renderer::draw_tile(const Tile& tile) {
  const Functions& gl = context_.gl();
  const float zero[4] = {0.0F, 0.0F, 0.0F, 0.0F};
  const GLuint none[4] = {kNoTriangle, 0, 0, 0};
  const float far[1] = {0.0F};
  gl.Viewport(0, 0, tile.columns, tile.rows);
  gl.ClearBufferfv(GL_COLOR, 0, zero);
  gl.ClearBufferfv(GL_COLOR, 1, zero);
  gl.ClearBufferuiv(GL_COLOR, 2, none);
  gl.ClearBufferfv(GL_DEPTH, 0, far);
  const float nearest = nearest_depth(scene_, grid_);
  const glm::mat4 to_clip = clip_matrix(grid_, tile, nearest);
  const auto at = [&](const char* name) { return gl.GetUniformLocation(view_.name(), name); };
  gl.UniformMatrix4fv(at("to_clip"), 1, GL_FALSE, &to_clip[0][0]);
  gl.Uniform2i(at("first_sample"), tile.x, tile.y);
  gl.Uniform1f(at("nearest"), nearest);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * scene_.triangles.size()), GL_UNSIGNED_INT, nullptr);
  context_.require_no_error("drawing");
}

void Renderer::read_tile(Tile& tile) {
  const Functions& gl = context_.gl();
  const auto size = static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
  read_radiance_.resize(size);
  read_albedo_.resize(size);
  read_triangles_.resize(size);
  const auto read = [&](GLenum from, GLenum format, GLenum type, void* to) {
    gl.ReadBuffer(from);
    gl.ReadPixels(0, 0, tile.columns, tile.rows, format, type, to);
  };
  read(GL_COLOR_ATTACHMENT0, GL_RGBA, GL_FLOAT, read_radiance_.data());
  read(GL_COLOR_ATTACHMENT1, GL_RGBA, GL_FLOAT, read_albedo_.data());
  read(GL_COLOR_ATTACHMENT2, GL_RED_INTEGER, GL_UNSIGNED_INT, read_triangles_.data());
  context_.require_no_error("reading back");
  tile.radiance = read_radiance_;
  tile.albedo = read_albedo_;
  tile.triangles = read_triangles_;
}

void Renderer::draw(const std::function<void(const Tile&)>& use) {
  const Functions& gl = context_.gl();
  constexpr GLenum kBuffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  gl.DrawBuffers(3, kBuffers);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_GREATER);
  gl.UseProgram(view_.name());
  gl.BindVertexArray(triangles_.name());
  const std::pair<const char*, const TextureBuffer*> inputs[] = {{"planes", &planes_},
                                                                 {"corners", &corners_},
                                                                 {"vertex_values", &vertex_values_},
                                                                 {"texcoords", &texcoords_},
                                                                 {"colors", &colors_},
                                                                 {"materials", &materials_},
                                                                 {"textures", &textures_},
                                                                 {"texels", &texels_of_textures_}};
  int unit = 0;
  for (const auto& [name, buffer] : inputs) bind(context_, view_, name, unit++, *buffer);
  const auto flag = [&](const char* name, bool value) {
    gl.Uniform1i(gl.GetUniformLocation(view_.name(), name), value ? 1 : 0);
  };
  flag("has_texcoords", !scene_.texcoords.empty());
  flag("has_colors", !scene_.vertex_colors.empty());
  const Vec3 eye(grid_.eye);
  gl.Uniform3f(gl.GetUniformLocation(view_.name(), "eye"), eye.x, eye.y, eye.z);
  const int step = tile_size_ / samples_a_side_ * samples_a_side_;
  for (int y = 0; y < grid_.rows; y += step) {
    for (int x = 0; x < grid_.columns; x += step) {
      Tile tile{x, y, std::min(step, grid_.columns - x), std::min(step, grid_.rows - y), {}, {}, {}};
      draw_tile(tile);
      if (!use) continue;
      read_tile(tile);
      use(tile);
    }
  }
}

}  // namespace plumbline::relight::gl
