// reference/light/environment_sampler.hpp: directions drawn in proportion to an environment's radiance.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/light/sky_blocks.hpp"
#include "reference/light/sky_density.hpp"

namespace plumbline::light {

struct DirectionSample {
  Vec3 direction{0.0F};  // unit
  double pdf = 0.0;      // per solid angle [sr^-1]
  Rgb radiance{0.0F};    // from that direction
};

/// The same, drawn about a normal. Reading the image costs a cache miss; what lies behind something is never asked for it.
struct LobeSample {
  Vec3 direction{0.0F};        // unit
  double pdf = 0.0;            // per solid angle [sr^-1]; 0: nothing was drawn
  const Rgb* texel = nullptr;  // of the environment, which holds the radiance; else `value` does
  Rgb value{0.0F};

  [[nodiscard]] Rgb radiance() const { return texel != nullptr ? *texel : value; }
};

/// Draws directions with a density that is positive wherever the radiance is not zero, and proportional to
/// its magnitude (largest of |r|, |g|, |b|) up to the resolution of the tables:
/// - constant sky: uniform over the sphere;
/// - lat-long image: every texel by its magnitude times its exact solid angle, uniform in solid angle inside;
/// - cube map: every texel likewise, uniform on the face inside;
/// - angular map and analytic: a table over lat-long cells filled from the largest of several lookups in each
///   cell and on its border, with 5 % uniform;
/// - bilinear lookup: lat-long images by the interpolated magnitudes themselves, cell by cell between texel
///   centres (density and magnitude differ by 1/2 to 3/2 beside a pole, and less the smaller the texels); cube
///   and angular maps as above, each texel's magnitude the largest of the 3 x 3 around it: a lone bright texel
///   costs a relative variance of up to 9 in a cube, 17 in an angular map and more at its rim;
/// - suns: their own cones, uniform in solid angle.
/// The density is the mixture of all of these: by power (magnitude times solid angle), but where there are
/// both a sky and suns at least 10 % for each, for the places that see only one of them. Deterministic in u.
/// Cost: about 0.3 us a sample and 50 ns a pdf from an image of 1024 x 512, 5 ms and 6 bytes a texel (bilinear: 10)
/// to build. Keeps a copy of nothing but its tables: the environment must outlive it.
class EnvironmentSampler {
 public:
  /// @throws InputError when an image is empty or the faces of a cube are not equal squares, when a radiance
  /// is not finite, or when a sun's direction is not unit or its half angle not in (0, pi].
  explicit EnvironmentSampler(const Environment& environment);

  /// None when the environment is black. u in [0, 1)^2. The result's radiance and pdf are exactly radiance()
  /// and pdf() of the result's direction. (Also none where the bright texels of a turned image are smaller
  /// than the rounding of a float direction: polar rows of images more than 8192 wide.)
  [[nodiscard]] std::optional<DirectionSample> sample(Vec2 u) const;
  /// Density with which sample() gives this direction; 0 for a black environment.
  [[nodiscard]] double pdf(const Vec3& direction) const;
  [[nodiscard]] bool is_black() const { return is_black_; }

  /// What sampling about one normal needs, made once for all samples of a point.
  struct Lobe {
    Vec3 normal{0.0F, 1.0F, 0.0F};
    SkyBlocks::Lobe sky;
    double sky_probability = 0.0;
    double cone_total = 0.0;
  };
  [[nodiscard]] Lobe lobe(const Vec3& normal) const;
  /// A direction above or near the horizon of the lobe's normal, drawn nearly in proportion to radiance times the clamped
  /// cosine: either of the sky (result's radiance: the sky's alone) or of one sun (the sun's alone), so that radiance / pdf
  /// estimates the integral over both. The density is positive wherever radiance times cosine is not zero. None when nothing
  /// is above the horizon, sometimes when little is.
  [[nodiscard]] std::optional<DirectionSample> sample(const Lobe& lobe, Vec2 u) const;
  /// One sample for each of up to kMostTogether points; pdf 0 stands for none. Faster than one by one: the samples' memory
  /// is fetched together.
  static constexpr std::size_t kMostTogether = 8;
  void sample(const Lobe& lobe, std::span<const Vec2> points, std::span<LobeSample> samples) const;

 private:
  struct Cone {
    const SunDisc* sun = nullptr;
    double probability = 0.0;  // of being chosen
    double density = 0.0;      // 1 / solid angle
    double power = 0.0;        // magnitude times solid angle
  };
  void add_cones();
  void share(double sky_power, double cone_power);
  [[nodiscard]] std::optional<DirectionSample> sample_towards(const Vec3& direction) const;
  [[nodiscard]] std::optional<DirectionSample> sample_sky(double x, double y) const;
  [[nodiscard]] std::optional<DirectionSample> sample_cones(double x, double y) const;
  [[nodiscard]] Vec3 inside_cone(const Cone& cone, double x, double y) const;
  [[nodiscard]] Vec3 to_world(const Vec3d& local_direction) const;
  void add_blocks();
  [[nodiscard]] double cone_weight(const Cone& cone, const Vec3d& local_normal) const;
  template <class Density>
  void sample_sky(const Density& density, const Lobe& lobe, std::span<const glm::dvec2> numbers,
                  std::span<LobeSample> samples) const;
  [[nodiscard]] LobeSample sample_cones(const Lobe& lobe, double x, double y) const;

  const Environment* environment_;
  glm::dmat3 to_world_{1.0};
  bool is_black_ = true;
  SkyDensity sky_;
  SkyBlocks blocks_;  // of sky_, where it has a table
  double sky_power_ = 0.0;
  double sky_probability_ = 0.0;
  std::vector<Cone> cones_;
};

}  // namespace plumbline::light
