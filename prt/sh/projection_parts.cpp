#include "prt/sh/projection_parts.hpp"

#include <algorithm>
#include <utility>

#include "prt/sh/quadrature.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::sh {

Coefficients sum_in_blocks(std::size_t count, std::size_t size, int threads,
                           const std::function<void(std::size_t, Coefficients&)>& add) {
  constexpr std::size_t kBlocks = 32;
  const std::size_t blocks = std::min(count, kBlocks);
  std::vector<Coefficients> partial(blocks);
  parallel_for(blocks, threads, [&](std::size_t block) {
    Coefficients sum(size, RgbD(0.0));
    for (std::size_t i = block * count / blocks; i < (block + 1) * count / blocks; ++i) add(i, sum);
    partial[block] = std::move(sum);
  });
  Coefficients total(size, RgbD(0.0));
  for (const Coefficients& part : partial) {
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += part[i];
  }
  return total;
}

Coefficients turned(const std::vector<TurnedPart>& parts, int bands, int threads) {
  const std::vector<SphereNode> nodes = sphere_quadrature(bands);
  const Basis<double> basis(bands);
  const auto size = static_cast<std::size_t>(coefficient_count(bands));
  return sum_in_blocks(nodes.size(), size, threads, [&](std::size_t k, Coefficients& sum) {
    std::vector<double> values(size);
    RgbD value(0.0);
    for (const TurnedPart& part : parts) {
      const Vec3d d = glm::normalize(glm::transpose(part.to_world) * nodes[k].direction);
      basis.evaluate(d.x, d.y, d.z, values);
      for (std::size_t i = 0; i < size; ++i) value += values[i] * part.coefficients[i];
    }
    value *= nodes[k].weight;
    basis.evaluate(nodes[k].direction.x, nodes[k].direction.y, nodes[k].direction.z, values);
    for (std::size_t i = 0; i < size; ++i) sum[i] += values[i] * value;
  });
}

}  // namespace plumbline::sh
