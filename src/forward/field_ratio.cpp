#include "forward/field_ratio.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "base/parallel.h"
#include "forward/electric_path.h"
#include "forward/patch_setup.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::forward {
namespace {

// What pixels and cells leave of a 3-D field without water, relative.
constexpr double kOfFullField = 0.02;
// What one skin says of others, one standard deviation: relative, over the table of
// docs/theory/electrostatics.md; and of the square of what is taken off the rule's pull, over six
// skins of flat glass and a3h600 from dry to flooded.
constexpr double kOfOneSkin = 0.03, kOfTakenOff = 0.3;
// What a film that lags behind the gap by an eighth of a turn leaves: the 3-D field sees the real
// part of its thickness, the rest as on a flat stack. Relative, one standard deviation; against the
// complex potential on rough skin at 30 Hz. Eq. electrostatics.17
constexpr double kOfLag = 0.1;

// One skin at one humidity under the drive, the gap at rest.
struct AtRest {
  Gap gap;
  Wetting wetting;
  double pull = 0;  // by the rule [Pa]
};

Fidelity control_fidelity(const Fidelity& fidelity) {
  Fidelity out = fidelity;
  out.grid = std::min(fidelity.grid, kMostFieldPixels);
  out.most_pixels = std::max(64, fidelity.pixels_per_side() * out.grid / fidelity.grid);
  out.skins = fidelity.field_skins;
  out.estimator = Estimator::Load;
  return out;
}

// One skin at every humidity: contact starts from that of the humidity before.
std::vector<AtRest> at_rest(const PatchSetup& setup, int k) {
  const Scene& scene = setup.scene();
  const Heightmap skin = setup.skin(k);
  const std::vector<double> height = setup.height(skin);
  const WaterMember mean{1, static_cast<std::uint64_t>(setup.fidelity().first_skin + k)};
  PatchStates start;
  std::vector<AtRest> out;
  for (const double rh : scene.environment.relative_humidity) {
    const auto kernel = contact_kernel(scene, setup.body(), setup.plan().grid, rh);
    const double pressure =
        ScaleBridge(scene, setup.fidelity(), setup.plan().grid, rh, setup.body(), setup.levels())
            .mean_pressure();
    PatchFields fields;
    solve_patch(setup.problem(height, *kernel, rh, pressure, mean), setup.plan(), setup.fidelity(),
                start, &fields);
    out.push_back({{setup.plan().grid, std::move(fields.off.gap)},
                   std::move(fields.wetting_on),
                   fields.pull.mean()});
  }
  return out;
}

// By the 3-D field [Pa], be it below 0; nothing where contact or field have no solution.
std::optional<double> full_pull(const PatchSetup& setup, const AtRest& patch,
                                double relative_humidity) {
  if (patch.gap.value.empty()) return std::nullopt;
  const FieldSolution full = solve_full_field(patch.gap, &setup.surface(), patch.wetting,
                                              field_problem(setup.scene(), relative_humidity));
  return full.ok ? std::optional(full.mean_pressure) : std::nullopt;
}

// Nothing for layers that conduct alike or insulate alike, and of second order in their lag. The
// scene is in its state.
double error_of_lag(const Scene& scene, double relative_humidity) {
  const SeriesLayers layers = series_layers(scene, relative_humidity);
  const std::complex<double> series = layers.film(scene.surface) + layers.skin;
  const double size = std::norm(series);
  return size > 0 ? kOfLag * square(2 * series.real() * series.imag() / size) : 0;
}

double taken_off(double ratio) { return std::clamp(1 - ratio, 0.0, 1.0); }

}  // namespace

double full_field_error(double correction) {
  return std::hypot(kOfFullField, std::min(1.0, square(taken_off(correction)) / correction));
}

FieldRatio field_ratio(std::span<const std::optional<double>> full, std::span<const double> rule,
                       bool corrected) {
  std::vector<double> solved, by_rule;
  for (std::size_t k = 0; k < full.size(); ++k) {
    if (!full[k]) continue;
    solved.push_back(*full[k]);
    by_rule.push_back(rule[k]);
  }
  const double sum = std::accumulate(by_rule.begin(), by_rule.end(), 0.0);
  FieldRatio out;
  // Nothing pulls, in a flooded patch, or no 3-D field is known: nothing to correct.
  if (!(sum > 0)) {
    out.error = 1;
    return out;
  }
  Estimate e = ratio_estimate(solved, by_rule);
  const double of_skins =
      std::hypot(kOfOneSkin * e.value, kOfTakenOff * square(taken_off(e.value))) /
      std::sqrt(static_cast<double>(solved.size()));
  e.se = std::max(e.se, of_skins);
  const Estimate ratio = not_below_zero(e);
  if (!corrected) {
    // Distance from the 3-D field over it; a pull is off by no more than all of itself.
    out.error = std::min(1.0, std::abs(1 / ratio.value - 1));
    return out;
  }
  out.correction = ratio.value;
  out.error = std::hypot(full_field_error(ratio.value), ratio.se / ratio.value);
  return out;
}

bool field_solved(const Scene& scene, const Fidelity& fidelity) {
  return scene.drive.driven() && fidelity.field_skins > 0 && scene.model.preset != Preset::M3 &&
         field_method(scene.model) != FieldMethod::Full;
}

bool field_corrected(const Scene& scene, const Fidelity& fidelity) {
  return field_solved(scene, fidelity) && field_method(scene.model) == FieldMethod::Spread;
}

double field_ratio_seconds(const Scene& scene, const Grid& grid, const Fidelity& fidelity) {
  const double finer = std::max(1.0, static_cast<double>(fidelity.grid) / kMostFieldPixels);
  const Grid pixels{static_cast<int>(grid.nx / finer), static_cast<int>(grid.ny / finer), grid.lx,
                    grid.ly};
  return fidelity.field_skins * full_field_seconds(pixels) *
         static_cast<double>(scene.environment.relative_humidity.size());
}

FieldRatios field_ratios(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  const std::size_t humidities = scene.environment.relative_humidity.size();
  FieldRatios out(humidities);
  const FieldMethod method = field_method(scene.model);
  if (!scene.drive.driven() || scene.model.preset == Preset::M3) return out;
  const Scene in_state = in_its_state(scene);
  if (method == FieldMethod::Full) {
    for (std::size_t i = 0; i < humidities; ++i)
      out[i].error = std::hypot(full_field_error(1),
                                error_of_lag(in_state, scene.environment.relative_humidity[i]));
    return out;
  }
  if (fidelity.field_skins == 0) return out;
  Scene once = scene;  // both fields over the gap before the drive
  once.model.coupling = Coupling::OnePass;
  const PatchSetup setup(once, texture, control_fidelity(fidelity));
  const auto skins = static_cast<std::size_t>(fidelity.field_skins);
  std::vector<std::vector<AtRest>> patches(skins);
  parallel_for(
      fidelity.field_skins,
      [&](int k) { patches[static_cast<std::size_t>(k)] = at_rest(setup, k); }, fidelity.threads);
  // The dear part, by single patches: one skin keeps all threads at work.
  std::vector<std::vector<std::optional<double>>> full(humidities,
                                                       std::vector<std::optional<double>>(skins));
  std::vector<std::vector<double>> rule(humidities, std::vector<double>(skins));
  parallel_for(
      static_cast<int>(skins * humidities),
      [&](int at) {
        const std::size_t i = static_cast<std::size_t>(at) % humidities,
                          k = static_cast<std::size_t>(at) / humidities;
        rule[i][k] = patches[k][i].pull;
        full[i][k] = full_pull(setup, patches[k][i], scene.environment.relative_humidity[i]);
      },
      fidelity.threads);
  for (std::size_t i = 0; i < humidities; ++i) {
    const double rh = scene.environment.relative_humidity[i];
    if (!knows_skin_layer(setup.plan().grid, field_problem(in_state, rh))) continue;
    out[i] = field_ratio(full[i], rule[i], method == FieldMethod::Spread);
    out[i].error = std::hypot(*out[i].error, error_of_lag(in_state, rh));
  }
  return out;
}

void add_field_error(const FieldRatio& ratio, const LoadExponents& exponents,
                     ResponsePoint& point) {
  point.field_correction = ratio.correction;
  point.field_error = ratio.error;
  if (!ratio.error) return;
  const double e = *ratio.error;
  point.electrostatic_force.parts.field = e * point.electrostatic_force.value;
  const auto& on = point.samples.load_on;
  const double load = std::accumulate(on.begin(), on.end(), 0.0);
  const double pull =
      load - std::accumulate(point.samples.load_off.begin(), point.samples.load_off.end(), 0.0);
  // Of the area under the drive, and of the friction of contact.
  const auto relative = [&](double exponent) {
    return load > 0 ? exponent * std::max(pull, 0.0) / load * e : 0;
  };
  const double rubs = relative(exponents.friction);
  point.area_fraction_on.parts.field = relative(exponents.area) * point.area_fraction_on.value;
  point.friction_on.parts.field =
      rubs * (point.friction_on.value - point.retention_force.value - point.retention_gain);
  point.modulation.parts.field = rubs * (1 + point.modulation.value);
}

}  // namespace papilla::forward
