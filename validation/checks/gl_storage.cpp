#include "validation/checks/gl_storage.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/base/error.hpp"

namespace plumbline::checks {
namespace {

using relight::gl::Context;
using relight::gl::Renderer;
using relight::gl::Storage;
using relight::gl::Target;

double size_of_terms(const transfer::Transfer& transfer, const sh::ShRgb& lighting, std::size_t v, int c) {
  const std::span<const float> vector = transfer.vector(v, c);
  double sum = 0.0;
  for (std::size_t i = 0; i < vector.size(); ++i)
    sum += std::abs(static_cast<double>(vector[i]) * lighting.coefficients[i][c]);
  return sum;
}

std::vector<Rgb> radiance_of(const Context& context, const transfer::Baked& baked, const sh::ShRgb& lighting,
                             Storage storage) {
  Renderer renderer(context, baked.scene, baked.transfer, {storage});
  renderer.set_light(lighting);
  return renderer.unit_albedo_exit_radiance();
}

StorageError error_of(const std::vector<Rgb>& found, const std::vector<Rgb>& exact,
                      const transfer::Baked& baked, const sh::ShRgb& lighting) {
  StorageError result;
  double squares = 0.0;
  double sum = 0.0;
  for (std::size_t v = 0; v < exact.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const double difference = static_cast<double>(found[v][c]) - static_cast<double>(exact[v][c]);
      squares += difference * difference;
      sum += std::abs(static_cast<double>(exact[v][c]));
      const double terms = size_of_terms(baked.transfer, lighting, v, c);
      if (terms > 0.0) result.of_terms = std::max(result.of_terms, std::abs(difference) / terms);
    }
  }
  const double count = 3.0 * static_cast<double>(exact.size());
  result.relative_rmse = sum > 0.0 ? std::sqrt(squares / count) / (sum / count) : 0.0;
  return result;
}

sh::ShRgb scaled(sh::ShRgb lighting, double factor) {
  for (RgbD& l : lighting.coefficients) l *= factor;
  return lighting;
}

/// The largest magnitude among the samples; none when one is Inf or NaN.
std::optional<double> brightest(Renderer& renderer, const sh::ShRgb& lighting) {
  renderer.set_light(lighting);
  double largest = 0.0;
  bool is_finite_everywhere = true;
  renderer.draw([&](const relight::gl::Tile& tile) {
    for (const glm::vec4& sample : tile.radiance) {
      is_finite_everywhere &= is_finite(Vec3(sample));
      largest = std::max(largest, static_cast<double>(max_magnitude(Vec3(sample))));
    }
  });
  if (!is_finite_everywhere) return std::nullopt;
  return largest;
}

/// `radiance`: the brightest sample under the light itself. It grows with the light.
struct Searched {
  Renderer& renderer;
  const sh::ShRgb& lighting;
  double radiance;

  [[nodiscard]] bool holds(double scale) const {
    const std::optional<double> found = brightest(renderer, scaled(lighting, scale));
    return found && std::abs(*found - scale * radiance) <= std::ldexp(scale * radiance, -10);
  }
};

// A light that the target holds and one that is twice as bright and that it does not, then halving between them.
TargetRange range_of(const Searched& search) {
  int low = 0;  // of powers of 2: every target holds radiance 1
  int high = 256;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (search.holds(std::ldexp(1.0 / search.radiance, middle)) ? low : high) = middle;
  }
  double held = std::ldexp(1.0 / search.radiance, low);
  double lost = std::ldexp(1.0 / search.radiance, high);
  while (lost - held > 0.5e-5 * held) {
    const double middle = 0.5 * (held + lost);
    (search.holds(middle) ? held : lost) = middle;
  }
  TargetRange range;
  range.light_scale = held;
  range.largest_radiance = brightest(search.renderer, scaled(search.lighting, held)).value_or(0.0);
  range.saturates = brightest(search.renderer, scaled(search.lighting, 1.01 * lost)).has_value();
  return range;
}

}  // namespace

std::vector<StorageError> storage_errors(const Context& context, const transfer::Baked& baked,
                                         const sh::ShRgb& lighting) {
  const std::vector<Rgb> exact = radiance_of(context, baked, lighting, Storage::f32);
  std::vector<StorageError> result;
  for (const Storage storage : relight::gl::kStorages) {
    StorageError error = error_of(radiance_of(context, baked, lighting, storage), exact, baked, lighting);
    error.storage = storage;
    error.bytes_per_vertex = relight::gl::pack(baked.transfer, storage).bytes.size() /
                             std::max<std::size_t>(1, baked.transfer.vertices);
    result.push_back(error);
  }
  return result;
}

std::vector<TargetRange> target_ranges(const Context& context, const transfer::Baked& baked,
                                       const sh::ShRgb& lighting, const scene::Camera& camera) {
  std::vector<TargetRange> result;
  double radiance = 0.0;
  for (const Target target : {Target::f32, Target::f16}) {
    Renderer renderer(context, baked.scene, baked.transfer, {Storage::f32, target});
    renderer.set_view(camera, {64, 64, 1, 0});
    if (target == Target::f32) radiance = brightest(renderer, lighting).value_or(0.0);
    if (!(radiance > 0.0)) throw InputError("light: the image of the scene under it is black");
    result.push_back(range_of({renderer, lighting, radiance}));
    result.back().target = target;
  }
  return result;
}

}  // namespace plumbline::checks
