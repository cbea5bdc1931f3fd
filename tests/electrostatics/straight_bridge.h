// A second method for the field beside a bridge of water with a straight edge: finite volumes in
// the plane across the edge, on cells that shrink towards the corners, solved directly.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

namespace papilla::tests {

// A strip of water as wide as twice `half_width` between a film on a flat electrode at one volt and
// a flat skin: symmetric about its middle. T: double, or complex for layers that conduct.
template <class T>
struct StraightBridge {
  double gap = 0, thickness = 0, half_width = 0;  // [m]
  T permittivity = 1;                             // of the film
  T skin_layer = 0;                               // over the air, d/eps; does not spread flux [m]
  T water_skin_layer = 0;                         // between water and body [m]; 0: grounded water
};

template <class T>
class StraightBridgeField {
 public:
  StraightBridgeField(const StraightBridge<T>& p, double finest) : p_(p) {
    const double far = 8 * (p.gap + p.thickness) + 4 * std::abs(p.skin_layer);
    const double coarse = 0.1 * (p.gap + p.thickness);
    std::vector<double> under = graded(p.half_width, finest, coarse);
    std::reverse(under.begin(), under.end());
    const std::vector<double> beside = graded(far, finest, coarse);
    left_ = static_cast<int>(under.size());
    dx_ = std::move(under);
    dx_.insert(dx_.end(), beside.begin(), beside.end());
    dy_ = graded(p.thickness, finest, 0.1 * p.thickness);
    std::reverse(dy_.begin(), dy_.end());
    film_ = static_cast<int>(dy_.size());
    // Fine at the film and at the skin.
    const std::vector<double> half = graded(0.5 * p.gap, finest, p.gap);
    dy_.insert(dy_.end(), half.begin(), half.end());
    dy_.insert(dy_.end(), half.rbegin(), half.rend());
    nx_ = static_cast<int>(dx_.size()), ny_ = static_cast<int>(dy_.size());
    assemble();
    const std::vector<T> grounded = solve(drive_);
    if (p.water_skin_layer == T(0)) {
      phi_ = grounded;
    } else {
      // The potential of the water at which as much charge comes to it as goes on to the body.
      const std::vector<T> alone = solve(from_water_);
      const T skin = p.half_width / p.water_skin_layer;
      water_ = arriving(grounded, 0) / (skin - arriving(alone, 1));
      phi_ = grounded;
      for (std::size_t i = 0; i < phi_.size(); ++i) phi_[i] += water_ * alone[i];
    }
  }

  T water_potential() const { return water_; }

  // What the pull lacks beside one edge: a strip of this width under the far pull [m]. The pull is
  // Maxwell's stress on the skin, of the field across it less that along it, as in the derivative
  // of the energy.
  double lost_length() const {
    const double far = std::norm(skin_field(nx_ - 1));
    double lost = 0, along = 0;
    T before = water_;
    for (int i = left_; i < nx_; ++i) {
      lost += dx_[i] * (1 - std::norm(skin_field(i)) / far);
      const T here = skin_field(i) * p_.skin_layer;
      along += std::norm(here - before) / (0.5 * (dx_[i] + (i > left_ ? dx_[i - 1] : 0)));
      before = here;
    }
    return lost + along / far;
  }

 private:
  static std::vector<double> graded(double length, double finest, double coarsest) {
    constexpr double kGrowth = 1.12;
    std::vector<double> out;
    double sum = 0, step = finest;
    while (sum < length) {
      out.push_back(step);
      sum += step;
      step = std::min(kGrowth * step, coarsest);
    }
    for (double& s : out) s *= length / sum;
    return out;
  }

  bool water(int i, int j) const { return i < left_ && j >= film_; }
  T medium(int j) const { return j < film_ ? p_.permittivity : T(1); }
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(i) * ny_ + j; }
  // Between neighbours in a row and in a column, of half a cell each.
  T across(int i, int j) const { return 2 * dy_[j] * medium(j) / (dx_[i] + dx_[i + 1]); }
  T up(int i, int j) const {
    return 2 * dx_[i] / (dy_[j] / medium(j) + dy_[j + 1] / medium(j + 1));
  }

  void assemble() {
    const std::size_t n = static_cast<std::size_t>(nx_) * ny_;
    const int width = ny_ + 1;
    band_.assign(n * width, T(0));
    drive_.assign(n, T(0));
    from_water_.assign(n, T(0));
    const auto to_body = [&](std::size_t cell, T c) { band_[cell * width] += c; };
    const auto join = [&](int i, int j, int k, int l, T c) {
      const bool first = water(i, j), second = water(k, l);
      if (first && second) return;
      if (first || second) return;  // walls: below, over half a cell
      band_[at(i, j) * width] += c;
      band_[at(k, l) * width] += c;
      band_[at(i, j) * width + (at(k, l) - at(i, j))] -= c;
    };
    for (int i = 0; i < nx_; ++i) {
      for (int j = 0; j < ny_; ++j) {
        if (water(i, j)) {
          to_body(at(i, j), T(1));
          continue;
        }
        if (i + 1 < nx_) join(i, j, i + 1, j, across(i, j));
        if (j + 1 < ny_) join(i, j, i, j + 1, up(i, j));
      }
      const T electrode = 2 * dx_[i] * medium(0) / dy_[0];
      to_body(at(i, 0), electrode);
      drive_[at(i, 0)] += electrode;
      if (i >= left_) {
        to_body(at(i, ny_ - 1), dx_[i] / (0.5 * dy_[ny_ - 1] + p_.skin_layer));
      } else {
        const T wall = 2 * dx_[i] * p_.permittivity / dy_[film_ - 1];
        to_body(at(i, film_ - 1), wall);
        from_water_[at(i, film_ - 1)] += wall;
      }
    }
    for (int j = film_; j < ny_; ++j) {
      const T wall = 2 * dy_[j] / dx_[left_];
      to_body(at(left_, j), wall);
      from_water_[at(left_, j)] += wall;
    }
    factor();
  }

  // L D L^T in place; symmetric, not Hermitian.
  void factor() {
    const std::size_t n = drive_.size(), width = static_cast<std::size_t>(ny_) + 1;
    for (std::size_t k = 0; k < n; ++k) {
      const T* row = &band_[k * width];
      for (std::size_t a = 1; a < width && k + a < n; ++a) {
        if (row[a] == T(0)) continue;
        const T share = row[a] / row[0];
        T* below = &band_[(k + a) * width];
        for (std::size_t b = a; b < width; ++b) below[b - a] -= share * row[b];
      }
    }
  }
  std::vector<T> solve(std::vector<T> x) const {
    const std::size_t n = x.size(), width = static_cast<std::size_t>(ny_) + 1;
    for (std::size_t k = 0; k < n; ++k) {
      const T* row = &band_[k * width];
      const T share = x[k] / row[0];
      for (std::size_t a = 1; a < width && k + a < n; ++a) x[k + a] -= row[a] * share;
    }
    for (std::size_t k = n; k-- > 0;) {
      const T* row = &band_[k * width];
      T sum = x[k];
      for (std::size_t a = 1; a < width && k + a < n; ++a) sum -= row[a] * x[k + a];
      x[k] = sum / row[0];
    }
    return x;
  }

  // What flows to the water at a potential, over eps0.
  T arriving(const std::vector<T>& phi, double potential) const {
    T sum = 0;
    for (int i = 0; i < left_; ++i)
      sum += 2 * dx_[i] * p_.permittivity / dy_[film_ - 1] * (phi[at(i, film_ - 1)] - potential);
    for (int j = film_; j < ny_; ++j)
      sum += 2 * dy_[j] / dx_[left_] * (phi[at(left_, j)] - potential);
    return sum;
  }

  // In the air at the skin [1/m].
  T skin_field(int i) const { return phi_[at(i, ny_ - 1)] / (0.5 * dy_[ny_ - 1] + p_.skin_layer); }

  StraightBridge<T> p_;
  std::vector<double> dx_, dy_;
  int left_ = 0, film_ = 0, nx_ = 0, ny_ = 0;  // cells under the water, in the film, of all
  std::vector<T> band_, drive_, from_water_, phi_;
  T water_ = 0;
};

}  // namespace papilla::tests
