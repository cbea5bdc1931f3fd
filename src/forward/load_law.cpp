#include "forward/load_law.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::forward {
namespace {

// What a skin leaves unknown of an exponent, in units of ln(load)^2: droplets bridge one gap and
// not the next, the field fills all gaps alike (docs/theory/coupling.md).
constexpr double kUnknownOfWater = 0.1, kUnknownOfField = 0.02;

// The exponent of a force that is `before` on the dry gap and `after` under `load` times the
// nominal one, shrunk towards 0 by what these skins leave `unknown` beside what the load tells. 0
// where the force is none or changes its sign: it then stays what it is. Eq. coupling.14
double exponent(double before, double after, double load, double unknown) {
  if (!(before * after > 0) || !(load > 0)) return 0;
  const double closed = std::log(load);
  return closed * std::log(after / before) / (square(closed) + unknown);
}

double sum_of(std::span<const AttractionSample> samples, PatchResult AttractionSample::*state,
              double PatchResult::*value) {
  double sum = 0;
  for (const AttractionSample& s : samples) sum += s.*state.*value;
  return sum;
}

// The load that a force grows by: no farther from the nominal one than that of the samples.
// Eq. coupling.14
double sampled_part(double load, double sampled) {
  return sampled > 1 ? std::min(load, sampled) : std::max(load, sampled);
}

// The lowest root of load = total(load) from 1 on; total is bounded. Where it falls, as of water
// that pushes, steps that swing around the root are halved.
template <class Total>
double settled_load(const Total& total) {
  constexpr double kLeast = 1e-3, kExact = 1e-12;
  constexpr int kMost = 1000;
  double load = 1, share = 1, before = 0;
  for (int k = 0; k < kMost; ++k) {
    const double step = std::max(total(load), kLeast) - load;
    if (step * before < 0) share /= 2;
    load += share * step;
    before = step;
    if (std::abs(step) <= kExact * load) break;
  }
  return load;
}

bool is_sample(const std::vector<SolvedPatch>& skin) {
  return !skin.empty() && skin.front().sample.has_value();
}

}  // namespace

double AttractionLaw::load_off(double capillary) const {
  return settled_load([&](double load) {
    return 1 + capillary * std::pow(sampled_part(load, sampled_off), capillary_off);
  });
}

double AttractionLaw::load_on(double capillary, double of_field) const {
  return settled_load([&](double load) {
    const double grown = sampled_part(load, sampled_on);
    return 1 + capillary * std::pow(grown, capillary_on) + of_field * std::pow(grown, pull);
  });
}

void AttractionLaw::apply(PatchResult& patch) const {
  patch.status.note(status);
  if (!(patch.load > 0)) return;
  const double off = load_off(patch.capillary_off / patch.load),
               on = load_on(patch.capillary_on / patch.load, patch.pull / patch.load);
  patch.capillary_off *= std::pow(sampled_part(off, sampled_off), capillary_off);
  patch.capillary_on *= std::pow(sampled_part(on, sampled_on), capillary_on);
  patch.pull *= std::pow(sampled_part(on, sampled_on), pull);
  patch.retention *= retention_off;
  patch.retention_on *= retention_on;
}

AttractionLaw AttractionLaw::toward(const AttractionLaw& other, double share) const {
  AttractionLaw out = *this;
  for (double AttractionLaw::*number :
       {&AttractionLaw::capillary_off, &AttractionLaw::capillary_on, &AttractionLaw::pull,
        &AttractionLaw::sampled_off, &AttractionLaw::sampled_on, &AttractionLaw::retention_off,
        &AttractionLaw::retention_on})
    out.*number += share * (other.*number - out.*number);
  return out;
}

int sampled_skins(const PatchSetup& setup, const Plan& plan) {
  const bool closes = setup.scene().model.coupling == Coupling::Equilibrium &&
                      !plan.traction_solves && (plan.water || plan.field);
  return closes ? setup.fidelity().equilibrium_skins : 0;
}

AttractionLaw attraction_law(std::span<const AttractionSample> samples) {
  AttractionLaw law;
  for (const AttractionSample& s : samples) {
    const ModelStatus& status = s.settled.status;
    if (status.pull_in() || status.trouble == Trouble::ContactUnsolved) law.status.note(status);
  }
  const auto sum = [&](PatchResult AttractionSample::*state, double PatchResult::*value) {
    return sum_of(samples, state, value);
  };
  const auto dry = &AttractionSample::dry, settled = &AttractionSample::settled;
  const double load = sum(dry, &PatchResult::load);
  if (!(load > 0) || !law.status.sound()) return law;
  law.sampled_off = 1 + sum(settled, &PatchResult::capillary_off) / load;
  law.sampled_on =
      1 + (sum(settled, &PatchResult::capillary_on) + sum(settled, &PatchResult::pull)) / load;
  const auto grows = [&](double PatchResult::*force, double by, double unknown) {
    return exponent(sum(dry, force), sum(settled, force), by,
                    unknown / static_cast<double>(samples.size()));
  };
  law.capillary_off = grows(&PatchResult::capillary_off, law.sampled_off, kUnknownOfWater);
  law.capillary_on = grows(&PatchResult::capillary_on, law.sampled_on, kUnknownOfWater);
  law.pull = grows(&PatchResult::pull, law.sampled_on, kUnknownOfField);
  const auto factor = [&](double PatchResult::*value) {
    const double before = sum(dry, value);
    return before > 0 ? sum(settled, value) / before : 1;
  };
  law.retention_off = factor(&PatchResult::retention);
  law.retention_on = factor(&PatchResult::retention_on);
  return law;
}

SolvedPatch over_members(std::span<const WaterMember> members, const Plan& plan,
                         const Fidelity& fidelity, PatchStates* start,
                         const std::function<PatchProblem(const WaterMember&)>& problem,
                         const std::function<DrivenPatch(const PatchProblem&)>& drive) {
  SolvedPatch out;
  std::vector<PatchResult> of_water;
  for (const WaterMember& member : members) {
    const PatchProblem of_member = problem(member);
    const DrivenPatch driven = drive(of_member);
    of_water.push_back(driven.result);
    if (start && of_water.size() == 1 && driven.before && !driven.before->dry.gap.empty()) {
      out.sample = AttractionSample{
          driven.result, settled_patch(of_member, plan, fidelity, *driven.before, *start)};
    }
  }
  out.result = over_water(of_water);
  if (out.sample) out.result.costs += out.sample->settled.costs;
  return out;
}

LoadLaws load_laws(const ScaleBridge& bridge, std::span<const std::vector<SolvedPatch>> skins) {
  LoadLaws laws;
  for (std::size_t q = 0; q < bridge.pressures().size(); ++q) {
    std::vector<AttractionSample> samples;
    for (const std::vector<SolvedPatch>& skin : skins) {
      if (skin[q].sample) samples.push_back(*skin[q].sample);
    }
    laws.push_back(attraction_law(samples));
  }
  return laws;
}

std::size_t samples_among(std::span<const std::vector<SolvedPatch>> skins) {
  return static_cast<std::size_t>(std::count_if(skins.begin(), skins.end(), is_sample));
}

std::vector<std::vector<PatchResult>> without_each(
    const ScaleBridge& bridge, std::span<const std::vector<SolvedPatch>> skins) {
  const std::size_t samples = samples_among(skins);
  if (samples < 2) return {};
  const LoadLaws laws = load_laws(bridge, skins);
  // Without one of m samples the law of m has the variance (m - 1)/m of the squares; the squares of
  // n skins count (n - 1)/n of theirs.
  const auto m = static_cast<double>(samples), n = static_cast<double>(skins.size());
  const double share = std::sqrt((m - 1) / m * n / (n - 1));
  std::vector<std::vector<PatchResult>> out;
  for (std::size_t k = 0; k < skins.size(); ++k) {
    std::vector<std::vector<SolvedPatch>> others(skins.begin(), skins.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    LoadLaws there = laws;
    if (is_sample(skins[k])) {
      there = load_laws(bridge, others);
      for (std::size_t q = 0; q < laws.size(); ++q) there[q] = laws[q].toward(there[q], share);
    }
    out.push_back(combined(bridge, there, others));
  }
  return out;
}

std::vector<PatchResult> combined(const ScaleBridge& bridge, const LoadLaws& laws,
                                  std::span<const std::vector<SolvedPatch>> skins) {
  std::vector<PatchResult> out, patches;
  for (const std::vector<SolvedPatch>& skin : skins) {
    patches.clear();
    for (std::size_t q = 0; q < skin.size(); ++q) {
      patches.push_back(skin[q].result);
      if (!laws.empty()) laws[q].apply(patches.back());
    }
    out.push_back(bridge.combine(patches));
  }
  return out;
}

}  // namespace papilla::forward
