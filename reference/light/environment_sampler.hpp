// reference/light/environment_sampler.hpp: directions drawn in proportion to an environment's radiance.
#pragma once

#include <optional>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/light/sky_density.hpp"

namespace plumbline::light {

struct DirectionSample {
  Vec3 direction{0.0F};  // unit
  double pdf = 0.0;      // per solid angle [sr^-1], > 0
  Rgb radiance{0.0F};    // from that direction
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

 private:
  struct Cone {
    const SunDisc* sun = nullptr;
    double probability = 0.0;  // of being chosen
    double density = 0.0;      // 1 / solid angle
  };
  void add_cones();
  void share(double sky_power, double cone_power);
  [[nodiscard]] std::optional<DirectionSample> sample_towards(const Vec3& direction) const;
  [[nodiscard]] std::optional<DirectionSample> sample_sky(double x, double y) const;
  [[nodiscard]] std::optional<DirectionSample> sample_cones(double x, double y) const;
  [[nodiscard]] Vec3 inside_cone(const Cone& cone, double x, double y) const;
  [[nodiscard]] Vec3 to_world(const Vec3d& local_direction) const;

  const Environment* environment_;
  bool is_black_ = true;
  SkyDensity sky_;
  double sky_probability_ = 0.0;
  std::vector<Cone> cones_;
};

}  // namespace plumbline::light
