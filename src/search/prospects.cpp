#include "search/prospects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "numerics/statistics.h"

namespace papilla::search {
namespace {

// Pairs of draws of the errors, a member: p(best) over the 32 members of the shipped belief to
// .008.
constexpr int kPairs = 64;
// Of all members at once: the same p(best) to .025.
constexpr int kSettledPairs = 200;

double total(const std::vector<double>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

// The best that is to be had at a member: of the designs that keep every limit there, else of all
// that are worth something; NaN where none is.
double best_at(const MemberWorth& d, std::size_t member) {
  double kept = std::nan(""), any = std::nan("");
  for (std::size_t i = 0; i < d.worth.size(); ++i) {
    any = std::fmax(any, d.worth[i][member]);
    if (d.keeps(i, member)) kept = std::fmax(kept, d.worth[i][member]);
  }
  return std::isnan(kept) ? any : kept;
}

// What a design is worth where it has a worth; else the least of the others there, of which one
// has a worth.
double worth_or_least(const MemberWorth& d, std::size_t design, std::size_t member) {
  double out = d.worth[design][member];
  if (!std::isnan(out)) return out;
  for (const std::vector<double>& other : d.worth) out = std::fmin(out, other[member]);
  return out;
}

// Who is the best at a member at which something is known. Eq. search.15
void add_best(const MemberWorth& d, std::size_t member, double weight, std::vector<Prospect>& out) {
  const double best = best_at(d, member);
  const bool any_keeps = [&] {
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (d.keeps(i, member)) return true;
    }
    return false;
  }();
  const auto is_best = [&](std::size_t i) {
    return d.worth[i][member] == best && (!any_keeps || d.keeps(i, member));
  };
  double ties = 0;
  for (std::size_t i = 0; i < out.size(); ++i) ties += is_best(i);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].p_best += is_best(i) ? weight / ties : 0;
}

// The regret of each design there. Eq. search.16
void add_regret(const MemberWorth& d, std::size_t member, double weight,
                std::vector<Prospect>& out) {
  const double best = best_at(d, member);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].regret += weight * std::max(0.0, best - worth_or_least(d, i, member));
}

// Some members of all.
MemberWorth of_members(const MemberWorth& all, const std::vector<std::size_t>& members) {
  MemberWorth out = all;
  const auto picked = [&](auto& of) {
    auto from = of;
    of.clear();
    for (std::size_t m : members) of.push_back(from[m]);
  };
  picked(out.weights);
  if (!out.draw_of.empty()) picked(out.draw_of);
  for (auto& of : out.worth) picked(of);
  for (auto& design : out.kept) {
    for (auto& of : design) picked(of);
  }
  for (auto& of : out.by_skin) picked(of);
  for (auto& of : out.by_error) picked(of);
  return out;
}

// Values without what they move all by alike, so that they sum up to nothing.
std::vector<double> beyond(const std::vector<double>& alike, std::vector<double> values) {
  const double factor = total(values) / total(alike);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= factor * alike[i];
  return values;
}

// What a skin moves; nothing where it was not there.
double of_skin(const std::vector<double>& by_skin, std::size_t skin) {
  return skin < by_skin.size() ? by_skin[skin] : 0;
}

double squares(const std::vector<double>& v) {
  return std::inner_product(v.begin(), v.end(), v.begin(), 0.0);
}

// Degrees of freedom of the scatter of `designs` designs, from what each skin moves them by
// (Satterthwaite): skins that move alike designs together leave fewer than designs are. So few
// skins make it seem less than it is, by 1/f = 1/f' - 1/(skins - 1).
double freedom_of(const std::vector<std::vector<double>>& of_skins, std::size_t designs) {
  double trace = 0, square_trace = 0;
  for (const std::vector<double>& a : of_skins) {
    trace += squares(a);
    for (const std::vector<double>& b : of_skins)
      square_trace += square(std::inner_product(a.begin(), a.end(), b.begin(), 0.0));
  }
  const double seen = square_trace / square(trace);
  return 1 / std::max(1 / (static_cast<double>(designs) - 1),
                      seen - 1 / (static_cast<double>(of_skins.size()) - 1));
}

// Few skins know their own scatter badly. For probabilities a draw is wider by that, of Student's
// distribution; expected regret is a mean, which its tails would overstate. Eq. search.15-16
enum class Tails { Normal, Student };

// What a draw takes the errors of all designs for, in the standard errors that by_skin and by_error
// state.
struct ErrorDraw {
  std::vector<double> skins, errors;
  double student = 1;  // what the skins' are wider by then

  ErrorDraw mirrored() const {
    ErrorDraw out = *this;
    for (double& z : out.skins) z = -z;
    for (double& z : out.errors) z = -z;
    return out;
  }
};

// The most numbers behind a worth, of by_skin or of by_error.
std::size_t longest(const std::vector<std::vector<std::vector<double>>>& moves) {
  std::size_t out = 0;
  for (const auto& design : moves) {
    for (const auto& member : design) out = std::max(out, member.size());
  }
  return out;
}

// What draws of the errors of `d` are made of. A single skin tells nothing of its own scatter.
struct ErrorCount {
  explicit ErrorCount(const MemberWorth& d)
      : skins(longest(d.by_skin)), errors(longest(d.by_error)) {}
  bool none() const { return skins < 2 && errors == 0; }

  std::size_t skins = 0, errors = 0;
};

ErrorDraw drawn(RandomStream& random, const ErrorCount& count) {
  ErrorDraw out;
  for (std::size_t k = 0; k < count.skins; ++k) out.skins.push_back(random.normal());
  for (std::size_t k = 0; k < count.errors; ++k) out.errors.push_back(random.normal());
  if (count.skins < 2) return out;
  double squares = 0;
  for (std::size_t k = 1; k < count.skins; ++k) squares += square(random.normal());
  out.student = std::sqrt(static_cast<double>(count.skins - 1) / squares);
  return out;
}

// A list of errors for each design and member; returns how many the longest has.
std::size_t make_room_for_errors(MemberWorth& d) {
  d.by_error.resize(d.worth.size());
  for (auto& design : d.by_error) design.resize(d.weights.size());
  return longest(d.by_error);
}

// L of L L^T = a correlation matrix, by Cholesky's method; what rules on pairs leave indefinite of
// it is left out.
std::vector<std::vector<double>> correlation_root(
    const std::vector<std::vector<double>>& correlation) {
  constexpr double kNothingLeft = 1e-9;
  const std::size_t n = correlation.size();
  std::vector<std::vector<double>> out(n, std::vector<double>(n, 0));
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = 1 - squares(out[k]);
    if (pivot < kNothingLeft) continue;
    out[k][k] = std::sqrt(pivot);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double common = std::inner_product(out[i].begin(), out[i].end(), out[k].begin(), 0.0);
      const double most = std::sqrt(std::max(0.0, 1 - squares(out[i])));
      out[i][k] = std::clamp((correlation[i][k] - common) / out[k][k], -most, most);
    }
  }
  return out;
}

// What a draw of errors moves a worth by.
double moved_by_errors(const std::vector<std::vector<std::vector<double>>>& moves,
                       std::size_t design, std::size_t member, const std::vector<double>& z) {
  if (moves.empty()) return 0;
  const std::vector<double>& of = moves[design][member];
  return std::inner_product(of.begin(), of.end(), z.begin(), 0.0);
}

// A member at a draw of the errors, one more of the members of `out`.
void add_draw(const MemberWorth& all, std::size_t member, const ErrorDraw& z, Tails tails,
              MemberWorth& out) {
  const double wider = tails == Tails::Student ? z.student : 1;
  out.weights.push_back(all.weights[member]);
  out.draw_of.push_back(all.draw_of.empty() ? member : all.draw_of[member]);
  out.worth.resize(all.worth.size());
  out.kept.resize(all.kept.size());
  for (std::size_t i = 0; i < all.worth.size(); ++i) {
    out.worth[i].push_back(all.worth[i][member] +
                           wider * moved_by_errors(all.by_skin, i, member, z.skins) +
                           moved_by_errors(all.by_error, i, member, z.errors));
    out.kept[i].resize(all.kept[i].size());
    for (std::size_t k = 0; k < all.kept[i].size(); ++k)
      out.kept[i][k].push_back(all.kept[i][k][member]);
  }
}

// Each member as so many that share its weight, at draws of the errors. A draw comes with its
// mirror image, so that errors move no mean: where they alone would choose, the worth does.
// Eq. search.15
MemberWorth over_errors(const MemberWorth& all, Tails tails) {
  const ErrorCount count(all);
  if (count.none()) return all;
  MemberWorth out;
  RandomStream random(1, "decision");
  for (std::size_t m = 0; m < all.weights.size(); ++m) {
    for (int pair = 0; pair < kPairs; ++pair) {
      const ErrorDraw z = drawn(random, count);
      add_draw(all, m, z, tails, out);
      add_draw(all, m, z.mirrored(), tails, out);
    }
  }
  return out;
}

Reversal reversal(const MemberWorth& all, const BeliefRisk& risk, double p_limits,
                  std::size_t over_all, const MemberGroup& group) {
  const MemberWorth there = of_members(all, group.members);
  const std::vector<Prospect> found = prospects(there, risk);
  const double known = known_share(there);
  Reversal out;
  out.name = group.name;
  out.weight = total(there.weights) / total(all.weights);
  out.known = out.weight * known;
  // Where nothing is known, nothing speaks for another design.
  out.best = known > 0 ? chosen(found, p_limits) : over_all;
  out.loss = found[over_all].regret - found[out.best].regret;
  return out;
}

}  // namespace

BeliefRisk parse_belief_risk(const std::string& text) {
  if (text == "regret") return {};
  try {
    return {false, parse_risk(text)};
  } catch (const InputError&) {
    throw InputError("risk.belief: \"" + text + "\": expected " + belief_risk_forms());
  }
}

std::string belief_risk_forms() {
  return "\"regret\", \"mean\", \"worst 10 %\", \"mean - 2 std\" or \"worst\"";
}

void add_field_moves(const std::vector<WorthBySkin>& confirmed, const std::vector<double>& moves,
                     const std::vector<std::vector<double>>& correlation, bool in_proportion,
                     MemberWorth& designs) {
  const std::size_t n = moves.size();
  if (std::all_of(moves.begin(), moves.end(), [](double move) { return move == 0; })) return;
  const std::vector<std::vector<double>> root = correlation_root(correlation);
  const std::size_t before = make_room_for_errors(designs);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t m = 0; m < designs.weights.size(); ++m) {
      const double worth = designs.worth[i][m];
      const bool scales = in_proportion && confirmed[i].worth != 0 && !std::isnan(worth);
      const double there = moves[i] * (scales ? worth / confirmed[i].worth : 1);
      std::vector<double>& by_error = designs.by_error[i][m];
      by_error.resize(before, 0);
      for (std::size_t k = 0; k < n; ++k) by_error.push_back(there * root[i][k]);
    }
  }
}

bool MemberWorth::known(std::size_t member) const {
  return std::any_of(worth.begin(), worth.end(), [member](const std::vector<double>& design) {
    return !std::isnan(design[member]);
  });
}

bool MemberWorth::keeps(std::size_t design, std::size_t member) const {
  if (std::isnan(worth[design][member]) && known(member)) return false;
  return std::all_of(kept[design].begin(), kept[design].end(),
                     [member](const std::vector<bool>& of) { return of[member]; });
}

std::vector<double> MemberWorth::mean_moves(std::size_t design) const {
  std::vector<double> out;
  for (const auto* moves : {&by_skin, &by_error}) {
    const std::size_t before = out.size();
    out.resize(before + longest(*moves), 0);
    for (std::size_t m = 0; !moves->empty() && m < weights.size(); ++m) {
      const std::vector<double>& at = (*moves)[design][m];
      for (std::size_t k = 0; k < at.size(); ++k)
        out[before + k] += weights[m] / total(weights) * at[k];
    }
  }
  return out;
}

void combine_levels(const std::vector<WorthBySkin>& confirmed, const std::vector<WorthBySkin>& few,
                    bool in_proportion, MemberWorth& designs) {
  for (std::size_t m = 0; m < designs.weights.size(); ++m) {
    std::vector<std::size_t> known;
    std::vector<double> alike;
    double there = 0, here = 0, fine = 0;
    std::size_t skins = 0;
    for (std::size_t i = 0; i < few.size(); ++i) {
      if (!std::isfinite(designs.worth[i][m] - few[i].worth - confirmed[i].worth)) {
        designs.worth[i][m] = std::nan("");
        continue;
      }
      known.push_back(i);
      alike.push_back(in_proportion ? confirmed[i].worth : 1);
      there += designs.worth[i][m];
      here += few[i].worth;
      fine += confirmed[i].worth;
      skins = std::max({skins, confirmed[i].by_skin.size(), few[i].by_skin.size(),
                        designs.by_skin[i][m].size()});
    }
    if (known.empty() || (in_proportion && (here == 0 || fine == 0))) continue;
    const double to_fine = in_proportion ? fine / here : 1,
                 moved = in_proportion ? there / here : 1;
    const double shift = in_proportion ? 0 : (fine - here) / static_cast<double>(known.size());
    // What each skin moves designs apart by: at the member; where the levels differ as the finger
    // is.
    std::vector<std::vector<double>> member, levels;
    double together = 0, alone = 0;
    for (std::size_t s = 0; s < skins; ++s) {
      std::vector<double> x, y;
      for (const std::size_t i : known) {
        x.push_back(to_fine * of_skin(designs.by_skin[i][m], s));
        y.push_back(moved *
                    (to_fine * of_skin(few[i].by_skin, s) - of_skin(confirmed[i].by_skin, s)));
      }
      member.push_back(x);
      levels.push_back(y);
      x = beyond(alike, std::move(x));
      y = beyond(alike, std::move(y));
      together += std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
      alone += squares(y);
    }
    // Eq. search.25
    const double corrected = alone > 0 ? std::clamp(together / alone, 0.0, 1.0) : 1;
    for (std::size_t k = 0; k < known.size(); ++k) {
      const std::size_t i = known[k];
      const double difference = moved * (to_fine * few[i].worth + shift - confirmed[i].worth);
      designs.worth[i][m] = to_fine * designs.worth[i][m] + shift - corrected * difference;
      std::vector<double>& by_skin = designs.by_skin[i][m];
      by_skin.resize(skins);
      for (std::size_t s = 0; s < skins; ++s) by_skin[s] = member[s][k] - corrected * levels[s][k];
    }
  }
}

void shrink_moves(const std::vector<WorthBySkin>& own, bool in_proportion, MemberWorth& designs) {
  const std::size_t before = make_room_for_errors(designs);
  for (std::size_t m = 0; m < designs.weights.size(); ++m) {
    std::vector<std::size_t> known;
    std::vector<double> alike;  // what all designs move by, up to a factor
    double there = 0, here = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (!std::isfinite(designs.worth[i][m] - own[i].worth)) continue;
      known.push_back(i);
      alike.push_back(in_proportion ? own[i].worth : 1);
      there += designs.worth[i][m];
      here += own[i].worth;
    }
    if (known.size() < 2 || total(alike) == 0) continue;
    const double factor = in_proportion ? there / here : 1;
    std::size_t skins = 0;
    std::vector<double> moves;
    for (const std::size_t i : known) {
      skins = std::max({skins, own[i].by_skin.size(), designs.by_skin[i][m].size()});
      moves.push_back(designs.worth[i][m] - factor * own[i].worth);
    }
    moves = beyond(alike, std::move(moves));
    std::vector<std::vector<double>> of_skins;
    double scatter = 0;
    for (std::size_t s = 0; s < skins; ++s) {
      std::vector<double> move;
      for (const std::size_t i : known)
        move.push_back(of_skin(designs.by_skin[i][m], s) - factor * of_skin(own[i].by_skin, s));
      of_skins.push_back(beyond(alike, std::move(move)));
      scatter += squares(of_skins.back());
    }
    if (!(scatter > 0)) continue;
    const Estimate kept = meant_share(squares(moves) / scatter, freedom_of(of_skins, known.size()));
    for (std::size_t k = 0; k < known.size(); ++k) {
      designs.worth[known[k]][m] -= (1 - kept.value) * moves[k];
      std::vector<double>& by_skin = designs.by_skin[known[k]][m];
      by_skin.resize(skins, 0);
      for (std::size_t s = 0; s < skins; ++s)
        by_skin[s] -= (1 - std::sqrt(kept.value)) * of_skins[s][k];
      designs.by_error[known[k]][m].resize(before + 1, 0);
      designs.by_error[known[k]][m].back() = kept.se * moves[k];
    }
  }
}

std::vector<double> less_sure(const std::vector<double>& weights,
                              const std::vector<std::vector<bool>>& keeps) {
  const double all = total(weights);
  std::vector<double> kept(keeps.size(), 0);
  for (std::size_t i = 0; i < keeps.size(); ++i) {
    for (std::size_t m = 0; m < weights.size(); ++m) kept[i] += keeps[i][m] ? weights[m] / all : 0;
  }
  const auto surest =
      static_cast<std::size_t>(std::max_element(kept.begin(), kept.end()) - kept.begin());
  std::vector<double> out(keeps.size(), 0);
  for (std::size_t i = 0; i < keeps.size(); ++i) {
    const double less = kept[surest] - kept[i];
    if (!(less > 1e-9)) continue;  // weights are sums of fractions
    double variance = 0;  // by the members at which one of both keeps every limit. Eq. search.17
    for (std::size_t m = 0; m < weights.size(); ++m) {
      const double here = (keeps[surest][m] ? 1 : 0) - (keeps[i][m] ? 1 : 0);
      variance += square(weights[m] / all * (here - less));
    }
    out[i] = variance > 0 ? less / std::sqrt(variance) : kInfinity;
  }
  return out;
}

namespace {

// Draws put together as the members that they are of: two draws of a member tell no more than it.
void set_less_sure(const MemberWorth& d, std::vector<Prospect>& found) {
  std::map<std::size_t, std::size_t> place;  // of a member
  std::vector<double> weights;
  std::vector<std::vector<bool>> keeps(found.size());
  for (std::size_t m = 0; m < d.weights.size(); ++m) {
    const auto [member, is_new] =
        place.try_emplace(d.draw_of.empty() ? m : d.draw_of[m], weights.size());
    if (!is_new) {
      weights[member->second] += d.weights[m];
      continue;
    }
    weights.push_back(d.weights[m]);
    for (std::size_t i = 0; i < found.size(); ++i) keeps[i].push_back(d.keeps(i, m));
  }
  const std::vector<double> of = less_sure(weights, keeps);
  for (std::size_t i = 0; i < found.size(); ++i) found[i].less_sure = of[i];
}

// What a risk makes of each design over the members at which any has a worth: without the draws of
// what their skins leave open, the worst of which would be the worst luck. Eq. search.17
void set_merit(const MemberWorth& d, const Risk& risk, std::vector<Prospect>& found) {
  std::vector<double> weights;
  std::vector<std::vector<double>> worth(found.size());
  for (std::size_t m = 0; m < d.weights.size(); ++m) {
    if (!d.known(m)) continue;
    weights.push_back(d.weights[m]);
    for (std::size_t i = 0; i < found.size(); ++i) worth[i].push_back(worth_or_least(d, i, m));
  }
  if (weights.empty()) return;
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i].merit = apply_risk(risk, true, worth[i], weights);
}

}  // namespace

std::vector<Prospect> prospects(const MemberWorth& designs, const BeliefRisk& risk) {
  PAPILLA_CHECK(designs.kept.size() == designs.worth.size(), "limits of every design");
  const MemberWorth d = over_errors(designs, Tails::Student),
                    of_means = over_errors(designs, Tails::Normal);
  std::vector<Prospect> out(d.worth.size());
  const double all = total(d.weights);
  // Those at which no design has an answer tell none from another.
  std::vector<std::size_t> known;
  double of_known = 0;
  for (std::size_t m = 0; m < d.weights.size(); ++m) {
    if (!d.known(m)) continue;
    known.push_back(m);
    of_known += d.weights[m];
  }
  for (const std::size_t m : known) {
    add_best(d, m, d.weights[m] / of_known, out);
    add_regret(of_means, m, d.weights[m] / of_known, out);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    Prospect& p = out[i];
    p.p_limits = 0;
    p.p_limit.assign(d.kept[i].size(), 0);
    for (std::size_t m = 0; m < d.weights.size(); ++m) {
      const double w = d.weights[m] / all;
      p.p_limits += d.keeps(i, m) ? w : 0;
      for (std::size_t k = 0; k < p.p_limit.size(); ++k) p.p_limit[k] += d.kept[i][k][m] ? w : 0;
    }
    // Weights sum to 1 but for their last digits.
    p.p_best = std::min(1.0, p.p_best);
    p.p_limits = std::min(1.0, p.p_limits);
    for (double& kept : p.p_limit) kept = std::min(1.0, kept);
    if (risk.regret) p.merit = -p.regret;
  }
  if (!risk.regret) set_merit(designs, risk.risk, out);
  set_less_sure(designs, out);
  return out;
}

SettledSkins settled_skins(const MemberWorth& designs, const BeliefRisk& risk, double p_limits) {
  const auto choice = [&](const MemberWorth& of) {
    const std::vector<Prospect> found = prospects(of, risk);
    return found[chosen(found, p_limits)];
  };
  const ErrorCount count(designs);
  if (count.none()) {
    const Prospect known = choice(designs);
    return {known.p_best, known.regret};
  }
  SettledSkins out;
  RandomStream random(2, "decision");
  for (int pair = 0; pair < kSettledPairs; ++pair) {
    const ErrorDraw z = drawn(random, count);  // of all members at once
    for (const ErrorDraw& draw : {z, z.mirrored()}) {
      const auto choice_if_true = [&](Tails tails) {
        MemberWorth of;
        for (std::size_t m = 0; m < designs.weights.size(); ++m)
          add_draw(designs, m, draw, tails, of);
        return choice(of);
      };
      // Eq. search.24
      out.p_best += choice_if_true(Tails::Student).p_best;
      out.regret += choice_if_true(Tails::Normal).regret;
    }
  }
  out.p_best /= 2 * kSettledPairs;  // of the sum: not a last digit above 1
  out.regret /= 2 * kSettledPairs;
  return out;
}

double best_worth(const MemberWorth& designs) {
  const MemberWorth d = over_errors(designs, Tails::Normal);
  double sum = 0, weight = 0;
  for (std::size_t m = 0; m < d.weights.size(); ++m) {
    const double best = best_at(d, m);
    if (std::isnan(best)) continue;
    sum += d.weights[m] * best;
    weight += d.weights[m];
  }
  return weight > 0 ? sum / weight : 0;
}

double known_share(const MemberWorth& designs) {
  const double all = total(designs.weights);
  double known = 0;
  for (std::size_t m = 0; m < designs.weights.size(); ++m)
    known += designs.known(m) ? designs.weights[m] : 0;
  return all > 0 ? known / all : 1;
}

std::size_t chosen(const std::vector<Prospect>& prospects, double p_limits) {
  PAPILLA_CHECK(!prospects.empty(), "a design to choose");
  constexpr double kTold = 2;  // standard errors from which on members tell designs apart
  const double wanted = p_limits - 1e-9;  // weights are sums of fractions
  const bool any = std::any_of(prospects.begin(), prospects.end(),
                               [&](const Prospect& p) { return p.p_limits >= wanted; });
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < prospects.size(); ++i) {
    const Prospect& p = prospects[i];
    if (any ? p.p_limits < wanted : p.less_sure > kTold) continue;
    if (!best || prospects[i].merit > prospects[*best].merit) best = i;
  }
  return *best;
}

std::vector<Reversal> by_group(const MemberWorth& designs, const BeliefRisk& risk, double p_limits,
                               const std::vector<MemberGroup>& groups) {
  const std::size_t over_all = chosen(prospects(designs, risk), p_limits);
  std::vector<Reversal> out;
  for (const MemberGroup& g : groups) out.push_back(reversal(designs, risk, p_limits, over_all, g));
  return out;
}

std::optional<HalvesReversal> by_half(const MemberWorth& designs, const BeliefRisk& risk,
                                      double p_limits, const std::vector<MemberNumber>& numbers) {
  const std::size_t over_all = chosen(prospects(designs, risk), p_limits);
  const double all = total(designs.weights);
  std::optional<HalvesReversal> out;
  double most = 0;
  for (const MemberNumber& number : numbers) {
    std::vector<std::size_t> order(number.values.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return number.values[a] < number.values[b];
    });
    // Eq. search.18: up to the middle of the weight; equal values stay together.
    MemberGroup low{number.path, {}}, high{number.path, {}};
    double below = 0;
    for (std::size_t m : order) {
      const bool same = !low.members.empty() && high.members.empty() &&
                        number.values[m] == number.values[low.members.back()];
      const bool first = below + 0.5 * designs.weights[m] <= 0.5 * all;
      (first || same ? low : high).members.push_back(m);
      below += designs.weights[m];
    }
    if (low.members.empty() || high.members.empty()) continue;
    const Reversal at_low = reversal(designs, risk, p_limits, over_all, low),
                   at_high = reversal(designs, risk, p_limits, over_all, high);
    if (at_low.best == over_all && at_high.best == over_all) continue;
    const double loss = at_low.known * at_low.loss + at_high.known * at_high.loss;
    if (out && loss <= most) continue;
    most = loss;
    out = {number.path,
           0.5 * (number.values[low.members.back()] + number.values[high.members.front()]), at_low,
           at_high};
  }
  return out;
}

}  // namespace papilla::search
