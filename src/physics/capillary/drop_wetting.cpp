#include "physics/capillary/drop_wetting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/capillary/film.h"

namespace papilla::capillary {
namespace {

// From disc to film between these times the limit (Eq. capillary.22).
constexpr double kFilmFrom = 0.8, kFilmTo = 1.25;

// Eq. capillary.22: how much of a bridge is film, by its width or the wetted area. size, limit and
// most in one unit; beyond most all is film.
double film_share(double size, double limit, double most) {
  const double from = kFilmFrom * std::min(limit, most);
  const double to = std::min(kFilmTo * std::min(limit, most), most);
  const double t = std::clamp((size - from) / (to - from), 0.0, 1.0);
  return square(t) * (3 - 2 * t);
}

class WettingBuilder {
 public:
  WettingBuilder(const Gap& gap, const WaterProperties& water, const DropletOptions& options,
                 const DropEnergy& energy, std::vector<Drop>& drops)
      : gap_(gap),
        grid_(gap.grid),
        water_(water),
        options_(options),
        energy_(energy),
        drops_(drops),
        force_(drops.size(), 0.0) {}

  Wetting build(double volume, double wicked) {
    Wetting out;
    out.grid = grid_;
    out.volume = volume;
    out.wicked_volume = wicked;
    out.status = WettingStatus::Discs;
    out.bridged.assign(grid_.size(), 0);
    if (mark_film()) add_film(out);
    add_discs(out);
    return out;
  }

 private:
  // Each drop's share of film; true if there is any.
  bool mark_film() {
    const double side = std::min(grid_.lx, grid_.ly);
    double area = 0;
    for (const Drop& d : drops_) {
      if (d.alive && d.bridge) area += kPi * square(d.radius);
    }
    const double all = film_share(area / grid_.area(), options_.film_area, 1);
    bool any = false;
    for (Drop& d : drops_) {
      if (!d.alive) continue;
      d.film = d.bridge ? std::max(all, film_share(2 * d.radius, options_.film_width, side))
                        : static_cast<double>(2 * d.radius > side);
      any = any || d.film > 0;
    }
    return any;
  }

  void add_discs(Wetting& out) {
    double wet = out.wetted_fraction * grid_.area();
    for (std::size_t i = 0; i < drops_.size(); ++i) {
      const Drop& d = drops_[i];
      if (!d.alive) continue;
      const bool disc = d.bridge && !(d.film > 0);
      if (disc) force_[i] = energy_.force(d);
      out.droplets.push_back(reported(d, force_[i]));
      if (!disc) continue;
      ++out.bridges;
      out.capillary_force += force_[i];
      out.bridge_volume += d.volume;
      out.retention += energy_.retention(d);
      wet += kPi * square(d.radius);
      for_pixels(grid_, disc_of(d), [&](std::size_t k) { out.bridged[k] = 1; });
    }
    out.wetted_fraction = std::min(1.0, wet / grid_.area());
  }

  static Droplet reported(const Drop& d, double force) {
    Droplet out;
    out.x = d.x;
    out.y = d.y;
    out.volume = d.volume;
    out.energy = d.energy;
    out.film = d.film;
    if (d.bridge) {
      const double area = kPi * square(d.radius);
      out.state = DropletState::Bridge;
      out.radius = d.radius;
      out.height = d.volume / area;
      out.edge_gap = d.edge_gap;
      out.force = force;
    } else {
      out.state = d.film > 0 ? DropletState::Bridge : d.side;
      out.radius = d.footprint;
      out.height = d.height;
    }
    return out;
  }

  // Where films start, and which other drop a pixel belongs to (-1: none).
  struct Sources {
    std::vector<FilmSource> sources;
    std::vector<std::size_t> seeds;
    std::vector<int> drop;   // of each source
    std::vector<int> owner;  // of each pixel
  };

  Sources film_sources() const {
    Sources out;
    out.owner.assign(grid_.size(), -1);
    for (int i = 0; i < static_cast<int>(drops_.size()); ++i) {
      const Drop& d = drops_[i];
      if (!d.alive) continue;
      if (d.film > 0) {
        out.sources.push_back({d.x, d.y, d.radius, d.edge_gap, d.volume, d.film});
        out.seeds.push_back(seed_of(out.sources.back(), d));
        out.drop.push_back(i);
        continue;
      }
      out.owner[pixel_of(grid_, d.x, d.y)] = i;
      if (!d.bridge) continue;
      for_pixels(grid_, disc_of(d), [&](std::size_t k) { out.owner[k] = i; });
    }
    return out;
  }

  // Where the region of a source starts: its lowest level inside the disc.
  std::size_t seed_of(const FilmSource& source, const Drop& d) const {
    std::size_t best = pixel_of(grid_, d.x, d.y);
    const auto level = [&](std::size_t k) {
      return film_level(source, square_distance(grid_, k, d.x, d.y), gap_.value[k]);
    };
    double lowest = level(best);
    for_pixels(grid_, disc_of(d), [&](std::size_t k) {
      const double here = level(k);
      if (here < lowest) {
        lowest = here;
        best = k;
      }
    });
    return best;
  }

  // The film takes in every bridge whose disc and every cap whose centre it reaches.
  void add_film(Wetting& out) {
    const Sources from = film_sources();
    struct Joined {
      int drop, source;
    };
    std::vector<Joined> joined;
    FilmRegions films =
        grow_films(gap_, from.sources, from.seeds, water_, [&](std::size_t k, int source) {
          const int i = from.owner[k];
          if (i < 0 || drops_[i].film > 0) return 0.0;
          drops_[i].film = 1;
          joined.push_back({i, source});
          return drops_[i].volume;
        });
    out.status = WettingStatus::Film;
    double area = 0;
    for (const FilmRegion& region : films.regions) {
      if (region.full) out.status = WettingStatus::Flooded;
      ++out.bridges;
      out.bridge_volume += region.volume;
      out.capillary_force += region.share * region.force;
      out.retention += region.share * region.retention;
      area += region.share * region.area;
    }
    const auto add_disc = [&](int i, double share) {  // what of it is still a disc
      const Drop& d = drops_[i];
      if (!d.bridge || share <= 0) return;
      force_[i] = share * energy_.force(d);
      out.capillary_force += force_[i];
      out.retention += share * energy_.retention(d);
      area += share * kPi * square(d.radius);
    };
    for (std::size_t s = 0; s < from.sources.size(); ++s) {
      add_disc(from.drop[s], 1 - from.sources[s].share);
    }
    for (const Joined& j : joined) {
      add_disc(j.drop, 1 - films.regions[films.of_source[j.source]].share);
    }
    out.wetted_fraction = area / grid_.area();
    mark_pixels(std::move(films), out);
  }

  void mark_pixels(FilmRegions films, Wetting& out) const {
    std::vector<double> pixels(films.regions.size(), 0.0);
    out.film.assign(films.source.size(), FilmPixel::None);
    out.film_region = std::move(films.source);
    for (std::size_t k = 0; k < out.film.size(); ++k) {
      int& place = out.film_region[k];  // until now that of its source
      if (place == 0) continue;
      const int region = films.of_source[place - 1];
      place = region + 1;
      ++pixels[region];
      out.bridged[k] = 1;
      out.film[k] = films.regions[region].share < 1 ? FilmPixel::OnItsWay : FilmPixel::Film;
    }
    for (std::size_t r = 0; r < pixels.size(); ++r) {
      const FilmRegion& region = films.regions[r];
      out.film_pressure.push_back(region.share * region.force / (pixels[r] * grid_.pixel_area()));
    }
  }

  const Gap& gap_;
  const Grid& grid_;
  const WaterProperties& water_;
  const DropletOptions& options_;
  const DropEnergy& energy_;
  std::vector<Drop>& drops_;
  std::vector<double> force_;  // of each drop, of what of it is a disc [N]
};

}  // namespace

Wetting wetting_of(const Gap& gap, const WaterProperties& water, const DropletOptions& options,
                   const DropEnergy& energy, std::vector<Drop>& drops, double volume,
                   double wicked) {
  return WettingBuilder(gap, water, options, energy, drops).build(volume, wicked);
}

}  // namespace papilla::capillary
