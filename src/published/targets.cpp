#include "published/targets.h"

#include <algorithm>

#include "base/constants.h"
#include "forward/ridges.h"
#include "published/samples.h"
#include "published/whole_finger.h"

namespace papilla::published {
namespace {

using Model = std::function<Estimate(FingerModel&)>;
using Quantity = double (*)(const Sample&, int rh, Skins over);

const Sample& flat(FingerModel& model, double angle = 0) { return m3_sample(model, "flat", angle); }

const Sample& flat_without_water(FingerModel& model, double angle = 0) {
  return sample(model, {.design = "m3_samples/flat.toml", .angle = angle, .water = false});
}

// From 15 to 75 % RH on the flat sample.
Model rise_of(Quantity friction) {
  return [friction](FingerModel& model) -> Estimate {
    const Sample& s = flat(model);
    return jackknife(s,
                     [&](Skins over) { return friction(s, kWet, over) / friction(s, kDry, over); });
  };
}

Model effect_of(const char* name, int from, int to) {
  return [name, from, to](FingerModel& model) -> Estimate {
    return effect_ratio(m3_sample(model, name), from, to);
  };
}

Estimate gross_area_growth(FingerModel& model) {
  const MacroContact& macro = model.finger().macro;
  return {100 * (macro.gross_area(0.2, 0.75) / macro.gross_area(0.2, 0.15) - 1), 0};
}

Estimate real_area_growth(FingerModel& model) {
  const Sample& s = flat(model);
  return jackknife(s, [&](Skins over) {
    return 100 * (over.mean(s.at(kWet).area_off) / over.mean(s.at(kDry).area_off) - 1);
  });
}

Estimate area_by_capillaries(FingerModel& model) {
  const Sample& s = flat(model);
  const Sample& dry = flat_without_water(model);
  return jackknife(s, [&](Skins over) {
    return 100 * (over.mean(s.at(kWet).area_off) / over.mean(dry.at(kWet).area_off) - 1);
  });
}

Estimate hydrophobic_gain(FingerModel& model) {
  return paired_percent(flat(model), flat(model, 110),
                        [](const Sample& s, Skins over) { return modulation(s, kWet, over); });
}

Estimate largest_modulation(FingerModel& model) {
  const Sample& s = flat_without_water(model, 110);
  return jackknife(s, [&](Skins over) {
    double most = -kInfinity;
    for (int rh = 0; rh < kHumidities; ++rh) most = std::max(most, modulation(s, rh, over));
    return most;
  });
}

Estimate retention_share(FingerModel& model) {
  const ResponsePoint& p = flat(model).response.points[kWet];
  return {100 * p.retention_force.value / p.friction_off.value,
          100 * p.retention_force.se() / p.friction_off.value};
}

Estimate room_friction(FingerModel& model) {
  const Sample& s = flat(model);
  const double load = read_case(m3_case("flat")).finger.load;
  return jackknife(s, [&](Skins over) {
    return (friction_off(s, kDamp, over) + friction_off(s, kMoist, over)) / (2 * load);
  });
}

Estimate gap_in_um(FingerModel& model) { return {1e6 * capacitance_gap(model.finger()), 0}; }

}  // namespace

std::vector<PublishedTarget> published_targets() {
  return {
      {"M1", "F_off(75 %) / F_off(15 %), flat", 2, 2, 0.2, rise_of(friction_off)},
      {"M2", "F_on(75 %) / F_on(15 %), flat", 2, 2, 0.2, rise_of(friction_on)},
      {"M3", "growth of the gross area, %", 58.5, 58.5, 3, gross_area_growth},
      {"M4", "growth of the patch's real area, flat, %", 45.5, 45.5, 4, real_area_growth},
      {"M5", "area added by capillaries at 75 %, flat, %", 22.3, 24.1, 4, area_by_capillaries},
      {"M9", "change of ΔF, 15 to 35 %, flat", 0.02, kInfinity, 0.05,
       effect_of("flat", kDry, kDamp)},
      {"M9", "change of ΔF, 35 to 75 %, a4h350", -kInfinity, -0.08, 0.05,
       effect_of("a4h350", kDamp, kWet)},
      {"M10", "change of ΔF, 15 to 35 %, a4h600", -0.25, 0.05, 0.1,
       effect_of("a4h600", kDry, kDamp)},
      {"M10", "change of ΔF, 15 to 75 %, a4h600", -0.25, 0.05, 0.1,
       effect_of("a4h600", kDry, kWet)},
      {"M13", "110° against 50°, flat at 75 %, %", 130, 130, 20, hydrophobic_gain},
      {"M15", "largest modulation at 110° without water", 1.38, 1.38, 0.1, largest_modulation},
      {"M17", "retention at 75 %, flat, % of F_off", 5, 5, 2, retention_share},
      {kGapTarget, "gap of a sliding finger by its capacitance, um", 1e6 * kPublishedGap,
       1e6 * kPublishedGap, 0.1, gap_in_um},
      {kFrictionTarget, "friction coefficient, flat, 35 and 55 %", 0.2, 0.4, 0.1, room_friction},
  };
}

std::vector<PublishedTarget> fittable_targets() {
  std::vector<PublishedTarget> out = published_targets();
  for (PublishedTarget& target : whole_finger_targets()) out.push_back(std::move(target));
  return out;
}

double capacitance_gap(const Finger& finger) {
  // A finger of 1 N on 30 mm2 of glass under 1 um of SiO2 (permittivity 3.9), as that paper prints
  // them; the air of a room, which it does not print.
  constexpr double kLoad = 1, kArea = 30e-6;  // [N], [m^2]
  constexpr double kOxide = 0.256e-6;         // thickness over permittivity [m]
  constexpr double kHumidity = 0.45;
  return capacitive_gap(finger, kLoad / kArea, kOxide, kHumidity,
                        rings_of(finger.calibrated_for, finger.macro));
}

}  // namespace papilla::published
