#include "prt/relight/gl/renderer.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::relight::gl {
namespace {

struct Images {
  image::Image mean;
  image::Image sky;
  image::Image albedo;
};

// The same sums in the same order as on the CPU.
void add_pixel(const Tile& tile, const SampleGrid& samples, int grid, int px, int py, Images& images,
               const std::function<Rgb(const Vec3&)>& background) {
  RgbD sums[3] = {};
  for (int k = 0; k < grid * grid; ++k) {
    const int column = px * grid + k % grid;
    const int row = py * grid + k / grid;
    const auto i = static_cast<std::size_t>(row - tile.y) * static_cast<std::size_t>(tile.columns) +
                   static_cast<std::size_t>(column - tile.x);
    const bool is_sky = tile.triangles[i] == kNoTriangle;
    const Rgb sky = is_sky && background ? background(sample_direction(samples, column, row)) : Rgb(0.0F);
    sums[0] += is_sky ? RgbD(sky) : RgbD(tile.radiance[i]);
    sums[1] += RgbD(sky);
    sums[2] += RgbD(tile.albedo[i]);
  }
  const double rays = grid * grid;
  images.mean.at(px, py) = Rgb(sums[0] / rays);
  images.sky.at(px, py) = Rgb(sums[1] / rays);
  images.albedo.at(px, py) = Rgb(sums[2] / rays);
}

}  // namespace

image::LayeredImage render_view(Renderer& renderer, const scene::Camera& camera, const ViewSettings& settings,
                                const std::function<Rgb(const Vec3&)>& background) {
  renderer.set_view(camera, settings);
  const SampleGrid samples = sample_grid(camera, settings.width, settings.height, settings.grid);
  Images images;
  images.mean = image::make_image(settings.width, settings.height);
  images.sky = images.mean;
  images.albedo = images.mean;
  renderer.draw([&](const Tile& tile) {
    const int first = tile.y / settings.grid;
    parallel_for(static_cast<std::size_t>(tile.rows / settings.grid), settings.threads, [&](std::size_t row) {
      for (int x = tile.x / settings.grid; x < (tile.x + tile.columns) / settings.grid; ++x)
        add_pixel(tile, samples, settings.grid, x, first + static_cast<int>(row), images, background);
    });
  });
  return view_layers(images.mean, images.sky, images.albedo, settings.grid);
}

}  // namespace plumbline::relight::gl
