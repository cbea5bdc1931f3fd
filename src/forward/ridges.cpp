#include "forward/ridges.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"

namespace papilla::forward {
namespace {

constexpr double kSpectraMeet = 12e-6;  // where the spectrum of the ridges meets that of the skin
constexpr int kRings = 3;
// Pressures of the table over the mean one: below the outermost ring, up to gaps that have closed.
constexpr double kLowest = 0.03, kHighest = 3000;
constexpr int kPressures = 34;
// Of the spectrum: friction and modulation to 1e-3 of those with 3600, over three fingers, 100 and
// 200 V and four humidities; 450 cost twice as much for 5e-4.
constexpr int kIntervals = 300;
// Gaps of the common row: in equal ratios of gap + kFinest, to kWidest.
constexpr std::size_t kGaps = 320;
constexpr double kFinest = 100e-9, kWidest = 200e-6;

// Whether a spectrum of the skin says how rough it is within patches. That of a pin's map is none.
bool skin_is_rough(const Skin& skin, double q_patch) {
  return skin.rms > 0 && 2 * kPi / skin.cutoff > q_patch;
}

PowerSpectrum skin_within(const Skin& skin, double q_patch) {
  const double roll_off = 2 * kPi / skin.roll_off, cutoff = 2 * kPi / skin.cutoff;
  const double begin = std::min(q_patch, roll_off);
  return self_affine_spectrum(skin.rms * skin.relief_factor(), begin, roll_off, cutoff, skin.hurst)
      .between(q_patch, cutoff);
}

// Spectrum of the ridge above the patch size, then that of the skin within patches; of a level face
// that of the skin alone.
PowerSpectrum ridge_and_skin(const Finger& finger, double q_patch) {
  const MacroContact& macro = finger.macro;
  const Skin& skin = finger.skin;
  if (macro.ridge_rms <= 0) return skin_within(skin, q_patch);
  const double lowest = std::min(2 * kPi / macro.ridge_longest, 0.5 * q_patch);
  const double ridge_roll_off =
      std::clamp(2 * kPi / macro.ridge_roll_off, lowest, std::max(lowest, 0.5 * q_patch));
  PowerSpectrum all = self_affine_spectrum(macro.ridge_rms, lowest, ridge_roll_off, q_patch,
                                           macro.ridge_hurst > 0 ? macro.ridge_hurst : skin.hurst);
  if (!skin_is_rough(skin, q_patch)) return all;
  const PowerSpectrum within = skin_within(skin, q_patch);
  for (std::size_t i = 0; i < within.wave_number.size(); ++i) {
    const double q = i == 0 ? q_patch * (1 + 1e-9) : within.wave_number[i];
    if (q <= all.wave_number.back()) continue;
    all.wave_number.push_back(q);
    all.density.push_back(within.density[i]);
  }
  return all;
}

}  // namespace

MeanField ridge_field(const Finger& finger, double q_patch, double relative_humidity,
                      const MeanFieldOptions& options) {
  const MacroContact& macro = finger.macro;
  const double factor = finger.skin.modulus_factor(relative_humidity);
  return MeanField(ridge_and_skin(finger, q_patch),
                   {finger.skin.bulk_modulus * factor, finger.skin.bulk_poisson,
                    macro.corneum_thickness, macro.tissue_modulus, 0.5},
                   options);
}

const std::vector<double>& GapShares::row() {
  static const std::vector<double> row = [] {
    std::vector<double> out;
    const double step = std::log1p(kWidest / kFinest) / (kGaps - 1);
    for (std::size_t i = 0; i < kGaps; ++i)
      out.push_back(kFinest * std::expm1(step * static_cast<double>(i)));
    return out;
  }();
  return row;
}

GapShares gap_shares(const GapDistribution& gaps, double q) {
  const std::vector<double>& row = GapShares::row();
  const double step = std::log1p(kWidest / kFinest) / (kGaps - 1);
  std::vector<double> all(kGaps, 0);
  gaps.visit_far(kFinest, q, [&](double u, double share) {
    const auto last = static_cast<double>(kGaps - 2);
    const auto i = static_cast<std::size_t>(std::min(std::log1p(u / kFinest) / step, last));
    const double t = std::clamp((u - row[i]) / (row[i + 1] - row[i]), 0.0, 1.0);
    all[i] += (1 - t) * share;
    all[i + 1] += t * share;
  });
  const auto some = [](double share) { return share > 0; };
  const auto begin = std::find_if(all.begin(), all.end(), some);
  const auto end = std::find_if(all.rbegin(), std::make_reverse_iterator(begin), some).base();
  return {static_cast<std::size_t>(begin - all.begin()), {begin, end}};
}

std::shared_ptr<const RidgeGaps> ridge_gaps(const Finger& finger, double q_patch,
                                            double relative_humidity, double mean_pressure) {
  using Key = std::tuple<double, double, double, MacroContact, Skin>;
  // Of every humidity, finger and member of a belief (528 in the default study): designs of one
  // patch size have them in turn, so that one too many would leave none.
  constexpr double kBytes = 70e3, kMostBytes = 72e6;  // shares at some 190 of the gaps, the field
  static Cache<Key, RidgeGaps> cache(1024, kMostBytes);
  const Key key{q_patch, relative_humidity, mean_pressure, finger.macro, finger.skin};
  return cache.get(key, kBytes, [&] {
    auto out = std::make_shared<RidgeGaps>(
        RidgeGaps{ridge_field(finger, q_patch, relative_humidity, {.intervals = kIntervals}),
                  q_patch,
                  {},
                  {},
                  {}});
    const MeanField ridges(out->field.spectrum().between(out->field.spectrum().lowest(), q_patch),
                           out->field.solid(), out->field.options());
    const double step = std::log(kHighest / kLowest) / (kPressures - 1);
    for (int i = 0; i < kPressures; ++i) {
      const double pressure = mean_pressure * kLowest * std::exp(step * i);
      out->pressure.push_back(pressure);
      out->open.push_back(gap_shares(out->field.gaps(pressure, q_patch), q_patch));
      out->hangs.push_back(gap_shares(ridges.gaps(pressure), kInfinity));
    }
    return std::shared_ptr<const RidgeGaps>(out);
  });
}

double capacitive_gap(const Finger& finger, double ridge_pressure, double dielectric,
                      double relative_humidity, const std::vector<PressureRing>& rings) {
  constexpr double kPatchNumber = 2 * kPi / kSpectraMeet;
  // A smooth pin lies on the surface.
  if (finger.macro.ridge_rms <= 0 && !skin_is_rough(finger.skin, kPatchNumber)) return 0;
  const double h0 = dielectric + finger.skin_layer(relative_humidity);
  const MeanField field = ridge_field(finger, kPatchNumber, relative_humidity);
  double inverse = 0;
  for (const PressureRing& ring : rings)
    inverse += ring.share * field.gaps(ridge_pressure * ring.over_mean).inverse(h0);
  return 1 / inverse - h0;
}

std::vector<PressureRing> rings_of(const ModelOptions& model, const MacroContact& macro) {
  if (model.closure != Closure::Balance) return {{}};
  return pressure_rings(macro.pressure_peak, kRings);
}

double compressed_share(const Finger& finger, double compliance, const CarryingShare& rigid,
                        double relative_humidity) {
  const double nominal = ridge_load(finger.macro, finger.load, relative_humidity).mean_pressure;
  if (!(nominal > 0) || !(compliance > 0) || finger.macro.ridge_rms <= 0) return rigid.share;
  const MeanField all = ridge_field(finger, 2 * kPi / kSpectraMeet, relative_humidity);
  const PowerSpectrum ridges =
      all.spectrum().between(all.spectrum().lowest(), 2 * kPi / kSpectraMeet);
  const GapDistribution gaps = MeanField(ridges, all.solid()).gaps(nominal);
  // A patch at a few nanometres touches with its skin.
  constexpr double kTouches = 5e-9;
  const double touching = gaps.cumulative(kTouches);
  if (!(touching > 0)) return rigid.share;
  const auto share = [&](double pressure) {
    return below(rigid.most, rigid.share,
                 rigid.share * gaps.cumulative(kTouches + compliance * pressure) / touching);
  };
  // pressure x patches is the load: rises with the pressure.
  double low = 0, high = rigid.pressure;
  for (int k = 0; k < 60 && high - low > 1e-9 * rigid.pressure; ++k) {
    const double pressure = 0.5 * (low + high);
    (pressure * share(pressure) < rigid.pressure * rigid.share ? low : high) = pressure;
  }
  return rigid.pressure * rigid.share / (0.5 * (low + high));
}

double below(double most, double share, double wanted) {
  const double room = most - share;
  if (!(room > 0)) return share;
  const double x = (wanted - share) / room;
  return share + room * x / std::pow(1 + square(square(x)), 0.25);
}

}  // namespace papilla::forward
