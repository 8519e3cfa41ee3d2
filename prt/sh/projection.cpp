// Projection of environments onto SH: project_radiance of lighting.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "prt/sh/aligned.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/sh/moment_kernels.hpp"
#include "prt/sh/projection_parts.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/texels.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::sh {

namespace {

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(coefficient_count(bands));
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

/// What a column of a grid stands for: a point at its middle (times its width), a box of its width, or a hat that
/// falls to 0 at the middles of the columns beside it (the periodic sum of such hats where they overlap).
enum class Column { point, box, hat };

/// cos and sin of pi j / n for j = 0 … 2n-1, by their symmetries from those of the first quarter.
struct Circle {
  std::vector<double> cosine;
  std::vector<double> sine;

  explicit Circle(std::size_t n) : cosine(2 * n), sine(2 * n) {
    for (std::size_t j = 0; 2 * j <= n; ++j) {
      const double angle = kPi * static_cast<double>(j) / static_cast<double>(n);
      const double c = 2 * j == n ? 0.0 : std::cos(angle);
      const double s = std::sin(angle);
      for (const bool is_mirrored : {false, true}) {
        const std::size_t k = is_mirrored ? n - j : j;
        cosine[k] = is_mirrored ? -c : c;
        sine[k] = s;
        if (k == 0 || k == n) continue;
        cosine[2 * n - k] = cosine[k];
        sine[2 * n - k] = -s;
      }
    }
    sine[n] = 0.0;
  }
};

// Half a turn on, cos(m phi) and sin(m phi) are what they were times (-1)^m. So where the number of columns is even,
// the two halves of a row are first added (for even m) and subtracted (for odd m).

/// integral of cos(m phi) and sin(m phi) times the column's shape, for columns that start at phi = start_half_turns
/// * pi: rows cos 0, sin 0, cos 1, … of `stride` columns each. With w the width, b = (2 / m) sin(m w / 2) times the value
/// at the middle for a box, and b^2 / w for a hat, which is a box convolved with a box, over w.
struct AzimuthTable {
  bool is_folded = false;
  std::size_t count = 0;   // columns, or half of them where folded
  std::size_t stride = 0;  // three numbers a column, padded
  AlignedVector<double> weights;

  AzimuthTable(int columns, int bands, int start_half_turns, Column shape)
      : is_folded(columns % 2 == 0),
        count(static_cast<std::size_t>(is_folded ? columns / 2 : columns)),
        stride(3 * padded(count)),
        weights(2 * static_cast<std::size_t>(bands) * stride, 0.0) {
    const Circle circle(static_cast<std::size_t>(columns));
    const double width = 2.0 * kPi / columns;
    for (int m = 0; m < bands; ++m) {
      const double box = m > 0 ? 2.0 / m * std::sin(0.5 * m * width) : width;
      double scale = shape == Column::point ? width : shape == Column::box ? box : box * box / width;
      if (start_half_turns % 2 != 0 && m % 2 == 1) scale = -scale;
      double* row = weights.data() + 2 * static_cast<std::size_t>(m) * stride;
      // The middle of column c is at pi (2c + 1) / columns; m times that, reduced as an integer, is exact.
      const auto turn = 2 * static_cast<std::size_t>(columns);
      std::size_t place = static_cast<std::size_t>(m) % turn;
      for (std::size_t c = 0; c < 3 * count; c += 3) {
        std::fill_n(row + c, 3, scale * circle.cosine[place]);
        std::fill_n(row + stride + c, 3, scale * circle.sine[place]);
        place += 2 * static_cast<std::size_t>(m);
        while (place >= turn) place -= turn;
      }
    }
  }
};

/// Moments of rows: for each of kRowsTogether rows [cos 0, sin 0, cos 1, …][r, g, b].
class AzimuthMoments {
 public:
  AzimuthMoments(const AzimuthTable& table, int bands)
      : weights_{table.weights.data(), 2 * static_cast<std::size_t>(bands), table.stride, table.count,
                 table.is_folded},
        room_(row_moments_room(weights_.rows)),
        moments_(kRowsTogether * 3 * weights_.rows) {}

  void make(const std::array<const float*, kRowsTogether>& rows) {
    row_moments(rows.data(), weights_, room_.data(), moments_.data());
  }
  [[nodiscard]] const double* of(std::size_t row) const { return moments_.data() + row * 3 * weights_.rows; }

 private:
  RowWeights weights_;
  AlignedVector<double> room_;
  std::vector<double> moments_;
};

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
  AzimuthTable azimuth;
  std::function<std::vector<Ring>(std::size_t row)> rings;  // weights include sin(theta) d theta
  /// Radiance of a row; may use the room it is given.
  std::function<std::span<const Rgb>(std::size_t row, std::vector<Rgb>& room)> read;
};

RgbD triple(const double* values) {
  return {values[0], values[1], values[2]};
}

/// Adds the products of a row's integrals over theta and its moments.
void add_row(const std::vector<double>& q, const double* f, int bands, Coefficients& sum) {
  for (int l = 0; l < bands; ++l) {
    for (int m = 0; m <= l; ++m) {
      const auto plus = static_cast<std::size_t>(index(l, m));
      const double* moment = f + 6 * static_cast<std::size_t>(m);
      sum[plus] += q[plus] * triple(moment);
      if (m > 0) sum[static_cast<std::size_t>(index(l, -m))] += q[plus] * triple(moment + 3);
    }
  }
}

Coefficients project_grid(const Grid& grid, int bands, int threads) {
  const Basis<double> basis(bands);
  constexpr std::size_t kRowsATask = 16;
  const std::size_t tasks = (grid.rows + kRowsATask - 1) / kRowsATask;
  return sum_in_blocks(tasks, size_of(bands), threads, [&](std::size_t task, Coefficients& sum) {
    AzimuthMoments azimuth(grid.azimuth, bands);
    std::array<std::vector<Rgb>, kRowsTogether> room;
    std::vector<double> scratch;
    std::vector<double> q;
    const std::size_t end = std::min(grid.rows, (task + 1) * kRowsATask);
    for (std::size_t first = task * kRowsATask; first < end; first += kRowsTogether) {
      const std::size_t count = std::min(kRowsTogether, end - first);
      std::array<const float*, kRowsTogether> pixels;
      for (std::size_t k = 0; k < kRowsTogether; ++k) {
        pixels[k] =
            k < count ? &grid.read(first + k, room[k])[0].x : pixels[0];  // repeated where rows are missing
      }
      azimuth.make(pixels);
      for (std::size_t k = 0; k < count; ++k) {
        integrate_rings(basis, grid.rings(first + k), scratch, q);
        add_row(q, azimuth.of(k), bands, sum);
      }
    }
  });
}

Coefficients turned(Coefficients coefficients, int bands, const Matrix& to_world, int threads) {
  if (to_world == Matrix(1.0)) return coefficients;
  return turned(std::vector<TurnedPart>{{std::move(coefficients), to_world}}, bands, threads);
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
}

/// Names the first texel that is not finite.
void require_finite(const image::Image& image, const std::string& name) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (is_finite(image.pixels[i])) continue;
    const auto width = static_cast<std::size_t>(image.width);
    throw InputError(name + ": texel (" + std::to_string(i % width) + ", " + std::to_string(i / width) +
                     ") is not finite");
  }
}

/// Texels that are not finite make the mean not finite: only then is it worth looking for them.
bool has_finite_mean(const Coefficients& coefficients) {
  const RgbD& mean = coefficients[0];
  return std::isfinite(mean.r) && std::isfinite(mean.g) && std::isfinite(mean.b);
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
  light::Lookup lookup;
  int bands;
  int threads;
};

Coefficients project(const light::ConstantSky& sky, const Task& task) {
  if (!is_finite(sky.radiance)) throw InputError(task.name + ": radiance is not finite");
  Coefficients result(size_of(task.bands), RgbD(0.0));
  result[0] = RgbD(sky.radiance) * std::sqrt(4.0 * kPi);
  return result;
}

/// Gauss nodes between two polar angles, the weights times a function linear in theta from `at_first` to
/// `at_last`.
void append_rings(double first, double last, double at_first, double at_last, const GaussLegendre& rule,
                  std::vector<Ring>& rings) {
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double height = 0.5 + 0.5 * rule.nodes[k];
    const double theta = first + (last - first) * height;
    const double sine = std::sin(theta);
    const double shape = at_first + (at_last - at_first) * height;
    rings.push_back({std::cos(theta), sine, 0.5 * (last - first) * rule.weights[k] * sine * shape});
  }
}

/// Row of a bilinear image: rises from the centre of the row above and falls to that of the row below, and is 1
/// from the first and last centre to the pole.
std::vector<Ring> hat_rings(std::size_t row, std::size_t rows, const GaussLegendre& rule) {
  const double step = kPi / static_cast<double>(rows);
  const double centre = step * (static_cast<double>(row) + 0.5);
  const bool is_top = row == 0;
  const bool is_bottom = row + 1 == rows;
  std::vector<Ring> rings;
  append_rings(is_top ? 0.0 : centre - step, centre, is_top ? 1.0 : 0.0, 1.0, rule, rings);
  append_rings(centre, is_bottom ? kPi : centre + step, 1.0, is_bottom ? 1.0 : 0.0, rule, rings);
  return rings;
}

std::vector<Ring> box_rings(std::size_t row, std::size_t rows, const GaussLegendre& rule) {
  const double step = kPi / static_cast<double>(rows);
  std::vector<Ring> rings;
  append_rings(step * static_cast<double>(row), step * static_cast<double>(row + 1), 1.0, 1.0, rule, rings);
  return rings;
}

// Q_lm sin(theta) is a trigonometric polynomial of degree l + 1 in theta (for every m: the root in sin(theta)
// does not appear), so Gauss nodes in theta converge at once; their number makes the error rounding. A bilinear
// image is a sum of products of a hat in phi and one in theta and separates in the same way; the linear factor in
// theta costs one more node.
Coefficients project(const light::LatLongSky& sky, const Task& task) {
  require_image(sky.image, task.name);
  const bool is_bilinear = task.lookup == light::Lookup::bilinear;
  const auto width = static_cast<std::size_t>(sky.image.width);
  const int count = gauss_count(task.bands * kPi / sky.image.height, 1e-16);
  const GaussLegendre rule = gauss_legendre(is_bilinear ? count + 1 : count);
  Grid grid{static_cast<std::size_t>(sky.image.height),
            AzimuthTable(sky.image.width, task.bands, -1, is_bilinear ? Column::hat : Column::box),
            {},
            {}};
  grid.rings = [&](std::size_t row) {
    return is_bilinear ? hat_rings(row, grid.rows, rule) : box_rings(row, grid.rows, rule);
  };
  grid.read = [&](std::size_t row, std::vector<Rgb>&) {
    return std::span<const Rgb>(sky.image.pixels).subspan(row * width, width);
  };
  Coefficients result = project_grid(grid, task.bands, task.threads);
  if (!has_finite_mean(result)) require_finite(sky.image, task.name);
  return turned(std::move(result), task.bands, task.rotation * grid_to_environment(), task.threads);
}

// Rows are Gauss nodes in cos(theta) over each hemisphere on its own, because skies jump at the horizon.
Coefficients project(const light::AnalyticSky& sky, const Task& task) {
  const int rows = std::max(512, 8 * task.bands);
  const int columns = 2 * rows;
  const GaussLegendre rule = gauss_legendre(rows / 2);
  Grid grid{2 * rule.nodes.size(), AzimuthTable(columns, task.bands, 0, Column::point), {}, {}};
  const auto ring = [&](std::size_t row) -> Ring {
    const std::size_t half = rule.nodes.size();
    const double sign = row < half ? 1.0 : -1.0;
    const double cosine = sign * 0.5 * (1.0 + rule.nodes[row % half]);
    return {cosine, std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.5 * rule.weights[row % half]};
  };
  grid.rings = [&](std::size_t row) { return std::vector<Ring>{ring(row)}; };
  grid.read = [&](std::size_t row, std::vector<Rgb>& radiance) {
    radiance.resize(static_cast<std::size_t>(columns));
    const Ring at = ring(row);
    for (int column = 0; column < columns; ++column) {
      const double phi = 2.0 * kPi * (column + 0.5) / columns;
      const Vec3 direction(at.sine * std::cos(phi), at.cosine, at.sine * std::sin(phi));
      const Rgb value = sky.radiance(direction);
      if (!is_finite(value)) throw InputError(task.name + ": radiance is not finite in some direction");
      radiance[static_cast<std::size_t>(column)] = value;
    }
    return std::span<const Rgb>(radiance);
  };
  return turned(project_grid(grid, task.bands, task.threads), task.bands,
                task.rotation * grid_to_environment(), task.threads);
}

/// Appends the nodes of a rectangle of the image.
using AppendNodes = std::function<void(const ImageRectangle& rectangle, std::vector<ImageNode>& nodes)>;

/// Sum over the texels of a square image of radiance times the integral of the basis over the texel.
Coefficients project_texels(const image::Image& image, const Task& task, const AppendNodes& append_nodes) {
  const Basis<double> basis(task.bands);
  return sum_in_blocks(static_cast<std::size_t>(image.height), size_of(task.bands), task.threads,
                       [&](std::size_t row, Coefficients& sum) {
                         std::vector<ImageNode> nodes;
                         std::vector<double> values(size_of(task.bands));
                         std::vector<double> integral(values.size());
                         const auto y = static_cast<int>(row);
                         for (int x = 0; x < image.width; ++x) {
                           const Rgb& texel = image.at(x, y);
                           if (is_black(texel)) continue;
                           nodes.clear();
                           append_nodes(texel_rectangle(image.width, x, y), nodes);
                           std::fill(integral.begin(), integral.end(), 0.0);
                           for (const ImageNode& node : nodes) {
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

/// Cell 0 … size of one axis: from texel centre to texel centre, half cells at the ends; see environment_lookup.hpp.
double cell_border(int size, int i) {
  return std::clamp((2.0 * i - 1.0) / size - 1.0, -1.0, 1.0);
}

ImageRectangle cell_rectangle(int size, int x, int y) {
  return {cell_border(size, x), cell_border(size, x + 1), cell_border(size, y), cell_border(size, y + 1)};
}

/// Bilinear interpolation in one cell of a square image, clamped at its border.
class Patch {
 public:
  using TexelAt = std::function<const Rgb&(int x, int y)>;
  Patch(int size, int x, int y, const TexelAt& texel) : size_(size), x_(x), y_(y) {
    const auto at = [&](int i, int j) {
      return RgbD(texel(std::clamp(x - 1 + i, 0, size - 1), std::clamp(y - 1 + j, 0, size - 1)));
    };
    corners_ = {at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
  }

  [[nodiscard]] bool is_black() const {
    return std::all_of(corners_.begin(), corners_.end(), [](const RgbD& c) { return c == RgbD(0.0); });
  }
  [[nodiscard]] RgbD radiance(double s, double t) const {
    const double across = 0.5 * size_ * (s + 1.0) + 0.5 - x_;
    const double down = 0.5 * size_ * (t + 1.0) + 0.5 - y_;
    return glm::mix(glm::mix(corners_[0], corners_[1], across), glm::mix(corners_[2], corners_[3], across),
                    down);
  }

 private:
  int size_;
  int x_;
  int y_;
  std::array<RgbD, 4> corners_;
};

/// Sum over the (size + 1)^2 cells of a square image of the integral of interpolated radiance times basis.
Coefficients project_patches(int size, const Task& task, const Patch::TexelAt& texel,
                             const AppendNodes& append_nodes) {
  const Basis<double> basis(task.bands);
  const auto rows = static_cast<std::size_t>(size) + 1;
  return sum_in_blocks(rows, size_of(task.bands), task.threads, [&](std::size_t row, Coefficients& sum) {
    std::vector<ImageNode> nodes;
    std::vector<double> values(size_of(task.bands));
    for (int x = 0; x <= size; ++x) {
      const Patch patch(size, x, static_cast<int>(row), texel);
      if (patch.is_black()) continue;
      nodes.clear();
      append_nodes(cell_rectangle(size, x, static_cast<int>(row)), nodes);
      for (const ImageNode& node : nodes) {
        const Vec3d d = task.rotation * node.direction;
        basis.evaluate(d.x, d.y, d.z, values);
        const RgbD radiance = node.weight * patch.radiance(node.s, node.t);
        for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i] * radiance;
      }
    }
  });
}

/// The linear factors of bilinear interpolation cost one more node.
int texel_count(double phase, light::Lookup lookup) {
  constexpr double kTexelTolerance = 1e-9;
  const int count = gauss_count(phase, kTexelTolerance);
  return lookup == light::Lookup::bilinear ? count + 1 : count;
}
GaussLegendre texel_rule(double phase, light::Lookup lookup) {
  return gauss_legendre(texel_count(phase, lookup));
}

/// 1 / r^(l + 3) has its poles one face half-width off the plane's centre: as a frequency, 3 + l.
double cube_phase(int bands, int size) {
  return 2.0 * (bands + 3) / size;
}

void require_cube(const light::CubeMapSky& sky, const Task& task) {
  for (std::size_t face = 0; face < 6; ++face) {
    require_square(sky.faces[face], task.name + ": cube face " + std::to_string(face));
  }
}

bool has_faces_of_one_size(const light::CubeMapSky& sky) {
  return std::all_of(sky.faces.begin(), sky.faces.end(),
                     [&](const image::Image& face) { return face.width == sky.faces[0].width; });
}

Coefficients project_faces_one_by_one(const light::CubeMapSky& sky, const Task& task) {
  Coefficients total(size_of(task.bands), RgbD(0.0));
  for (int face = 0; face < 6; ++face) {
    const image::Image& image = sky.faces[static_cast<std::size_t>(face)];
    const GaussLegendre rule = texel_rule(cube_phase(task.bands, image.width), task.lookup);
    const AppendNodes nodes = [&](const ImageRectangle& rectangle, std::vector<ImageNode>& out) {
      append_cube_nodes(face, rectangle, rule, out);
    };
    const auto texel = [&](int x, int y) -> const Rgb& { return image.at(x, y); };
    const Coefficients part = task.lookup == light::Lookup::bilinear
                                  ? project_patches(image.width, task, texel, nodes)
                                  : project_texels(image, task, nodes);
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += part[i];
  }
  return total;
}

Coefficients project(const light::CubeMapSky& sky, const Task& task) {
  require_cube(sky, task);
  const bool is_quick =
      task.lookup == light::Lookup::nearest && task.bands <= kCubeFaceBands && has_faces_of_one_size(sky);
  const int size = sky.faces[0].width;
  Coefficients total =
      is_quick ? project_cube_faces(sky, task.rotation, task.bands,
                                    texel_count(cube_phase(task.bands, size), task.lookup), task.threads)
               : project_faces_one_by_one(sky, task);
  if (!has_finite_mean(total)) {
    for (std::size_t face = 0; face < 6; ++face) {
      require_finite(sky.faces[face], task.name + ": cube face " + std::to_string(face));
    }
  }
  return total;
}

/// Sum of the weights of all nodes of count x count rectangles of an angular map: 4 pi but for the error at the rim.
double sphere_of_nodes(int count, ImageRectangle (*rectangle)(int size, int x, int y), int size,
                       const AppendNodes& append_nodes) {
  std::vector<ImageNode> nodes;
  double sphere = 0.0;
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < count; ++x) {
      nodes.clear();
      append_nodes(rectangle(size, x, y), nodes);
      for (const ImageNode& node : nodes) sphere += node.weight;
    }
  }
  return sphere;
}

Coefficients project(const light::AngularMapSky& sky, const Task& task) {
  require_square(sky.image, task.name);
  require_finite(sky.image, task.name);
  const int size = sky.image.width;
  const GaussLegendre rule = texel_rule(2.0 * kPi * (task.bands + 1) / size, task.lookup);
  const AppendNodes nodes = [&](const ImageRectangle& rectangle, std::vector<ImageNode>& out) {
    append_angular_nodes(rectangle, rule, out);
  };
  const auto texel = [&](int x, int y) -> const Rgb& { return light::angular_map_texel(sky.image, x, y); };
  const bool is_bilinear = task.lookup == light::Lookup::bilinear;
  Coefficients result =
      is_bilinear ? project_patches(size, task, texel, nodes) : project_texels(sky.image, task, nodes);
  const double sphere = is_bilinear ? sphere_of_nodes(size + 1, cell_rectangle, size, nodes)
                                    : sphere_of_nodes(size, texel_rectangle, size, nodes);
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
  const Task task{environment.name, require_rotation(environment.rotation, environment.name),
                  environment.lookup, bands, threads};
  ShRgb result{bands, std::visit([&](const auto& sky) { return project(sky, task); }, environment.sky)};
  for (const light::SunDisc& sun : environment.suns) add_sun(sun, task, result.coefficients);
  return result;
}

}  // namespace plumbline::sh
