#include "geometry/textures/particle_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "geometry/texture.h"

namespace papilla::geometry {
namespace {

// Area that a particle is seen to cover over that of its widest circle: 1 for the whole sphere,
// less for the cap of one that sits deep.
double seen_share(double embedding) {
  return embedding <= 0.5 ? 1 : 4 * embedding * (1 - embedding);
}
// Radius of what is seen of it.
double disc_radius(const Particle& p, double embedding) {
  return p.radius * std::sqrt(seen_share(embedding));
}

// Random sequential placement of discs jams at 0.547 (Feder 1980).
constexpr double kDensest = 0.52;

// Particles that a patch holds at least, so that a thin film is not one of no or of one particle,
// and the patch that is simulated at most, in radii: twenty pixels a radius at 1024 a side.
constexpr int kFewest = 4;
constexpr double kLongest = 50;

double draw_radius(const ParticleFilm& film, RandomStream& random) {
  return film.radius * std::clamp(1 + film.radius_spread * random.normal(), 0.3, 1.7);
}

RandomStream draws(const ParticleFilm& film) {
  return RandomStream(static_cast<std::uint64_t>(film.seed), "particles");
}

double disc_area(const Particle& p, double embedding) {
  return kPi * square(disc_radius(p, embedding));
}

// Side of the patch that the first particles drawn cover as asked for: of a thinner film it is
// longer, with the same particles farther apart.
double side_of_fewest(const ParticleFilm& film) {
  RandomStream random = draws(film);
  double covered = 0;
  for (int k = 0; k < kFewest; ++k)
    covered += disc_area({0, 0, draw_radius(film, random)}, film.embedding);
  return std::sqrt(covered / film.coverage);
}

double periodic(double d, double length) { return d - length * std::round(d / length); }

// Discs on a periodic patch, by squares at least as wide as the widest: whatever a disc can touch
// lies in its own square or beside it.
class PlacedDiscs {
 public:
  PlacedDiscs(const Grid& patch, double widest)
      : patch_(patch),
        nx_(squares(patch.lx, widest)),
        ny_(squares(patch.ly, widest)),
        in_(static_cast<std::size_t>(nx_) * ny_) {}

  bool touches(double x, double y, double radius) const {
    const int cx = square_of(x, patch_.lx, nx_), cy = square_of(y, patch_.ly, ny_);
    // Of fewer than three squares each is beside each, once.
    for (int j = 0; j < std::min(ny_, 3); ++j) {
      for (int i = 0; i < std::min(nx_, 3); ++i) {
        for (const Disc& d : at(wrap(cx + i - 1, nx_), wrap(cy + j - 1, ny_))) {
          if (square(periodic(x - d.x, patch_.lx)) + square(periodic(y - d.y, patch_.ly)) <
              square(radius + d.radius))
            return true;
        }
      }
    }
    return false;
  }

  void add(double x, double y, double radius) {
    in_[index(square_of(x, patch_.lx, nx_), square_of(y, patch_.ly, ny_))].push_back(
        {x, y, radius});
  }

 private:
  struct Disc {
    double x, y, radius;
  };
  static int squares(double length, double widest) {
    constexpr double kMost = 1024;
    return static_cast<int>(std::clamp(std::floor(length / widest), 1.0, kMost));
  }
  static int square_of(double at, double length, int count) {
    return std::clamp(static_cast<int>(at / length * count), 0, count - 1);
  }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * nx_ + x; }
  const std::vector<Disc>& at(int x, int y) const { return in_[index(x, y)]; }

  Grid patch_;
  int nx_, ny_;
  std::vector<std::vector<Disc>> in_;
};

}  // namespace

void fields(FieldVisitor& v, ParticleFilm& t) {
  v.number({"radius", "um", 0.01, 100, "mean particle radius", Source::Paper, "M3: 1.5 and 3 um"},
           t.radius);
  v.number({"radius_spread", "%", 0, 50, "standard deviation of the radius over its mean",
            Source::Estimate, "none published"},
           t.radius_spread);
  v.number({"coverage", "%", 0, 100 * kDensest,
            "projected share covered by what shows of the particles, to half of one of them; "
            "particles embedded by more than half touch below the film, and less can be placed",
            Source::Estimate, "none published"},
           t.coverage);
  v.number({"embedding", "%", 0, 95, "share of the diameter below the film", Source::Estimate,
            "none published"},
           t.embedding);
  v.number({"clustering", "", 0, 1, "share of particles placed against another one"}, t.clustering);
  v.integer({"seed", "which random arrangement"}, 0, 1000000000, t.seed);
}

std::vector<Particle> place_particles(const ParticleFilm& film, const Grid& grid) {
  RandomStream random = draws(film);
  std::vector<Particle> particles;
  double covered = 0;
  const double wanted = film.coverage * grid.area();
  while (covered < wanted) {
    const Particle p{0, 0, draw_radius(film, random)};
    const double area = disc_area(p, film.embedding);
    // The last particle is placed when that brings the coverage nearer.
    if (covered + area - wanted > wanted - covered && !particles.empty()) break;
    particles.push_back(p);
    covered += area;
  }
  std::stable_sort(particles.begin(), particles.end(),
                   [](const Particle& a, const Particle& b) { return a.radius > b.radius; });
  // Spheres keep apart by their widest circles, above the film or below it. The first is the
  // largest.
  PlacedDiscs discs(grid, particles.empty() ? 1 : 2 * particles[0].radius);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Particle& p = particles[i];
    bool placed = false;
    constexpr int kTries = 100000;
    for (int attempt = 0; attempt < kTries && !placed; ++attempt) {
      if (i > 0 && random.uniform() < film.clustering) {
        const Particle& other =
            particles[static_cast<std::size_t>(random.below(static_cast<int>(i)))];
        const double angle = random.uniform(0, 2 * kPi);
        const double reach = (p.radius + other.radius) * (1 + 1e-9);
        p.x = other.x + reach * std::cos(angle);
        p.y = other.y + reach * std::sin(angle);
        p.x -= grid.lx * std::floor(p.x / grid.lx);
        p.y -= grid.ly * std::floor(p.y / grid.ly);
      } else {
        p.x = random.uniform(0, grid.lx);
        p.y = random.uniform(0, grid.ly);
      }
      placed = 2 * p.radius < std::min(grid.lx, grid.ly) && !discs.touches(p.x, p.y, p.radius);
    }
    if (placed) discs.add(p.x, p.y, p.radius);
    if (!placed) {
      throw InputError(
          fmt::format("a coverage of {:.0f} % with particles of {:.3g} um radius cannot be reached "
                      "on a patch of "
                      "{:.3g} um; lower the coverage or the spread of the radius",
                      100 * film.coverage, 1e6 * film.radius, 1e6 * grid.lx));
    }
  }
  return particles;
}

Heightmap heights(const ParticleFilm& film, const Grid& grid) {
  Heightmap out{grid, std::vector<double>(grid.size(), 0)};
  for (const Particle& p : place_particles(film, grid)) {
    const double centre = p.radius * (1 - 2 * film.embedding);  // height of the sphere's centre
    const double reach = disc_radius(p, film.embedding);
    const int nx = static_cast<int>(reach / grid.dx()) + 1,
              ny = static_cast<int>(reach / grid.dy()) + 1;
    const int cx = static_cast<int>(p.x / grid.dx()), cy = static_cast<int>(p.y / grid.dy());
    for (int iy = cy - ny; iy <= cy + ny; ++iy) {
      for (int ix = cx - nx; ix <= cx + nx; ++ix) {
        const double dx = (ix + 0.5) * grid.dx() - p.x, dy = (iy + 0.5) * grid.dy() - p.y;
        const double above2 = p.radius * p.radius - dx * dx - dy * dy;
        if (above2 <= 0) continue;
        double& z = out(wrap(ix, grid.nx), wrap(iy, grid.ny));
        z = std::max(z, centre + std::sqrt(above2));
      }
    }
  }
  return out;
}

TextureProblems problems(const ParticleFilm& t) {
  // Of the widest circles, which lie below the film where the particles sit deep.
  if (const double most = kDensest * seen_share(t.embedding); t.coverage > most) {
    const std::string below =
        t.embedding <= 0.5 ? ""
                           : fmt::format(" where {:.3g} % of their diameter lies below the film",
                                         100 * t.embedding);
    return {
        {"coverage",
         fmt::format("random non-overlapping particles jam near {:.3g} %{}; use at most {:.3g} %",
                     55 * seen_share(t.embedding), below, 100 * most)}};
  }
  constexpr double kRoundedUp = 1.05;  // two digits of it are enough
  const double longest = std::max(kLongest * t.radius, kWindow);
  if (!(t.coverage > 0) || side_of_fewest(t) <= longest) return {};
  return {{"coverage",
           fmt::format("so few particles that {} of them need a patch of {:.3g} um, which is more "
                       "than the {:.3g} um that are simulated; use at least {:.2g} %, "
                       "or 0 % for none",
                       kFewest, 1e6 * side_of_fewest(t), 1e6 * longest,
                       100 * kRoundedUp * t.coverage * square(side_of_fewest(t) / longest))}};
}

TextureFacts facts(const ParticleFilm& t) {
  const double top = t.coverage > 0 ? 2 * t.radius * (1 - t.embedding) : 0;
  // No film is flat glass, on the patch of all that is flat.
  const double least = t.coverage > 0 ? std::max(8 * t.radius, side_of_fewest(t)) : 0;
  return {.relief = Relief::between(0, top),
          .cell = std::nullopt,
          .free_patch = FreePatch{least, std::nullopt, false},
          .margins = FabricationMargins::none(),
          .open_share = std::nullopt,
          .rim_radius = std::nullopt,
          // Upright where the widest circle of a particle lies above the film.
          .steepest = t.coverage > 0 ? std::acos(std::clamp(2 * t.embedding - 1, 0.0, 1.0)) : 0.0,
          .outline = NoOutline{"a film of particles has no outline: its caps rise gradually from "
                               "the film, and nothing is etched"},
          .scans = kNoScans,
          .rough = kNoRoughness,
          .directional = false,
          .quick_look = false};
}

Roles roles(ParticleFilm& t) {
  Roles out = Roles::none();
  out.relief = &t.coverage;
  return out;
}

}  // namespace papilla::geometry
