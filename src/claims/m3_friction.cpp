// The M3 paper on friction and contact area without voltage, and how both grow with humidity.
#include <fmt/format.h>

#include <cmath>

#include "claims/papers.h"
#include "published/samples.h"

namespace papilla::claims {
namespace {

Judgement friction_rise(FingerModel& model, double (*friction)(const Sample&, int, Skins)) {
  std::vector<Part> parts;
  for (const std::string& name : m3_sample_names()) {
    const Sample& s = m3_sample(model, name);
    const SkinEstimate e = jackknife(
        model, [&](Skins over) { return friction(s, kWet, over) / friction(s, kDry, over); });
    parts.push_back(in_band(name, e, 1.6, 2.4));
  }
  return all_of(parts);
}

Judgement gross_area(FingerModel& model) {
  const MacroContact& macro = model.finger().macro;
  const double growth = 100 * (macro.gross_area(0.2, 0.75) / macro.gross_area(0.2, 0.15) - 1);
  return agrees_if(std::abs(growth - 58.5) <= 3, growth, 0, fmt::format("+{:.1f} %", growth),
                   "an input: the finger file's growth of the gross area");
}

Judgement real_area(FingerModel& model) {
  const Sample& s = m3_sample(model, "flat");
  const Sample& dry = sample(model, {.design = "m3_samples/flat.toml", .water = false});
  const auto rise = [](const Sample& a) {
    return jackknife(a, [&](Skins over) {
      return 100 * (over.mean(a.at(kWet).area_off) / over.mean(a.at(kDry).area_off) - 1);
    });
  };
  const SkinEstimate patch = rise(s), without = rise(dry);
  const double growth = s.point(kWet).strength / s.point(kDry).strength;
  return agrees_if(
      std::abs(patch.value - 45.5) <= 8, patch.value, patch.se,
      fmt::format("+{:.1f} ± {:.1f} %", patch.value, patch.se),
      fmt::format("a patch with capillaries, flat; without them +{:.1f} %, the whole finger "
                  "+{:.0f} % and +{:.0f} %",
                  without.value, 100 * ((1 + patch.value / 100) * growth - 1),
                  100 * ((1 + without.value / 100) * growth - 1)));
}

Judgement friction_by_diameter(FingerModel& model) {
  std::vector<Part> parts;
  for (const char* depth : {"h350", "h600"}) {
    for (int rh = 0; rh < kHumidities; ++rh) {
      const SkinEstimate e = paired_percent(
          m3_sample(model, std::string("a3") + depth), m3_sample(model, std::string("a4") + depth),
          [rh](const Sample& s, Skins over) { return friction_off(s, rh, over); });
      parts.push_back(below_zero(
          fmt::format("a4{0} against a3{0} at {1} % RH, %", depth, humidity_percent(rh)), e));
    }
  }
  return all_of(parts);
}

}  // namespace

std::vector<Claim> m3_friction_claims() {
  Claim growth = m3_claim("M3", "apparent contact area +58.5 %", "±3 points", gross_area);
  growth.basis = Basis::Input;
  return {
      m3_claim("M1", "F_off rises nearly two-fold from 15 to 75 % RH, all samples", "1.6 to 2.4",
               [](FingerModel& model) { return friction_rise(model, friction_off); }),
      m3_claim("M2", "F_on rises nearly two-fold from 15 to 75 % RH, all samples", "1.6 to 2.4",
               [](FingerModel& model) { return friction_rise(model, friction_on); }),
      growth,
      m3_claim("M4", "microscopic real area +45.5 %", "±8 points", real_area),
      m3_claim("M8", "larger holes: lower friction", "95 % interval excludes 0",
               friction_by_diameter),
  };
}

}  // namespace papilla::claims
