// How far the options of the droplets move capillary force, pull and modulation on the gaps of real
// scenes, which placement of droplets has the least error for its cost, and what the papers'
// ensemble says. Prints results/accuracy/water.csv: ninja -C build/release water_accuracy_bench &&
// build/release/bench/water_accuracy_bench designs > results/accuracy/water.csv
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace {

using namespace papilla::tests;

constexpr int kSkins = 16;

// Dry contacts of one scene at one humidity: what water and field see.
struct Patches {
  std::string scene;
  double humidity = 0, volume = 0, load = 0;
  WaterProperties off, on;
  DropletOptions options;
  FieldProblem field;
  std::vector<Gap> gaps;
  std::optional<CoveredSurface> surface;
  Grid grid;
};

Patches solve_dry(const std::string& folder, const std::string& file, double angle, double rh) {
  Design design = read_design(folder + "/m3_samples/" + file + ".toml");
  design.surface.contact_angle = angle * kPi / 180;
  const Scene scene = scene_of(design);
  const Fidelity fidelity = fidelity_level("search");
  Patches out;
  out.scene = fmt::format("{} {:.0f} deg", file, angle);
  out.humidity = rh;
  const SkinWater& water = scene.finger.water;
  out.off = {water.surface_tension, water.contact_angle, scene.surface.contact_angle,
             water.hysteresis};
  out.on = out.off;
  out.on.theta_substrate = driven_contact_angle(scene, rh);
  out.field = field_problem(scene, rh);
  Scene dry = scene;
  std::fill(dry.finger.water.volume.begin(), dry.finger.water.volume.end(), 0.0);
  dry.drive.amplitude = 0;
  for (int k = 0; k < kSkins; ++k) {
    PatchPicture p = picture_patch(dry, design.texture, fidelity, rh, k);
    out.gaps.push_back({p.texture.grid, std::move(p.fields.off.gap)});
    out.grid = p.texture.grid;
    out.surface.emplace(std::move(p.texture), film_layers(scene.surface));
  }
  const double area = out.grid.area();
  out.volume = water.volume_per_area(rh) * area;
  out.load = ScaleBridge(scene, fidelity, out.grid, rh).mean_pressure() * area;
  return out;
}

struct Answer {
  double capillary, pull, modulation, bridge_share;  // by load, by load, -, of the water
};

Answer answer(const Patches& p, std::size_t k, const Wetting& off) {
  const Wetting on = rewet(off, p.gaps[k], p.on);
  const double pull =
      solve_spread_field(p.gaps[k], &*p.surface, on, p.field).mean_pressure * p.gaps[k].grid.area();
  return {off.capillary_force / p.load, pull / p.load,
          (p.load + on.capillary_force + pull) / (p.load + off.capillary_force) - 1,
          off.volume > 0 ? off.bridge_volume / off.volume : 0};
}

using Settle = std::function<Wetting(const Patches&, std::size_t skin)>;

std::vector<Answer> answers(const Patches& p, const Settle& settle) {
  std::vector<Answer> out;
  for (std::size_t k = 0; k < p.gaps.size(); ++k) out.push_back(answer(p, k, settle(p, k)));
  return out;
}

std::vector<double> column(const std::vector<Answer>& a, double Answer::*member) {
  std::vector<double> out;
  for (const Answer& x : a) out.push_back(x.*member);
  return out;
}

void print_row(const Patches& p, const std::string& variant, const std::vector<Answer>& now,
               const std::vector<Answer>& reference) {
  fmt::print("options,{},{:.0f},{},{:.3f},{:.3f},{:.4f},{:.3f}", p.scene, 100 * p.humidity, variant,
             mean_estimate(column(now, &Answer::bridge_share)).value,
             mean_estimate(column(now, &Answer::capillary)).value,
             mean_estimate(column(now, &Answer::modulation)).value,
             mean_estimate(column(now, &Answer::pull)).value);
  for (auto member : {&Answer::capillary, &Answer::modulation, &Answer::pull}) {
    const Estimate change = ratio_estimate(column(now, member), column(reference, member));
    fmt::print(",{:.1f},{:.1f}", 100 * (change.value - 1), 100 * change.se);
  }
  fmt::print("\n");
}

Settle droplets(const std::function<void(DropletOptions&)>& change, double factor = 1) {
  return [change, factor](const Patches& p, std::size_t k) {
    DropletOptions options = p.options;
    change(options);
    return settle_droplets(p.gaps[k], factor * p.volume, p.off, options, 1, k);
  };
}

void study_options(const std::vector<Patches>& all) {
  fmt::print(
      "table,scene,humidity_percent,variant,bridge_share,capillary_per_load,modulation,pull_per_"
      "load,capillary_change_percent,se,modulation_change_percent,se,pull_change_percent,se\n");
  for (const Patches& p : all) {
    const std::vector<Answer> reference = answers(p, droplets([](DropletOptions&) {}));
    print_row(p, "default", reference, reference);
    for (double step : {25e-9, 50e-9, 100e-9, 400e-9, 800e-9, 1600e-9}) {
      const auto with = [step](DropletOptions& o) {
        o.first_step = step;
        o.halvings = std::max(0, static_cast<int>(std::lround(std::log2(step / 12.5e-9))));
      };
      print_row(p, fmt::format("step {:.0f} nm", 1e9 * step), answers(p, droplets(with)),
                reference);
    }
    for (double drops : {12.5, 25.0, 50.0, 200.0, 400.0, 800.0}) {
      const auto with = [drops](DropletOptions& o) { o.drops_per_volume = drops * 1e18; };
      print_row(p, fmt::format("{:g} per um3", drops), answers(p, droplets(with)), reference);
    }
    print_row(p, "last step 3 nm", answers(p, droplets([](DropletOptions& o) { o.halvings = 6; })),
              reference);
    const auto film = [](double width, double area) {
      return droplets([width, area](DropletOptions& o) {
        o.film_width = width;
        o.film_area = area;
      });
    };
    print_row(p, "film from 3 um or 30 %", answers(p, film(3e-6, 0.3)), reference);
    print_row(p, "film from 6 um or 55 %", answers(p, film(6e-6, 0.55)), reference);
    print_row(p, "volume x 2/3", answers(p, droplets([](DropletOptions&) {}, 2.0 / 3)), reference);
    print_row(p, "volume x 4/3", answers(p, droplets([](DropletOptions&) {}, 4.0 / 3)), reference);
    // The force of a bridge as if the gap did not open at its rim: C A / h_e + f pi r.
    const auto flat_rims = [](const Patches& q, std::size_t k) {
      Wetting w = settle_droplets(q.gaps[k], q.volume, q.off, q.options, 1, k);
      const double c = wetting_gain(q.off.theta_skin, q.off.theta_substrate);
      const double f = meniscus_factor(q.off.theta_skin, q.off.theta_substrate);
      for (const Droplet& d : w.droplets) {
        if (d.state != DropletState::Bridge || d.film > 0) continue;
        w.capillary_force += q.off.surface_tension * kPi * d.radius *
                                 (c * d.radius / std::max(d.edge_gap, 1e-9) + f) -
                             d.force;
      }
      return w;
    };
    print_row(p, "force without the slope at the rim", answers(p, flat_rims), reference);
    const auto threshold = [&p](bool same_bridges) {
      return [&p, same_bridges](const Patches&, std::size_t k) {
        const double volume =
            same_bridges
                ? settle_droplets(p.gaps[k], p.volume, p.off, p.options, 1, k).bridge_volume
                : p.volume;
        return fill_threshold(p.gaps[k], volume, p.off);
      };
    };
    print_row(p, "threshold", answers(p, threshold(false)), reference);
    print_row(p, "threshold same bridge water", answers(p, threshold(true)), reference);
  }
}

// Standard deviation of the mean over two members on one skin, by how their droplets are placed:
// its square relative to independent members is the cost factor at equal error.
void study_placement(const std::vector<Patches>& all) {
  fmt::print(
      "\ntable,scene,humidity_percent,placement,mean_relative_to_uniform_percent,se,variance_of_a_"
      "pair_relative_to_independent,seed_sd_percent,skin_sd_percent\n");
  constexpr int kPairs = 24;
  const auto force = [](const Patches& p, std::size_t k, const std::vector<DropletSeed>& seeds) {
    return settle_droplets(p.gaps[k], seeds, p.off, p.options).capillary_force;
  };
  using Place = std::function<std::vector<DropletSeed>(const Patches&, std::uint64_t, bool)>;
  const auto uniform = [](const Patches& p, std::uint64_t i) {
    return scatter_droplets(p.grid, p.volume, p.options, 7, i);
  };
  const std::vector<std::pair<std::string, Place>> places = {
      {"independent", [&](const Patches& p, std::uint64_t i,
                          bool second) { return uniform(p, 2 * i + (second ? 1 : 0)); }},
      {"antithetic: shifted by half a patch",
       [&](const Patches& p, std::uint64_t i, bool second) {
         auto seeds = uniform(p, 2 * i);
         if (!second) return seeds;
         for (DropletSeed& d : seeds) {
           d.x = std::fmod(d.x + 0.5 * p.grid.lx, p.grid.lx);
           d.y = std::fmod(d.y + 0.5 * p.grid.ly, p.grid.ly);
         }
         return seeds;
       }},
      {"antithetic: small volumes for large",
       [&](const Patches& p, std::uint64_t i, bool second) {
         auto seeds = uniform(p, 2 * i);
         if (!second) return seeds;
         double largest = 0, sum = 0;
         for (const DropletSeed& d : seeds) largest = std::max(largest, d.volume);
         for (DropletSeed& d : seeds) sum += d.volume = 1.001 * largest - d.volume;
         for (DropletSeed& d : seeds) d.volume *= p.volume / sum;
         return seeds;
       }},
      {"stratified: jittered cells", [&](const Patches& p, std::uint64_t i, bool second) {
         auto seeds = uniform(p, 2 * i + (second ? 1 : 0));
         // A cell a droplet, rows of nearly equal length; the place inside from the uniform one.
         const std::size_t n = seeds.size();
         const auto rows =
             static_cast<std::size_t>(std::max(1.0, std::round(std::sqrt(static_cast<double>(n)))));
         for (std::size_t r = 0, k = 0; r < rows; ++r) {
           const std::size_t end = (r + 1) * n / rows, in_row = end - k;
           for (std::size_t c = 0; k < end; ++k, ++c) {
             const double cell_x = p.grid.lx / static_cast<double>(in_row),
                          cell_y = p.grid.ly / static_cast<double>(rows);
             seeds[k].x = (static_cast<double>(c) + seeds[k].x / p.grid.lx) * cell_x;
             seeds[k].y = (static_cast<double>(r) + seeds[k].y / p.grid.ly) * cell_y;
           }
         }
         return seeds;
       }}};
  for (const Patches& p : all) {
    const std::size_t skins = 8;
    double independent = 0;
    std::vector<double> uniform_means;
    for (const auto& [name, place] : places) {
      double pair_variance = 0, seed_variance = 0;
      std::vector<double> skin_means;
      for (std::size_t k = 0; k < skins; ++k) {
        std::vector<double> pairs, single;
        for (std::uint64_t i = 0; i < kPairs; ++i) {
          const double a = force(p, k, place(p, i, false)), b = force(p, k, place(p, i, true));
          pairs.push_back(0.5 * (a + b));
          single.push_back(a);
        }
        const Estimate pair = mean_estimate(pairs), one = mean_estimate(single);
        pair_variance += square(pair.se) * kPairs / static_cast<double>(skins);
        seed_variance += square(one.se) * kPairs / static_cast<double>(skins);
        skin_means.push_back(pair.value);
      }
      if (uniform_means.empty()) {
        uniform_means = skin_means;
        independent = pair_variance;
      }
      const Estimate mean = mean_estimate(skin_means);
      const Estimate ratio = ratio_estimate(skin_means, uniform_means);
      fmt::print("placement,{},{:.0f},{},{:.1f},{:.1f},{:.2f},{:.1f},{:.1f}\n", p.scene,
                 100 * p.humidity, name, 100 * (ratio.value - 1), 100 * ratio.se,
                 pair_variance / independent, 100 * std::sqrt(seed_variance) / mean.value,
                 100 * mean.se * std::sqrt(static_cast<double>(skins)) / mean.value);
    }
  }
}

// The paper's way: low and high volume by six seeds on each patch; and its test of one sample
// against another: six seeds on one patch each, Welch's t at 95 %.
void study_ensemble(const std::string& folder) {
  fmt::print(
      "\ntable,scene,humidity_percent,low_per_load,se_seeds,high_per_load,se_seeds,mean_per_load,"
      "se_"
      "skins,against_a3h350_percent,se_paired_skins,patches_where_six_seeds_differ_percent\n");
  constexpr int kSeeds = 6;
  constexpr double kSpread = 1.0 / 3;  // 5 to 10 um3
  for (double rh : {0.55, 0.75}) {
    std::vector<std::vector<Estimate>> reference;  // [skin][low, high]
    std::vector<double> reference_mean;
    for (const char* file : {"a3h350", "a3h600", "a3h900", "a4h350", "a4h600", "flat"}) {
      const Patches p = solve_dry(folder, file, 50, rh);
      std::vector<std::vector<Estimate>> all;
      std::vector<double> means;
      for (std::size_t k = 0; k < p.gaps.size(); ++k) {
        std::vector<Estimate> both;
        for (double factor : {1 - kSpread, 1 + kSpread}) {
          std::vector<double> force;
          for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            force.push_back(
                settle_droplets(p.gaps[k], factor * p.volume, p.off, p.options, 1, k + (seed << 32))
                    .capillary_force /
                p.load);
          }
          both.push_back(mean_estimate(force));
        }
        means.push_back(0.5 * (both[0].value + both[1].value));
        all.push_back(both);
      }
      if (reference.empty()) {
        reference = all;
        reference_mean = means;
      }
      Estimate low, high;
      int differ = 0;
      for (std::size_t k = 0; k < all.size(); ++k) {
        const auto n = static_cast<double>(all.size());
        low.value += all[k][0].value / n;
        low.se += square(all[k][0].se) / (n * n);
        high.value += all[k][1].value / n;
        high.se += square(all[k][1].se) / (n * n);
        for (int v = 0; v < 2; ++v) {
          const Estimate &a = all[k][v], &b = reference[k][v];
          const double variance = square(a.se) + square(b.se);
          const double freedom =
              square(variance) * (kSeeds - 1) / (square(square(a.se)) + square(square(b.se)));
          differ += std::abs(a.value - b.value) >
                    student_t_quantile(0.975, static_cast<int>(freedom)) * std::sqrt(variance);
        }
      }
      const Estimate mean = mean_estimate(means), ratio = ratio_estimate(means, reference_mean);
      fmt::print(
          "ensemble,{},{:.0f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.1f},{:.1f},{:.0f}\n",
          p.scene, 100 * rh, low.value, std::sqrt(low.se), high.value, std::sqrt(high.se),
          mean.value, mean.se, 100 * (ratio.value - 1), 100 * ratio.se,
          100.0 * differ / (2 * static_cast<double>(all.size())));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "designs";
  std::vector<Patches> all;
  for (const char* file : {"flat", "a3h600", "dense_deep"}) {
    for (double rh : {0.15, 0.35, 0.55, 0.75}) all.push_back(solve_dry(folder, file, 50, rh));
  }
  for (double rh : {0.55, 0.75}) all.push_back(solve_dry(folder, "flat", 110, rh));
  study_options(all);
  std::erase_if(all, [](const Patches& p) { return p.humidity < 0.5; });
  study_placement(all);
  study_ensemble(folder);
  return 0;
}
