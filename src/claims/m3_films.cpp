// The M3 paper on films of large, soft and of small, hard particles.
#include <fmt/format.h>

#include <cmath>

#include "claims/papers.h"
#include "published/samples.h"

namespace papilla::claims {
namespace {

// Friction on the small particles against that on the large ones, in percent, in three regions of
// both films; `sign` is the direction that the paper reports.
Judgement film_friction(FingerModel& model, FingerState state, double sign,
                        const std::string& why_not = "") {
  std::vector<Part> parts;
  for (int region = 1; region <= 3; ++region) {
    const auto film = [&](const char* size) -> const Sample& {
      return sample(
          model, {.design = fmt::format("coatings/hdpe_{}_{}.toml", size, region), .state = state});
    };
    const SkinEstimate e =
        paired_percent(film("large"), film("small"),
                       [](const Sample& s, Skins over) { return friction_off(s, 0, over); });
    const std::string name = fmt::format("small against large, region {}, %", region);
    parts.push_back(sign > 0 ? above_zero(name, e) : below_zero(name, e));
  }
  return all_of(parts, why_not);
}

Judgement films_natural_area(FingerModel& model) {
  std::vector<Part> parts;
  for (const char* size : {"large", "small"}) {
    for (int region = 1; region <= 3; ++region) {
      const std::string design = fmt::format("coatings/hdpe_{}_{}.toml", size, region);
      const SkinEstimate e =
          paired_percent(sample(model, {.design = design}),
                         sample(model, {.design = design, .state = FingerState::Natural}),
                         [](const Sample& s, Skins over) { return over.mean(s.at(0).area_off); });
      parts.push_back(above_zero(fmt::format("{} {}, %", size, region), e));
    }
  }
  return all_of(parts);
}

// Compliance: indentation over pressure, of the mean response.
Judgement films_compliance(FingerModel& model) {
  std::vector<Part> parts;
  for (int region = 1; region <= 3; ++region) {
    const auto compliance = [&](const char* size) {
      const ResponsePoint& p =
          sample(model, {.design = fmt::format("coatings/hdpe_{}_{}.toml", size, region)})
              .response.points[0];
      return Estimate{1e12 * p.indentation.value / p.patch_pressure,
                      1e12 * p.indentation.se() / p.patch_pressure};
    };
    const Estimate large = compliance("large"), small = compliance("small");
    const SkinEstimate gain{{large.value - small.value, std::hypot(large.se, small.se)},
                            model.sampling().skins};
    parts.push_back(above_zero(fmt::format("large minus small, region {}, um/MPa", region), gain));
  }
  return all_of(parts);
}

}  // namespace

std::vector<Claim> m3_film_claims() {
  return {
      m3_claim("M19", "clean finger: films with larger, softer particles rub more",
               "95 % intervals exclude 0, three regions",
               [](FingerModel& model) { return film_friction(model, FingerState::Clean, -1); }),
      m3_claim("M20", "natural finger: smaller particles have more capillary force and rub more",
               "95 % intervals exclude 0, three regions",
               [](FingerModel& model) {
                 return film_friction(
                     model, FingerState::Natural, 1,
                     "the small particles are of 7 MPa, the large of 2.6 MPa: their dry area "
                     "is half, and no water the model holds makes up for that");
               }),
      m3_claim("M23", "larger, softer particles are more compliant",
               "95 % intervals exclude 0, three regions", films_compliance),
      m3_claim("M28", "both films: larger area with the natural than with the clean finger",
               "95 % intervals exclude 0, three regions", films_natural_area),
  };
}

}  // namespace papilla::claims
