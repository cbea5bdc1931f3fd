#include "physics/electrostatics/screening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "base/constants.h"
#include "numerics/arrays.h"
#include "numerics/loops.h"

namespace papilla::electrostatics {
namespace {

constexpr double kReach = 4;        // tanh^2(4) = 0.9987
constexpr double kLeastGap = 1e-9;  // [m]
// Of the first and second power of the water's potential, per length of grounded water and per gap.
// Those of the length add up to 1: in a gap that closes nothing is lost. Eq. electrostatics.19
constexpr double kOfLength[] = {0.954, 0.046};
constexpr double kOfGap[] = {0.419, -1.169};

// Eqs. electrostatics.3 and 16: tanh^2 of the root of u, u at most kReach^2, within 2e-6: the ninth
// step of its continued fraction.
template <class T>
T tanh_square(const T& u) {
  using N = typename NumberOf<T>::Type;
  const T above = N(34459425) + u * (N(4729725) + u * (N(135135) + u * (N(990) + u)));
  const T below = N(34459425) + u * (N(16216200) + u * (N(945945) + u * (N(13860) + u * N(45))));
  const T ratio = above / below;
  return u * (ratio * ratio);
}

// The factor at distances of `step` times the root of `squared`, over the widths in `out`; 1 from
// kReach on, and where a width is no number. No branch, so that several go at once.
void fade_out(std::span<const float> squared, double step, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double u = square(step / out[i]) * static_cast<double>(squared[i]);
    const double faded = tanh_square(u);
    out[i] = u < square(kReach) ? faded : 1.0;
  }
}

// Width of the tanh^2 profile around a disc a that loses the pull of the disc a + L:
// W^2 ln 2 + a W = a L + L^2/2.
double profile_width(double radius, double reach) {
  constexpr double kLn2 = std::numbers::ln2;
  return (std::sqrt(square(radius) + 4 * kLn2 * reach * (radius + 0.5 * reach)) - radius) /
         (2 * kLn2);
}

// What the pull keeps where grounded water would leave a share.
double left_of(double grounded, double lost) { return grounded + (1 - lost) * (1 - grounded); }

void screen_disc(const Grid& grid, const Droplet& bridge, const WaterLayers& layers,
                 std::vector<double>& factor) {
  const double edge_gap = std::max(bridge.edge_gap, kLeastGap);
  const double width = profile_width(
      bridge.radius, screening_reach(edge_gap + layers.skin, layers.thickness, bridge.radius));
  const double lost = lost_share(edge_gap, layers);
  const double reach = bridge.radius + kReach * width;
  const double dx = grid.dx(), dy = grid.dy();
  // The window holds every pixel once, however wide the reach is.
  const int x0 = static_cast<int>(std::floor((bridge.x - std::min(reach, 0.5 * grid.lx)) / dx));
  const int y0 = static_cast<int>(std::floor((bridge.y - std::min(reach, 0.5 * grid.ly)) / dy));
  const int nx = std::min(static_cast<int>(2 * reach / dx) + 2, grid.nx);
  const int ny = std::min(static_cast<int>(2 * reach / dy) + 2, grid.ny);
  for (int j = 0; j < ny; ++j) {
    const double y = (y0 + j + 0.5) * dy - bridge.y;
    if (std::abs(y) >= reach) continue;
    double* row = factor.data() + grid.index(0, wrap(y0 + j, grid.ny));
    int column = wrap(x0, grid.nx);
    for (int i = 0; i < nx; ++i, ++column) {
      if (column == grid.nx) column = 0;
      const double x = (x0 + i + 0.5) * dx - bridge.x;
      const double r2 = x * x + y * y;
      if (r2 >= reach * reach) continue;
      const double distance = (std::sqrt(r2) - bridge.radius) / width;
      const double faded = distance <= 0 ? 0 : tanh_square(square(std::min(distance, kReach)));
      const double fade = left_of(faded, lost);
      row[column] *= bridge.film > 0 ? std::pow(fade, 1 - bridge.film) : fade;
    }
  }
}

// Squared distances in steps of a row, single precision: a fading factor asks for no more.
// Distances to the nearest wet pixel of a periodic row; infinite without one. beside: the potential
// there, of the one behind where two are as near; null: not asked for.
void row_distance(const std::uint8_t* wet, int n, float step, float* out, const double* potential,
                  float* beside) {
  const int first =
      static_cast<int>(std::find_if(wet, wet + n, [](auto w) { return w != 0; }) - wet);
  if (beside) std::fill(beside, beside + n, 0.0F);
  if (first == n) return std::fill(out, out + n, std::numeric_limits<float>::infinity());
  // Pixels since the last wet one, once around from one to itself, each way.
  std::vector<int> since(n);
  float last = 0;
  int count = 0;
  for (int k = 0, i = first; k < n; ++k) {
    since[i] = count = wet[i] ? 0 : count + 1;
    if (beside) beside[i] = last = wet[i] ? static_cast<float>(potential[i]) : last;
    if (++i == n) i = 0;
  }
  count = 0;
  for (int k = 0, i = first; k < n; ++k) {
    count = wet[i] ? 0 : count + 1;
    if (beside) {
      last = wet[i] ? beside[i] : last;
      beside[i] = count < since[i] ? last : beside[i];
    }
    since[i] = std::min(since[i], count);
    if (i-- == 0) i = n - 1;
  }
  for (int i = 0; i < n; ++i)
    out[i] = step * static_cast<float>(since[i]) * (step * static_cast<float>(since[i]));
}

// Distance of each pixel to the nearest wet one, where that is less than most(pixel) [m]; that or
// more elsewhere.
class WaterDistance {
 public:
  // potential: of the wet pixels; null: not asked for.
  template <class Most>
  WaterDistance(const Grid& g, const std::vector<std::uint8_t>& wet, const Most& most,
                const std::vector<double>* potential = nullptr)
      : step_(g.dy()),
        grid_(g),
        along_(g.size()),
        reach_(g.size()),
        squared_(g.size()),
        beside_(potential ? g.size() : 0),
        potential_(beside_.size()) {
    const double rows_per_metre = 1 / g.dy();
    for (int iy = 0; iy < g.ny; ++iy) {
      const std::size_t row = g.index(0, iy);
      row_distance(wet.data() + row, g.nx, static_cast<float>(g.dx() / g.dy()), &along_[row],
                   potential ? potential->data() + row : nullptr,
                   potential ? &beside_[row] : nullptr);
      for (std::size_t i = row; i < row + static_cast<std::size_t>(g.nx); ++i)
        reach_[i] = static_cast<float>(std::min(most(i) * rows_per_metre, 0.5 * g.ny));
    }
    for (int iy = 0; iy < g.ny; ++iy) {
      for_each_pixel<float>(static_cast<std::size_t>(g.nx), [&](auto at) {
        if (potential) {
          at.store(&squared_[grid_.index(0, iy)], nearest_row<true>(at, iy));
        } else {
          at.store(&squared_[grid_.index(0, iy)], nearest_row<false>(at, iy));
        }
      });
    }
  }
  double operator()(std::size_t i) const { return step_ * std::sqrt(squared_[i]); }  // [m]
  std::span<const float> squared() const { return squared_; }      // in steps of a row
  std::span<const float> potential() const { return potential_; }  // of the nearest wet pixel

 private:
  // Of one pixel or several side by side: rows farther and farther off, until none of the pixels
  // asks for one as far, or all know a nearer one.
  template <bool kPotential, class At>
  auto nearest_row(const At& at, int iy) {
    constexpr int kRows = 4;  // rows between two looks at what the pixels know
    auto nearest = at(&along_[grid_.index(0, iy)]), potential = nearest;
    if constexpr (kPotential) potential = at(&beside_[grid_.index(0, iy)]);
    const int rows = static_cast<int>(largest_of(at(&reach_[grid_.index(0, iy)])));
    float farthest = largest_of(nearest);
    for (int j = 1, up = iy, down = iy; j <= rows && static_cast<float>(j * j) < farthest; ++j) {
      if (++up == grid_.ny) up = 0;
      if (down-- == 0) down = grid_.ny - 1;
      const auto above = at(&along_[grid_.index(0, up)]), below = at(&along_[grid_.index(0, down)]);
      const auto nearer = smaller(above, below) + static_cast<float>(j * j);
      if constexpr (kPotential) {
        const auto of_row = chosen(above < below, at(&beside_[grid_.index(0, up)]),
                                   at(&beside_[grid_.index(0, down)]));
        potential = chosen(nearer < nearest, of_row, potential);
      }
      nearest = smaller(nearer, nearest);
      if (j % kRows == 0) farthest = largest_of(nearest);
    }
    if constexpr (kPotential) at.store(&potential_[grid_.index(0, iy)], potential);
    return nearest;
  }

  double step_;
  const Grid& grid_;
  // Squared distance along the row, and how far a pixel asks, both in steps of a row.
  UnsetArray<float> along_, reach_;
  UnsetArray<float> squared_;             // to the nearest wet pixel
  UnsetArray<float> beside_, potential_;  // of the nearest wet pixel, in the row and at all
};

// What water at U = u phi adds to the pull of a column, where grounded water leaves t of it. Eq.
// electrostatics.20
template <class T>
T excess(const T& t, const T& u, const T& corner) {
  const T faded = 1.0F - t, field = t + u * faded;
  return field * field / (t + corner * faded) - t;
}

// Of the field between the wall and the skin beside it; h, reach, gap, film [m]. Fitted.
template <class T>
T corner_share(float h, const T& reach, const T& gap, const T& film) {
  const T share = h / reach;
  return share * (3.3F + 0.8F * gap / (film + 0.14F * share * gap));
}

// The mean over a pixel, from where its side to the water is to where its far side is.
void add_wall_pull(const WaterDistance& distance, const WallFields& wall, double pixel,
                   double row_step, const std::vector<double>& width, std::vector<double>& factor) {
  // Gauss and Legendre's: places in the pixel, weights.
  constexpr float kAt[][2] = {{-0.930568156F, 0.173927423F},
                              {-0.669990522F, 0.326072577F},
                              {-0.330009478F, 0.326072577F},
                              {-0.069431844F, 0.173927423F}};
  // Single precision, as the distances.
  const auto side = static_cast<float>(pixel), step = static_cast<float>(row_step);
  const auto skin = static_cast<float>(wall.skin);
  for_each_pixel<float>(factor.size(), [&](auto at) {
    const auto phi = at(wall.potential), per_width = 1.0F / at(width);
    const auto far = step * root(at(distance.squared()));
    const auto u = at(distance.potential()) / phi;
    const auto corner = corner_share(skin, at(wall.reach), static_cast<float>(kPi / 2) * at(width),
                                     at(wall.dielectric));
    auto sum = 0.0F * far;
    for (const auto& [place, weight] : kAt) {
      const auto x = (far + side * place) * per_width;
      const auto t = tanh_square(smaller(x * x, static_cast<float>(square(kReach))));
      sum = sum + weight * excess(t, u, corner);
    }
    const auto near =
        far > 0.0F && (far - side) * per_width < static_cast<float>(kReach) && phi > 0.0F;
    at.store(factor, at(factor) + chosen(near, sum, 0.0F));
  });
}

// share: how much of a film it is; the factor to that power.
void screen_film(const Gap& gap, const std::vector<std::uint8_t>& wet, double share,
                 const WaterLayers& layers, std::vector<double>& factor) {
  // The fit never exceeds 0.64 gaps + 0.42 thicknesses.
  const auto farthest = [&](double g) {
    return kReach * (0.64 * (g + layers.skin) + 0.42 * layers.thickness);
  };
  const auto gap_at = [&](std::size_t i) { return std::max(gap.value[i], kLeastGap); };
  const WaterDistance distance(gap.grid, wet, [&](std::size_t i) { return farthest(gap_at(i)); });
  for (std::size_t i = 0; i < factor.size(); ++i) {
    const double g = gap_at(i);
    if (distance(i) >= farthest(g)) continue;  // spares the power
    const double x = distance(i) / screening_length(g + layers.skin, layers.thickness);
    if (x >= kReach) continue;
    const double fade = left_of(tanh_square(square(x)), lost_share(g, layers));
    factor[i] *= share < 1 ? std::pow(fade, share) : fade;
  }
}

// Water that is on its way from disc to film fades as both, by its share (Eq. capillary.22).
void screen_films(const Gap& gap, const Wetting& wetting, const WaterLayers& layers,
                  std::vector<double>& factor) {
  if (wetting.film.empty()) return screen_film(gap, wetting.bridged, 1, layers, factor);
  double share = 0;
  for (const Droplet& drop : wetting.droplets) {
    if (drop.film < 1) share = std::max(share, drop.film);
  }
  for (const FilmPixel kind : {FilmPixel::OnItsWay, FilmPixel::Film}) {
    std::vector<std::uint8_t> wet(wetting.film.size());
    bool any = false;
    for (std::size_t i = 0; i < wet.size(); ++i) {
      wet[i] = wetting.film[i] == kind;
      any = any || wet[i];
    }
    if (any) screen_film(gap, wet, kind == FilmPixel::Film ? 1 : share, layers, factor);
  }
}

}  // namespace

double screening_length(double gap, double dielectric_thickness) {
  const double x = std::min(dielectric_thickness / gap, 10.0);
  return gap * (2 / kPi + 0.5051 * std::pow(x, 1.29761) / (1 + 0.24186 * x));
}

double screening_reach(double gap, double dielectric_thickness, double bridge_radius) {
  const double x = std::min(dielectric_thickness / gap, 10.0);
  const double i = gap / std::max(bridge_radius, 0.25 * gap);
  return screening_length(gap, dielectric_thickness) / (1 + 0.05027 * x * i / (1 + 0.07394 * i)) *
         (1 - 0.23027 * i / (1 + 2 * i));
}

double lost_share(double gap, const WaterLayers& layers) {
  if (layers.skin <= 0) return 1;
  const double g = std::max(gap, kLeastGap), h = layers.skin, reach = g + h;
  // The water's potential over that of the film far from it, by the dividers of both.
  const double u = h * (reach + layers.dielectric) / (reach * (h + layers.dielectric));
  const double per_gap = g / screening_length(reach, layers.thickness);
  return std::min(1 - u * (kOfLength[0] + per_gap * kOfGap[0]) -
                      square(u) * (kOfLength[1] + per_gap * kOfGap[1]),
                  1.0);
}

std::vector<double> screening_factor(const Gap& gap, const Wetting& wetting,
                                     const WaterLayers& layers, bool fade) {
  const bool wet = wetting.bridges > 0 || wetting.status == WettingStatus::Film;
  if (!wet && wetting.bridged.empty()) return {};
  std::vector<double> factor(gap.grid.size(), 1.0);
  if (wet && fade) {
    if (wetting.status == WettingStatus::Film && !wetting.bridged.empty()) {
      screen_films(gap, wetting, layers, factor);
    }
    for (const Droplet& drop : wetting.droplets) {
      if (drop.state == DropletState::Bridge && drop.film < 1) {
        screen_disc(gap.grid, drop, layers, factor);
      }
    }
  }
  if (!wetting.bridged.empty()) {
    for (std::size_t i = 0; i < factor.size(); ++i) {
      if (wetting.bridged[i]) factor[i] = 0;  // electrowetting carries the load of a bridge
    }
  }
  return factor;
}

std::vector<double> air_screening_factor(const Gap& gap, const Wetting& wetting, bool fade,
                                         const WallFields* wall) {
  const auto wet = [](std::uint8_t pixel) { return pixel != 0; };
  if (std::none_of(wetting.bridged.begin(), wetting.bridged.end(), wet)) return {};
  if (!fade) return screening_factor(gap, wetting, {}, false);
  std::vector<double> width(gap.grid.size());
  for (std::size_t i = 0; i < width.size(); ++i) {
    width[i] = 2 / kPi * std::max(gap.value[i], kLeastGap);
  }
  const double pixel = wall ? std::min(gap.grid.dx(), gap.grid.dy()) : 0;
  const WaterDistance distance(
      gap.grid, wetting.bridged, [&](std::size_t i) { return kReach * width[i] + pixel; },
      wall ? &wall->potential : nullptr);
  std::vector<double> factor = width;
  fade_out(distance.squared(), gap.grid.dy(), factor);
  if (wall) add_wall_pull(distance, *wall, pixel, gap.grid.dy(), width, factor);
  return factor;
}

}  // namespace papilla::electrostatics
