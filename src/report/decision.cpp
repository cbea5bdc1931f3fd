#include "report/decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "metrics/metric.h"
#include "metrics/shown.h"
#include "numerics/statistics.h"
#include "report/grounds.h"
#include "report/json.h"
#include "report/recommendation.h"
#include "report/run_numbers.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const Decision& decision_of(const ResultFiles& f) { return f.result.decision; }

std::string percent(double share) {
  // 100 % is said of what all members say.
  if (share > 0.99 && share < 1 - 1e-9) return "over 99 %";
  if (share > 1e-9 && share < 0.01) return "under 1 %";
  return fmt::format("{:.0f} %", 100 * share);
}

constexpr const char* kOfBelief = "what belief leaves open, itself";
const std::vector<Stage> kOfDecision{Stage::Confirm, Stage::Belief};

std::string percent_stated(const std::string& words, double share) {
  return stated(bare_number(words, 100 * share, "%", kOfBelief, kOfDecision), percent(share));
}

std::string name_of(const ResultFiles& f, std::size_t design) {
  return design_name(f.result.finalists[design].folder);
}

// What designs are compared in: "the worst modulation".
std::string worth_name(const ResultFiles& f) {
  const PickRule& rule = decision_of(f).rule;
  if (rule.kind == PickRule::Kind::Worst) return "the worst modulation";
  if (rule.kind == PickRule::Kind::Objective) return f.problem.objectives()[rule.index].name;
  return "the sum of the objectives in units of their ranges over the front";
}

// What the knee divides each objective by: " (ranges: mean(friction) 3.1 mN, mean(adhesion) 3 mN)".
std::string ranges_text(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (d.rule.kind != PickRule::Kind::Knee) return {};
  std::string out;
  for (std::size_t k = 0; k < d.ranges.size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const ShownUnit shown = shown_unit(o.expression);
    const double width = d.ranges[k].width * shown.scale;
    out += fmt::format(
        "{}{} {}", out.empty() ? " (ranges, on average over the members: " : ", ", o.name,
        stated(bare_number("range of " + o.name + " over the front", width, shown.unit, kOfBelief,
                           kOfDecision),
               fmt::format("{:.2g}{}{}", width, shown.unit.empty() ? "" : " ", shown.unit)));
  }
  return out + ")";
}

// Of one design there is nothing to choose: what is said of the best of several says nothing.
bool has_choice(const Decision& d) { return d.designs.size() > 1; }

// A value of it in its unit. more: what stands behind that.
std::string in_worth(const ResultFiles& f, const std::string& words, double value,
                     const std::string& more) {
  const ShownUnit shown = unit_of_worth(f.problem, decision_of(f).rule);
  return stated(
      bare_number(words, value * shown.scale, shown.unit, kOfBelief, kOfDecision),
      significant(value * shown.scale, 2) + (shown.unit.empty() ? "" : " " + shown.unit) + more);
}

// Whether differences are said in per cent too.
bool has_shares(const Decision& d) {
  return d.rule.kind != PickRule::Kind::Knee && d.best_worth != 0;
}

// A difference in it: "0.004 (0.8 %)", "1.2 mN (3 %)".
std::string worth_text(const ResultFiles& f, const std::string& words, double difference) {
  const Decision& d = decision_of(f);
  return in_worth(f, words, difference,
                  has_shares(d)
                      ? fmt::format(" ({:.2g} %)", 100 * difference / std::abs(d.best_worth))
                      : std::string());
}

// "0.009 less than the best design of each member, which has 0.16 (5.7 %: the expected regret)"
std::string behind_text(const ResultFiles& f, std::size_t design) {
  const Decision& d = decision_of(f);
  // Worths rise with what is wished for: of less they are the negative values.
  const bool less =
      d.rule.kind == PickRule::Kind::Objective && !f.problem.objectives()[d.rule.index].maximise;
  const double regret = d.designs[design].regret;
  const std::string by =
      in_worth(f, "expected regret of " + name_of(f, design), regret, "") +
      fmt::format(" {} than the best design of each member", less ? "more" : "less");
  if (!has_shares(d)) return by + " (the expected regret)";
  return fmt::format("{}, which has {} ({:.2g} %: the expected regret)", by,
                     in_worth(f, "what the best of each member has on average",
                              less ? -d.best_worth : d.best_worth, ""),
                     100 * regret / std::abs(d.best_worth));
}

std::string regret_text(const ResultFiles& f, std::size_t design) {
  return worth_text(f, "expected regret of " + name_of(f, design),
                    decision_of(f).designs[design].regret);
}

std::string p_best_text(const ResultFiles& f, std::size_t design) {
  return percent_stated("probability that " + name_of(f, design) + " is the best",
                        decision_of(f).designs[design].p_best);
}

std::string p_limits_text(const ResultFiles& f, std::size_t design) {
  return percent_stated("probability that " + name_of(f, design) + " keeps every limit",
                        decision_of(f).designs[design].p_limits);
}

std::string wanted_text(const ResultFiles& f) {
  return percent_stated("probability that the study wants (risk.limits)", f.study.risk.limits);
}

std::string members_text(const ResultFiles& f) {
  const std::size_t members = decision_of(f).members;
  return stated(count_number("members of belief", members, {}), fmt::format("{}", members));
}

std::string hypothesis_share(const Reversal& r) {
  return percent_stated("weight of hypothesis \"" + r.name + "\"", r.weight);
}

// "if the choice of the model "emission" holds (9 % of belief), design 02 is better by 0.01 (2 %)"
std::string reversal_text(const ResultFiles& f, const std::string& where, const Reversal& r) {
  const Decision& d = decision_of(f);
  if (r.loss > 0)
    return fmt::format(
        "{}, {} is better by {}", where, name_of(f, r.best),
        worth_text(f, "what " + name_of(f, r.best) + " is better by " + where, r.loss));
  return fmt::format("{}, {} is recommended, as it keeps the limits more surely (over all {})",
                     where, name_of(f, r.best), p_limits_text(f, d.best));
}

// "if finger.skin.rms is below 207 nm"
std::string parameter_text(const ResultFiles& f, const char* word) {
  const HalvesReversal& p = *decision_of(f).parameter;
  Finger finger = f.problem.tasks().front().finger;
  const std::vector<NumberField> known = number_fields(finger);
  const NumberField field = find_number_field(known, p.path);
  const double edge = p.edge / find_unit(field.unit)->to_si;
  return fmt::format("if finger.{} is {} {}", p.path, word,
                     stated(bare_number("middle of belief in finger." + p.path, edge, field.unit,
                                        kOfBelief, kOfDecision),
                            in_unit(p.edge, field.unit, 3)));
}

// Below this share of what the best is worth (of the knee: of an objective's range over the front)
// two designs are alike: nobody would build the other for it.
constexpr double kAlike = 0.01;
constexpr double kSure = 0.95;  // p(best) that asks for no measurement

bool matters(const Decision& d, double loss) {
  return loss >= kAlike * (d.rule.kind == PickRule::Kind::Knee ? 1 : std::abs(d.best_worth));
}

bool overturns(const Decision& d, const Reversal& r) {
  if (r.best == d.best) return false;
  return r.loss <= 0 || matters(d, r.loss);  // no loss: chosen for its limits
}

// Each hypothesis and the parameter that another design is better under.
std::vector<std::string> overturned(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  std::vector<std::string> out;
  for (const Reversal& r : d.hypotheses) {
    if (overturns(d, r))
      out.push_back(
          reversal_text(f,
                        fmt::format("if the choice of the model \"{}\" holds ({} of belief)",
                                    r.name, hypothesis_share(r)),
                        r));
  }
  if (!d.parameter) return out;
  for (const auto& [half, word] :
       {std::pair(&d.parameter->low, "below"), std::pair(&d.parameter->high, "above")}) {
    if (overturns(d, *half)) out.push_back(reversal_text(f, parameter_text(f, word), *half));
  }
  return out;
}

// ", by 0.0002 (0.1 %) beside design 06"
std::string by_loss(const ResultFiles& f, const Reversal& r) {
  const Decision& d = decision_of(f);
  if (r.best == d.best || !(r.loss > 0)) return {};
  return fmt::format(
      ", by {} beside {}",
      worth_text(f, "what " + name_of(f, r.best) + " is better by under \"" + r.name + "\"",
                 r.loss),
      name_of(f, d.best));
}

std::string overturned_text(const ResultFiles& f) {
  const std::vector<std::string> found = overturned(f);
  if (found.empty())
    return fmt::format(
        "nothing that was tried: under no choice of the model that belief weighs and with no "
        "number of the finger in the upper or lower half of what is believed of it is another "
        "design better by {:.0f} % or more",
        100 * kAlike);
  return fmt::format(
      "{}; no other choice of the model that belief weighs and no number of the finger that was "
      "tried makes another design better by {:.0f} % or more",
      join_names(found, "; "), 100 * kAlike);
}

// How surely the limits hold: "" where the study has none.
std::string limits_sentence(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  const double wanted = f.study.risk.limits;
  if (f.study.constraints.empty()) return {};
  const std::string has = p_limits_text(f, d.best);
  const std::string made =
      YieldModel::exists(f.study)
          ? ""
          : ", if it is made exactly so (tolerances in a section [scatter] of the study add what "
            "making scatters)";
  const std::string name = name_of(f, d.best);
  const auto surest =
      static_cast<std::size_t>(std::find_if(d.designs.begin(), d.designs.end(),
                                            [](const Prospect& p) { return p.less_sure == 0; }) -
                               d.designs.begin());
  if (d.sure(wanted))
    return fmt::format(" With probability {} {} keeps every limit{}.", has, name, made);
  return fmt::format(
      " With probability {} {} keeps every limit, {}, where the study wants {} (risk.limits): "
      "loosen a limit or leave more room to it{}.",
      has, name,
      d.designs[d.best].less_sure > 0
          ? fmt::format("{} with {}, too little more for the members to tell", name_of(f, surest),
                        p_limits_text(f, surest))
          : std::string("the highest of the front"),
      wanted_text(f), made);
}

// Of the members that tell no design from another, as none of them has a number there: " At 16 of
// these members (51 % of belief) ...".
std::string unanswered_sentence(const ResultFiles& f) {
  const MemberWorth& worth = decision_of(f).worth;
  std::size_t unanswered = 0;
  for (std::size_t m = 0; m < worth.weights.size(); ++m) unanswered += worth.known(m) ? 0 : 1;
  if (unanswered == 0) return {};
  return fmt::format(
      " At {} of these members ({} of belief) {}a limit that needs an answer is not kept there.",
      stated(count_number("members of belief without an answer", unanswered, kOfDecision),
             fmt::format("{}", unanswered)),
      percent_stated("share of belief without an answer", 1 - search::known_share(worth)),
      has_choice(decision_of(f)) ? "no design of the front has an answer: probabilities of being "
                                   "the best and regrets are over the others, and "
                                 : "it has no answer: ");
}

// Of finalists that keep every limit and are behind the front by their confirmed numbers alone.
std::string unjudged_sentence(const ResultFiles& f) {
  std::string out;
  for (const FinalDesign& design : f.result.finalists) {
    if (design.on_front || design.unjudged.empty()) continue;
    out += fmt::format(
        " Whether a member of belief prefers the finalist with {} to all of the front is not "
        "known: "
        "it has no answer at the members ({}).",
        shape_text(design.design), design.unjudged);
  }
  return out;
}

// The design whose measurement beside that of the chosen one settles most: what is better where
// belief may be true (its share times what is lost there), else the next most probable best.
std::size_t rival_of(const Decision& d) {
  std::vector<Reversal> all = d.hypotheses;
  if (d.parameter) all.insert(all.end(), {d.parameter->low, d.parameter->high});
  const Reversal* most = nullptr;
  for (const Reversal& r : all) {
    if (overturns(d, r) && (!most || r.known * r.loss > most->known * most->loss)) most = &r;
  }
  if (most) return most->best;
  std::size_t out = d.best == 0 ? 1 : 0;
  for (std::size_t i = 0; i < d.designs.size(); ++i) {
    if (i != d.best && d.designs[i].p_best > d.designs[out].p_best) out = i;
  }
  return out;
}

// Its texture, and what else the variables say of its surface.
std::string rival_text(const ResultFiles& f, const FinalDesign& rival) {
  const std::string surface = surface_text(f, "the design to measure", rival.unit);
  return shape_text(rival.design) + (surface.empty() ? "" : "; " + surface);
}

std::string measure_sentence(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (!design_to_measure(f)) return {};
  return fmt::format(
      "To be surer, measure the friction of {} and of {} ({}){}, at the humidities and the load of "
      "this study, and build the one that is better in {}. `papilla next RESULTS` with the folder "
      "of this run plans what to measure, and `papilla tell` says what the measurements change.",
      name_of(f, d.best), name_of(f, rival_of(d)), rival_text(f, f.result.finalists[rival_of(d)]),
      f.problem.driven() ? " with the drive off and on" : "", worth_name(f));
}

// " (0.292 there, where design 06 has 0.272)": the worst modulations that the fit compares.
std::string at_the_fit(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (d.rule.kind != PickRule::Kind::Worst) return {};
  const auto worst = [&](std::size_t design) {
    return worst_text(name_of(f, design), f.result.finalists[design].confirmed.worst);
  };
  return fmt::format(" ({} there, where {} has {})", worst(d.nominal), name_of(f, d.best),
                     worst(d.best));
}

// The choice by the numbers of the fit, and what is the best more often and loses more where it is
// not: one design in most cases.
std::string others_sentence(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  const auto oftener =
      std::max_element(d.designs.begin(), d.designs.end(),
                       [](const Prospect& a, const Prospect& b) { return a.p_best < b.p_best; });
  const auto often = static_cast<std::size_t>(oftener - d.designs.begin());
  const bool any = often != d.best && oftener->p_best > d.designs[d.best].p_best;
  const auto more_often = [&] {
    return fmt::format("the best more often (probability {})", p_best_text(f, often));
  };
  std::string out;
  if (d.nominal != d.best)
    out += fmt::format(
        " By the finger and the model as fitted alone, {}{} would be chosen{}; over the members it "
        "stays {} behind the best on average.",
        name_of(f, d.nominal), any && often == d.nominal ? ", " + more_often() + "," : "",
        at_the_fit(f), regret_text(f, d.nominal));
  if (any && often != d.nominal)
    out += fmt::format(" Not chosen, but {}, is {}, with an expected regret of {}.", more_often(),
                       name_of(f, often), regret_text(f, often));
  return out;
}

std::string chosen_how(const ResultFiles& f) {
  return (f.problem.belief_risk().regret
              ? "the least expected regret"
              : fmt::format("the best by risk.belief = \"{}\"", f.study.risk.belief)) +
         of_the_sure_text(f);
}

// What of belief has an answer for a design: its worths there, their weights.
struct KnownWorths {
  std::vector<double> worths, weights;
  double all = 0;  // of the weights
};

KnownWorths known_worths(const MemberWorth& worth, std::size_t design) {
  KnownWorths out;
  for (std::size_t m = 0; m < worth.weights.size(); ++m) {
    if (std::isnan(worth.worth[design][m])) continue;
    out.worths.push_back(worth.worth[design][m]);
    out.weights.push_back(worth.weights[m]);
    out.all += worth.weights[m];
  }
  return out;
}

// By members of belief alone, as what skins leave open is a part of ±.
bool has_worst_over_belief(const ResultFiles& f, std::size_t design) {
  const Decision& d = decision_of(f);
  return d.made() && d.rule.kind == PickRule::Kind::Worst && f.problem.judged_at_amplitude() &&
         design < d.designs.size() && known_worths(d.worth, design).all > 0;
}

// How probable it is that people notice the worst modulation. Eq. search.26
std::string felt_sentence(const ResultFiles& f, std::size_t shown) {
  if (!has_worst_over_belief(f, shown)) return {};
  const KnownWorths known = known_worths(decision_of(f).worth, shown);
  double felt = 0;
  for (std::size_t m = 0; m < known.worths.size(); ++m)
    felt += known.worths[m] >= kNoticed ? known.weights[m] : 0;
  return fmt::format(
      " People notice a worst modulation of {} and more (Fehlberg 2022): with probability {} it is "
      "felt by every finger of the study at every humidity.",
      noticed_text(),
      percent_stated("probability that the worst modulation of what is "
                     "recommended is noticed",
                     felt / known.all));
}

// Whether single skins are known behind a number of the front's confirmed answers. of: its samples.
bool has_skins(const ResultFiles& f, const std::function<bool(const TaskAnswer&)>& of) {
  return std::any_of(
      f.result.finalists.begin(), f.result.finalists.end(), [&](const FinalDesign& design) {
        return design.on_front && std::any_of(design.answers.begin(), design.answers.end(), of);
      });
}

bool has_skins(const ResultFiles& f, std::size_t objective) {
  return has_skins(f, [objective](const TaskAnswer& a) {
    return objective < a.samples.size() &&
           std::any_of(a.samples[objective].begin(), a.samples[objective].end(),
                       [](const ErrorSamples& number) { return !number.sampling.empty(); });
  });
}

// Objectives that differ from skin to skin, and of which no single skins are known: a share of
// people, the distance to pull-in. What skins leave open of them is in no probability.
std::vector<std::string> objectives_without_skins(const ResultFiles& f) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < f.problem.objectives().size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    if (!info_of(o.expression.metric).appearance && !has_skins(f, k)) out.push_back(o.name);
  }
  return out;
}

// Whether what designs are compared in is over skins: " and over skins, without errors of".
std::string skins_text(const ResultFiles& f) {
  const PickRule& rule = decision_of(f).rule;
  std::vector<std::string> without = objectives_without_skins(f);
  std::size_t compared = f.problem.objectives().size();
  if (rule.kind == PickRule::Kind::Worst) {
    without.clear();
    if (!has_skins(f, [](const TaskAnswer& a) { return !a.worst_samples.sampling.empty(); }))
      without.push_back(worth_name(f));
    compared = 1;
  } else if (rule.kind == PickRule::Kind::Objective) {
    const std::string& name = f.problem.objectives()[rule.index].name;
    const bool none = std::find(without.begin(), without.end(), name) != without.end();
    without.assign(none ? 1 : 0, name);
    compared = 1;
  }
  if (without.empty()) return " and over skins, without errors of";
  const std::string of =
      join_names(without) + ", of which single skins are not known, and without errors of";
  return (without.size() < compared ? " and over skins, without what these leave open of "
                                    : ", without what skins leave open of ") +
         of;
}

// The same of the probabilities of each objective; "" where all are over skins.
std::string without_skins_sentence(const ResultFiles& f) {
  const std::vector<std::string> without = objectives_without_skins(f);
  if (without.empty()) return {};
  return fmt::format(
      " Probabilities in {} are over the members alone: what skins leave open is not in them.",
      join_names(without));
}

// Why a surface without texture is recommended where belief prefers another design: "" of a design
// that was picked.
std::string beside_belief_sentence(const ResultFiles& f, std::size_t shown) {
  if (shown == f.result.best) return {};
  // The best may itself be a surface without texture: what it changes is the finish.
  const bool textured = facts(f.result.finalists[f.result.best].design.texture).relief.present;
  return fmt::format(
      " The recommendation follows the objectives, in which the {} of {} gains no more than the "
      "error of the difference; belief is judged in {}.",
      textured ? "texture" : "finish", name_of(f, f.result.best), worth_name(f));
}

// How much of the doubt more skins would take away, and what only measurements can.
std::string settled_sentence(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  constexpr double kFew = 0.02;  // of p(best), by draws
  if (d.settled.p_best < d.designs[d.best].p_best + kFew) return {};
  return fmt::format(
      " Skins without end would make that {} and {} on average: what is missing then, only "
      "measurements tell.",
      percent_stated("probability of being the best with skins without end", d.settled.p_best),
      worth_text(f, "expected regret with skins without end", d.settled.regret));
}

}  // namespace

std::string worst_over_belief(const ResultFiles& f) {
  if (!has_worst_over_belief(f, f.result.best)) return {};
  constexpr double kShare = 0.95;
  const KnownWorths known = known_worths(decision_of(f).worth, f.result.best);
  double mean = 0;
  for (std::size_t m = 0; m < known.worths.size(); ++m)
    mean += known.worths[m] * known.weights[m] / known.all;
  const auto said = [](const char* which, double worst) {
    return stated(
        bare_number(fmt::format("{} worst modulation of what is recommended over belief", which),
                    worst, "", kOfBelief, kOfDecision),
        fmt::format("{:.3f}", worst));
  };
  const auto at = [&](double p) { return weighted_quantile(known.worths, known.weights, p); };
  return fmt::format("{} on average over belief ({} to {} on {:.0f} % of it)", said("mean", mean),
                     said("low", at(0.5 - 0.5 * kShare)), said("high", at(0.5 + 0.5 * kShare)),
                     100 * kShare);
}

std::optional<std::size_t> design_to_measure(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (!d.made() || !has_choice(d)) return std::nullopt;
  const Prospect& chosen = d.designs[d.best];
  if (chosen.p_best > kSure || !matters(d, chosen.regret)) return std::nullopt;
  return rival_of(d);
}

std::string of_the_sure_text(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  const double wanted = f.study.risk.limits;
  std::size_t unsure = 0;
  for (std::size_t i = 0; i < d.designs.size(); ++i) unsure += d.keeps_limits(i, wanted) ? 0 : 1;
  if (unsure == 0) return {};
  if (!d.sure(wanted))
    return " of those that keep every limit the most surely, as far as the members tell";
  return " of those that keep every limit with probability " + wanted_text(f) + " or more";
}

std::string unsure_limits_text(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  const std::size_t shown = f.result.best;
  if (!d.made() || f.study.constraints.empty() || d.keeps_limits(shown, f.study.risk.limits))
    return {};
  return fmt::format(
      " By what is believed of finger and model it keeps every limit with probability {} only; the "
      "study wants {} (risk.limits).",
      p_limits_text(f, shown), wanted_text(f));
}

std::vector<std::string> decision_grounds(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (!d.made()) return {};
  const auto place = recommended_place(f);
  if (!place || *place >= d.designs.size())
    return {
        "How sure that is was not judged: only designs of the front are judged at the members of "
        "belief, and the surface is none of them."};
  const std::size_t shown = *place;
  if (!has_choice(d))
    return {
        fmt::format("How sure: {} is the one design on the front, so there is nothing to choose by "
                    "belief. It was judged at {} members of it.",
                    name_of(f, shown), members_text(f)) +
        unanswered_sentence(f) + felt_sentence(f, shown) + limits_sentence(f)};
  const bool textured = facts(f.result.finalists[shown].design.texture).relief.present;
  std::string sure = fmt::format(
      "How sure: of the {} designs of the front {}{} is the best in {} with probability {}, by "
      "this model, over the {} members of belief (finger and model as the measurements leave them "
      "open){} the grid and of what all designs share of the 3-D field. On average over the "
      "members it has {}",
      stated(count_number("designs of the front", d.designs.size(), {Stage::Confirm}),
             fmt::format("{}", d.designs.size())),
      name_of(f, shown), textured ? "" : ", the surface that is recommended,", worth_name(f),
      p_best_text(f, shown), members_text(f), skins_text(f), behind_text(f, shown));
  const std::string unanswered = unanswered_sentence(f);
  if (shown != d.best)
    return {sure + fmt::format("; {} has {}.", name_of(f, d.best), chosen_how(f)) +
            beside_belief_sentence(f, shown) + unanswered};
  std::vector<std::string> out{sure + "." + unanswered + felt_sentence(f, shown) +
                               settled_sentence(f) + others_sentence(f) + limits_sentence(f)};
  out.push_back("What would overturn it: " + overturned_text(f) + ".");
  if (std::string measure = measure_sentence(f); !measure.empty()) out.push_back(measure);
  return out;
}

std::string decision_text(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (!f.result.has_best() || (!d.made() && d.absent.empty())) return {};
  std::string out = "\n## Which of them, by belief\n\n";
  if (!d.made()) return out + fmt::format("By the numbers of the fit alone: {}.\n", d.absent);
  const bool choice = has_choice(d);
  const std::string at = fmt::format(
      "at {} members of belief about finger and model (as good as {} equal ones)", members_text(f),
      stated(bare_number("effective members of belief", d.effective_members, "", kOfBelief, {}),
             fmt::format("{:.3g}", d.effective_members)));
  if (choice)
    out += fmt::format(
        "Each design of the front {}, judged in {}{}. Regret: what is lost on average against the "
        "best design at each member. {} has {}.",
        at, worth_name(f), ranges_text(f), f.result.finalists[d.best].folder, chosen_how(f));
  else
    out += fmt::format(
        "{} is the one design on the front, so there is nothing to choose. It was judged {}.",
        f.result.finalists[d.best].folder, at);
  out += unanswered_sentence(f) + unjudged_sentence(f) +
         (choice ? without_skins_sentence(f) : std::string()) + "\n";
  const bool limited = !f.study.constraints.empty();
  std::vector<std::string> head{"design"};
  if (choice) {
    head.insert(head.end(), {"p(best)", "expected regret"});
    for (const StudyObjective& o : f.problem.objectives()) head.push_back("p(best) in " + o.name);
  }
  if (limited) head.push_back("p(every limit)");
  for (const Constraint& c : f.study.constraints) head.push_back("p(" + limit_name(c.on) + ")");
  if (choice || limited) out += "\n" + markdown_head(head);
  for (std::size_t i = 0; i < d.designs.size() && (choice || limited); ++i) {
    const Prospect& p = d.designs[i];
    std::vector<std::string> row{f.result.finalists[i].folder};
    if (choice) row.insert(row.end(), {p_best_text(f, i), regret_text(f, i)});
    for (std::size_t k = 0; k < d.p_best_by.size() && choice; ++k)
      row.push_back(percent_stated(
          "probability that " + name_of(f, i) + " is the best in " + f.problem.objectives()[k].name,
          d.p_best_by[k][i]));
    if (limited) row.push_back(p_limits_text(f, i));
    for (std::size_t k = 0; k < p.p_limit.size(); ++k)
      row.push_back(percent_stated(
          "probability that " + name_of(f, i) + " keeps " + limit_name(f.study.constraints[k].on),
          p.p_limit[k]));
    out += markdown_row(row);
  }
  if (!choice) return out;
  for (const Reversal& r : d.hypotheses)
    out +=
        fmt::format("\n- Under hypothesis \"{}\" ({} of belief) {}.", r.name, hypothesis_share(r),
                    r.known > 0 ? name_of(f, r.best) + " has " + chosen_how(f) + by_loss(f, r)
                                : std::string("no design of the front has an answer"));
  return out + fmt::format("\n\nWhat would overturn the choice of {}: {}.\n",
                           f.result.finalists[d.best].folder, overturned_text(f));
}

Json prospect_json(const ResultFiles& f, std::size_t finalist) {
  const Decision& d = decision_of(f);
  if (!d.made() || finalist >= d.designs.size()) return nullptr;
  const Prospect& p = d.designs[finalist];
  Json by = Json::object(), limits = Json::object();
  for (std::size_t k = 0; k < d.p_best_by.size(); ++k)
    by[f.problem.objectives()[k].name] = json_number(d.p_best_by[k][finalist]);
  for (std::size_t k = 0; k < p.p_limit.size(); ++k)
    limits[limit_name(f.study.constraints[k].on)] = json_number(p.p_limit[k]);
  return {{"p_best", json_number(p.p_best)},
          {"regret", json_number(p.regret)},
          {"p_best_by", std::move(by)},
          {"p_every_limit", json_number(p.p_limits)},
          {"p_limits", std::move(limits)}};
}

Json decision_json(const ResultFiles& f) {
  const Decision& d = decision_of(f);
  if (!d.made()) return {{"absent", d.absent}};
  const auto folder = [&](std::size_t i) { return f.result.finalists[i].folder; };
  Json hypotheses = Json::array(), designs = Json::object(), ranges = Json::object();
  for (std::size_t k = 0; k < d.ranges.size(); ++k)
    ranges[f.problem.objectives()[k].name] = json_number(d.ranges[k].width);
  const auto reversal = [&](const Reversal& r) {
    return Json{{"name", r.name},
                {"weight", json_number(r.weight)},
                {"best", folder(r.best)},
                {"loss", json_number(r.loss)}};
  };
  for (const Reversal& r : d.hypotheses) hypotheses.push_back(reversal(r));
  for (std::size_t i = 0; i < d.designs.size(); ++i) {
    designs[folder(i)] = prospect_json(f, i);
    Json worth = Json::array(), kept = Json::array();
    for (std::size_t m = 0; m < d.worth.weights.size(); ++m) {
      worth.push_back(json_number(d.worth.worth[i][m]));
      kept.push_back(d.worth.keeps(i, m));
    }
    designs[folder(i)]["worth_at_members"] = std::move(worth);
    designs[folder(i)]["worth_moved_by_skins"] = d.worth.mean_moves(i);
    designs[folder(i)]["limits_kept_at_members"] = std::move(kept);
  }
  Json out{{"absent", ""},
           {"by", f.study.risk.belief},
           {"worth", worth_name(f)},
           {"ranges", std::move(ranges)},
           {"members", d.members},
           {"effective_members", json_number(d.effective_members)},
           {"best", folder(d.best)},
           {"best_worth", json_number(d.best_worth)},
           {"with_endless_skins",
            {{"p_best", json_number(d.settled.p_best)}, {"regret", json_number(d.settled.regret)}}},
           {"by_the_fit_alone", folder(d.nominal)},
           {"keeps_limits_as_wanted", d.sure(f.study.risk.limits)},
           {"designs", std::move(designs)},
           {"hypotheses", std::move(hypotheses)},
           {"parameter", nullptr},
           {"overturned", overturned(f)}};
  if (const double known = search::known_share(d.worth); known < 1)
    out["belief_without_answer"] = json_number(1 - known);  // p_best and regret are over the rest
  if (d.parameter)
    out["parameter"] = {{"path", d.parameter->path},
                        {"edge", json_number(d.parameter->edge)},
                        {"low", reversal(d.parameter->low)},
                        {"high", reversal(d.parameter->high)}};
  return out;
}

}  // namespace papilla::report
