#include "forward/load_law.h"

#include <algorithm>
#include <cmath>

namespace papilla::forward {
namespace {

// The exponent of a force that is `before` on the dry gap and `after` under `load` times the
// nominal one. 0 where it is none or changes its sign: the force then stays what it is.
double exponent(double before, double after, double load) {
  constexpr double kLargest = 4, kSame = 1e-9;
  if (!(before * after > 0) || !(load > 0) || std::abs(load - 1) < kSame) return 0;
  return std::clamp(std::log(after / before) / std::log(load), -kLargest, kLargest);
}

double sum_of(std::span<const AttractionSample> samples, PatchResult AttractionSample::*state,
              double PatchResult::*value) {
  double sum = 0;
  for (const AttractionSample& s : samples) sum += s.*state.*value;
  return sum;
}

// The lowest root of load = total(load), from 1 upwards; total rises.
template <class Total>
std::optional<double> settled_load(const Total& total) {
  constexpr double kClosed = 1e3, kLeast = 1e-3, kExact = 1e-12;
  constexpr int kMost = 1000;
  double load = 1;
  for (int k = 0; k < kMost && load < kClosed; ++k) {
    const double next = std::max(total(load), kLeast);
    if (std::abs(next - load) <= kExact * next) return next;
    load = next;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> AttractionLaw::load_off(double capillary) const {
  return settled_load([&](double load) { return 1 + capillary * std::pow(load, capillary_off); });
}

std::optional<double> AttractionLaw::load_on(double capillary, double of_field) const {
  return settled_load([&](double load) {
    return 1 + capillary * std::pow(load, capillary_on) + of_field * std::pow(load, pull);
  });
}

void AttractionLaw::apply(PatchResult& patch) const {
  patch.status.note(status);
  if (!(patch.load > 0)) return;
  const double water = patch.capillary_off / patch.load;
  const std::optional<double> off = load_off(water), on = load_on(patch.capillary_on / patch.load,
                                                                  patch.pull / patch.load);
  if (!off) patch.status.note({Trouble::UndrivenPullIn, 0, ""});
  if (!on) patch.status.note({Trouble::ClosedPullIn, 0, ""});
  patch.capillary_off *= std::pow(off.value_or(1 + water), capillary_off);
  patch.capillary_on *= std::pow(on.value_or(1), capillary_on);
  patch.pull *= std::pow(on.value_or(1), pull);
  patch.retention *= retention_off;
  patch.retention_on *= retention_on;
}

AttractionLaw AttractionLaw::toward(const AttractionLaw& other, double share) const {
  AttractionLaw out = *this;
  for (double AttractionLaw::*number :
       {&AttractionLaw::capillary_off, &AttractionLaw::capillary_on, &AttractionLaw::pull,
        &AttractionLaw::retention_off, &AttractionLaw::retention_on})
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
  const double off = 1 + sum(settled, &PatchResult::capillary_off) / load;
  const double on =
      1 + (sum(settled, &PatchResult::capillary_on) + sum(settled, &PatchResult::pull)) / load;
  const auto grows = [&](double PatchResult::*force, double by) {
    return exponent(sum(dry, force), sum(settled, force), by);
  };
  law.capillary_off = grows(&PatchResult::capillary_off, off);
  law.capillary_on = grows(&PatchResult::capillary_on, on);
  law.pull = grows(&PatchResult::pull, on);
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

std::vector<std::vector<PatchResult>> without_each(const ScaleBridge& bridge,
                                                   std::span<const std::vector<SolvedPatch>> skins,
                                                   int samples) {
  const LoadLaws laws = load_laws(bridge, skins);
  // Without one of m samples the law of m has the variance (m - 1)/m of the squares; the squares of
  // n skins count (n - 1)/n of theirs.
  const auto m = static_cast<double>(samples), n = static_cast<double>(skins.size());
  const double share = std::sqrt((m - 1) / m * n / (n - 1));
  std::vector<std::vector<PatchResult>> out;
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples); ++k) {
    std::vector<std::vector<SolvedPatch>> others(skins.begin(), skins.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    LoadLaws there = load_laws(bridge, others);
    for (std::size_t q = 0; q < laws.size(); ++q) there[q] = laws[q].toward(there[q], share);
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
