// Projection of environments onto SH: project_radiance of lighting.hpp.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "prt/sh/lighting.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/texels.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::sh {
namespace {

using Coefficients = std::vector<RgbD>;
using Matrix = glm::dmat3;

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(coefficient_count(bands));
}

/// Sum over i = 0 … count-1 of what add(i, sum) adds. The blocks and their places in the sum depend on count
/// only, so that the bits do not depend on the threads.
Coefficients sum_in_blocks(std::size_t count, int bands, int threads,
                           const std::function<void(std::size_t, Coefficients&)>& add) {
  constexpr std::size_t kBlocks = 32;
  const std::size_t blocks = std::min(count, kBlocks);
  std::vector<Coefficients> partial(blocks);
  parallel_for(blocks, threads, [&](std::size_t block) {
    Coefficients sum(size_of(bands), RgbD(0.0));
    for (std::size_t i = block * count / blocks; i < (block + 1) * count / blocks; ++i) add(i, sum);
    partial[block] = std::move(sum);
  });
  Coefficients total(size_of(bands), RgbD(0.0));
  for (const Coefficients& part : partial) {
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += part[i];
  }
  return total;
}

// ---------------------------------------------------------------- grids with a polar axis
//
// In a frame whose z is the grid's polar axis, y_lm = Q_lm(theta) cos(m phi) and y_l,-m = Q_lm(theta) sin(m
// phi), where Q_lm(theta) = y_lm(theta, phi = 0). For radiance that is constant over the cells of a grid the
// integral separates into
//
//   c_l,+-m = sum over rows of q_lm(row) f_+-m(row),
//   q_lm = integral over the row of Q_lm sin(theta) d theta,
//   f_+-m = sum over columns of L * integral over the column of cos(m phi) or sin(m phi) d phi.
//
// f is 2 bands - 1 numbers a row, whatever the degree. The result is then turned from the grid's frame to the
// world.

/// A circle of constant colatitude, with the weight of its point in the integral over theta.
struct Ring {
  double cosine = 0.0;
  double sine = 0.0;
  double weight = 0.0;
};

/// integral of cos(m phi) and sin(m phi) over each column (or width * value at its middle): [column][cos 0 …
/// n-1, sin 0 … n-1], for columns that start at phi = start_half_turns * pi.
std::vector<double> azimuth_table(int columns, int bands, int start_half_turns, bool integrate_cells) {
  std::vector<double> table;
  table.reserve(2 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(bands));
  std::vector<double> scale;
  for (int m = 0; m < bands; ++m) {
    const double width = 2.0 * kPi / columns;
    scale.push_back(m > 0 && integrate_cells ? 2.0 / m * std::sin(0.5 * m * width) : width);
    if (start_half_turns % 2 != 0 && m % 2 == 1) scale.back() = -scale.back();
  }
  // The angle m pi (2c + 1) / columns is reduced as an integer, so that it is exact for every m.
  const auto angle = [&](int m, int column) {
    const long long turns = static_cast<long long>(m) * (2LL * column + 1) % (2LL * columns);
    return kPi * static_cast<double>(turns) / columns;
  };
  for (int column = 0; column < columns; ++column) {
    for (int m = 0; m < bands; ++m) {
      table.push_back(scale[static_cast<std::size_t>(m)] * std::cos(angle(m, column)));
    }
    for (int m = 0; m < bands; ++m) {
      table.push_back(scale[static_cast<std::size_t>(m)] * std::sin(angle(m, column)));
    }
  }
  return table;
}

/// Moments of one row: for each of r, g, b the 2 n sums over columns of radiance times the table.
void azimuth_moments(std::span<const Rgb> row, const std::vector<double>& table, std::size_t stride,
                     std::vector<double>& moments) {
  moments.assign(3 * stride, 0.0);
  double* red = moments.data();
  double* green = red + stride;
  double* blue = green + stride;
  for (std::size_t column = 0; column < row.size(); ++column) {
    const double* values = table.data() + column * stride;
    const RgbD radiance(row[column]);
    for (std::size_t k = 0; k < stride; ++k) red[k] += radiance.r * values[k];
    for (std::size_t k = 0; k < stride; ++k) green[k] += radiance.g * values[k];
    for (std::size_t k = 0; k < stride; ++k) blue[k] += radiance.b * values[k];
  }
}

/// The integral of Q_lm over one row, at the places of y_lm, m >= 0.
void integrate_rings(const Basis<double>& basis, std::span<const Ring> rings, std::vector<double>& scratch,
                     std::vector<double>& integral) {
  integral.assign(size_of(basis.bands()), 0.0);
  scratch.resize(integral.size());
  for (const Ring& ring : rings) {
    basis.evaluate(ring.sine, 0.0, ring.cosine, scratch);
    for (std::size_t i = 0; i < integral.size(); ++i) integral[i] += ring.weight * scratch[i];
  }
}

struct Grid {
  std::size_t rows = 0;
  int columns = 0;
  std::vector<double> azimuth;                              // azimuth_table
  std::function<std::vector<Ring>(std::size_t row)> rings;  // weights include sin(theta) d theta
  std::function<void(std::size_t row, std::span<Rgb> radiance)> read;
};

Coefficients project_grid(const Grid& grid, int bands, int threads) {
  const Basis<double> basis(bands);
  const auto n = static_cast<std::size_t>(bands);
  return sum_in_blocks(grid.rows, bands, threads, [&](std::size_t row, Coefficients& sum) {
    std::vector<Rgb> radiance(static_cast<std::size_t>(grid.columns));
    grid.read(row, radiance);
    std::vector<double> moments;
    azimuth_moments(radiance, grid.azimuth, 2 * n, moments);
    std::vector<double> scratch;
    std::vector<double> q;
    integrate_rings(basis, grid.rings(row), scratch, q);
    const double* f = moments.data();
    for (int l = 0; l < bands; ++l) {
      for (int m = 0; m <= l; ++m) {
        const auto k = static_cast<std::size_t>(m);
        const auto plus = static_cast<std::size_t>(index(l, m));
        sum[plus] += q[plus] * RgbD(f[k], f[2 * n + k], f[4 * n + k]);
        if (m == 0) continue;
        const auto minus = static_cast<std::size_t>(index(l, -m));
        sum[minus] += q[plus] * RgbD(f[n + k], f[3 * n + k], f[5 * n + k]);
      }
    }
  });
}

/// Coefficients of g(R^-1 w) from those of g, R orthogonal (mirrors included): evaluated at the nodes of a
/// rule that is exact for the degree, and projected again.
Coefficients turned(const Coefficients& coefficients, int bands, const Matrix& to_world, int threads) {
  if (to_world == Matrix(1.0)) return coefficients;
  const std::vector<SphereNode> nodes = sphere_quadrature(bands);
  const Basis<double> basis(bands);
  const Matrix from_world = glm::transpose(to_world);
  return sum_in_blocks(nodes.size(), bands, threads, [&](std::size_t k, Coefficients& sum) {
    std::vector<double> values(size_of(bands));
    const Vec3d d = glm::normalize(from_world * nodes[k].direction);
    basis.evaluate(d.x, d.y, d.z, values);
    RgbD value(0.0);
    for (std::size_t i = 0; i < values.size(); ++i) value += values[i] * coefficients[i];
    value *= nodes[k].weight;
    basis.evaluate(nodes[k].direction.x, nodes[k].direction.y, nodes[k].direction.z, values);
    for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i] * value;
  });
}

/// Grid frame (polar axis +Y, azimuth from +X to +Z) to environment frame. A mirror, which is no matter here.
Matrix grid_to_environment() {
  return Matrix(Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, 0.0, 1.0), Vec3d(0.0, 1.0, 0.0));
}

// ---------------------------------------------------------------- skies

void require_image(const image::Image& image, const std::string& name) {
  const auto count = static_cast<std::size_t>(std::max(image.width, 0)) *
                     static_cast<std::size_t>(std::max(image.height, 0));
  if (count == 0 || image.pixels.size() != count) {
    throw InputError(name + ": expected width x height > 0 texels, got " + std::to_string(image.width) +
                     " x " + std::to_string(image.height) + " and " + std::to_string(image.pixels.size()) +
                     " texels");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (is_finite(image.pixels[i])) continue;
    const auto width = static_cast<std::size_t>(image.width);
    throw InputError(name + ": texel (" + std::to_string(i % width) + ", " + std::to_string(i / width) +
                     ") is not finite");
  }
}

void require_square(const image::Image& image, const std::string& name) {
  require_image(image, name);
  if (image.width != image.height) {
    throw InputError(name + ": expected a square image, got " + std::to_string(image.width) + " x " +
                     std::to_string(image.height));
  }
}

struct Task {
  const std::string& name;
  Matrix rotation;  // environment to world
  int bands;
  int threads;
};

Coefficients project(const light::ConstantSky& sky, const Task& task) {
  if (!is_finite(sky.radiance)) throw InputError(task.name + ": radiance is not finite");
  Coefficients result(size_of(task.bands), RgbD(0.0));
  result[0] = RgbD(sky.radiance) * std::sqrt(4.0 * kPi);
  return result;
}

// Q_lm sin(theta) is a trigonometric polynomial of degree l + 1 in theta (for every m: the root in sin(theta)
// does not appear), so Gauss nodes in theta converge at once; their number makes the error rounding.
Coefficients project(const light::LatLongSky& sky, const Task& task) {
  require_image(sky.image, task.name);
  const int height = sky.image.height;
  const double step = kPi / height;
  const GaussLegendre rule = gauss_legendre(gauss_count(task.bands * step, 1e-16));
  const auto width = static_cast<std::size_t>(sky.image.width);
  Grid grid;
  grid.rows = static_cast<std::size_t>(height);
  grid.columns = sky.image.width;
  grid.azimuth = azimuth_table(grid.columns, task.bands, -1, true);
  grid.rings = [&](std::size_t row) {
    std::vector<Ring> rings;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double theta = step * (static_cast<double>(row) + 0.5 + 0.5 * rule.nodes[k]);
      const double sine = std::sin(theta);
      rings.push_back({std::cos(theta), sine, 0.5 * step * rule.weights[k] * sine});
    }
    return rings;
  };
  grid.read = [&](std::size_t row, std::span<Rgb> radiance) {
    std::copy_n(sky.image.pixels.begin() + static_cast<std::ptrdiff_t>(row * width), width, radiance.begin());
  };
  return turned(project_grid(grid, task.bands, task.threads), task.bands,
                task.rotation * grid_to_environment(), task.threads);
}

// Rows are Gauss nodes in cos(theta) over each hemisphere on its own, because skies jump at the horizon.
Coefficients project(const light::AnalyticSky& sky, const Task& task) {
  const int rows = std::max(512, 8 * task.bands);
  const int columns = 2 * rows;
  const GaussLegendre rule = gauss_legendre(rows / 2);
  Grid grid;
  grid.rows = 2 * rule.nodes.size();
  grid.columns = columns;
  grid.azimuth = azimuth_table(columns, task.bands, 0, false);
  const auto ring = [&](std::size_t row) -> Ring {
    const std::size_t half = rule.nodes.size();
    const double sign = row < half ? 1.0 : -1.0;
    const double cosine = sign * 0.5 * (1.0 + rule.nodes[row % half]);
    return {cosine, std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.5 * rule.weights[row % half]};
  };
  grid.rings = [&](std::size_t row) { return std::vector<Ring>{ring(row)}; };
  grid.read = [&](std::size_t row, std::span<Rgb> radiance) {
    const Ring at = ring(row);
    for (int column = 0; column < columns; ++column) {
      const double phi = 2.0 * kPi * (column + 0.5) / columns;
      const Vec3 direction(at.sine * std::cos(phi), at.cosine, at.sine * std::sin(phi));
      const Rgb value = sky.radiance(direction);
      if (!is_finite(value)) throw InputError(task.name + ": radiance is not finite in some direction");
      radiance[static_cast<std::size_t>(column)] = value;
    }
  };
  return turned(project_grid(grid, task.bands, task.threads), task.bands,
                task.rotation * grid_to_environment(), task.threads);
}

using TexelNodes = std::function<void(int x, int y, std::vector<SphereNode>& nodes)>;

/// Sum over the texels of a square image of radiance times the integral of the basis over the texel.
Coefficients project_texels(const image::Image& image, const Task& task, const TexelNodes& append_nodes) {
  const Basis<double> basis(task.bands);
  return sum_in_blocks(static_cast<std::size_t>(image.height), task.bands, task.threads,
                       [&](std::size_t row, Coefficients& sum) {
                         std::vector<SphereNode> nodes;
                         std::vector<double> values(size_of(task.bands));
                         std::vector<double> integral(values.size());
                         const auto y = static_cast<int>(row);
                         for (int x = 0; x < image.width; ++x) {
                           const Rgb& texel = image.at(x, y);
                           if (is_black(texel)) continue;
                           nodes.clear();
                           append_nodes(x, y, nodes);
                           std::fill(integral.begin(), integral.end(), 0.0);
                           for (const SphereNode& node : nodes) {
                             const Vec3d d = task.rotation * node.direction;
                             basis.evaluate(d.x, d.y, d.z, values);
                             for (std::size_t i = 0; i < values.size(); ++i) {
                               integral[i] += node.weight * values[i];
                             }
                           }
                           const RgbD radiance(texel);
                           for (std::size_t i = 0; i < values.size(); ++i) sum[i] += integral[i] * radiance;
                         }
                       });
}

constexpr double kTexelTolerance = 1e-9;

Coefficients project(const light::CubeMapSky& sky, const Task& task) {
  Coefficients total(size_of(task.bands), RgbD(0.0));
  for (int face = 0; face < 6; ++face) {
    const image::Image& image = sky.faces[static_cast<std::size_t>(face)];
    require_square(image, task.name + ": cube face " + std::to_string(face));
    const int size = image.width;
    // 1 / r^(l + 3) has its poles one face half-width off the plane's centre: as a frequency, 3 + l.
    const GaussLegendre rule = gauss_legendre(gauss_count(2.0 * (task.bands + 3) / size, kTexelTolerance));
    const Coefficients part = project_texels(image, task, [&](int x, int y, std::vector<SphereNode>& nodes) {
      append_cube_texel(face, size, x, y, rule, nodes);
    });
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += part[i];
  }
  return total;
}

Coefficients project(const light::AngularMapSky& sky, const Task& task) {
  require_square(sky.image, task.name);
  const int size = sky.image.width;
  const GaussLegendre rule =
      gauss_legendre(gauss_count(2.0 * kPi * (task.bands + 1) / size, kTexelTolerance));
  std::vector<SphereNode> nodes;
  double sphere = 0.0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      nodes.clear();
      append_angular_texel(size, x, y, rule, nodes);
      for (const SphereNode& node : nodes) sphere += node.weight;
    }
  }
  Coefficients result = project_texels(sky.image, task, [&](int x, int y, std::vector<SphereNode>& out) {
    append_angular_texel(size, x, y, rule, out);
  });
  for (RgbD& c : result) c *= 4.0 * kPi / sphere;
  return result;
}

void add_sun(const light::SunDisc& sun, const Task& task, Coefficients& sum) {
  if (!is_finite(sun.radiance)) throw InputError(task.name + ": sun: radiance is not finite");
  const double length = glm::length(Vec3d(sun.direction));
  if (!(length > 0.0 && std::isfinite(length))) {
    throw InputError(task.name + ": sun: direction has no length");
  }
  const Vec3d direction = glm::normalize(task.rotation * Vec3d(sun.direction));
  const std::vector<double> disc = rotate_zonal(cap(task.bands, sun.half_angle_rad), direction);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += disc[i] * RgbD(sun.radiance);
}

Matrix require_rotation(const glm::mat3& rotation, const std::string& name) {
  constexpr double kRounding = 1e-4;  // far above a float matrix's, far below any real shear or scale
  const Matrix r(rotation);
  const Matrix gram = glm::transpose(r) * r;
  bool is_rotation = std::abs(glm::determinant(r) - 1.0) <= kRounding;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      is_rotation = is_rotation && std::abs(gram[i][j] - (i == j ? 1.0 : 0.0)) <= kRounding;
    }
  }
  if (!is_rotation) {
    throw InputError(name + ": rotation: expected orthonormal columns and determinant 1, got determinant " +
                     std::to_string(glm::determinant(r)));
  }
  return r;
}

}  // namespace

ShRgb project_radiance(const light::Environment& environment, int bands, int threads) {
  require_bands(bands);
  const Task task{environment.name, require_rotation(environment.rotation, environment.name), bands, threads};
  ShRgb result{bands, std::visit([&](const auto& sky) { return project(sky, task); }, environment.sky)};
  for (const light::SunDisc& sun : environment.suns) add_sun(sun, task, result.coefficients);
  return result;
}

}  // namespace plumbline::sh
