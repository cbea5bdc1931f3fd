// The M3 paper on forces across the gap: the electrostatic pull, its fields, van der Waals.
#include <fmt/format.h>

#include <cmath>

#include "base/constants.h"
#include "claims/papers.h"
#include "forward/forward.h"
#include "published/samples.h"

namespace papilla::claims {
namespace {

Judgement van_der_waals(FingerModel& model) {
  constexpr double kHamaker = 5e-20;           // [J] water, glass, keratin: 3.7e-20 to 9e-20
  constexpr double kClosestApproach = 0.3e-9;  // [m]
  const Design d = read_case({.design = "m3_samples/flat.toml"});
  const Scene s = scene_of(model, {.design = "m3_samples/flat.toml", .water = false}, d);
  const Fidelity f = model.fidelity();
  std::vector<double> shares;
  for (int k = 0; k < 8; ++k) {
    const PatchPicture p = picture_patch(s, d.texture, f, 0.15, k);
    double pull = 0, load = 0;
    for (std::size_t i = 0; i < p.fields.off.gap.size(); ++i) {
      load += p.fields.off.pressure[i];
      if (p.fields.off.pressure[i] <= 0)
        pull += kHamaker / (6 * kPi * std::pow(p.fields.off.gap[i] + kClosestApproach, 3));
    }
    shares.push_back(100 * pull / load);
  }
  const Estimate e = mean_estimate(shares);
  return agrees_if(e.value < 5, e.value, e.se,
                   fmt::format("{:.2f} ± {:.2f} % of the contact load", e.value, e.se),
                   "A/(6 pi g^3) with A = 5e-20 J over the solved gap, outside the contact, no "
                   "nearer than 0.3 nm");
}

Judgement pull_falls(FingerModel& model) {
  std::vector<Part> parts;
  for (const std::string& name : m3_sample_names()) {
    const Sample& s = m3_sample(model, name);
    const SkinEstimate e = jackknife(model, [&](Skins over) {
      const auto pull = [&](int rh) {
        return over.mean(s.at(rh).load_on) - over.mean(s.at(rh).load_off);
      };
      return pull(kWet) / pull(kDry) - 1;
    });
    parts.push_back(below_zero(name, e));
  }
  return all_of(parts);
}

Judgement fields_in_air_and_oxide(FingerModel& model) {
  const ResponsePoint& p = m3_sample(model, "flat").response.points[kDry];
  Judgement j;
  j.verdict = Verdict::PaperInconsistent;
  j.value = p.peak_air_field * 1e-6;
  j.model = fmt::format("{:.0f} MV/m in air, {:.0f} MV/m in SiO2", p.peak_air_field * 1e-6,
                        p.peak_oxide_field * 1e-6);
  j.reason = fmt::format(
      "200 V over 500 nm of oxide is 400 MV/m where they touch; {:.0f} % of the area, with "
      "{:.0f} % of the pull, lies beyond the limit of thin air gaps (350 V/um below 1 um)",
      100 * p.over_limit_area, 100 * p.over_limit_share);
  return j;
}

}  // namespace

std::vector<Claim> m3_field_claims() {
  return {
      m3_claim("M18", "van der Waals forces negligible", "below 5 % of the contact load",
               van_der_waals),
      m3_claim("M21", "hydrophilic: the electrostatic force falls as bridges grow",
               "95 % intervals exclude 0", pull_falls),
      m3_claim("M24", "fields well below 3 MV/m in air and 10 MV/m in SiO2", "our fields",
               fields_in_air_and_oxide),
  };
}

}  // namespace papilla::claims
