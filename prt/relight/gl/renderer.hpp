// prt/relight/gl/renderer.hpp: light times transfer, in OpenGL 3.3.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "prt/relight/cpu.hpp"
#include "prt/relight/gl/object.hpp"
#include "prt/relight/gl/storage.hpp"
#include "prt/relight/screen_triangle.hpp"
#include "prt/sh/lighting.hpp"

namespace plumbline::relight::gl {

/// What an image is drawn into. A half holds up to 65504 and has 11 bits.
enum class Target { f32, f16 };
[[nodiscard]] std::string_view to_string(Target target);
/// @throws InputError listing the targets there are.
[[nodiscard]] Target target_from_string(std::string_view text);

struct RendererSettings {
  Storage storage = Storage::f32;
  Target target = Target::f32;
  bool allows_double = true;  // sums of the vertex pass, where the driver has GL_ARB_gpu_shader_fp64
  int largest_tile = 1024;    // samples a side; smaller where the driver's frame buffers are
};

/// Samples [x, x + columns) x [y, y + rows) of an image, row 0 at the top.
struct Tile {
  int x = 0;
  int y = 0;
  int columns = 0;
  int rows = 0;
  std::span<const glm::vec4> radiance;       // alpha 1 where a triangle is seen, else 0
  std::span<const glm::vec4> albedo;         // 0 on back faces
  std::span<const std::uint32_t> triangles;  // kNoTriangle where none is seen
};
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// A baked scene on the OpenGL side. The context, which must be current, and the scene must outlive it.
class Renderer {
 public:
  /// @throws InputError when the scene and the transfer do not belong together, or are larger than the driver's buffers;
  /// DeviceError when the driver refuses a shader or is out of memory.
  Renderer(const Context& context, const scene::Scene& scene, const transfer::Transfer& transfer,
           const RendererSettings& settings);

  /// Exit radiance for unit albedo at all vertices: one dot product a vertex and channel, in the vertex shader.
  /// @throws InputError when the lighting has fewer bands than the transfer.
  void set_light(const sh::ShRgb& lighting);
  /// What set_light() found, read back.
  [[nodiscard]] std::vector<Rgb> unit_albedo_exit_radiance() const;

  /// @throws InputError as relight::render_view().
  void set_view(const scene::Camera& camera, const ViewSettings& settings);
  /// Draws all samples, tile after tile; a tile starts and ends at whole pixels, and its spans end with the call. Without
  /// `use` nothing is read back.
  void draw(const std::function<void(const Tile&)>& use);

  /// "double" or "float": how the vertex pass adds.
  [[nodiscard]] std::string_view sums() const { return sums_in_double_ ? "double" : "float"; }

 private:
  void upload_scene(const scene::Scene& scene);
  void upload_materials(const scene::Scene& scene);
  void upload_transfer(const transfer::Transfer& transfer, Storage storage);
  void make_tile_buffers();
  void draw_tile(const Tile& tile);
  void read_tile(Tile& tile);

  const Context& context_;
  const scene::Scene& scene_;
  RendererSettings settings_;
  bool sums_in_double_;
  int bands_;
  int channels_;
  std::size_t texels_ = 0;
  bool has_ranges_;

  Object vertex_pass_;
  Object view_;
  Object no_attributes_;
  Object triangles_;  // vertex array
  Object positions_;
  Object elements_;
  TextureBuffer transfer_, offsets_, scales_, lighting_, vertex_values_;
  TextureBuffer planes_, corners_, texcoords_, colors_, materials_, textures_, texels_of_textures_;
  Object framebuffer_, radiance_, albedo_, triangle_, depth_;

  SampleGrid grid_;
  int samples_a_side_ = 1;  // of a pixel
  int tile_size_ = 0;
  std::vector<glm::vec4> read_radiance_, read_albedo_;
  std::vector<std::uint32_t> read_triangles_;
};

/// relight::render_view() in OpenGL: the same channels, with `background` looked up on the CPU.
[[nodiscard]] image::LayeredImage render_view(Renderer& renderer, const scene::Camera& camera,
                                              const ViewSettings& settings,
                                              const std::function<Rgb(const Vec3& direction)>& background);

}  // namespace plumbline::relight::gl
