#include "validation/conformance/subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>

namespace plumbline::conformance {
namespace {

constexpr std::size_t kGuard = 64;  // values on each side
// NaNs with payloads that no arithmetic gives.
constexpr std::uint64_t kGuardBits = 0x7ff8'6a75'6172'6400;
constexpr std::uint64_t kMarkerBits = 0x7ff8'656d'7074'7900;

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

/// Values between guards.
class Guarded {
 public:
  explicit Guarded(std::size_t size)
      : size_(size), values_(size + 2 * kGuard, std::bit_cast<double>(kGuardBits)) {}

  [[nodiscard]] double* data() { return values_.data() + kGuard; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool is_intact() const {
    const auto is_guard = [](double v) { return std::bit_cast<std::uint64_t>(v) == kGuardBits; };
    return std::all_of(values_.begin(), values_.begin() + kGuard, is_guard) &&
           std::all_of(values_.end() - kGuard, values_.end(), is_guard);
  }

 private:
  std::size_t size_;
  std::vector<double> values_;
};

/// Pixels as floats, followed and preceded by NaN: a read outside shows in what is made of it.
std::vector<float> guarded_pixels(const std::vector<Rgb>& pixels, std::size_t guard) {
  std::vector<float> result(guard, std::numeric_limits<float>::quiet_NaN());
  for (const Rgb& p : pixels) result.insert(result.end(), {p.r, p.g, p.b});
  result.resize(result.size() + guard, std::numeric_limits<float>::quiet_NaN());
  return result;
}

Values flattened(const std::vector<Vec3d>& vectors) {
  Values result;
  for (const Vec3d& v : vectors) result.insert(result.end(), {v.x, v.y, v.z});
  return result;
}

int declared_bands(const plumbline_implementation& implementation) {
  constexpr int kMostJudged = 20;
  return std::clamp(implementation.max_bands, 1, kMostJudged);
}

}  // namespace

/// The arrays of one call.
class Subject::Call {
 public:
  Call(Subject& subject, const char* operation) : subject_(&subject), operation_(operation) {}

  const double* in(const Values& values) {
    inputs_.push_back({std::make_unique<Guarded>(values.size()), values});
    std::copy(values.begin(), values.end(), inputs_.back().array->data());
    return inputs_.back().array->data();
  }
  double* out(std::size_t size) {
    outputs_.push_back(std::make_unique<Guarded>(size));
    std::fill_n(outputs_.back()->data(), size, std::bit_cast<double>(kMarkerBits));
    return outputs_.back()->data();
  }
  /// What the call came to: the first output, unless it was refused.
  Answer finish(int status) {
    for (const Input& input : inputs_) {
      if (std::memcmp(input.array->data(), input.sent.data(), input.sent.size() * sizeof(double)) != 0)
        subject_->note(fmt::format("{} changes its input", operation_));
      if (!input.array->is_intact()) subject_->note(fmt::format("{} writes beside its input", operation_));
    }
    for (const auto& output : outputs_) {
      if (!output->is_intact()) subject_->note(fmt::format("{} writes outside its output", operation_));
    }
    if (status != 0) return std::nullopt;
    for (const auto& output : outputs_) note_unwritten(*output);
    return values(0);
  }
  [[nodiscard]] Values values(std::size_t output) const {
    return {outputs_[output]->data(), outputs_[output]->data() + outputs_[output]->size()};
  }

 private:
  struct Input {
    std::unique_ptr<Guarded> array;
    Values sent;
  };
  void note_unwritten(Guarded& output) {
    const auto left = std::count_if(output.data(), output.data() + output.size(),
                                    [](double v) { return std::bit_cast<std::uint64_t>(v) == kMarkerBits; });
    if (left > 0)
      subject_->note(
          fmt::format("{} leaves {} of {} output values unwritten", operation_, left, output.size()));
  }

  Subject* subject_;
  const char* operation_;
  std::vector<Input> inputs_;
  std::vector<std::unique_ptr<Guarded>> outputs_;
};

Subject::Subject(const plumbline_implementation& implementation)
    : Subject(implementation, implementation.convention) {}

Subject::Subject(const plumbline_implementation& implementation, const plumbline_convention& convention)
    : implementation_(&implementation), border_(convention, declared_bands(implementation)) {}

double Subject::epsilon() const {
  return implementation_->precision == PLUMBLINE_PRECISION_FLOAT ? std::numeric_limits<float>::epsilon()
                                                                 : std::numeric_limits<double>::epsilon();
}

void Subject::note(const std::string& misdeed) {
  if (std::find(misdeeds_.begin(), misdeeds_.end(), misdeed) == misdeeds_.end()) misdeeds_.push_back(misdeed);
}

Answer Subject::converted(int bands, const Answer& answer) const {
  if (!answer) return answer;
  return border_.to_ours(bands, *answer);
}

Answer Subject::basis(int bands, const std::vector<Vec3d>& directions) {
  Call call(*this, "evaluate_basis");
  const double* in = call.in(flattened(directions));
  const Answer raw = call.finish(implementation_->evaluate_basis(
      bands, directions.size(), in, call.out(directions.size() * size_of(bands))));
  if (!raw) return raw;
  Values result;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const auto first = raw->begin() + static_cast<std::ptrdiff_t>(k * size_of(bands));
    const Values row =
        border_.basis_to_ours(bands, {first, first + static_cast<std::ptrdiff_t>(size_of(bands))});
    result.insert(result.end(), row.begin(), row.end());
  }
  return result;
}

Answer Subject::hemisphere_basis(int bands, const std::vector<Vec3d>& directions) {
  Call call(*this, "evaluate_hemisphere_basis");
  const double* in = call.in(flattened(directions));
  return call.finish(implementation_->evaluate_hemisphere_basis(
      bands, directions.size(), in, call.out(directions.size() * size_of(bands))));
}

Answer Subject::project_lat_long(int bands, const image::Image& image) {
  Call call(*this, "project_lat_long");
  const auto guard = static_cast<std::size_t>(3 * image.width);
  const std::vector<float> pixels = guarded_pixels(image.pixels, guard);
  const Answer raw = call.finish(implementation_->project_lat_long(
      bands, image.width, image.height, pixels.data() + guard, call.out(3 * size_of(bands))));
  return raw ? Answer(border_.rgb_to_ours(bands, *raw)) : raw;
}

Answer Subject::project_cube(int bands, int size, const std::vector<Rgb>& texels) {
  Call call(*this, "project_cube");
  const auto guard = static_cast<std::size_t>(3 * size);
  const std::vector<float> pixels = guarded_pixels(texels, guard);
  const Answer raw = call.finish(
      implementation_->project_cube(bands, size, pixels.data() + guard, call.out(3 * size_of(bands))));
  return raw ? Answer(border_.rgb_to_ours(bands, *raw)) : raw;
}

Answer Subject::lookup_lat_long(const image::Image& image, const Vec3d& direction) {
  Call call(*this, "lookup_lat_long");
  const auto guard = static_cast<std::size_t>(3 * image.width);
  const std::vector<float> pixels = guarded_pixels(image.pixels, guard);
  const double* in = call.in({direction.x, direction.y, direction.z});
  return call.finish(
      implementation_->lookup_lat_long(image.width, image.height, pixels.data() + guard, in, call.out(3)));
}

Answer Subject::rotate(int bands, const glm::dmat3& rotation, const Values& in) {
  Call call(*this, "rotate");
  Values rows;  // GLM keeps columns
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rows.push_back(rotation[column][row]);
  const double* matrix = call.in(rows);
  const double* coefficients = call.in(border_.to_theirs(bands, in));
  return converted(
      bands, call.finish(implementation_->rotate(bands, matrix, coefficients, call.out(size_of(bands)))));
}

Answer Subject::multiply(int bands, const Values& a, const Values& b) {
  Call call(*this, "multiply");
  const double* first = call.in(border_.to_theirs(bands, a));
  const double* second = call.in(border_.to_theirs(bands, b));
  return converted(bands,
                   call.finish(implementation_->multiply(bands, first, second, call.out(size_of(bands)))));
}

Answer Subject::exponential(int bands, const Values& in) {
  Call call(*this, "exponential");
  const double* a = call.in(border_.to_theirs(bands, in));
  return converted(bands, call.finish(implementation_->exponential(bands, a, call.out(size_of(bands)))));
}

Answer Subject::logarithm(int bands, const Values& in) {
  Call call(*this, "logarithm");
  const double* a = call.in(border_.to_theirs(bands, in));
  return converted(bands, call.finish(implementation_->logarithm(bands, a, call.out(size_of(bands)))));
}

Answer Subject::rotate_zonal(int bands, const Values& zonal, const Vec3d& axis) {
  Call call(*this, "rotate_zonal");
  const double* z = call.in(zonal);
  const double* d = call.in({axis.x, axis.y, axis.z});
  return converted(bands, call.finish(implementation_->rotate_zonal(bands, z, d, call.out(size_of(bands)))));
}

Answer Subject::irradiance(int bands, const Values& coefficients, const Vec3d& normal) {
  Call call(*this, "irradiance");
  const double* c = call.in(border_.to_theirs(bands, coefficients));
  const double* n = call.in({normal.x, normal.y, normal.z});
  return call.finish(implementation_->irradiance(bands, c, n, call.out(1)));
}

Answer Subject::light_directional(int bands, const Vec3d& direction) {
  Call call(*this, "light_directional");
  const double* d = call.in({direction.x, direction.y, direction.z});
  return converted(bands,
                   call.finish(implementation_->light_directional(bands, d, call.out(size_of(bands)))));
}

Answer Subject::light_cone(int bands, const Vec3d& direction, double half_angle_rad) {
  Call call(*this, "light_cone");
  const double* d = call.in({direction.x, direction.y, direction.z});
  return converted(
      bands, call.finish(implementation_->light_cone(bands, d, half_angle_rad, call.out(size_of(bands)))));
}

Answer Subject::light_sphere(int bands, const Vec3d& centre, double radius) {
  Call call(*this, "light_sphere");
  const double* c = call.in({centre.x, centre.y, centre.z});
  return converted(bands,
                   call.finish(implementation_->light_sphere(bands, c, radius, call.out(size_of(bands)))));
}

Answer Subject::light_hemisphere(int bands, const Vec3d& up, double top, double bottom) {
  Call call(*this, "light_hemisphere");
  const double* u = call.in({up.x, up.y, up.z});
  return converted(
      bands, call.finish(implementation_->light_hemisphere(bands, u, top, bottom, call.out(size_of(bands)))));
}

// Exit radiance for unit albedo is T . l: transfer goes with the reciprocal of what multiplies the light.
Answer Subject::transfer_unshadowed(int bands, const Vec3d& normal) {
  Call call(*this, "transfer_unshadowed");
  const double* n = call.in({normal.x, normal.y, normal.z});
  const Answer raw = call.finish(implementation_->transfer_unshadowed(bands, n, call.out(size_of(bands))));
  return raw ? Answer(border_.dual_to_ours(bands, *raw)) : raw;
}

Answer Subject::relight(int bands, const Values& transfer, const Values& lighting) {
  Call call(*this, "relight");
  const double* t = call.in(border_.dual_to_theirs(bands, transfer));
  const double* l = call.in(border_.to_theirs(bands, lighting));
  return call.finish(implementation_->relight(bands, t, l, call.out(1)));
}

Answer Subject::window(int bands, const Values& in) {
  Call call(*this, "window");
  const double* a = call.in(border_.to_theirs(bands, in));
  return converted(bands, call.finish(implementation_->window(bands, a, call.out(size_of(bands)))));
}

Answer Subject::dominant_direction(int bands, const Values& coefficients) {
  Call call(*this, "dominant_direction");
  const double* c = call.in(border_.to_theirs(bands, coefficients));
  return call.finish(implementation_->dominant_direction(bands, c, call.out(3)));
}

std::optional<Subject::Samples> Subject::sample_directions(int distribution, std::uint64_t seed,
                                                           std::uint64_t stream, std::size_t count) {
  Call call(*this, "sample_directions");
  double* directions = call.out(3 * count);
  double* densities = call.out(count);
  const Answer raw = call.finish(
      implementation_->sample_directions(distribution, seed, stream, count, directions, densities));
  if (!raw) return std::nullopt;
  Samples samples{{}, call.values(1)};
  for (std::size_t i = 0; i < count; ++i)
    samples.directions.emplace_back((*raw)[3 * i], (*raw)[3 * i + 1], (*raw)[3 * i + 2]);
  return samples;
}

Answer Subject::mean_and_error(const Values& samples) {
  Call call(*this, "mean_and_error");
  const double* in = call.in(samples);
  return call.finish(implementation_->mean_and_error(samples.size(), in, call.out(2)));
}

Answer Subject::rmse(const Values& reference, const Values& test) {
  Call call(*this, "rmse");
  const double* a = call.in(reference);
  const double* b = call.in(test);
  return call.finish(implementation_->rmse(reference.size(), a, b, call.out(1)));
}

}  // namespace plumbline::conformance
