#include "physics/persson/gap_integrals.h"

#include <cmath>

#include "base/cache.h"
#include "base/constants.h"
#include "numerics/quadrature.h"

namespace papilla::persson {
namespace {

double table_node(int i) {
  return std::ldexp(1.0 + (i % kCellsPerOctave) / double(kCellsPerOctave),
                    i / kCellsPerOctave + kLowExponent);
}

struct GapIntegrals {
  std::vector<double> plain, squared;  // with weights 1 and erf^2, times y^-1/2
};

const GapIntegrals& gap_integrals() {
  static const GapIntegrals tables = [] {
    GapIntegrals t{std::vector<double>(kTableSize), std::vector<double>(kTableSize)};
    const Quadrature rule = gauss_legendre(4);
    double plain = 0, squared = 0;
    for (int i = 0; i < kTableSize; ++i) {
      const double y = table_node(i);
      if (i > 0) {  // in ln t over the cell, t from y^-1/2 of this node to that of the last one
        const double low = -0.5 * std::log(y), high = -0.5 * std::log(table_node(i - 1));
        for (int k = 0; k < 4; ++k) {
          const double x = std::exp(0.5 * (low + high) + 0.5 * (high - low) * rule.nodes[k]);
          const double w = 0.5 * (high - low) * rule.weights[k] * std::exp(-x * x);
          plain += w;
          squared += w * square(std::erf(x));
        }
      }
      t.plain[i] = plain / std::sqrt(y);
      t.squared[i] = squared / std::sqrt(y);
    }
    return t;
  }();
  return tables;
}

}  // namespace

std::shared_ptr<const std::vector<double>> gap_integral_table(double energy_factor) {
  static Cache<double, std::vector<double>> cache(8, kInfinity);
  return cache.get(energy_factor, 0, [&] {
    const GapIntegrals& integrals = gap_integrals();
    auto table = std::make_shared<std::vector<double>>(kTableSize);
    for (int i = 0; i < kTableSize; ++i) {
      (*table)[i] =
          energy_factor * integrals.plain[i] + 3 * (1 - energy_factor) * integrals.squared[i];
    }
    return table;
  });
}

}  // namespace papilla::persson
