#include "forward/forward.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "forward/scale_bridge.h"
#include "geometry/measured.h"
#include "geometry/roughness.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla {
namespace {

// The kernel of a humidity. Skin on a rigid surface softens as a whole, so the kernel at 15 % RH
// serves all humidities (see PatchSolver); a compliant surface does not soften, and needs one each.
std::shared_ptr<const ContactKernel> kernel_at(const Scene& scene, const Grid& grid, double rh) {
  const Skin& skin = scene.finger.skin;
  const double factor = scene.surface.modulus > 0 ? skin.modulus_factor(rh) : 1;
  return make_contact_kernel(grid,
                             {skin.layer_modulus * factor, skin.layer_poisson, skin.layer_thickness,
                              skin.bulk_modulus * factor, skin.bulk_poisson, scene.surface.modulus,
                              scene.surface.poisson});
}

// The finger in its state, with nothing more to apply.
Scene applied(const Scene& scene) {
  Scene out = scene;
  out.finger = scene.finger.applied();
  return out;
}

// Sliding offset of skin k against the texture: the R2 low-discrepancy sequence over the patch.
double offset_share(int k, bool second) {
  const double step = second ? 0.56984029099805327 : 0.75487766624669276;
  return std::fmod(0.5 + step * (k + 1), 1.0);
}

// Skin of a patch: common to every design, because its modes are keyed by integer index.
Heightmap skin_patch(const Scene& scene, const Plan& plan, const Fidelity& fidelity, int index) {
  const Skin& skin = scene.finger.skin;
  const Grid& grid = plan.grid;
  if (!skin.map.empty())
    return measured_skin(skin.map, skin.map_width, grid, fidelity.seed,
                         static_cast<std::uint64_t>(index));
  const Spectrum spectrum{skin.rms, skin.roll_off, skin.hurst, plan.effective_cutoff};
  return random_surface(spectrum, grid, fidelity.seed, static_cast<std::uint64_t>(index),
                        offset_share(index, false) * grid.lx, offset_share(index, true) * grid.ly);
}

std::vector<double> added(const Heightmap& a, const Heightmap& b) {
  std::vector<double> sum(a.z.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a.z[i] + b.z[i];
  return sum;
}

Measured sampled_mean(const std::vector<PatchResult>& patches, double PatchResult::*member,
                      double factor = 1) {
  std::vector<double> values;
  values.reserve(patches.size());
  for (const PatchResult& p : patches) values.push_back(p.*member);
  const Estimate e = mean_estimate(values);
  return {factor * e.value, {.sampling = std::abs(factor) * e.se}};
}

// Worst relative error of friction from a contact solve with this certificate: Eq. accuracy.1
constexpr double kSolverError = 5;

// Of the 3-D potential on the pixels of a patch (docs/theory/electrostatics.md).
constexpr double kFullFieldError = 0.08;

// Volumes and placements of the water on one skin: low and high (or the mean) by droplet seeds.
struct WaterMember {
  double factor;
  std::uint64_t index;
};
std::vector<WaterMember> water_members(const Scene& scene, const Plan& plan,
                                       const Fidelity& fidelity, int skin) {
  const auto index = static_cast<std::uint64_t>(skin);
  if (!plan.water) return {{1, index}};
  const double spread = scene.finger.water.volume_spread;
  const int seeds = scene.model.water == WaterModel::Droplets ? fidelity.droplet_seeds : 1;
  std::vector<WaterMember> out;
  for (int s = 0; s < seeds; ++s) {
    const std::uint64_t member = index + (static_cast<std::uint64_t>(s) << 32);
    if (spread > 0) {
      out.push_back({1 - spread, member});
      out.push_back({1 + spread, member});
    } else {
      out.push_back({1, member});
    }
  }
  return out;
}

// Of the members on one skin: means, highest peaks, summed costs, the first trouble.
PatchResult mean_of(const std::vector<PatchResult>& members) {
  PatchResult out = members.front();
  if (members.size() == 1) return out;
  for (double PatchResult::*value :
       {&PatchResult::capillary_off, &PatchResult::capillary_on, &PatchResult::pull,
        &PatchResult::retention, &PatchResult::area_off, &PatchResult::area_on,
        &PatchResult::bridges, &PatchResult::wetted, &PatchResult::bridge_volume,
        &PatchResult::on_its_way, &PatchResult::volume, &PatchResult::over_limit_area,
        &PatchResult::over_limit_share}) {
    out.*value = 0;
    for (const PatchResult& m : members) {
      out.*value += m.*value / static_cast<double>(members.size());
    }
  }
  for (std::size_t k = 1; k < members.size(); ++k) {
    const PatchResult& m = members[k];
    out.peak_oxide_field = std::max(out.peak_oxide_field, m.peak_oxide_field);
    out.peak_air_field = std::max(out.peak_air_field, m.peak_air_field);
    out.oxide_margin = std::min(out.oxide_margin, m.oxide_margin);
    out.certificate = std::max(out.certificate, m.certificate);
    out.contact_solves += m.contact_solves;
    out.fft_pairs += m.fft_pairs;
    out.seconds.contact += m.seconds.contact;
    out.seconds.water += m.seconds.water;
    out.seconds.field += m.seconds.field;
    if (out.status.empty()) out.status = m.status;
  }
  return out;
}

class PointBuilder {
 public:
  PointBuilder(const Scene& scene, const Plan& plan, const Fidelity& fidelity)
      : scene_(scene), plan_(plan), fidelity_(fidelity) {}

  ResponsePoint build(double rh, double weight, const ScaleBridge& bridge,
                      const std::vector<PatchResult>& patches) const {
    ResponsePoint point;
    point.relative_humidity = rh;
    point.weight = weight;
    point.patch_pressure = bridge.mean_pressure();
    const MacroContact& macro = scene_.finger.macro;
    const double carrying =
        bridge.carrying_share() * macro.gross_area(scene_.finger.load, rh);  // [m^2]
    const double patches_per_finger = carrying / plan_.grid.area();

    double certificate = 0;
    for (const PatchResult& p : patches) {
      point.samples.load_off.push_back(p.load + p.capillary_off);
      point.samples.load_on.push_back(p.load + p.capillary_on + p.pull);
      point.samples.area_off.push_back(p.area_off);
      point.samples.area_on.push_back(p.area_on);
      certificate = std::max(certificate, p.certificate);
      point.over_limit_area += p.over_limit_area / static_cast<double>(patches.size());
      point.over_limit_share += p.over_limit_share / static_cast<double>(patches.size());
      point.oxide_margin = std::min(point.oxide_margin, p.oxide_margin);
      point.peak_oxide_field = std::max(point.peak_oxide_field, p.peak_oxide_field);
      point.peak_air_field = std::max(point.peak_air_field, p.peak_air_field);
      if (p.volume > 0) {
        point.bridge_water_share +=
            p.bridge_volume / p.volume / static_cast<double>(patches.size());
      }
      if (!p.status.empty() && point.status == "ok") point.status = p.status;
    }

    if (fidelity_.estimator == Estimator::Load || !plan_.traction_solves) {
      load_based(point, patches);
    } else {
      area_based(point);
    }
    for (const Measured* area : {&point.area_fraction_off, &point.area_fraction_on}) {
      // Resolved areas end at the patch, the load law does not.
      if (area->value > 1 && point.status == "ok") {
        point.status = fmt::format(
            "full contact: the area estimate is {:.3g} times the patch, friction and modulation "
            "mean "
            "nothing physical",
            area->value);
      }
    }
    const double strength = macro.shear_strength * carrying;
    point.retention_force = plan_.retention
                                ? sampled_mean(patches, &PatchResult::retention, patches_per_finger)
                                : Measured{};
    point.strength = strength;
    point.friction_off = friction(strength, point.area_fraction_off, point.retention_force);
    point.friction_on = friction(strength, point.area_fraction_on, point.retention_force);
    if (plan_.field) {
      // The retention force is part of both frictions (Eq. friction.1).
      const double dry_ratio = point.modulation.value;
      const double share = point.friction_off.value > 0
                               ? 1 - point.retention_force.value / point.friction_off.value
                               : 1;
      point.modulation.value = dry_ratio * share;
      point.modulation.parts.sampling *= std::abs(share);
    } else {
      point.modulation = {};
    }
    point.capillary_force = sampled_mean(patches, &PatchResult::capillary_off, patches_per_finger);
    point.electrostatic_force = sampled_mean(patches, &PatchResult::pull, patches_per_finger);
    point.bridges = sampled_mean(patches, &PatchResult::bridges);
    point.wetted_fraction = sampled_mean(patches, &PatchResult::wetted);
    if (plan_.field) {
      const double wetted = point.wetted_fraction.value;
      switch (field_method(scene_.model)) {
        case FieldMethod::Local:
          point.field_error = local_rule_error(wetted);
          break;
        case FieldMethod::Spread:
          point.field_error = spread_rule_error(wetted);
          break;
        case FieldMethod::Full:
          point.field_error = kFullFieldError;
          break;
      }
    }
    point.mean_gap = sampled_mean(patches, &PatchResult::mean_gap);
    point.indentation = sampled_mean(patches, &PatchResult::indentation);
    for (const auto member : kMeasured) {
      Measured& m = point.*member;
      m.parts.solver = kSolverError * certificate * std::abs(m.value);
    }
    point.modulation.parts.solver =
        kSolverError * certificate * (1 + std::abs(point.modulation.value));
    state_band(point, patches);
    return point;
  }

 private:
  // Eqs. capillary.19, 20: what mobility and number of the droplets leave open.
  void state_band(ResponsePoint& point, const std::vector<PatchResult>& patches) const {
    if (!plan_.water) return;
    double volume = 0, preload = 0, capillary = 0, pull = 0;
    for (const PatchResult& p : patches) {
      volume += p.volume / static_cast<double>(patches.size());
      preload += p.load;
      capillary += p.capillary_off;
      pull += p.pull;
    }
    if (scene_.model.water == WaterModel::Threshold) {
      // Eq. capillary.21, of what droplets would give.
      const double short_of = threshold_shortfall(volume / plan_.grid.area());
      point.modulation.parts.water = short_of / (1 - short_of) * std::abs(point.modulation.value);
      return;
    }
    DropletBand band =
        droplet_band(volume / plan_.grid.area(), point.mean_gap.value, point.bridge_water_share);
    add_hand_over(band, patches, capillary, pull);
    const double beta = fidelity_.load_exponent;
    // Of a load that water or drive lift off there is nothing to be wrong by.
    const auto share = [&](double change, double load) {
      return load > 0 ? beta * std::abs(change) / load : 0;
    };
    const double off = share(band.capillary * capillary, preload + capillary);
    const double on =
        share(band.capillary * capillary - band.pull * pull, preload + capillary + pull);
    const std::array<std::pair<Measured ResponsePoint::*, double>, 10> all{
        {{&ResponsePoint::capillary_force, band.capillary},
         {&ResponsePoint::retention_force, band.capillary},
         {&ResponsePoint::bridges, band.capillary},
         {&ResponsePoint::wetted_fraction, band.capillary},
         {&ResponsePoint::electrostatic_force, band.pull},
         {&ResponsePoint::modulation, band.pull},
         {&ResponsePoint::friction_off, off},
         {&ResponsePoint::area_fraction_off, off},
         {&ResponsePoint::friction_on, on},
         {&ResponsePoint::area_fraction_on, on}}};
    for (const auto& [member, relative] : all) {
      Measured& m = point.*member;
      m.parts.water = relative * std::abs(m.value);
    }
  }

  // Eq. capillary.23: patches whose water is between disc and film, each with a step of its own.
  static void add_hand_over(DropletBand& band, const std::vector<PatchResult>& patches,
                            double capillary, double pull) {
    // The largest steps of the sweeps in Film.WithMovingDroplets... and docs/theory/capillary.md.
    constexpr double kForceStep = 0.18, kPullStep = 0.10;
    double forces = 0, pulls = 0;
    for (const PatchResult& p : patches) {
      if (!(p.on_its_way > 0)) continue;
      const double share = p.on_its_way / p.bridge_volume;
      forces += square(kForceStep * share * p.capillary_off);
      pulls += square(kPullStep * share * p.pull);
    }
    if (capillary != 0) band.capillary = std::hypot(band.capillary, std::sqrt(forces) / capillary);
    if (pull > 0) band.pull = std::hypot(band.pull, std::sqrt(pulls) / pull);
  }

  // Eq. friction.3: F ~ L^beta on the dry contact area.
  void load_based(ResponsePoint& point, const std::vector<PatchResult>& patches) const {
    const Measured dry = sampled_mean(patches, &PatchResult::area_dry);
    std::vector<double> loads;
    for (const PatchResult& p : patches) loads.push_back(p.load);
    const Estimate off = ratio_estimate(point.samples.load_off, loads);
    const Estimate on = ratio_estimate(point.samples.load_on, loads);
    const Estimate gain = ratio_estimate(point.samples.load_on, point.samples.load_off);
    point.area_fraction_off = scaled(dry, off);
    point.area_fraction_on = scaled(dry, on);
    const double ratio = fidelity_.area_by_load(gain.value);
    point.modulation.value = ratio - 1;
    point.modulation.parts.sampling =
        fidelity_.load_exponent * ratio * gain.se / std::max(gain.value, 1e-12);
  }

  // Eq. friction.1, friction.2: resolved areas, ratio of sums over the skins.
  static void area_based(ResponsePoint& point) {
    const Estimate off = mean_estimate(point.samples.area_off);
    const Estimate on = mean_estimate(point.samples.area_on);
    point.area_fraction_off = {off.value, {.sampling = off.se}};
    point.area_fraction_on = {on.value, {.sampling = on.se}};
    if (off.value > 0) {
      const Estimate gain = ratio_estimate(point.samples.area_on, point.samples.area_off);
      point.modulation = {gain.value - 1, {.sampling = gain.se}};
    }
  }

  Measured scaled(const Measured& dry, const Estimate& load_ratio) const {
    const double factor = fidelity_.area_by_load(load_ratio.value);
    const double relative =
        load_ratio.value > 0 ? fidelity_.load_exponent * load_ratio.se / load_ratio.value : 0;
    return {dry.value * factor,
            {.sampling = std::hypot(dry.parts.sampling * factor, dry.value * factor * relative)}};
  }

  Measured friction(double strength, const Measured& area, const Measured& retention) const {
    Measured f;
    f.value = strength * area.value + retention.value;
    f.parts.sampling = std::hypot(strength * area.parts.sampling, retention.parts.sampling);
    return f;
  }

  const Scene& scene_;
  const Plan& plan_;
  const Fidelity& fidelity_;
};

}  // namespace

double ErrorParts::total() const {
  double sum = sampling * sampling;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (origin.in_total) sum += square((this->*origin.part).value_or(0));
  }
  return std::sqrt(sum);
}

std::string Response::trouble() const {
  std::string out;
  for (const ResponsePoint& point : points) {
    if (point.status == "ok") continue;
    out += fmt::format("{}{:.0f} % RH: {}", out.empty() ? "" : "; ", 100 * point.relative_humidity,
                       point.status);
  }
  return out;
}

void PatchSet::add(const PatchSet& other) {
  PAPILLA_CHECK(results.size() == other.results.size(), "the same humidities");
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].insert(results[i].end(), other.results[i].begin(), other.results[i].end());
  }
  seconds += other.seconds;
}

PatchSet solve_patches(const Scene& given, const Texture& texture, const Fidelity& fidelity) {
  const auto begin = std::chrono::steady_clock::now();
  const Scene scene = applied(given);
  PatchSet set;
  set.plan = make_plan(scene, texture, fidelity);
  const Grid& grid = set.plan.grid;
  const CoveredSurface surface(generate(texture, grid), scene.surface.dielectric_thickness());
  const std::vector<double>& humidities = scene.environment.relative_humidity;
  PAPILLA_CHECK(!humidities.empty(), "one humidity at least");
  std::vector<std::shared_ptr<const ContactKernel>> kernels;
  for (double rh : humidities) {
    kernels.push_back(kernel_at(scene, grid, rh));
    set.bridges.emplace_back(scene, fidelity, grid, rh);
  }

  set.results.assign(humidities.size(),
                     std::vector<PatchResult>(static_cast<std::size_t>(fidelity.skins)));
  parallel_for(
      fidelity.skins,
      [&](int k) {
        const int index = fidelity.first_skin + k;
        const Heightmap skin = skin_patch(scene, set.plan, fidelity, index);
        const std::vector<double> height = added(surface.height, skin);
        // One a patch pressure: the contact of the previous humidity.
        std::vector<PatchStates> start(set.bridges[0].pressures().size());
        const std::vector<WaterMember> members = water_members(scene, set.plan, fidelity, index);
        std::vector<PatchResult> patches, one;
        for (std::size_t i = 0; i < humidities.size(); ++i) {
          patches.clear();
          for (double pressure : set.bridges[i].pressures()) {
            one.clear();
            for (const WaterMember& member : members) {
              const PatchProblem problem{&scene,        &surface, height,       kernels[i].get(),
                                         humidities[i], pressure, member.index, member.factor};
              one.push_back(solve_patch(problem, set.plan, fidelity, start[patches.size()]));
            }
            patches.push_back(mean_of(one));
          }
          set.results[i][static_cast<std::size_t>(k)] = set.bridges[i].combine(patches);
        }
      },
      fidelity.threads);
  set.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return set;
}

Response respond(const Scene& given, const Fidelity& fidelity, const PatchSet& set) {
  const Scene scene = applied(given);
  Response response;
  response.plan = set.plan;
  response.controls = set.controls;
  response.fidelity = fidelity;
  response.fidelity.skins = set.skins();
  response.driven = set.plan.field;
  response.seconds = set.seconds;
  const PointBuilder builder(scene, response.plan, fidelity);
  const std::vector<double>& humidities = scene.environment.relative_humidity;
  if (set.skins() > 1) response.without.resize(static_cast<std::size_t>(set.skins()));
  for (std::size_t i = 0; i < humidities.size(); ++i) {
    const std::vector<PatchResult>& patches = set.results[i];
    const double weight = scene.environment.weights.empty() ? 1 : scene.environment.weights[i];
    response.points.push_back(builder.build(humidities[i], weight, set.bridges[i], patches));
    std::vector<PatchResult> rest(patches.begin() + (patches.empty() ? 0 : 1), patches.end());
    for (std::size_t k = 0; k < response.without.size(); ++k) {
      // `rest` holds all but skin k.
      response.without[k].push_back(builder.build(humidities[i], weight, set.bridges[i], rest));
      response.without[k].back().samples = {};
      if (k < rest.size()) rest[k] = patches[k];
    }
    for (const PatchResult& patch : patches) {
      response.contact_solves += patch.contact_solves;
      response.fft_pairs += patch.fft_pairs;
      response.piece_seconds.contact += patch.seconds.contact;
      response.piece_seconds.water += patch.seconds.water;
      response.piece_seconds.field += patch.seconds.field;
    }
    for (const MeasuredError& error : set.errors) {
      if (!error.pull_in.empty() && !error.pull_in[i].empty() &&
          response.points.back().status == "ok") {
        response.points.back().status = error.pull_in[i];
      }
      for (std::size_t m = 0; m < kMeasured.size(); ++m) {
        Measured& measured = response.points.back().*kMeasured[m];
        std::optional<double>& part = measured.parts.*error.origin;
        part = std::hypot(part.value_or(0), error.size[i][m] * std::abs(measured.value));
      }
    }
  }
  for (const MeasuredError& error : set.errors) {
    response.contact_solves += error.contact_solves;
    response.fft_pairs += error.fft_pairs;
    response.seconds += error.seconds;
  }
  return response;
}

Response evaluate(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  PatchSet patches = solve_patches(scene, texture, fidelity);
  measure_errors(scene, texture, fidelity, patches);
  return respond(scene, fidelity, patches);
}

RestPatches::RestPatches(const Scene& scene, const Texture& texture, const Fidelity& fidelity)
    : scene_(applied(scene)), fidelity_(fidelity) {
  PAPILLA_CHECK(scene.environment.relative_humidity.size() == 1, "one humidity");
  if (!scene_.drive.driven()) scene_.drive.amplitude = 1;
  plan_ = make_plan(scene_, texture, fidelity_);
  surface_ = std::make_unique<const CoveredSurface>(generate(texture, plan_.grid),
                                                    scene_.surface.dielectric_thickness());
  const double humidity = scene_.environment.relative_humidity[0];
  kernel_ = kernel_at(scene_, plan_.grid, humidity);
  pressures_ = ScaleBridge(scene_, fidelity_, plan_.grid, humidity).pressures();
  height_.resize(static_cast<std::size_t>(fidelity_.skins));
  rest_.resize(height_.size());
  parallel_for(
      fidelity_.skins,
      [&](int k) {
        const int index = fidelity_.first_skin + k;
        height_[k] = added(surface_->height, skin_patch(scene_, plan_, fidelity_, index));
        const std::vector<WaterMember> members = water_members(scene_, plan_, fidelity_, index);
        for (double pressure : pressures_) {
          PatchStates start;  // the dry contact is that of the first member
          for (const WaterMember& member : members) {
            const PatchProblem problem{&scene_,  surface_.get(), height_[k],   kernel_.get(),
                                       humidity, pressure,       member.index, member.factor};
            rest_[k].push_back(rest_patch(problem, plan_, fidelity_, start));
            if (members.size() > 1) start.dry = rest_[k].back().dry;
          }
        }
      },
      fidelity_.threads);
}

ResponsePoint RestPatches::drive(double amplitude, Estimator estimator) const {
  Scene scene = scene_;
  scene.drive.amplitude = amplitude;
  Fidelity fidelity = fidelity_;
  fidelity.estimator = estimator;
  Plan plan = plan_;
  plan.traction_solves = plan_.traction_solves && estimator == Estimator::Area;
  const double humidity = scene.environment.relative_humidity[0];
  const ScaleBridge bridge(scene, fidelity, plan.grid, humidity);
  std::vector<PatchResult> results(rest_.size());
  parallel_for(
      fidelity.skins,
      [&](int k) {
        const std::vector<WaterMember> members =
            water_members(scene, plan, fidelity, fidelity.first_skin + k);
        std::vector<PatchResult> patches, one;
        std::size_t at = 0;
        for (double pressure : pressures_) {
          one.clear();
          for (const WaterMember& member : members) {
            const PatchProblem problem{&scene,   surface_.get(), height_[k],   kernel_.get(),
                                       humidity, pressure,       member.index, member.factor};
            one.push_back(drive_patch(problem, plan, fidelity, rest_[k][at++]));
          }
          patches.push_back(mean_of(one));
        }
        results[k] = bridge.combine(patches);
      },
      fidelity.threads);
  return PointBuilder(scene, plan, fidelity).build(humidity, 1, bridge, results);
}

PatchPicture picture_patch(const Scene& given, const Texture& texture, const Fidelity& fidelity,
                           double relative_humidity, int index) {
  const Scene scene = applied(given);
  const Plan plan = make_plan(scene, texture, fidelity);
  PatchPicture picture;
  const CoveredSurface surface(generate(texture, plan.grid), scene.surface.dielectric_thickness());
  picture.texture = surface.height;
  picture.skin = skin_patch(scene, plan, fidelity, fidelity.first_skin + index);
  const std::vector<double> height = added(picture.texture, picture.skin);
  const auto kernel = kernel_at(scene, plan.grid, relative_humidity);
  PatchStates start;
  const PatchProblem problem{
      &scene,
      &surface,
      height,
      kernel.get(),
      relative_humidity,
      ScaleBridge(scene, fidelity, plan.grid, relative_humidity).mean_pressure(),
      static_cast<std::uint64_t>(fidelity.first_skin + index)};
  solve_patch(problem, plan, fidelity, start, &picture.fields);
  return picture;
}

}  // namespace papilla
