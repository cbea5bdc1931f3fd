#include "published/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "forward/dry_areas.h"
#include "forward/forward.h"

namespace papilla::published {
namespace {

// Without control skins areas are still those of the whole skin.
Response resolved(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  return fidelity.control_skins > 1 ? evaluate(scene, texture, fidelity)
                                    : evaluate_resolved(scene, texture, fidelity, kDrySkins);
}

Sample evaluate_sample(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  Sample out{resolved(scene, texture, fidelity), {}};
  for (const ResponsePoint& p : out.response.points) out.preload.push_back(p.samples.preload);
  if (fidelity.estimator == Estimator::Area) return out;
  for (std::size_t i = 0; i < out.response.points.size(); ++i) {  // areas from loads, of each skin
    PatchSamples& p = out.response.points[i].samples;
    for (std::size_t k = 0; k < p.area_off.size(); ++k) {
      p.area_off[k] *= fidelity.area_by_load(p.load_off[k] / p.pressed_off);
      p.area_on[k] *= fidelity.area_by_load(p.load_on[k] / p.pressed_on);
    }
  }
  return out;
}

}  // namespace

Design read_case(const SampleCase& c) { return read_design(find_design(c.design)); }

Scene scene_of(const FingerModel& model, const SampleCase& c, const Design& d) {
  Scene s{d.surface, model.finger().touching_as(d.finger), d.environment, d.drive,
          model.finger().calibrated_for};
  s.finger.state = c.state;
  s.model.preset = model.preset();
  if (c.angle > 0) s.surface.contact_angle = c.angle * kPi / 180;
  if (!c.water) std::fill(s.finger.water.volume.begin(), s.finger.water.volume.end(), 0.0);
  return s;
}

const Sample& sample(FingerModel& model, const SampleCase& c) {
  const std::string key =
      fmt::format("{} {} {} {}", c.design, c.angle, c.water, static_cast<int>(c.state));
  return model.once<Sample>(key, [&] {
    const Design d = read_case(c);
    return evaluate_sample(scene_of(model, c, d), d.texture, model.fidelity());
  });
}

const std::vector<std::string>& m3_sample_names() {
  static const std::vector<std::string> names{"flat",   "a3h350", "a3h600",
                                              "a3h900", "a4h350", "a4h600"};
  return names;
}

SampleCase m3_case(const std::string& name, double angle) {
  return {.design = "m3_samples/" + name + ".toml", .angle = angle};
}

const Sample& m3_sample(FingerModel& model, const std::string& name, double angle) {
  return sample(model, m3_case(name, angle));
}

const Sample& m3_sample_at_rest(FingerModel& model, const std::string& name) {
  const SampleCase c = m3_case(name);
  return model.once<Sample>("at rest " + name, [&] {
    const Design d = read_case(c);
    Scene scene = scene_of(model, c, d);
    scene.drive.amplitude = 0;
    Fidelity f = model.fidelity();
    f.estimator = Estimator::Load;
    f.skins *= kRestingShare;
    return evaluate_sample(scene, d.texture, f);
  });
}

double Skins::mean(const std::vector<double>& v) const {
  if (choice_ == Choice::Only) return v[index_];
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (choice_ == Choice::All || i != index_) sum += v[i];
  }
  return sum / static_cast<double>(v.size() - (choice_ == Choice::Without ? 1 : 0));
}

double friction_off(const Sample& s, int rh, Skins over) {
  return s.point(rh).strength * over.mean(s.at(rh).area_off);
}
double friction_on(const Sample& s, int rh, Skins over) {
  return s.point(rh).strength * over.mean(s.at(rh).area_on);
}
double effect(const Sample& s, int rh, Skins over) {  // Delta F [N]
  return friction_on(s, rh, over) - friction_off(s, rh, over);
}
double modulation(const Sample& s, int rh, Skins over) {
  return over.mean(s.at(rh).area_on) / over.mean(s.at(rh).area_off) - 1;
}
double capillary_load(const Sample& s, int rh, Skins over) {  // of a patch [N]
  return over.mean(s.at(rh).load_off) - s.preload[static_cast<std::size_t>(rh)];
}
double mean_modulation(const Sample& s, Skins over) {
  double sum = 0;
  for (int rh = 0; rh < kHumidities; ++rh) sum += modulation(s, rh, over);
  return sum / kHumidities;
}
double range_over_mean(const Sample& s, Skins over) {
  double low = kInfinity, high = -kInfinity;
  for (int rh = 0; rh < kHumidities; ++rh) {
    low = std::min(low, modulation(s, rh, over));
    high = std::max(high, modulation(s, rh, over));
  }
  return (high - low) / mean_modulation(s, over);
}
double deviation_over_mean(const Sample& s, Skins over) {
  const double mean = mean_modulation(s, over);
  double sum = 0;
  for (int rh = 0; rh < kHumidities; ++rh) sum += square(modulation(s, rh, over) - mean);
  return std::sqrt(sum / kHumidities) / mean;
}
double SkinEstimate::half_width() const { return student_t_quantile(0.975, skins - 1) * se; }

bool positive(const SkinEstimate& e) { return e.value > e.half_width(); }
bool negative(const SkinEstimate& e) { return -e.value > e.half_width(); }

SkinEstimate effect_ratio(const Sample& s, int from, int to) {
  return jackknife(s, [&](Skins over) { return effect(s, to, over) / effect(s, from, over) - 1; });
}

}  // namespace papilla::published
