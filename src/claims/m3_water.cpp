// The M3 paper on water: capillary forces, bridges, and what the contact angle does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "base/parallel.h"
#include "claims/papers.h"
#include "forward/forward.h"
#include "published/samples.h"

namespace papilla::claims {
namespace {

Judgement capillary_area(FingerModel& model) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a3h350"}) {
    const Sample& s = m3_sample(model, name);
    SampleCase dry_case = m3_case(name);
    dry_case.water = false;
    const Sample& dry = sample(model, dry_case);
    const SkinEstimate e = jackknife(model, [&](Skins over) {
      return 100 * (over.mean(s.at(kWet).area_off) / over.mean(dry.at(kWet).area_off) - 1);
    });
    parts.push_back(in_band(fmt::format("{} %", name), e, 15, 32));
  }
  return all_of(parts);
}

// Capillary force [N] of a sample at rest on each skin, by each placement of its droplets.
using Placements = std::vector<std::vector<double>>;

const Placements& placements(FingerModel& model, const std::string& name, int rh) {
  return model.once<Placements>(fmt::format("placements {} {}", name, rh), [&] {
    const SampleCase c = m3_case(name);
    const Design d = read_case(c);
    Scene scene = scene_of(model, c, d);
    scene.drive.amplitude = 0;
    Fidelity fidelity = model.fidelity();
    fidelity.estimator = Estimator::Load;  // no areas under tractions
    Placements out(static_cast<std::size_t>(fidelity.skins));
    parallel_for(
        fidelity.skins,
        [&](int k) {
          for (int p = 0; p < kPlacements; ++p) {
            const PatchPicture picture =
                picture_patch(scene, d.texture, fidelity, humidity_percent(rh) / 100.0, k, p);
            out[static_cast<std::size_t>(k)].push_back(picture.fields.wetting_off.capillary_force);
          }
        },
        fidelity.threads);
    return out;
  });
}

// The paper's judge: Student's t-test of six placements against six on one patch.
struct PlacementTest {
  double difference;  // second less first [N]
  bool differs;       // with 95 % confidence
};

std::vector<PlacementTest> placement_tests(FingerModel& model, const std::string& first,
                                           const std::string& second, int rh) {
  const Placements &a = placements(model, first, rh), &b = placements(model, second, rh);
  std::vector<PlacementTest> out;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Estimate one = mean_estimate(a[k]), two = mean_estimate(b[k]);
    const double difference = two.value - one.value;
    const double critical = student_t_quantile(0.975, 2 * kPlacements - 2);
    out.push_back({difference, std::abs(difference) > critical * std::hypot(one.se, two.se)});
  }
  return out;
}

Judgement capillary_by_diameter(FingerModel& model) {
  std::vector<Part> parts;
  for (int rh : {kMoist, kWet}) {
    for (const char* depth : {"h350", "h600"}) {
      const SkinEstimate e =
          paired_percent(m3_sample_at_rest(model, std::string("a3") + depth),
                         m3_sample_at_rest(model, std::string("a4") + depth),
                         [rh](const Sample& s, Skins over) { return capillary_load(s, rh, over); });
      Part part{fmt::format("a4{0} against a3{0} at {1} % RH, %", depth, humidity_percent(rh)), e,
                negative(e)};
      for (const PlacementTest& test :
           placement_tests(model, std::string("a3") + depth, std::string("a4") + depth, rh))
        part.single.push_back(test.differs && test.difference < 0);
      parts.push_back(std::move(part));
    }
  }
  return all_of(parts);
}

Judgement capillary_by_depth(FingerModel& model) {
  std::vector<Part> parts;
  for (int rh : {kMoist, kWet}) {
    for (const char* deep : {"a3h600", "a3h900"}) {
      const SkinEstimate e =
          paired_percent(m3_sample_at_rest(model, "a3h350"), m3_sample_at_rest(model, deep),
                         [rh](const Sample& s, Skins over) { return capillary_load(s, rh, over); });
      Part part{fmt::format("{} against a3h350 at {} % RH, %", deep, humidity_percent(rh)), e,
                !positive(e) && !negative(e)};
      for (const PlacementTest& test : placement_tests(model, "a3h350", deep, rh))
        part.single.push_back(!test.differs);
      parts.push_back(std::move(part));
    }
  }
  return all_of(parts,
                fmt::format("{} paired patches resolve differences that the paper's test of six "
                            "droplet placements on one patch does not (in brackets)",
                            kRestingShare * model.sampling().skins));
}

Judgement hydrophobic_gain(FingerModel& model) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a3h350"}) {
    const Sample &a = m3_sample(model, name), &b = m3_sample(model, name, 110);
    for (int rh = kHumidities - 1; rh >= 0; --rh) {
      const SkinEstimate e = paired_percent(
          a, b, [rh](const Sample& s, Skins over) { return modulation(s, rh, over); });
      const std::string at = fmt::format("{} at {} % RH, %", name, humidity_percent(rh));
      parts.push_back(rh == kWet ? in_band(at, e, 90, 170) : above_zero(at, e));
    }
  }
  return all_of(parts);
}

Judgement theoretical_maximum(FingerModel& model) {
  const Sample& s = sample(model, {.design = "m3_samples/flat.toml", .angle = 110, .water = false});
  Estimate best{-kInfinity, 0};
  int at = 0;
  for (int rh = 0; rh < kHumidities; ++rh) {
    const SkinEstimate e = jackknife(model, [&](Skins over) { return modulation(s, rh, over); });
    if (e.value > best.value) {
      best = e;
      at = rh;
    }
  }
  return agrees_if(std::abs(best.value / 1.38 - 1) <= 0.15, best.value, best.se,
                   fmt::format("{:.2f} ± {:.2f}", best.value, best.se),
                   fmt::format("flat, no water in the field, at {} % RH", humidity_percent(at)));
}

Judgement hydrophobic_friction(FingerModel& model) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a3h350"}) {
    for (int rh = 0; rh < kHumidities; ++rh) {
      const SkinEstimate e =
          paired_percent(m3_sample(model, name), m3_sample(model, name, 110),
                         [rh](const Sample& s, Skins over) { return friction_off(s, rh, over); });
      parts.push_back(below_zero(fmt::format("{} at {} % RH, %", name, humidity_percent(rh)), e));
    }
  }
  return all_of(parts);
}

Judgement retention(FingerModel& model) {
  const ResponsePoint& p = m3_sample(model, "flat").response.points[kWet];
  const double share = 100 * p.retention_force.value / p.friction_off.value;
  const double se = 100 * p.retention_force.se() / p.friction_off.value;
  return agrees_if(within(share, 2, 10), share, se, fmt::format("{:.1f} ± {:.1f} %", share, se),
                   "flat at 75 % RH; proportional to the hysteresis of the contact angle, which is "
                   "not published");
}

Judgement bridges_in_holes(FingerModel& model) {
  const SampleCase c{.design = "m3_samples/a3h350.toml"};
  const Design d = read_case(c);
  const Scene s = scene_of(model, c, d);
  const double depth = facts(d.texture).relief.height().value();
  double spanning = 0, all = 0;
  for (int k = 0; k < 8; ++k) {
    const PatchPicture p = picture_patch(s, d.texture, model.fidelity(), 0.75, k);
    const Grid& grid = p.texture.grid;
    for (const Droplet& drop : p.fields.wetting_off.droplets) {
      if (drop.state != DropletState::Bridge) continue;
      const int ix = wrap(static_cast<int>(drop.x / grid.dx()), grid.nx);
      const int iy = wrap(static_cast<int>(drop.y / grid.dy()), grid.ny);
      const double high = *std::max_element(p.texture.z.begin(), p.texture.z.end());
      all += 1;
      spanning += p.texture.z[grid.index(ix, iy)] < high - 0.5 * depth;
    }
  }
  if (all == 0)
    return {Verdict::NotTestable, std::numeric_limits<double>::quiet_NaN(), 0, "no bridge",
            "at 75 % RH no droplet of this finger bridges skin and glass"};
  const double share = 100 * spanning / all;
  const double se = 100 * std::sqrt(std::max(spanning, 1.0)) / all;
  return agrees_if(share < 5, share, se, fmt::format("{:.1f} ± {:.1f} %", share, se),
                   fmt::format("{:.0f} of {:.0f} bridges at 75 % RH stand on the floor of a hole",
                               spanning, all));
}

}  // namespace

std::vector<Claim> m3_water_claims() {
  return {
      m3_claim("M5", "capillaries add 22.3 to 24.1 % microscopic area at 75 % RH", "15 to 32 %",
               capillary_area),
      m3_claim("M6", "capillary force: 4 um holes below 3 um holes at 55 and 75 % RH",
               "95 % interval excludes 0", capillary_by_diameter),
      m3_claim("M7", "capillary force does not depend on the depth of the holes",
               "95 % interval contains 0", capillary_by_depth),
      m3_claim("M13", "110° against 50°: modulation at 75 % RH +130 %, stronger at every humidity",
               "+90 to +170 %; signs", hydrophobic_gain),
      m3_claim("M15", "110°, no reduction of the field: 1.38", "±15 %", theoretical_maximum),
      m3_claim("M16", "110° lowers the friction without field", "95 % intervals exclude 0",
               hydrophobic_friction),
      m3_claim("M17", "retention by hysteresis about 5 % of F_off", "2 to 10 %", retention),
      m3_claim("M27", "bridges rarely span even holes of 350 nm", "below 5 % of the bridges",
               bridges_in_holes),
  };
}

}  // namespace papilla::claims
