#include "geometry/areal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "base/constants.h"
#include "base/memory.h"
#include "numerics/fft.h"

namespace papilla::geometry {
namespace {

double mean_of(const std::vector<double>& z) {
  double sum = 0;
  for (const double v : z) sum += v;
  return sum / static_cast<double>(z.size());
}

void heights(const Heightmap& h, ArealParameters& out) {
  const double mean = mean_of(h.z), n = static_cast<double>(h.z.size());
  double s2 = 0, s3 = 0, s4 = 0;
  for (const double v : h.z) {
    const double z = v - mean;
    out.sa += std::abs(z) / n;
    s2 += z * z / n, s3 += z * z * z / n, s4 += z * z * z * z / n;
    out.sp = std::max(out.sp, z), out.sv = std::max(out.sv, -z);
  }
  out.sq = std::sqrt(s2);
  out.sz = out.sp + out.sv;
  out.ssk = s2 > 0 ? s3 / (s2 * out.sq) : 0;
  out.sku = s2 > 0 ? s4 / (s2 * s2) : 0;
}

void slopes(const Heightmap& h, ArealParameters& out) {
  const Grid& g = h.grid;
  double sum = 0, area = 0, steepest = 0, n = 0;
  // A single row or column has slopes along it alone.
  const int rows = std::max(g.ny - 1, 1), columns = std::max(g.nx - 1, 1);
  for (int iy = 0; iy < rows; ++iy) {
    for (int ix = 0; ix < columns; ++ix) {
      const double step_x = g.nx > 1 ? h(ix + 1, iy) - h(ix, iy) : 0,
                   step_y = g.ny > 1 ? h(ix, iy + 1) - h(ix, iy) : 0;
      const double slope = square(step_x / g.dx()) + square(step_y / g.dy());
      sum += slope, area += std::sqrt(1 + slope) - 1, n += 1;
      steepest = std::max({steepest, std::abs(step_x), std::abs(step_y)});
    }
  }
  out.sdq = std::sqrt(sum / n);
  out.sdr = area / n;
  out.sampling_limited = out.sz > 0 && steepest > 0.25 * out.sz;
}

// --- how far it is alike ---

// Autocorrelation at shifts of up to half the map: c(0) = 1; each is the mean over the pixels that
// both copies have.
class Autocorrelation {
 public:
  explicit Autocorrelation(const Heightmap& h) : g_(h.grid), nx_(2 * g_.nx), ny_(2 * g_.ny) {
    const auto fft = Fft2d::shared(nx_, ny_);
    const double mean = mean_of(h.z);
    value_.assign(fft->real_size(), 0);
    for (int iy = 0; iy < g_.ny; ++iy) {
      for (int ix = 0; ix < g_.nx; ++ix) value_[at(ix, iy)] = h(ix, iy) - mean;
    }
    SpectrumArray spectrum(fft->spectrum_size());
    fft->forward(value_.data(), spectrum.data());
    for (auto& mode : spectrum) mode = std::norm(mode);
    fft->inverse(spectrum.data(), value_.data());
  }
  int reach_x() const { return g_.nx / 2; }
  int reach_y() const { return g_.ny / 2; }
  // Of shifts within the reach, to either side.
  double operator()(int sx, int sy) const {
    const double overlap = static_cast<double>(g_.nx - std::abs(sx)) * (g_.ny - std::abs(sy));
    const double all = static_cast<double>(g_.nx) * g_.ny;
    return value_[at(wrap(sx, nx_), wrap(sy, ny_))] / value_[0] * all / overlap;
  }

 private:
  std::size_t at(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(ix);
  }
  Grid g_;
  int nx_, ny_;
  RealArray value_;
};

// The region around no shift where the autocorrelation is above 0.2: how near and how far its
// border is, between pixels by a straight line.
class AlikeRegion {
 public:
  explicit AlikeRegion(const Autocorrelation& c, const Grid& grid)
      : c_(c),
        grid_(grid),
        wide_(2 * c.reach_x() + 1),
        seen_(static_cast<std::size_t>(wide_ * (2 * c.reach_y() + 1))) {
    visit(0, 0);
    while (!open_.empty()) {
      const auto [sx, sy] = open_.back();
      open_.pop_back();
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        step(sx, sy, sx + dx, sy + dy);
    }
  }

  double nearest = kInfinity, farthest = 0;  // [m]
  bool leaves = false;                       // reaches half the map

 private:
  static constexpr double kAlike = 0.2;

  void visit(int sx, int sy) {
    std::uint8_t& seen =
        seen_[static_cast<std::size_t>((sy + c_.reach_y()) * wide_ + sx + c_.reach_x())];
    if (seen) return;
    seen = 1;
    open_.emplace_back(sx, sy);
  }
  void step(int sx, int sy, int tx, int ty) {
    if (std::abs(tx) > c_.reach_x() || std::abs(ty) > c_.reach_y()) {
      leaves = true;
      return;
    }
    const double inside = c_(sx, sy), outside = c_(tx, ty);
    if (outside > kAlike) {
      visit(tx, ty);
      return;
    }
    const double t = (inside - kAlike) / (inside - outside);
    const double way =
        std::hypot((sx + t * (tx - sx)) * grid_.dx(), (sy + t * (ty - sy)) * grid_.dy());
    nearest = std::min(nearest, way);
    farthest = std::max(farthest, way);
  }

  const Autocorrelation& c_;
  Grid grid_;
  int wide_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::pair<int, int>> open_;
};

void likeness(const Heightmap& h, ArealParameters& out) {
  if (out.sq == 0) return;
  const Autocorrelation correlation(h);
  const AlikeRegion region(correlation, h.grid);
  if (region.nearest < kInfinity) out.sal = region.nearest;
  if (region.nearest < kInfinity && !region.leaves) out.str = region.nearest / region.farthest;
}

// --- spectrum ---

// The modes of the map less its mean under a Hann window along both sides; use(qx, qy, power) with
// power its density, twice for the half that is kept. Eq. geometry.6
template <typename Use>
void each_mode(const Heightmap& h, const Use& use) {
  const Grid& g = h.grid;
  const auto fft = Fft2d::shared(g.nx, g.ny);
  const auto hann = [](int i, int n) { return square(std::sin(kPi * (i + 0.5) / n)); };
  double weight = 0, weighted = 0, squares = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const double w = hann(ix, g.nx) * hann(iy, g.ny);
      weight += w, squares += w * w, weighted += w * h(ix, iy);
    }
  }
  RealArray z(g.size());
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix)
      z[g.index(ix, iy)] = hann(ix, g.nx) * hann(iy, g.ny) * (h(ix, iy) - weighted / weight);
  }
  SpectrumArray spectrum(fft->spectrum_size());
  fft->forward(z.data(), spectrum.data());
  const double n = static_cast<double>(g.size());
  const double density = g.area() / square(2 * kPi) / (n * squares);
  for (int iy = 0; iy < g.ny; ++iy) {
    const int ky = signed_mode(iy, g.ny);
    for (int kx = 0; kx < fft->half(); ++kx) {
      if (kx == 0 && ky == 0) continue;
      const bool twice = kx > 0 && 2 * kx < g.nx;
      use(2 * kPi * kx / g.lx, 2 * kPi * ky / g.ly,
          density *
              std::norm(
                  spectrum[static_cast<std::size_t>(iy) * static_cast<std::size_t>(fft->half()) +
                           static_cast<std::size_t>(kx)]),
          twice ? 2 : 1);
    }
  }
}

// The direction with the most power in five degrees, then the middle of what is within twelve of it
// (the window spreads a wave over its neighbours); of waves of at least three periods, within a
// circle: no direction of the grid counts more.
double direction(const Heightmap& h) {
  constexpr int kBins = 180, kPeak = 2, kBeside = 12;
  const Grid& g = h.grid;
  const double least = 3 * 2 * kPi / std::min(g.lx, g.ly), most = kPi / std::max(g.dx(), g.dy());
  std::vector<double> power(kBins), along(kBins), across(kBins);
  each_mode(h, [&](double qx, double qy, double density, int times) {
    const double q = std::hypot(qx, qy);
    if (q < least || q > most) return;
    double angle = std::atan2(qy, qx);
    if (angle < 0) angle += kPi;
    const int bin = std::min(kBins - 1, static_cast<int>(angle / kPi * kBins));
    const auto i = static_cast<std::size_t>(bin);
    power[i] += times * density;
    along[i] += times * density * std::cos(2 * angle);
    across[i] += times * density * std::sin(2 * angle);
  });
  const auto around = [&](const std::vector<double>& values, int bin, int beside) {
    double sum = 0;
    for (int d = -beside; d <= beside; ++d)
      sum += values[static_cast<std::size_t>(wrap(bin + d, kBins))];
    return sum;
  };
  int best = 0;
  for (int i = 1; i < kBins; ++i) {
    if (around(power, i, kPeak) > around(power, best, kPeak)) best = i;
  }
  double angle = 0;
  for (int round = 0; round < 2; ++round) {  // again around what was found
    angle = 0.5 * std::atan2(around(across, best, kBeside), around(along, best, kBeside));
    if (angle < 0) angle += kPi;
    best = std::min(kBins - 1, static_cast<int>(angle / kPi * kBins));
  }
  return angle;
}

// --- how the material is shared out ---

void material(const Heightmap& h, ArealParameters& out) {
  std::vector<double> z = h.z;
  std::sort(z.begin(), z.end(), std::greater<>());
  const auto n = static_cast<std::ptrdiff_t>(z.size());
  const double count = static_cast<double>(n);
  // Height that a share m of the surface is above; linear between the pixels' middles.
  const auto curve = [&](double m) {
    const double at = std::clamp(m * count - 0.5, 0.0, count - 1);
    const auto i = std::min(static_cast<std::ptrdiff_t>(at), n - 1);
    const auto j = std::min(i + 1, n - 1);
    const double t = at - static_cast<double>(i);
    return (1 - t) * z[static_cast<std::size_t>(i)] + t * z[static_cast<std::size_t>(j)];
  };
  // The secant over 40 % that falls least.
  constexpr double kSecant = 0.4;
  constexpr int kStarts = 6000;
  double best = kInfinity, start = 0;
  for (int i = 0; i <= kStarts; ++i) {
    const double m = (1 - kSecant) * i / kStarts;
    const double fall = curve(m) - curve(m + kSecant);
    if (fall < best) best = fall, start = m;
  }
  const double steep = best / kSecant;
  const double top = curve(start) + steep * start, bottom = top - steep;
  out.sk = top - bottom;
  const std::ptrdiff_t peaks =
      std::partition_point(z.begin(), z.end(), [&](double v) { return v > top; }) - z.begin();
  const std::ptrdiff_t core =
      std::partition_point(z.begin(), z.end(), [&](double v) { return v >= bottom; }) - z.begin();
  out.smr1 = static_cast<double>(peaks) / count;
  out.smr2 = static_cast<double>(core) / count;
  double hills = 0, dales = 0;
  for (std::ptrdiff_t i = 0; i < peaks; ++i)
    hills += (z[static_cast<std::size_t>(i)] - top) / count;
  for (std::ptrdiff_t i = core; i < n; ++i)
    dales += (bottom - z[static_cast<std::size_t>(i)]) / count;
  out.spk = peaks > 0 ? 2 * hills / out.smr1 : 0;
  out.svk = core < n ? 2 * dales / (1 - out.smr2) : 0;
}

}  // namespace

ArealParameters areal_parameters(const Heightmap& h) {
  require_memory(100.0 * static_cast<double>(h.grid.size()), "the autocorrelation of a surface");
  ArealParameters out;
  heights(h, out);
  slopes(h, out);
  likeness(h, out);
  out.std = direction(h);
  material(h, out);
  return out;
}

std::vector<SpectrumRing> radial_spectrum(const Heightmap& h) {
  constexpr double kRingsPerDecade = 10;
  struct Sums {
    double density = 0, logarithm = 0, count = 0;
  };
  const Grid& g = h.grid;
  const double longest = std::max(g.lx, g.ly), shortest = 2 * std::max(g.dx(), g.dy());
  if (!(longest > shortest)) return {};
  const int rings =
      1 + static_cast<int>(std::ceil(kRingsPerDecade * std::log10(longest / shortest)));
  std::vector<Sums> sums(static_cast<std::size_t>(rings));
  each_mode(h, [&](double qx, double qy, double density, int times) {
    const double wavelength = 2 * kPi / std::hypot(qx, qy);
    if (wavelength < shortest * (1 - 1e-9)) return;
    const double at = kRingsPerDecade * std::log10(longest / wavelength);
    Sums& ring =
        sums[static_cast<std::size_t>(std::clamp(static_cast<int>(at + 1e-9), 0, rings - 1))];
    ring.density += times * density;
    ring.logarithm += times * std::log(wavelength);
    ring.count += times;
  });
  std::vector<SpectrumRing> out;
  for (const Sums& ring : sums) {
    if (ring.count > 0)
      out.push_back({std::exp(ring.logarithm / ring.count), ring.density / ring.count});
  }
  return out;
}

KnownBand known_band(const Heightmap& h, const std::vector<SpectrumRing>& spectrum, double tip) {
  const Grid& g = h.grid;
  KnownBand out{0.25 * std::min(g.lx, g.ly), 2 * std::max(g.dx(), g.dy()), false};
  if (!(tip > 0)) return out;
  // Along one direction, of an isotropic surface: 3/8 of the integral of q^4 C over the plane.
  double curvature2 = 0, before = 0;
  for (const SpectrumRing& ring : spectrum) {
    const double q = 2 * kPi / ring.wavelength;
    if (before > 0)
      curvature2 += 0.375 * 2 * kPi * q * (q - before) * std::pow(q, 4) * ring.density;
    before = q;
    if (std::sqrt(curvature2) <= 0.5 / tip || ring.wavelength < out.shortest) continue;
    out.shortest = ring.wavelength;
    out.by_tip = true;
    break;
  }
  return out;
}

std::vector<double> height_histogram(const Heightmap& h, int bins) {
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  std::vector<double> out(static_cast<std::size_t>(bins));
  for (const double z : h.z) {
    const double share = *high > *low ? (z - *low) / (*high - *low) : 0;
    out[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>(share * bins)))] +=
        1 / static_cast<double>(h.z.size());
  }
  return out;
}

}  // namespace papilla::geometry
