// The claims of the M3 paper, judged on one finger, on skins that no fit has seen. Patches are the
// sample: every difference is paired over the same skins, its error comes from the jackknife, and a
// sign counts when the 95 % interval excludes zero.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/statistics.h"
#include "claims/reproduce.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scale_bridge.h"

namespace papilla {
namespace {

constexpr int kHumidities = 4;  // 15, 35, 55, 75 % RH, as in designs/m3_samples
constexpr int kDry = 0, kDamp = 1, kMoist = 2, kWet = 3;

// A surface of the paper under one of its conditions.
constexpr int kRestingShare = 4;  // skins of samples at rest, over those of driven ones

struct Case {
  std::string design;  // below designs/
  double angle = 0;    // contact angle [deg]; 0: the design's own
  bool water = true;
  FingerState state = FingerState::Clean;
};

struct Sample {
  Response response;
  std::vector<double> strength;  // tau x carrying area at each humidity [N]: F = strength x area
  std::vector<double> preload;   // of a patch [N]

  const PatchSamples& at(int rh) const {
    return response.points[static_cast<std::size_t>(rh)].samples;
  }
};

Fidelity fidelity_of(const ClaimInputs& in) { return in.sampling().fidelity(in.threads()); }

Design read_case(const Case& c) { return read_design(find_design(c.design)); }

Scene scene_of(const ClaimInputs& in, const Case& c, const Design& d) {
  Scene s{d.surface, in.finger(), d.environment, d.drive, in.finger().calibrated_for};
  s.finger.load = d.finger.load;
  s.finger.state = c.state;
  s.model.preset = in.preset();
  if (c.angle > 0) s.surface.contact_angle = c.angle * kPi / 180;
  if (!c.water) std::fill(s.finger.water.volume.begin(), s.finger.water.volume.end(), 0.0);
  return s;
}

Sample evaluate_sample(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  Sample out;
  out.response = evaluate(scene, texture, fidelity);
  const MacroContact& macro = scene.finger.macro;
  for (const ResponsePoint& p : out.response.points) {
    out.strength.push_back(macro.shear_strength * macro.load_share *
                           macro.gross_area(scene.finger.load, p.relative_humidity));
    out.preload.push_back(p.patch_pressure * out.response.plan.grid.area());
  }
  if (fidelity.estimator == Estimator::Load) {  // Eq. friction.3: areas from loads, a skin
    for (std::size_t i = 0; i < out.response.points.size(); ++i) {
      PatchSamples& p = out.response.points[i].samples;
      for (std::size_t k = 0; k < p.area_off.size(); ++k) {
        const double beta = fidelity.load_exponent;
        p.area_off[k] *= std::pow(std::max(0.0, p.load_off[k] / out.preload[i]), beta);
        p.area_on[k] *= std::pow(std::max(0.0, p.load_on[k] / out.preload[i]), beta);
      }
    }
  }
  return out;
}

const Sample& sample(ClaimInputs& in, const Case& c) {
  const std::string key =
      fmt::format("{} {} {} {}", c.design, c.angle, c.water, static_cast<int>(c.state));
  return in.once<Sample>(key, [&] {
    const Design d = read_case(c);
    return evaluate_sample(scene_of(in, c, d), d.texture, fidelity_of(in));
  });
}

Case m3_sample(const std::string& name, double angle = 0) {
  return {.design = "m3_samples/" + name + ".toml", .angle = angle};
}
const Sample& m3(ClaimInputs& in, const std::string& name, double angle = 0) {
  return sample(in, m3_sample(name, angle));
}

// A sample at rest, on more skins: capillary forces scatter most of all, and cost least.
const Sample& resting(ClaimInputs& in, const std::string& name) {
  const Case c = m3_sample(name);
  return in.once<Sample>("at rest " + name, [&] {
    const Design d = read_case(c);
    Scene scene = scene_of(in, c, d);
    scene.drive.amplitude = 0;
    Fidelity f = fidelity_of(in);
    f.estimator = Estimator::Load;
    f.skins *= kRestingShare;
    return evaluate_sample(scene, d.texture, f);
  });
}

// --- Statistics over skins, one left out (skip; -1: none) -------------------------------------

double mean_without(const std::vector<double>& v, int skip) {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (static_cast<int>(i) != skip) sum += v[i];
  }
  return sum / static_cast<double>(v.size() - (skip >= 0 ? 1 : 0));
}

double friction_off(const Sample& s, int rh, int skip) {
  return s.strength[static_cast<std::size_t>(rh)] * mean_without(s.at(rh).area_off, skip);
}
double friction_on(const Sample& s, int rh, int skip) {
  return s.strength[static_cast<std::size_t>(rh)] * mean_without(s.at(rh).area_on, skip);
}
double effect(const Sample& s, int rh, int skip) {  // Delta F [N]
  return friction_on(s, rh, skip) - friction_off(s, rh, skip);
}
double modulation(const Sample& s, int rh, int skip) {
  return mean_without(s.at(rh).area_on, skip) / mean_without(s.at(rh).area_off, skip) - 1;
}
double capillary_load(const Sample& s, int rh, int skip) {  // of a patch [N]
  return mean_without(s.at(rh).load_off, skip) - s.preload[static_cast<std::size_t>(rh)];
}
double mean_modulation(const Sample& s, int skip) {
  double sum = 0;
  for (int rh = 0; rh < kHumidities; ++rh) sum += modulation(s, rh, skip);
  return sum / kHumidities;
}
double range_over_mean(const Sample& s, int skip) {
  double low = kInfinity, high = -kInfinity;
  for (int rh = 0; rh < kHumidities; ++rh) {
    low = std::min(low, modulation(s, rh, skip));
    high = std::max(high, modulation(s, rh, skip));
  }
  return (high - low) / mean_modulation(s, skip);
}
double deviation_over_mean(const Sample& s, int skip) {
  const double mean = mean_modulation(s, skip);
  double sum = 0;
  for (int rh = 0; rh < kHumidities; ++rh) sum += square(modulation(s, rh, skip) - mean);
  return std::sqrt(sum / kHumidities) / mean;
}

// An estimate over skins, with what its interval needs.
struct SkinEstimate : Estimate {
  int skins = 2;

  double half_width() const { return student_t_quantile(0.975, skins - 1) * se; }  // 95 %
};

template <class F>
SkinEstimate jackknife(int skins, F&& f) {
  std::vector<double> without;
  for (int k = 0; k < skins; ++k) without.push_back(f(k));
  return {mean_estimate(jackknife_samples(f(-1), without)), skins};
}
template <class F>
SkinEstimate jackknife(const Sample& s, F&& f) {
  return jackknife(static_cast<int>(s.at(0).area_off.size()), f);
}
template <class F>
SkinEstimate jackknife(const ClaimInputs& in, F&& f) {
  return jackknife(in.sampling().skins, f);
}

bool positive(const SkinEstimate& e) { return e.value > e.half_width(); }
bool negative(const SkinEstimate& e) { return -e.value > e.half_width(); }
bool within(double v, double low, double high) { return v >= low && v <= high; }

// A claim about several numbers holds when all do; the number shown is the first that does not,
// else the first.
struct Part {
  std::string name;
  Estimate value;
  bool holds;
};
Judgement all_of(const std::vector<Part>& parts, const std::string& why_not = "") {
  std::string list;
  const Part* shown = &parts.front();
  bool all = true;
  for (const Part& p : parts) {
    list += fmt::format("{}{} {:.3g} ± {:.2g}{}", list.empty() ? "" : "; ", p.name, p.value.value,
                        p.value.se, p.holds ? "" : " (no)");
    if (all && !p.holds) shown = &p;
    all = all && p.holds;
  }
  std::string reason = list;
  if (!all && !why_not.empty()) reason += ". " + why_not;
  return agrees_if(all, shown->value.value, shown->value.se,
                   fmt::format("{:.3g} ± {:.2g}", shown->value.value, shown->value.se), reason);
}

const std::vector<std::string>& samples() {
  static const std::vector<std::string> names{"flat",   "a3h350", "a3h600",
                                              "a3h900", "a4h350", "a4h600"};
  return names;
}

// --- The claims -------------------------------------------------------------------------------

Judgement friction_rise(ClaimInputs& in, double (*friction)(const Sample&, int, int)) {
  std::vector<Part> parts;
  for (const std::string& name : samples()) {
    const Sample& s = m3(in, name);
    const SkinEstimate e =
        jackknife(in, [&](int k) { return friction(s, kWet, k) / friction(s, kDry, k); });
    parts.push_back({name, e, within(e.value, 1.6, 2.4)});
  }
  return all_of(parts);
}

Judgement gross_area(ClaimInputs& in) {
  const MacroContact& macro = in.finger().macro;
  const double growth = 100 * (macro.gross_area(0.2, 0.75) / macro.gross_area(0.2, 0.15) - 1);
  return agrees_if(std::abs(growth - 58.5) <= 3, growth, 0, fmt::format("+{:.1f} %", growth),
                   "an input: the finger file's growth of the gross area");
}

Judgement real_area(ClaimInputs& in) {
  const Sample& s = m3(in, "flat");
  const Sample& dry = sample(in, {.design = "m3_samples/flat.toml", .water = false});
  const auto rise = [](const Sample& a) {
    return jackknife(a, [&](int k) {
      return 100 *
             (mean_without(a.at(kWet).area_off, k) / mean_without(a.at(kDry).area_off, k) - 1);
    });
  };
  const SkinEstimate patch = rise(s), without = rise(dry);
  const double growth = s.strength[kWet] / s.strength[kDry];
  return agrees_if(
      std::abs(patch.value - 45.5) <= 8, patch.value, patch.se,
      fmt::format("+{:.1f} ± {:.1f} %", patch.value, patch.se),
      fmt::format("a patch with capillaries, flat; without them +{:.1f} %, the whole finger "
                  "+{:.0f} % and +{:.0f} %",
                  without.value, 100 * ((1 + patch.value / 100) * growth - 1),
                  100 * ((1 + without.value / 100) * growth - 1)));
}

Judgement capillary_area(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a3h350"}) {
    const Sample& s = m3(in, name);
    Case dry_case = m3_sample(name);
    dry_case.water = false;
    const Sample& dry = sample(in, dry_case);
    const SkinEstimate e = jackknife(in, [&](int k) {
      return 100 *
             (mean_without(s.at(kWet).area_off, k) / mean_without(dry.at(kWet).area_off, k) - 1);
    });
    parts.push_back({fmt::format("{} %", name), e, within(e.value, 15, 32)});
  }
  return all_of(parts);
}

// Difference b - a of a quantity in percent of a, paired over skins.
template <class F>
SkinEstimate paired_percent(const Sample& a, const Sample& b, F&& quantity) {
  return jackknife(a, [&](int k) { return 100 * (quantity(b, k) / quantity(a, k) - 1); });
}

Judgement capillary_by_diameter(ClaimInputs& in) {
  std::vector<Part> parts;
  for (int rh : {kMoist, kWet}) {
    for (const char* depth : {"h350", "h600"}) {
      const SkinEstimate e = paired_percent(
          resting(in, std::string("a3") + depth), resting(in, std::string("a4") + depth),
          [rh](const Sample& s, int k) { return capillary_load(s, rh, k); });
      parts.push_back(
          {fmt::format("a4{0} against a3{0} at {1} % RH, %", depth, 15 + 20 * rh), e, negative(e)});
    }
  }
  return all_of(parts);
}

Judgement capillary_by_depth(ClaimInputs& in) {
  std::vector<Part> parts;
  for (int rh : {kMoist, kWet}) {
    for (const char* deep : {"a3h600", "a3h900"}) {
      const SkinEstimate e =
          paired_percent(resting(in, "a3h350"), resting(in, deep),
                         [rh](const Sample& s, int k) { return capillary_load(s, rh, k); });
      parts.push_back({fmt::format("{} against a3h350 at {} % RH, %", deep, 15 + 20 * rh), e,
                       !positive(e) && !negative(e)});
    }
  }
  return all_of(parts,
                fmt::format("{} paired patches resolve differences that six droplet seeds on "
                            "one patch cannot",
                            kRestingShare * in.sampling().skins));
}

Judgement friction_by_diameter(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* depth : {"h350", "h600"}) {
    for (int rh = 0; rh < kHumidities; ++rh) {
      const SkinEstimate e =
          paired_percent(m3(in, std::string("a3") + depth), m3(in, std::string("a4") + depth),
                         [rh](const Sample& s, int k) { return friction_off(s, rh, k); });
      parts.push_back(
          {fmt::format("a4{0} against a3{0} at {1} % RH, %", depth, 15 + 20 * rh), e, negative(e)});
    }
  }
  return all_of(parts);
}

SkinEstimate effect_ratio(const Sample& s, int from, int to) {
  return jackknife(s, [&](int k) { return effect(s, to, k) / effect(s, from, k) - 1; });
}

Judgement effect_rises_and_falls(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a4h350", "a3h600"}) {
    const SkinEstimate up = effect_ratio(m3(in, name), kDry, kDamp);
    const SkinEstimate down = effect_ratio(m3(in, name), kDamp, kWet);
    parts.push_back({fmt::format("{} 15 to 35 %", name), up, positive(up)});
    parts.push_back({fmt::format("{} 35 to 75 %", name), down, negative(down)});
  }
  return all_of(parts);
}

Judgement effect_constant(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* name : {"a4h600", "a3h900"}) {
    for (int rh : {kDamp, kMoist, kWet}) {
      const SkinEstimate e = effect_ratio(m3(in, name), kDry, rh);
      parts.push_back(
          {fmt::format("{} at {} % RH", name, 15 + 20 * rh), e, within(e.value, -0.25, 0.05)});
    }
  }
  return all_of(parts,
                "the course of ΔF over humidity is nearly the same for all samples, so with M9 it "
                "holds only for a rise of 0 to 5 %");
}

const std::vector<std::pair<const char*, const char*>>& stronger_pairs() {
  static const std::vector<std::pair<const char*, const char*>> pairs{
      {"a3h600", "a4h600"}, {"a4h350", "a4h600"}, {"a3h600", "a3h900"}};
  return pairs;
}

template <class F>
Judgement compare_pairs(ClaimInputs& in, F&& quantity, const std::string& why_not) {
  std::vector<Part> parts;
  for (const auto& [strong, weak] : stronger_pairs()) {
    const SkinEstimate e = paired_percent(m3(in, weak), m3(in, strong), quantity);
    parts.push_back({fmt::format("{} against {}, %", strong, weak), e, positive(e)});
  }
  return all_of(parts, why_not);
}

Judgement hydrophobic_gain(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a3h350"}) {
    const Sample &a = m3(in, name), &b = m3(in, name, 110);
    for (int rh = kHumidities - 1; rh >= 0; --rh) {
      const SkinEstimate e =
          paired_percent(a, b, [rh](const Sample& s, int k) { return modulation(s, rh, k); });
      parts.push_back({fmt::format("{} at {} % RH, %", name, 15 + 20 * rh), e,
                       rh == kWet ? within(e.value, 90, 170) : positive(e)});
    }
  }
  return all_of(parts);
}

Judgement variation_readings(ClaimInputs& in) {
  struct Reading {
    const char* name;
    double flat_angle;
    double (*measure)(const Sample&, int);
  };
  std::string list;
  bool any = false;
  double best = kInfinity;
  Estimate shown;
  for (const Reading& r : {Reading{"both 110°, range/mean", 110, range_over_mean},
                           Reading{"both 110°, sd/mean", 110, deviation_over_mean},
                           Reading{"flat 50°, a3h350 110°, range/mean", 0, range_over_mean},
                           Reading{"flat 50°, a3h350 110°, sd/mean", 0, deviation_over_mean}}) {
    const Sample &a = m3(in, "flat", r.flat_angle), &b = m3(in, "a3h350", 110);
    const SkinEstimate flat = jackknife(in, [&](int k) { return 100 * r.measure(a, k); });
    const SkinEstimate holes = jackknife(in, [&](int k) { return 100 * r.measure(b, k); });
    const double miss = std::max(std::abs(flat.value - 27.3), std::abs(holes.value - 6.7));
    any = any || miss <= 5;
    if (miss < best) shown = holes;
    best = std::min(best, miss);
    list += fmt::format("{}{}: {:.1f} ± {:.1f} to {:.1f} ± {:.1f} %", list.empty() ? "" : "; ",
                        r.name, flat.value, flat.se, holes.value, holes.se);
  }
  return agrees_if(any, shown.value, shown.se,
                   fmt::format("{:.1f} ± {:.1f} % (nearest reading)", shown.value, shown.se), list);
}

Judgement theoretical_maximum(ClaimInputs& in) {
  const Sample& s = sample(in, {.design = "m3_samples/flat.toml", .angle = 110, .water = false});
  Estimate best{-kInfinity, 0};
  int at = 0;
  for (int rh = 0; rh < kHumidities; ++rh) {
    const SkinEstimate e = jackknife(in, [&](int k) { return modulation(s, rh, k); });
    if (e.value > best.value) {
      best = e;
      at = rh;
    }
  }
  return agrees_if(std::abs(best.value / 1.38 - 1) <= 0.15, best.value, best.se,
                   fmt::format("{:.2f} ± {:.2f}", best.value, best.se),
                   fmt::format("flat, no water in the field, at {} % RH", 15 + 20 * at));
}

Judgement hydrophobic_friction(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* name : {"flat", "a3h350"}) {
    for (int rh = 0; rh < kHumidities; ++rh) {
      const SkinEstimate e =
          paired_percent(m3(in, name), m3(in, name, 110),
                         [rh](const Sample& s, int k) { return friction_off(s, rh, k); });
      parts.push_back({fmt::format("{} at {} % RH, %", name, 15 + 20 * rh), e, negative(e)});
    }
  }
  return all_of(parts);
}

Judgement retention(ClaimInputs& in) {
  const ResponsePoint& p = m3(in, "flat").response.points[kWet];
  const double share = 100 * p.retention_force.value / p.friction_off.value;
  const double se = 100 * p.retention_force.se() / p.friction_off.value;
  return agrees_if(within(share, 2, 10), share, se, fmt::format("{:.1f} ± {:.1f} %", share, se),
                   "flat at 75 % RH; proportional to the hysteresis of the contact angle, which is "
                   "not published");
}

Judgement van_der_waals(ClaimInputs& in) {
  constexpr double kHamaker = 5e-20;           // [J] water, glass, keratin: 3.7e-20 to 9e-20
  constexpr double kClosestApproach = 0.3e-9;  // [m]
  const Design d = read_case({.design = "m3_samples/flat.toml"});
  const Scene s = scene_of(in, {.design = "m3_samples/flat.toml", .water = false}, d);
  const Fidelity f = fidelity_of(in);
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

Judgement pull_falls(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const std::string& name : samples()) {
    const Sample& s = m3(in, name);
    const SkinEstimate e = jackknife(in, [&](int k) {
      const auto pull = [&](int rh) {
        return mean_without(s.at(rh).load_on, k) - mean_without(s.at(rh).load_off, k);
      };
      return pull(kWet) / pull(kDry) - 1;
    });
    parts.push_back({name, e, negative(e)});
  }
  return all_of(parts);
}

Judgement screens(ClaimInputs& in) {
  std::vector<const Sample*> order;
  for (const char* name : {"smooth", "middle", "rough"}) {
    order.push_back(&sample(in, {.design = fmt::format("m3_samples/screen_{}.toml", name)}));
  }
  std::vector<Part> parts;
  const char* names[] = {"smooth over middle", "middle over rough"};
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const SkinEstimate mean = jackknife(in, [&](int k) {
      return mean_modulation(*order[i], k) - mean_modulation(*order[i + 1], k);
    });
    const SkinEstimate range = jackknife(in, [&](int k) {
      return range_over_mean(*order[i], k) - range_over_mean(*order[i + 1], k);
    });
    parts.push_back({fmt::format("mean, {}", names[i]), mean, positive(mean)});
    parts.push_back({fmt::format("range/mean, {}", names[i]), range, positive(range)});
  }
  return all_of(parts);
}

Judgement fields_in_air_and_oxide(ClaimInputs& in) {
  const ResponsePoint& p = m3(in, "flat").response.points[kDry];
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

Judgement aspect_ratio(ClaimInputs& in) {
  const Sample& shallow = sample(in, {.design = "m3_samples/dense_shallow.toml"});
  const Sample& deep = sample(in, {.design = "m3_samples/dense_deep.toml"});
  const SkinEstimate e =
      jackknife(in, [&](int k) { return range_over_mean(deep, k) - range_over_mean(shallow, k); });
  const SkinEstimate a = jackknife(in, [&](int k) { return range_over_mean(shallow, k); });
  const SkinEstimate b = jackknife(in, [&](int k) { return range_over_mean(deep, k); });
  return agrees_if(negative(e), e.value, e.se, fmt::format("{:.3f} ± {:.3f}", e.value, e.se),
                   fmt::format("range/mean of 2.6 um holes, 3 um apart, 50°: {:.2f} ± {:.2f} at "
                               "depth 350 nm, {:.2f} ± {:.2f} at 1 um",
                               a.value, a.se, b.value, b.se));
}

Judgement softening_alone(ClaimInputs& in) {
  const Sample& s = sample(in, {.design = "m3_samples/flat.toml", .water = false});
  std::vector<Part> parts;
  for (int rh = 0; rh + 1 < kHumidities; ++rh) {
    const SkinEstimate e = effect_ratio(s, rh, rh + 1);
    parts.push_back({fmt::format("{} to {} % RH", 15 + 20 * rh, 35 + 20 * rh), e, positive(e)});
  }
  return all_of(parts);
}

Judgement bridges_in_holes(ClaimInputs& in) {
  const Case c{.design = "m3_samples/a3h350.toml"};
  const Design d = read_case(c);
  const Scene s = scene_of(in, c, d);
  const double depth = facts(d.texture).relief.height().value();
  double spanning = 0, all = 0;
  for (int k = 0; k < 8; ++k) {
    const PatchPicture p = picture_patch(s, d.texture, fidelity_of(in), 0.75, k);
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
  const double share = all > 0 ? 100 * spanning / all : 0;
  const double se = all > 0 ? 100 * std::sqrt(std::max(spanning, 1.0)) / all : 0;
  return agrees_if(share < 5, share, se, fmt::format("{:.1f} ± {:.1f} %", share, se),
                   fmt::format("{:.0f} of {:.0f} bridges at 75 % RH stand on the floor of a hole",
                               spanning, all));
}

// Both particle films in three regions each; `quantity` of the small over the large particles (or
// of natural over clean), in percent, with `sign` the direction that the paper reports.
template <class F>
Judgement films(ClaimInputs& in, FingerState state, F&& quantity, double sign,
                const std::string& why_not) {
  std::vector<Part> parts;
  for (int region = 1; region <= 3; ++region) {
    const auto film = [&](const char* size) -> const Sample& {
      return sample(
          in, {.design = fmt::format("coatings/hdpe_{}_{}.toml", size, region), .state = state});
    };
    const SkinEstimate e = paired_percent(film("large"), film("small"), quantity);
    parts.push_back({fmt::format("small against large, region {}, %", region), e,
                     sign > 0 ? positive(e) : negative(e)});
  }
  return all_of(parts, why_not);
}

double film_friction(const Sample& s, int k) { return friction_off(s, 0, k); }

Judgement films_natural_area(ClaimInputs& in) {
  std::vector<Part> parts;
  for (const char* size : {"large", "small"}) {
    for (int region = 1; region <= 3; ++region) {
      const std::string design = fmt::format("coatings/hdpe_{}_{}.toml", size, region);
      const SkinEstimate e =
          paired_percent(sample(in, {.design = design}),
                         sample(in, {.design = design, .state = FingerState::Natural}),
                         [](const Sample& s, int k) { return mean_without(s.at(0).area_off, k); });
      parts.push_back({fmt::format("{} {}, %", size, region), e, positive(e)});
    }
  }
  return all_of(parts);
}

// Compliance: indentation over pressure, of the mean response.
Judgement films_compliance(ClaimInputs& in) {
  std::vector<Part> parts;
  for (int region = 1; region <= 3; ++region) {
    const auto compliance = [&](const char* size) {
      const ResponsePoint& p =
          sample(in, {.design = fmt::format("coatings/hdpe_{}_{}.toml", size, region)})
              .response.points[0];
      return Estimate{1e12 * p.indentation.value / p.patch_pressure,
                      1e12 * p.indentation.se() / p.patch_pressure};
    };
    const Estimate large = compliance("large"), small = compliance("small");
    const SkinEstimate gain{{large.value - small.value, std::hypot(large.se, small.se)},
                            in.sampling().skins};
    parts.push_back(
        {fmt::format("large minus small, region {}, um/MPa", region), gain, positive(gain)});
  }
  return all_of(parts);
}

Claim claim(const char* id, const char* statement, const char* band,
            std::function<Judgement(ClaimInputs&)> judge) {
  return {id, "M3 model (Ma et al. 2025)", statement, band, true, std::move(judge)};
}

// --- What a fit compares ----------------------------------------------------------------------

ClaimTarget target(const char* claim, const char* what, double low, double high, double sd,
                   std::function<Estimate(ClaimInputs&)> model) {
  return {claim, what, low, high, sd, std::move(model)};
}

}  // namespace

std::vector<ClaimTarget> m3_targets() {
  const auto flat_rise = [](double (*friction)(const Sample&, int, int)) {
    return [friction](ClaimInputs& in) -> Estimate {
      const Sample& s = m3(in, "flat");
      return jackknife(s, [&](int k) { return friction(s, kWet, k) / friction(s, kDry, k); });
    };
  };
  const auto effect_of = [](const char* name, int from, int to) {
    return [name, from, to](ClaimInputs& in) -> Estimate {
      return effect_ratio(m3(in, name), from, to);
    };
  };
  return {
      target("M1", "F_off(75 %) / F_off(15 %), flat", 2, 2, 0.2, flat_rise(friction_off)),
      target("M2", "F_on(75 %) / F_on(15 %), flat", 2, 2, 0.2, flat_rise(friction_on)),
      target("M3", "growth of the gross area, %", 58.5, 58.5, 3,
             [](ClaimInputs& in) -> Estimate {
               const MacroContact& macro = in.finger().macro;
               return {100 * (macro.gross_area(0.2, 0.75) / macro.gross_area(0.2, 0.15) - 1), 0};
             }),
      target("M4", "growth of the patch's real area, flat, %", 45.5, 45.5, 4,
             [](ClaimInputs& in) -> Estimate {
               const Sample& s = m3(in, "flat");
               return jackknife(s, [&](int k) {
                 return 100 * (mean_without(s.at(kWet).area_off, k) /
                                   mean_without(s.at(kDry).area_off, k) -
                               1);
               });
             }),
      target("M5", "area added by capillaries at 75 %, flat, %", 22.3, 24.1, 4,
             [](ClaimInputs& in) -> Estimate {
               const Sample& s = m3(in, "flat");
               const Sample& dry = sample(in, {.design = "m3_samples/flat.toml", .water = false});
               return jackknife(s, [&](int k) {
                 return 100 * (mean_without(s.at(kWet).area_off, k) /
                                   mean_without(dry.at(kWet).area_off, k) -
                               1);
               });
             }),
      target("M9", "change of ΔF, 15 to 35 %, flat", 0.02, kInfinity, 0.05,
             effect_of("flat", kDry, kDamp)),
      target("M9", "change of ΔF, 35 to 75 %, a4h350", -kInfinity, -0.08, 0.05,
             effect_of("a4h350", kDamp, kWet)),
      target("M10", "change of ΔF, 15 to 35 %, a4h600", -0.25, 0.05, 0.1,
             effect_of("a4h600", kDry, kDamp)),
      target("M10", "change of ΔF, 15 to 75 %, a4h600", -0.25, 0.05, 0.1,
             effect_of("a4h600", kDry, kWet)),
      target("M13", "110° against 50°, flat at 75 %, %", 130, 130, 20,
             [](ClaimInputs& in) -> Estimate {
               return paired_percent(m3(in, "flat"), m3(in, "flat", 110),
                                     [](const Sample& s, int k) { return modulation(s, kWet, k); });
             }),
      target("M15", "largest modulation at 110° without water", 1.38, 1.38, 0.1,
             [](ClaimInputs& in) -> Estimate {
               const Sample& s =
                   sample(in, {.design = "m3_samples/flat.toml", .angle = 110, .water = false});
               const auto largest = [&](int k) {
                 double most = -kInfinity;
                 for (int rh = 0; rh < kHumidities; ++rh)
                   most = std::max(most, modulation(s, rh, k));
                 return most;
               };
               return jackknife(s, largest);
             }),
      target("M17", "retention at 75 %, flat, % of F_off", 5, 5, 2,
             [](ClaimInputs& in) -> Estimate {
               const ResponsePoint& p = m3(in, "flat").response.points[kWet];
               return {100 * p.retention_force.value / p.friction_off.value,
                       100 * p.retention_force.se() / p.friction_off.value};
             }),
      target("C_gap", "gap of a sliding finger by its capacitance, um", 1.06, 1.06, 0.1,
             [](ClaimInputs& in) -> Estimate {
               constexpr double kOxide = 0.256e-6, kArea = 30e-6, kLoad = 1, kHumidity = 0.45;
               return {1e6 * capacitive_gap(in.finger(), kLoad / kArea, kOxide, kHumidity), 0};
             }),
  };
}

std::vector<Claim> m3_claims() {
  return {
      claim("M1", "F_off rises nearly two-fold from 15 to 75 % RH, all samples", "1.6 to 2.4",
            [](ClaimInputs& in) { return friction_rise(in, friction_off); }),
      claim("M2", "F_on rises nearly two-fold from 15 to 75 % RH, all samples", "1.6 to 2.4",
            [](ClaimInputs& in) { return friction_rise(in, friction_on); }),
      claim("M3", "apparent contact area +58.5 %", "±3 points", gross_area),
      claim("M4", "microscopic real area +45.5 %", "±8 points", real_area),
      claim("M5", "capillaries add 22.3 to 24.1 % microscopic area at 75 % RH", "15 to 32 %",
            capillary_area),
      claim("M6", "capillary force: 4 um holes below 3 um holes at 55 and 75 % RH",
            "95 % interval excludes 0", capillary_by_diameter),
      claim("M7", "capillary force does not depend on the depth of the holes",
            "95 % interval contains 0", capillary_by_depth),
      claim("M8", "larger holes: lower friction", "95 % interval excludes 0", friction_by_diameter),
      claim("M9", "ΔF of flat, a4h350, a3h600 rises from 15 to 35 % RH and falls to 75 %",
            "95 % intervals exclude 0", effect_rises_and_falls),
      claim("M10", "ΔF of a4h600 and a3h900 constant or slightly falling", "-25 to +5 %",
            effect_constant),
      claim("M11", "stronger effect: a3h600 over a4h600, a4h350 over a4h600, a3h600 over a3h900",
            "95 % intervals exclude 0",
            [](ClaimInputs& in) { return compare_pairs(in, mean_modulation, ""); }),
      claim("M12", "the stronger of each pair varies more over humidity",
            "95 % intervals exclude 0",
            [](ClaimInputs& in) { return compare_pairs(in, range_over_mean, ""); }),
      claim("M13", "110° against 50°: modulation at 75 % RH +130 %, stronger at every humidity",
            "+90 to +170 %; signs", hydrophobic_gain),
      claim("M14", "variation of the modulation over humidity 27.3 % (flat) to 6.7 % (a3h350)",
            "one reading with both within ±5 points", variation_readings),
      claim("M15", "110°, no reduction of the field: 1.38", "±15 %", theoretical_maximum),
      claim("M16", "110° lowers the friction without field", "95 % intervals exclude 0",
            hydrophobic_friction),
      claim("M17", "retention by hysteresis about 5 % of F_off", "2 to 10 %", retention),
      claim("M18", "van der Waals forces negligible", "below 5 % of the contact load",
            van_der_waals),
      claim("M19", "clean finger: films with larger, softer particles rub more",
            "95 % intervals exclude 0, three regions",
            [](ClaimInputs& in) { return films(in, FingerState::Clean, film_friction, -1, ""); }),
      claim("M20", "natural finger: smaller particles have more capillary force and rub more",
            "95 % intervals exclude 0, three regions",
            [](ClaimInputs& in) {
              return films(in, FingerState::Natural, film_friction, 1,
                           "the small particles are of 7 MPa, the large of 2.6 MPa: their dry area "
                           "is half, and no water the model holds makes up for that");
            }),
      claim("M21", "hydrophilic: the electrostatic force falls as bridges grow",
            "95 % intervals exclude 0", pull_falls),
      claim("M22",
            "screens: the smoothest strongest and most sensitive to humidity, the roughest "
            "weakest and least",
            "95 % intervals exclude 0", screens),
      claim("M23", "larger, softer particles are more compliant",
            "95 % intervals exclude 0, three regions", films_compliance),
      claim("M24", "fields well below 3 MV/m in air and 10 MV/m in SiO2", "our fields",
            fields_in_air_and_oxide),
      claim("M25", "a higher aspect ratio lowers the variation", "95 % interval excludes 0",
            aspect_ratio),
      claim("M26", "softening alone makes ΔF rise at every step", "95 % intervals exclude 0",
            softening_alone),
      claim("M27", "bridges rarely span even holes of 350 nm", "below 5 % of the bridges",
            bridges_in_holes),
      claim("M28", "both films: larger area with the natural than with the clean finger",
            "95 % intervals exclude 0, three regions", films_natural_area),
  };
}

}  // namespace papilla
