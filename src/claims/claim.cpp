#include "claims/claim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/check.h"
#include "claims/papers.h"

namespace papilla::claims {

std::string verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Agrees:
      return "agrees";
    case Verdict::Fitted:
      return "fitted";
    case Verdict::Differs:
      return "differs";
    case Verdict::PaperInconsistent:
      return "paper inconsistent";
    case Verdict::NotTestable:
      return "not testable";
  }
  return "";
}

std::string basis_name(Basis basis) {
  switch (basis) {
    case Basis::Finger:
      return "of the finger";
    case Basis::Input:
      return "input";
    case Basis::Identity:
      return "identity";
  }
  return "";
}

Judgement agrees_if(bool agrees, double value, double se, std::string model, std::string reason) {
  return {agrees ? Verdict::Agrees : Verdict::Differs, value, se, std::move(model),
          std::move(reason)};
}

namespace {

Part part(std::string name, const SkinEstimate& e, bool holds,
          const std::function<bool(double)>& on_patch) {
  Part out{std::move(name), e, holds};
  for (const double value : e.single) out.single.push_back(on_patch(value));
  return out;
}

double share_of(const std::vector<bool>& flags) {
  return static_cast<double>(std::count(flags.begin(), flags.end(), true)) /
         static_cast<double>(flags.size());
}

// The share of patches on which every part holds; none unless all parts are of the same patches.
std::optional<double> on_single_patches(const std::vector<Part>& parts) {
  std::vector<bool> all = parts.front().single;
  if (all.empty()) return std::nullopt;
  for (const Part& p : parts) {
    if (p.single.size() != all.size()) return std::nullopt;
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = all[k] && p.single[k];
  }
  return share_of(all);
}

}  // namespace

Part above_zero(std::string name, const SkinEstimate& e) {
  return part(std::move(name), e, positive(e), [](double v) { return v > 0; });
}

Part below_zero(std::string name, const SkinEstimate& e) {
  return part(std::move(name), e, negative(e), [](double v) { return v < 0; });
}

Part in_band(std::string name, const SkinEstimate& e, double low, double high) {
  return part(std::move(name), e, within(e.value, low, high),
              [=](double v) { return within(v, low, high); });
}

Judgement all_of(const std::vector<Part>& parts, const std::string& why_not) {
  std::string list;
  const Part* shown = &parts.front();
  bool all = true, numbers = true;
  for (const Part& p : parts) {
    numbers = numbers && !std::isnan(p.value.value);
    list += fmt::format("{}{} {:.3g} ± {:.2g}{}", list.empty() ? "" : "; ", p.name, p.value.value,
                        p.value.se, p.holds ? "" : " (no)");
    if (!p.single.empty()) list += fmt::format(" [{:.0f} %]", 100 * share_of(p.single));
    if (all && !p.holds) shown = &p;
    all = all && p.holds;
  }
  std::string reason = list;
  if (!all && !why_not.empty()) reason += ". " + why_not;
  Judgement out =
      agrees_if(all, shown->value.value, shown->value.se,
                fmt::format("{:.3g} ± {:.2g}", shown->value.value, shown->value.se), reason);
  out.single = on_single_patches(parts);
  if (!numbers) out.verdict = Verdict::NotTestable;
  return out;
}

Judgement trend(const std::vector<double>& values, bool rises, std::string reason) {
  bool agrees = true;
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) agrees = agrees && (rises ? values[i] > values[i - 1] : values[i] < values[i - 1]);
    text += fmt::format("{}{:.4g}", i ? ", " : "", values[i]);
  }
  return agrees_if(agrees, values.back() / values.front(), 0, text, std::move(reason));
}

namespace {

std::vector<Claim> joined(std::vector<std::vector<Claim>> lists) {
  std::vector<Claim> all;
  for (std::vector<Claim>& list : lists) {
    for (Claim& claim : list) all.push_back(std::move(claim));
  }
  return all;
}

}  // namespace

Claim m3_claim(const char* id, const char* statement, const char* band,
               std::function<Judgement(FingerModel&)> judge) {
  return {id, "M3 model (Ma et al. 2025)", statement, band, true, std::move(judge), Basis::Finger};
}

std::vector<Claim> m3_claims() {
  std::vector<Claim> all = joined({m3_friction_claims(), m3_modulation_claims(), m3_water_claims(),
                                   m3_field_claims(), m3_film_claims()});
  const auto number = [](const Claim& claim) { return std::stoi(claim.id.substr(1)); };
  std::sort(all.begin(), all.end(),
            [&](const Claim& a, const Claim& b) { return number(a) < number(b); });
  return all;
}

std::vector<std::string> m3_claim_ids() {
  std::vector<std::string> out;
  for (const Claim& claim : m3_claims()) out.push_back(claim.id);
  return out;
}

std::vector<Claim> theory_claims() {
  return joined({mean_field_claims(), network_claims(), stiction_claims()});
}

const std::vector<Claim>& claims() {
  static const std::vector<Claim> list = [] {
    const std::vector<Claim> all = joined({m3_claims(), theory_claims()});
    std::set<std::string> ids;
    for (const Claim& claim : all) {
      PAPILLA_CHECK(ids.insert(claim.id).second, "every claim has an id of its own");
    }
    return all;
  }();
  return list;
}

}  // namespace papilla::claims
