#include "published/whole_finger.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/constants.h"
#include "design/design.h"
#include "forward/forward.h"

namespace papilla::published {
namespace {

// The finger of the paper on broadband electroadhesion: 1 N on 1 um of SiO2 over ITO, 25 kHz; the
// air of a room, which it does not print.
const std::vector<std::string> kBroadband{"finger.load=\"1 N\"", "drive.frequency=\"25 kHz\"",
                                          "surface.dielectric.0.thickness=\"1 um\"",
                                          "environment.relative_humidity=[\"45 %\"]"};
// Its law at 136 V: alpha = 2.195e-5 N/V^2 on the gap, of a mean over time, by a friction
// coefficient of 0.2; fits of other days are off by a factor 1.5: by a third, downwards.
constexpr double kLawPull = 609, kLawEffect = 122, kLawShare = 1 - 1 / 1.5;  // [mN], [mN]
// 4 mA leave 102 V in the gap, 80 to 90 % of all; less than 150 V were applied.
constexpr double kLeastVolts = 113, kMostVolts = 150;

const Response& response(FingerModel& model, const std::vector<std::string>& keys) {
  std::string key = "whole finger";
  for (const std::string& k : keys) key += " " + k;
  return model.once<Response>(key, [&] {
    Design d = read_design(find_design("m3_samples/flat.toml"), keys);
    d.finger = model.finger().touching_as(d.finger);
    d.model = model.finger().calibrated_for;
    d.model.preset = model.preset();
    return evaluate(scene_of(d), d.texture, model.fidelity());
  });
}

// A number of the first humidity, with the error of its sampling.
template <class F>
Estimate read(const Response& response, F&& number) {
  std::vector<double> without;
  for (const std::vector<ResponsePoint>& points : response.without)
    without.push_back(number(points.front()));
  const double all = number(response.points.front());
  return {all, mean_estimate(jackknife_samples(all, without)).se};
}

const Response& at_volts(FingerModel& model) {
  std::vector<std::string> keys = kBroadband;
  keys.emplace_back("drive.amplitude=\"136 V\"");
  return response(model, keys);
}

Estimate whole_pull(FingerModel& model) {
  return read(at_volts(model),
              [](const ResponsePoint& p) { return 1e3 * p.electrostatic_force.value; });
}

Estimate whole_effect(FingerModel& model) {
  return read(at_volts(model), [](const ResponsePoint& p) {
    return 1e3 * (p.friction_on.value - p.friction_off.value);
  });
}

Estimate whole_volts(FingerModel& model) {
  std::vector<std::string> keys = kBroadband;
  for (const char* key :
       {"drive.control=\"current\"", "drive.amplitude=\"0 V\"", "drive.current=\"4 mA\""})
    keys.emplace_back(key);
  return read(response(model, keys), [](const ResponsePoint& p) { return p.source_voltage; });
}

// The friction coefficient under 200 V, light over heavy touch.
Estimate light_over_heavy(FingerModel& model) {
  const auto at = [&](const char* load) -> const Response& {
    return response(model, {fmt::format("finger.load=\"{} N\"", load),
                            "environment.relative_humidity=[\"45 %\"]"});
  };
  const Response &light = at("0.2"), &heavy = at("2");
  const auto ratio = [](const ResponsePoint& a, const ResponsePoint& b) {
    return a.friction_on.value / 0.2 / (b.friction_on.value / 2);
  };
  std::vector<double> without;
  for (std::size_t k = 0; k < light.without.size(); ++k)
    without.push_back(ratio(light.without[k].front(), heavy.without[k].front()));
  const double all = ratio(light.points.front(), heavy.points.front());
  return {all, mean_estimate(jackknife_samples(all, without)).se};
}

}  // namespace

std::vector<PublishedTarget> whole_finger_targets() {
  return {
      {"B3", "pull of a whole finger, 136 V at 25 kHz, 1 N, 1 um of oxide, mN", kLawPull, kLawPull,
       kLawShare * kLawPull, whole_pull},
      {"B3", "ΔF there, mN", kLawEffect, kLawEffect, kLawShare * kLawEffect, whole_effect},
      {"B8", "amplitude of 4 mA there, V", kLeastVolts, kMostVolts, 10, whole_volts},
      {"P8", "friction coefficient under 200 V, 0.2 N over 2 N", 1, kInfinity, 0.1,
       light_over_heavy},
  };
}

}  // namespace papilla::published
