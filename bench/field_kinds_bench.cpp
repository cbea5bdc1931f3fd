// The field rule against the 3-D field over kinds, slopes, processes and humidities, and what is
// left of the difference where two skins correct four others: prints
// results/accuracy/field_kinds.csv. With `pixels` both fields on more and more pixels, dry to
// nearly flooded: results/accuracy/field_pixels.csv. Run by hand: ninja -C build/release
// field_kinds_bench && build/release/bench/field_kinds_bench designs [random COUNT SEED | pixels]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/electrostatics/full_field.h"

namespace {

using namespace papilla::tests;

constexpr int kSkins = 6, kControls = 2, kPixels = 128;

struct Case {
  std::string name, base = "m3_samples/common.toml";
  std::vector<std::string> keys;
};

std::string quantity(const char* key, double value, const char* unit) {
  return fmt::format("{}=\"{:.6g} {}\"", key, value, unit);
}

// A texture of one kind: its lateral size and land [um], depth [nm], wall [deg].
Case relief(const std::string& kind, double period, double width, double depth, double wall) {
  Case out;
  out.name =
      fmt::format("{} {:.2g}/{:.2g} um {:.0f} nm {:.0f} deg", kind, width, period, depth, wall);
  const bool pillar = kind == "pillar_array", grating = kind == "grating";
  out.keys = {fmt::format("texture.type=\"{}\"", kind), quantity("texture.period", period, "um"),
              quantity(grating ? "texture.width" : "texture.diameter", width, "um"),
              quantity(pillar ? "texture.height" : "texture.depth", depth, "nm"),
              quantity("texture.wall_angle", wall, "deg")};
  return out;
}

Case rough(double rms) {
  return {fmt::format("random_rough {:.0f} nm", rms),
          "m3_samples/common.toml",
          {"texture.type=\"random_rough\"", quantity("texture.rms", rms, "nm"),
           quantity("texture.roll_off", 3, "um")}};
}

std::vector<Case> fixed_cases() {
  std::vector<Case> out;
  for (const double wall : {88.0, 60.0, 44.0, 30.0})
    out.push_back(relief("hole_array", 3, 2, 350, wall));
  for (const double depth : {50.0, 100.0, 600.0, 1000.0})
    out.push_back(relief("hole_array", 3, 2, depth, 88));
  out.push_back(relief("hole_array", 1, 0.6, 350, 88));
  out.push_back(relief("hole_array", 3, 2.6, 262, 80));
  for (const double wall : {88.0, 60.0, 40.0, 20.0})
    out.push_back(relief("pillar_array", 3, 1.2, 400, wall));
  for (const double wall : {85.0, 45.0, 25.0}) out.push_back(relief("grating", 3, 1.6, 300, wall));
  for (const double rms : {60.0, 236.0}) out.push_back(rough(rms));
  return out;
}

std::vector<Case> with_processes(const std::vector<Case>& cases) {
  std::vector<Case> out;
  for (const Case& c : cases) {
    for (const char* process : {"conformal", "directional", "planar"}) {
      Case one = c;
      one.name += fmt::format(",{}", process);
      one.keys.push_back(fmt::format("surface.process=\"{}\"", process));
      if (std::string(process) == "planar")
        one.keys.push_back(quantity("surface.dielectric.0.thickness", 1200, "nm"));
      out.push_back(std::move(one));
    }
  }
  return out;
}

// Designs of all kinds at random: slopes of 20 to 89 degrees, lands of 0.2 to 3 um, depths of 0.1
// to 2 film thicknesses, voltage, contact angle and load.
std::vector<Case> random_cases(int count, std::uint64_t seed) {
  std::vector<Case> out;
  RandomStream random(seed, "field designs");
  const auto between = [&](double low, double high) { return random.uniform(low, high); };
  while (static_cast<int>(out.size()) < count) {
    const char* kinds[] = {"hole_array", "pillar_array", "grating", "random_rough"};
    const char* processes[] = {"conformal", "directional", "planar"};
    const std::string kind = kinds[std::min(3, static_cast<int>(4 * random.uniform()))];
    const char* process = processes[std::min(2, static_cast<int>(3 * random.uniform()))];
    const double depth = between(50, 1000), wall = between(20, 89);
    const double width = between(0.5, 4), land = between(0.2, 3);
    Case c = kind == "random_rough" ? rough(between(20, 240))
                                    : relief(kind, width + land, width, depth, wall);
    c.name += fmt::format(",{}", process);
    c.keys.push_back(fmt::format("surface.process=\"{}\"", process));
    c.keys.push_back(quantity("surface.step_coverage", between(0, 1), ""));
    if (std::string(process) == "planar")
      c.keys.push_back(
          quantity("surface.dielectric.0.thickness", depth + between(150, 1000), "nm"));
    c.keys.push_back(quantity("surface.contact_angle", between(30, 115), "deg"));
    c.keys.push_back(quantity("drive.amplitude", between(80, 220), "V"));
    c.keys.push_back(quantity("finger.load", between(0.1, 0.5), "N"));
    out.push_back(std::move(c));
  }
  return out;
}

// Pull of the rule and of the 3-D field on each skin.
void print(const Case& c, const Design& design) {
  Fidelity fidelity = fidelity_level("draft");
  fidelity.grid = kPixels;
  const Scene scene = scene_of(design);
  for (const double humidity : design.environment.relative_humidity) {
    std::vector<double> rule, full;
    bool ok = true;
    for (int k = 0; k < kSkins; ++k) {
      const PatchPicture p = picture_patch(scene, design.texture, fidelity, humidity, k);
      const CoveredSurface surface(p.texture, film_of(scene));
      const Gap gap{p.texture.grid, p.fields.off.gap};
      const FieldSolution s =
          solve_full_field(gap, &surface, p.fields.wetting_on, field_problem(scene, humidity));
      ok = ok && s.ok;
      full.push_back(s.mean_pressure);
      rule.push_back(p.fields.pull.mean());
    }
    const auto sum = [](const std::vector<double>& v, int from, int to) {
      return std::accumulate(v.begin() + from, v.begin() + to, 0.0);
    };
    const double correction = sum(full, 0, kControls) / sum(rule, 0, kControls);
    const double left =
        correction * sum(rule, kControls, kSkins) / sum(full, kControls, kSkins) - 1;
    fmt::print("{},{:.0f},{:.4g},{:.1f},{:.1f},{}\n", c.name, 100 * humidity,
               1e-3 * sum(full, 0, kSkins) / kSkins,
               100 * (sum(rule, 0, kSkins) / sum(full, 0, kSkins) - 1), 100 * left,
               ok ? "ok" : "not solved");
    std::fflush(stdout);
  }
}

// Both fields over the same two skins on 64 to 512 pixels along the patch, and how far the ratios
// of six skins are apart on those of the correction.
void print_pixels(const std::string& designs) {
  constexpr int kFew = 2;
  fmt::print(
      "sample,finger,relative humidity [%],pixels,under water [%],pull of the rule [kPa],pull in "
      "3-D [kPa],ratio,deviation of a skin's ratio\n");
  for (const char* sample : {"flat", "a3h600"}) {
    for (const auto& [state, humidities] : {std::pair("clean", std::vector{0.15, 0.55, 0.75, 0.85}),
                                            std::pair("natural", std::vector{0.35, 0.55, 0.65})}) {
      const Design design = read_design(fmt::format("{}/m3_samples/{}.toml", designs, sample),
                                        {fmt::format("finger.state=\"{}\"", state)});
      Scene scene = scene_of(design);
      scene.model.coupling = Coupling::OnePass;  // both fields over the gap before the drive
      for (const double humidity : humidities) {
        for (const int pixels : {64, 128, 256, 512}) {
          Fidelity fidelity = fidelity_level("draft");
          fidelity.grid = fidelity.most_pixels = pixels;
          double wet = 0, rule = 0, full = 0;
          std::vector<double> ratios;
          for (int k = 0; k < (pixels == kPixels ? kSkins : kFew); ++k) {
            const PatchPicture p = picture_patch(scene, design.texture, fidelity, humidity, k);
            const CoveredSurface surface(p.texture, film_of(scene));
            const Wetting& water = p.fields.wetting_on;
            const double by_rule = p.fields.pull.mean(),
                         solved = solve_full_field({p.texture.grid, p.fields.off.gap}, &surface,
                                                   water, field_problem(scene, humidity))
                                      .mean_pressure;
            ratios.push_back(solved / by_rule);
            if (k >= kFew) continue;
            for (const std::uint8_t pixel : water.bridged)
              wet += (pixel != 0) / static_cast<double>(kFew * water.bridged.size());
            rule += by_rule / kFew;
            full += solved / kFew;
          }
          fmt::print("{},{},{:.0f},{},{:.1f},{:.4g},{:.4g},{:.3f},{}\n", sample, state,
                     100 * humidity, pixels, 100 * wet, 1e-3 * rule, 1e-3 * full, full / rule,
                     pixels == kPixels
                         ? fmt::format("{:.3f}", mean_estimate(ratios).se * std::sqrt(kSkins))
                         : "");
          std::fflush(stdout);
        }
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string designs = argc > 1 ? argv[1] : "designs";
  if (argc > 2 && std::string(argv[2]) == "pixels") {
    print_pixels(designs);
    return 0;
  }
  const bool random = argc > 4 && std::string(argv[2]) == "random";
  const std::vector<Case> cases =
      random ? random_cases(std::atoi(argv[3]), static_cast<std::uint64_t>(std::atoi(argv[4])))
             : with_processes(fixed_cases());
  fmt::print(
      "texture,process,relative humidity [%],pull in 3-D [kPa],rule over it [%],left on four skins "
      "where two others correct it [%],status\n");
  for (const Case& c : cases) {
    try {
      print(c, read_design(designs + "/" + c.base, c.keys));
    } catch (const std::exception& e) {
      // Walls that meet, a texture through its film: no design.
      fmt::print("{},,,,,{}\n", c.name, std::string(e.what()).substr(0, 60));
    }
  }
}
