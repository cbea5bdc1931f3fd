#include "report/droplets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "geometry/io/files.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const char* name(DropletState state) {
  switch (state) {
    case DropletState::OnSkin:
      return "skin";
    case DropletState::OnSubstrate:
      return "substrate";
    case DropletState::Bridge:
      return "bridge";
  }
  return "";
}

const char* name(WettingStatus status) {
  switch (status) {
    case WettingStatus::Dry:
      return "dry";
    case WettingStatus::Discs:
      return "discs";
    case WettingStatus::Flooded:
      return "flooded";
    case WettingStatus::Film:
      return "film";
  }
  return "";
}

Json estimate_json(const Estimate& e) { return {{"value", e.value}, {"se", e.se}}; }

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kBridge{30, 110, 255}, kFilm{0, 190, 200}, kSubstrate{255, 150, 0},
    kOnSkin{220, 40, 160};

const Colour& colour_of(DropletState state) {
  switch (state) {
    case DropletState::OnSkin:
      return kOnSkin;
    case DropletState::OnSubstrate:
      return kSubstrate;
    case DropletState::Bridge:
      return kBridge;
  }
  return kBridge;
}

// One panel: the gap in grey (bright: wide) with its scale bar, droplets by state.
class Panel {
 public:
  explicit Panel(const Gap& gap) : grid_(gap.grid) {
    rgb_ = render_field(gap.grid, gap.value, width_, height_);
    bar_.resize(static_cast<std::size_t>(width_) * height_);
    for (std::size_t k = 0; k < bar_.size(); ++k) {
      std::uint8_t* p = &rgb_[3 * k];
      // The colour scale has neither white nor black: those are the bar.
      bar_[k] = p[0] == p[1] && p[1] == p[2] && (p[0] == 0 || p[0] == 255);
      if (bar_[k]) continue;
      const auto grey = static_cast<std::uint8_t>((2 * p[0] + 5 * p[1] + p[2]) / 8);
      p[0] = p[1] = p[2] = grey;
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& rgb() const { return rgb_; }

  void draw(const Wetting& wetting) {
    if (wetting.status == WettingStatus::Film || wetting.status == WettingStatus::Flooded)
      draw_film(wetting);
    for (const Droplet& d : wetting.droplets) {
      if (!(d.film > 0)) draw(d);
    }
  }

 private:
  void draw_film(const Wetting& wetting) {
    for (int iy = 0; iy < height_; ++iy) {
      for (int ix = 0; ix < width_; ++ix) {
        const int px = std::min(ix * grid_.nx / width_, grid_.nx - 1);
        const int py = std::min(iy * grid_.ny / height_, grid_.ny - 1);
        const std::size_t k = grid_.index(px, py);
        if (wetting.film.empty() ? wetting.bridged[k] : wetting.film[k] != FilmPixel::None)
          blend(ix, iy, kFilm, 0.6);
      }
    }
  }

  // A disc with a darker rim.
  void draw(const Droplet& d) {
    const double sx = width_ / grid_.lx, sy = height_ / grid_.ly;
    const double rx = d.radius * sx, ry = d.radius * sy;
    const double rim = std::max(0.0, 1 - 1.5 / std::max(1.5, std::min(rx, ry)));
    const int x0 = static_cast<int>(std::floor(d.x * sx)),
              y0 = static_cast<int>(std::floor(d.y * sy));
    const int nx = static_cast<int>(std::ceil(rx)), ny = static_cast<int>(std::ceil(ry));
    for (int iy = -ny; iy <= ny; ++iy) {
      for (int ix = -nx; ix <= nx; ++ix) {
        const double q = std::hypot(ix / std::max(rx, 1.0), iy / std::max(ry, 1.0));
        if (q <= 1) blend(x0 + ix, y0 + iy, colour_of(d.state), q >= rim ? 1 : 0.45);
      }
    }
  }

  void blend(int ix, int iy, const Colour& c, double share) {
    const std::size_t k =
        static_cast<std::size_t>(height_ - 1 - wrap(iy, height_)) * width_ + wrap(ix, width_);
    if (bar_[k]) return;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint8_t& v = rgb_[3 * k + i];
      v = static_cast<std::uint8_t>(std::lround((1 - share) * v + share * c[i]));
    }
  }

  const Grid& grid_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> rgb_;
  std::vector<bool> bar_;  // pixels of the scale bar, that nothing covers
};

}  // namespace

std::string droplets_text(const DropletCase& c, const DropletResult& result) {
  const Wetting& w = result.wetting;
  const SettleReport& report = result.report;
  return fmt::format(
      "state            {}\nwater            {:.6g} um3, {:.4g} % of it in {} bridges\n"
      "wetted           {:.4g} % of the patch\ncapillary force  {:.6g} uN ({:.6g} kPa)\n"
      "retention        {:.6g} uN\ndroplets         {} of {} left, {} moves, {} mergers{}\n",
      name(w.status), w.volume * 1e18, w.volume > 0 ? 100 * w.bridge_volume / w.volume : 0.0,
      w.bridges, 100 * w.wetted_fraction, w.capillary_force * 1e6,
      w.capillary_force / c.gap.grid.area() * 1e-3, w.retention * 1e6, w.droplets.size(),
      report.initial_droplets, report.moves, report.merges,
      report.converged ? "" : "; stopped before every droplet was at rest");
}

std::string droplets_json(const DropletCase& c, WaterModel model, const DropletResult& result,
                          double seconds) {
  const Wetting& w = result.wetting;
  const SettleReport& report = result.report;
  Json droplets = Json::array();
  for (const Droplet& d : w.droplets) {
    droplets.push_back({{"x", d.x},
                        {"y", d.y},
                        {"volume", d.volume},
                        {"state", name(d.state)},
                        {"radius", d.radius},
                        {"height", d.height},
                        {"edge_gap", d.edge_gap},
                        {"force", d.force},
                        {"film", d.film},
                        {"energy", d.energy}});
  }
  return Json{{"schema", 1},
              {"model", model == WaterModel::Threshold ? "threshold" : "droplets"},
              {"status", name(w.status)},
              {"converged", report.converged},
              {"volume", w.volume},
              {"bridge_volume", w.bridge_volume},
              {"bridges", w.bridges},
              {"wetted_fraction", w.wetted_fraction},
              {"capillary_force", w.capillary_force},
              {"capillary_pressure", w.capillary_force / c.gap.grid.area()},
              {"retention", w.retention},
              {"initial_droplets", report.initial_droplets},
              {"initial_energy", report.initial_energy},
              {"final_energy", report.final_energy},
              {"moves", report.moves},
              {"merges", report.merges},
              {"seconds", seconds},
              {"droplets", droplets}}
      .dump(2);
}

std::string droplet_ensemble_text(const DropletEnsemble& ensemble) {
  std::string out;
  for (const DropletMeans& m : ensemble.volumes) {
    const Estimate &f = m.capillary_force, &b = m.bridges, &a = m.wetted_fraction;
    out += fmt::format(
        "{:.4g} um3, {} placements: capillary force {:.4g} ± {:.2g} uN, {:.3g} ± {:.2g} bridges, "
        "wetted {:.3g} ± {:.2g} %\n",
        1e18 * m.volume, ensemble.placements, 1e6 * f.value, 1e6 * f.se, b.value, b.se,
        100 * a.value, 100 * a.se);
  }
  return out + fmt::format("mean             {:.4g} uN\n", 1e6 * ensemble.mean_capillary_force);
}

std::string droplet_ensemble_json(const DropletEnsemble& ensemble) {
  Json volumes = Json::array();
  for (const DropletMeans& m : ensemble.volumes) {
    volumes.push_back({{"volume", m.volume},
                       {"capillary_force", estimate_json(m.capillary_force)},
                       {"bridges", estimate_json(m.bridges)},
                       {"wetted_fraction", estimate_json(m.wetted_fraction)}});
  }
  return Json{
      {"schema", 1}, {"volumes", volumes}, {"mean_capillary_force", ensemble.mean_capillary_force}}
      .dump(2);
}

void write_droplet_picture(const std::string& path, const Gap& gap, const Wetting& initial,
                           const Wetting& final) {
  Panel left(gap), right(gap);
  left.draw(initial);
  right.draw(final);
  constexpr int kBetween = 8;
  const int width = 2 * left.width() + kBetween;
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3) * width * left.height(), 255);
  const auto copy = [&](const Panel& panel, int from) {
    for (int y = 0; y < panel.height(); ++y) {
      std::copy_n(panel.rgb().begin() + static_cast<std::ptrdiff_t>(3) * y * panel.width(),
                  3 * panel.width(),
                  rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width + from));
    }
  };
  copy(left, 0);
  copy(right, left.width() + kBetween);
  write_png_rgb(path, width, left.height(), rgb);
}

}  // namespace papilla::report
