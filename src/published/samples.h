// The samples of the M3 paper under one finger, and numbers over their patches. Patches are the
// sample: every difference is paired over the same skins, and its error comes from the jackknife.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/response.h"
#include "numerics/statistics.h"
#include "published/finger_model.h"

namespace papilla::published {

// The humidities of designs/m3_samples, places in the list of points.
inline constexpr int kHumidities = 4;
inline constexpr int kDry = 0, kDamp = 1, kMoist = 2, kWet = 3;
inline constexpr int humidity_percent(int rh) { return 15 + 20 * rh; }

// A surface of the paper under one of its conditions.
struct SampleCase {
  std::string design;  // below designs/
  double angle = 0;    // contact angle [deg]; 0: the design's own
  bool water = true;
  FingerState state = FingerState::Clean;
};
Design read_case(const SampleCase& c);
Scene scene_of(const FingerModel& model, const SampleCase& c, const Design& design);

struct Sample {
  Response response;            // by the load law too, with the contact areas of each skin
  std::vector<double> preload;  // of a patch [N]

  const ResponsePoint& point(int rh) const { return response.points[static_cast<std::size_t>(rh)]; }
  const PatchSamples& at(int rh) const { return point(rh).samples; }
};

// Each is run once per model.
const Sample& sample(FingerModel& model, const SampleCase& c);
// The paper's six: "flat", "a3h350", ...
const std::vector<std::string>& m3_sample_names();
// One of them, by its own contact angle or another [deg].
SampleCase m3_case(const std::string& name, double angle = 0);
const Sample& m3_sample(FingerModel& model, const std::string& name, double angle = 0);
// Without voltage, on kRestingShare times as many skins: capillary forces scatter most of all, and
// cost least.
inline constexpr int kRestingShare = 4;
const Sample& m3_sample_at_rest(FingerModel& model, const std::string& name);

// Which skins a mean is over.
class Skins {
 public:
  static Skins all() { return {Choice::All, 0}; }
  static Skins without(int k) { return {Choice::Without, static_cast<std::size_t>(k)}; }
  static Skins only(int k) { return {Choice::Only, static_cast<std::size_t>(k)}; }

  double mean(const std::vector<double>& v) const;

 private:
  enum class Choice { All, Without, Only };
  Skins(Choice choice, std::size_t index) : choice_(choice), index_(index) {}

  Choice choice_;
  std::size_t index_;
};

// Means over skins of a sample at a humidity (its place in the list). Friction is without
// retention: the paper's is shear strength times contact area.
double friction_off(const Sample& s, int rh, Skins over);  // [N]
double friction_on(const Sample& s, int rh, Skins over);
double effect(const Sample& s, int rh, Skins over);  // Delta F [N]
double modulation(const Sample& s, int rh, Skins over);
double capillary_load(const Sample& s, int rh, Skins over);  // of a patch [N]
// The same over humidity.
double mean_modulation(const Sample& s, Skins over);
double range_over_mean(const Sample& s, Skins over);
double deviation_over_mean(const Sample& s, Skins over);

// An estimate over skins, with what its interval needs, and what each skin alone would say: the
// paper had one.
struct SkinEstimate : Estimate {
  int skins = 2;
  std::vector<double> single{};

  double half_width() const;  // of the 95 % interval
};
// A sign counts when the 95 % interval excludes zero.
bool positive(const SkinEstimate& e);
bool negative(const SkinEstimate& e);

// A number over the skins of a sample, by `f(Skins)`, with its error.
template <class F>
SkinEstimate jackknife(int skins, F&& f) {
  std::vector<double> without, single;
  for (int k = 0; k < skins; ++k) {
    without.push_back(f(Skins::without(k)));
    single.push_back(f(Skins::only(k)));
  }
  return {mean_estimate(jackknife_samples(f(Skins::all()), without)), skins, std::move(single)};
}
template <class F>
SkinEstimate jackknife(const Sample& s, F&& f) {
  return jackknife(static_cast<int>(s.at(0).area_off.size()), f);
}
template <class F>
SkinEstimate jackknife(const FingerModel& model, F&& f) {
  return jackknife(model.sampling().skins, f);
}

// Difference b - a of a quantity in percent of a, paired over skins.
template <class F>
SkinEstimate paired_percent(const Sample& a, const Sample& b, F&& quantity) {
  return jackknife(a,
                   [&](Skins over) { return 100 * (quantity(b, over) / quantity(a, over) - 1); });
}
// Change of the effect from one humidity to another, relative.
SkinEstimate effect_ratio(const Sample& s, int from, int to);

}  // namespace papilla::published
