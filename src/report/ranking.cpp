#include "report/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "base/folder.h"
#include "base/text.h"
#include "config/writer.h"
#include "metrics/shown.h"
#include "numerics/statistics.h"
#include "report/json.h"
#include "report/markup.h"
#include "report/page.h"
#include "report/sums.h"
#include "report/svg.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const std::string& state_name(FingerState state) {
  return finger_state_names()[static_cast<std::size_t>(state)];
}

// A share of draws as it is known: never certain.
std::string probability(double p) {
  return p > 0.999 ? ">0.999" : p < 0.001 ? "<0.001" : fmt::format("{:.3f}", p);
}

std::string criterion_head(const Criterion& c) {
  const std::string unit = shown_unit(c.expression).unit;
  return c.text() + (unit.empty() ? "" : " " + unit);
}

std::string metric_cell(const Criterion& c, const Interval& i) {
  const double scale = shown_unit(c.expression).scale;
  // Of a look that nothing scatters there is no ±; the last bits of a mean are none.
  constexpr double kBits = 1e-9;
  if (!(i.high - i.low > kBits * std::abs(i.value))) return fmt::format("{:.4g}", i.value * scale);
  return with_error(i.value * scale, (i.high - i.low) / 2 * scale);
}

// What each design meets more of where the order is open.
const char* met(const RankOptions& options) { return options.felt() ? "skins" : "arrangements"; }

// One score: who leads by how much.
std::vector<std::string> score_head(const RankOptions& options) {
  std::vector<std::string> head{"rank", "design"};
  for (const Criterion& c : options.criteria) head.push_back(criterion_head(c));
  head.push_back("ahead of the next, %");
  if (options.moves_finger()) head.push_back("model part");
  for (const char* name : {"p(ahead)", "p(best)", met(options)}) head.push_back(name);
  return head;
}

std::vector<std::string> score_row(const std::string& name, const RankOptions& options,
                                   const RankedCandidate& r, bool last) {
  std::vector<std::string> row{fmt::format("{:>3}{}", r.rank, r.tied_with_next ? "=" : ""), name};
  for (std::size_t c = 0; c < r.metrics.size(); ++c)
    row.push_back(metric_cell(options.criteria[c], r.metrics[c]));
  const Interval& ahead = r.ahead_of_next;
  row.push_back(last ? std::string("-")
                     : fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * ahead.value, 100 * ahead.low,
                                   100 * ahead.high));
  if (options.moves_finger())
    row.push_back(
        last ? std::string("-")
             : fmt::format("±{:.1f}", 100 * normal_quantile(0.975) * ahead.parameters.value_or(0)));
  row.push_back(last ? std::string("-") : probability(r.p_ahead));
  row.push_back(probability(r.p_best));
  row.push_back(fmt::format("{}", r.skins));
  return row;
}

std::string relation_text(Relation relation) {
  switch (relation) {
    case Relation::Better:
      return "better";
    case Relation::Worse:
      return "worse";
    case Relation::TradeOff:
      return "trade-off";
    case Relation::Equal:
      return "equal";
    case Relation::Open:
      break;
  }
  return "open";
}

// Several criteria and no weights: each criterion by itself, and who is beaten by whom.
std::string dominance_tables(const std::vector<std::string>& names, const RankOptions& options,
                             const StateRanking& state) {
  std::vector<std::vector<std::string>> rows{{"rank", "design"}}, pairs{{"row against column"}};
  for (const Criterion& c : options.criteria) {
    rows[0].push_back(criterion_head(c));
    rows[0].push_back("p(best)");
  }
  rows[0].push_back(met(options));
  for (const RankedCandidate& r : state.candidates) {
    std::vector<std::string>& row = rows.emplace_back();
    row = {fmt::format("{:>3}", r.rank), names[r.index]};
    for (std::size_t c = 0; c < r.metrics.size(); ++c) {
      row.push_back(metric_cell(options.criteria[c], r.metrics[c]));
      row.push_back(probability(r.p_best_by[c]));
    }
    row.push_back(fmt::format("{}", r.skins));
    pairs[0].push_back(names[r.index]);
    std::vector<std::string>& pair = pairs.emplace_back();
    pair.push_back(names[r.index]);
    for (const RankedCandidate& other : state.candidates)
      pair.push_back(&other == &r ? "-" : relation_text(r.over[other.index]));
  }
  return aligned_table(rows, 2) + "\n" + aligned_table(pairs, 1) + "\n";
}

int skins_of(const StateRanking& state, std::size_t candidate) {
  for (const RankedCandidate& r : state.candidates) {
    if (r.index == candidate) return r.skins;
  }
  return 0;
}

// "fine and hard", of several criteria "fine and hard in mean(haze):low".
std::string pair_text(const CandidatePair& pair, const std::vector<std::string>& names,
                      const RankOptions& options) {
  const std::string both = fmt::format("{} and {}", names[pair.first], names[pair.second]);
  return options.scored() ? both
                          : fmt::format("{} in {}", both, options.criteria[pair.criterion].text());
}

// Pairs that nothing tells apart; "" where there are none.
std::string equal_text(const std::vector<std::string>& names, const RankOptions& options,
                       const StateRanking& state) {
  if (state.equal.empty()) return {};
  std::vector<std::string> pairs;
  for (const CandidatePair& pair : state.equal) pairs.push_back(pair_text(pair, names, options));
  return fmt::format("the same on all {}, so that more would not tell them apart: {}", met(options),
                     join_names(pairs, "; "));
}

// Whether more skins would say more, in words.
std::string end_text(const std::vector<std::string>& names, const RankOptions& options,
                     const StateRanking& state) {
  const std::string equal = equal_text(names, options, state);
  if (state.open.empty()) {
    const std::string known =
        options.scored() ? "the order is known" : "the order is known in every criterion";
    return equal.empty() ? known : known + "; " + equal;
  }
  // More skins would tell those apart that had as many as they may; what is left open of the others
  // is not the skins'.
  std::vector<std::string> spent, unknown;
  for (const CandidatePair& pair : state.open) {
    const int skins = std::min(skins_of(state, pair.first), skins_of(state, pair.second));
    (options.moves_finger() && skins < options.max_skins ? unknown : spent)
        .push_back(pair_text(pair, names, options));
  }
  std::string out;
  if (!spent.empty())
    out =
        fmt::format("the budget of {} {} per design (--max-skins) is spent with the order open: {}",
                    options.max_skins, met(options), join_names(spent, "; "));
  if (!unknown.empty())
    out += fmt::format(
        "{}more skins would not settle what is not known of finger and model, which leaves open: "
        "{}",
        out.empty() ? "" : "\n", join_names(unknown, "; "));
  return equal.empty() ? out : out + "\n" + equal;
}

std::string state_table(const std::vector<std::string>& names, const RankOptions& options,
                        const StateRanking& state) {
  std::string out = state.touching + "\n";
  if (options.scored()) {
    std::vector<std::vector<std::string>> rows{score_head(options)};
    for (const RankedCandidate& r : state.candidates)
      rows.push_back(score_row(names[r.index], options, r, &r == &state.candidates.back()));
    out += aligned_table(rows, 2);
  } else {
    out += dominance_tables(names, options, state);
  }
  out += fmt::format("{}; {} {} tried", end_text(names, options, state), state.skins,
                     options.felt() ? "patches of skin" : met(options));
  if (state.skins < state.equal_skins)
    out += fmt::format(" (more where two designs are close; {} with as many for every design)",
                       state.equal_skins);
  return out + "\n\n";
}

Json interval_json(const Interval& i) {
  return {{"value", json_number(i.value)},
          {"low", json_number(i.low)},
          {"high", json_number(i.high)},
          {"parameters", json_number(i.parameters)},
          {"model", json_number(i.parameters)}};
}

Json candidate_json(const std::string& name, const std::string& title, const RankOptions& options,
                    const RankedCandidate& r) {
  Json metrics = Json::object(), best = Json::object(), over = Json::array();
  for (std::size_t c = 0; c < r.metrics.size(); ++c) {
    const std::string metric = metric_text(options.criteria[c].expression);
    metrics[metric] = interval_json(r.metrics[c]);
    best[metric] = r.p_best_by[c];
  }
  for (const Relation relation : r.over) over.push_back(relation_text(relation));
  Json out{{"name", name}, {"title", title}, {"index", r.index}, {"rank", r.rank}};
  if (options.scored()) {
    out["tied_with_next"] = r.tied_with_next;
    out["score"] = interval_json(r.score);
    out["behind_best"] = interval_json(r.behind_best);
    out["ahead_of_next"] = interval_json(r.ahead_of_next);
    out["p_ahead"] = r.p_ahead;
    out["p_best"] = r.p_best;
  }
  out["metrics"] = std::move(metrics);
  out["p_best_by"] = std::move(best);
  out["over"] = std::move(over);
  out["skins"] = r.skins;
  return out;
}

Json state_json(const std::vector<std::string>& names, const RankOptions& options,
                const Ranking& ranking, const StateRanking& state) {
  Json candidates = Json::array();
  for (const RankedCandidate& r : state.candidates)
    candidates.push_back(candidate_json(names[r.index], ranking.titles[r.index], options, r));
  const auto pairs = [&](const std::vector<CandidatePair>& of) {
    Json out = Json::array();
    for (const CandidatePair& pair : of)
      out.push_back({{"designs", {names[pair.first], names[pair.second]}},
                     {"by", options.scored() ? "score" : options.criteria[pair.criterion].text()}});
    return out;
  };
  return {{"state", state_name(state.state)},
          {"candidates", candidates},
          {"open", pairs(state.open)},
          {"equal", pairs(state.equal)},
          {"end", end_text(names, options, state)},
          {"skins", state.skins},
          {"equal_skins", state.equal_skins}};
}

// On each axis the best candidate reaches the rim; the others the ratio to it.
double share_of_best(const StateRanking& state, std::size_t criterion, bool high, double value) {
  double least = kInfinity, most = -kInfinity;
  for (const RankedCandidate& other : state.candidates) {
    least = std::min(least, std::abs(other.metrics[criterion].value));
    most = std::max(most, std::abs(other.metrics[criterion].value));
  }
  const double v = std::abs(value);
  return high ? (most > 0 ? v / most : 1) : (v > 0 ? least / v : 1);
}

}  // namespace

std::string ranking_table(const std::vector<std::string>& names, const RankOptions& options,
                          const Ranking& ranking) {
  std::string out;
  for (const StateRanking& state : ranking.states) out += state_table(names, options, state);
  if (!ranking.conditions.empty()) {
    out +=
        "warning: the designs are not judged under the same conditions, and the order is that of "
        "surface and conditions together:\n";
    for (const ConditionDifference& d : ranking.conditions) out += "  " + d.text() + "\n";
  }
  const char* part = options.scored() ? ". Model part: of the lead" : "";
  if (ranking.members > 0) {
    out += fmt::format(
        "belief about finger and model in every interval and probability: {} members, the same for "
        "all designs; {} skins, {} pixels{}\n",
        ranking.members, ranking.step_skins, ranking.step_grid, part);
  }
  if (ranking.directions > 0) {
    out += fmt::format(
        "parameters of the finger in every interval and probability: {} directions of its "
        "covariance, the same for all designs; {} skins, {} pixels{}\n",
        ranking.directions, ranking.step_skins, ranking.step_grid, part);
  }
  if (options.criteria.size() > 1 && options.scored())
    out +=
        "ahead of the next: by the weighted mean over criteria of what each is better by, in parts "
        "of the candidates' mean size\n";
  if (options.scored())
    out += "rank: 1 and how many are ahead beyond doubt\n";
  else
    out +=
        "no weights (--weights), so no single order: rank 1 is beaten by nobody, rank 2 by one. "
        "Better: ahead in a criterion and behind in none, as far as the intervals tell; equal: the "
        "same in every criterion; open: no difference is told from none\n";
  for (const std::string& note : ranking.notes) out += note + "\n";
  if (options.felt() && !options.parameters)
    out += "what the fit of the finger leaves open is in no interval and no probability\n";
  int fewest = std::numeric_limits<int>::max();  // of those that have more than one look
  bool several = false;
  for (const StateRanking& state : ranking.states) {
    for (const RankedCandidate& r : state.candidates) {
      if (!options.felt() && r.skins == 1) continue;
      several = true;
      fewest = std::min(fewest, r.skins);
    }
  }
  const std::string seconds =
      ranking.seconds ? fmt::format(", {:.1f} s", *ranking.seconds) : std::string();
  const char* bars =
      options.scored() ? "± and [ ] are 95 % intervals over " : "± are 95 % intervals over ";
  const char* tie = options.scored() ? "; = marks a tie with the next" : "";
  if (!options.felt()) {
    const std::string over = several ? fmt::format(
                                           "{}arrangements of what is random ({} of each at "
                                           "least); of any other surface there is one, and no ±",
                                           bars, fewest)
                                     : "no surface is random: there is one look of each, and no ±";
    return out + fmt::format(
                     "what is ranked is seen and not felt: neither the finger nor belief about it "
                     "is in it. {}{}. {} arrangements in all{}\n",
                     over, tie, ranking.skins, seconds);
  }
  const char* over = ranking.members > 0      ? "skins and belief"
                     : ranking.directions > 0 ? "skins and the parameters of the finger"
                                              : "skins";
  return out +
         fmt::format(
             "all designs met the same skins ({} at least): trust the order, its leads and "
             "probabilities, not the values, which may all be high or low together, beyond their "
             "±; errors of grid, method and water are not in ± either, and cancel as far as "
             "designs are alike: papilla evaluate gives values. {}{}{}. {} patches of skin in "
             "all{}\n",
             fewest, bars, over, tie, ranking.skins, seconds);
}

std::string ranking_json(const std::vector<std::string>& names, const RankOptions& options,
                         const Ranking& ranking) {
  Json states = Json::array(), by = Json::array(), criteria = Json::array();
  for (const StateRanking& state : ranking.states)
    states.push_back(state_json(names, options, ranking, state));
  for (const Criterion& c : options.criteria) {
    by.push_back(c.text());
    criteria.push_back({{"metric", metric_text(c.expression)},
                        {"better", c.high ? "high" : "low"},
                        {"unit", si_unit(c.expression)}});
  }
  Json conditions = Json::array();
  for (const ConditionDifference& d : ranking.conditions) {
    conditions.push_back(
        {{"key", d.key}, {"designs", {d.first, d.other}}, {"values", {d.value, d.other_value}}});
  }
  Json parameters;
  if (ranking.directions + ranking.members > 0) {
    parameters = {{"directions", ranking.directions},
                  {"members", ranking.members},
                  {"skins", ranking.step_skins},
                  {"grid", ranking.step_grid}};
  }
  Json out{{"schema", 1},
           {"by", by},
           {"felt", options.felt()},
           {"weights", options.weights},
           {"scored", options.scored()},
           {"conditions_differ", conditions},
           {"notes", ranking.notes},
           {"scans", ranking.scans},
           {"criteria", criteria},
           {"candidates", states.front()["candidates"]},
           {"states", states},
           {"parameters", parameters},
           {"skins", ranking.skins}};
  if (ranking.seconds) out["seconds"] = *ranking.seconds;
  return out.dump(2);
}

std::string ranking_csv(const std::vector<std::string>& names, const RankOptions& options,
                        const Ranking& ranking) {
  std::string out = "finger,rank,design,title";
  for (const Criterion& c : options.criteria) {
    const std::string unit = si_unit(c.expression);
    out += fmt::format(",{0}{1},{0} low,{0} high,{0} p(best)", metric_text(c.expression),
                       unit.empty() ? "" : " [" + unit + "]");
  }
  out += options.scored() ? ",score,score low,score high,p(best),p(ahead)" : ",beaten by";
  out += ",skins\n";
  for (const StateRanking& state : ranking.states) {
    for (const RankedCandidate& r : state.candidates) {
      out += fmt::format("{},{},{},{}", state_name(state.state), r.rank, csv_cell(names[r.index]),
                         csv_cell(ranking.titles[r.index]));
      for (std::size_t c = 0; c < r.metrics.size(); ++c) {
        const Interval& i = r.metrics[c];
        out += fmt::format(",{:.6g},{:.6g},{:.6g},{:.4g}", i.value, i.low, i.high, r.p_best_by[c]);
      }
      if (options.scored()) {
        out += fmt::format(",{:.6g},{:.6g},{:.6g},{:.4g},", r.score.value, r.score.low,
                           r.score.high, r.p_best);
        if (&r != &state.candidates.back()) out += fmt::format("{:.4g}", r.p_ahead);
      } else {
        std::vector<std::string> beaten;
        for (std::size_t i = 0; i < r.over.size(); ++i) {
          if (r.over[i] == Relation::Worse) beaten.push_back(names[i]);
        }
        out += fmt::format(",{}", csv_cell(join_names(beaten, "; ")));
      }
      out += fmt::format(",{}\n", r.skins);
    }
  }
  return out;
}

std::string radar_svg(const std::vector<std::string>& names, const RankOptions& options,
                      const StateRanking& state) {
  static constexpr const char* kColours[] = {"#1b6ca8", "#d1495b", "#3c8d5a", "#8a5fbf",
                                             "#c98a1b", "#4a4a4a", "#2aa9a9", "#b0467d"};
  constexpr double kCentre = 260, kRadius = 180;
  const std::size_t axes = options.criteria.size();
  const auto angle = [&](std::size_t axis) {
    return 2 * kPi * static_cast<double>(axis) / static_cast<double>(axes) - kPi / 2;
  };
  const auto point = [&](std::size_t axis, double share) {
    return fmt::format("{:.1f},{:.1f} ", kCentre + kRadius * share * std::cos(angle(axis)),
                       kCentre + kRadius * share * std::sin(angle(axis)));
  };
  std::string out = svg_sheet(760, 540, 13);
  for (double ring : {0.25, 0.5, 0.75, 1.0}) {
    out += "<polygon fill=\"none\" stroke=\"#cccccc\" points=\"";
    for (std::size_t a = 0; a < axes; ++a) out += point(a, ring);
    out += "\"/>\n";
  }
  for (std::size_t a = 0; a < axes; ++a) {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                       kCentre + (kRadius + 26) * std::cos(angle(a)),
                       kCentre + (kRadius + 26) * std::sin(angle(a)),
                       markup_text(options.criteria[a].text()));
  }
  for (std::size_t i = 0; i < state.candidates.size(); ++i) {
    const RankedCandidate& r = state.candidates[i];
    const char* colour = kColours[i % std::size(kColours)];
    out += fmt::format(
        "<polygon fill=\"{0}\" fill-opacity=\"0.12\" stroke=\"{0}\" stroke-width=\"2\" points=\"",
        colour);
    for (std::size_t a = 0; a < axes; ++a)
      out += point(a, share_of_best(state, a, options.criteria[a].high, r.metrics[a].value));
    out += "\"/>\n";
    out += fmt::format("<text x=\"500\" y=\"{}\" fill=\"{}\">{}. {}</text>\n",
                       60 + 22 * static_cast<int>(i), colour, r.rank, markup_text(names[r.index]));
  }
  return out + "</svg>\n";
}

void write_ranking(const std::string& folder, const std::vector<Regions>& candidates,
                   const std::vector<std::string>& names, const RankOptions& options,
                   const Ranking& ranking) {
  const Folder results = Folder::made(folder);
  results.made_below("designs");
  Ranking lasting = ranking;
  lasting.seconds.reset();  // the same files of every run
  results.write("ranking.txt", ranking_table(names, options, lasting));
  results.write("ranking.csv", ranking_csv(names, options, lasting));
  results.write("ranking.json", ranking_json(names, options, lasting) + "\n");
  if (options.criteria.size() > 2) {
    for (const StateRanking& state : ranking.states)
      results.write(std::string("radar_") + state_name(state.state) + ".svg",
                    radar_svg(names, options, state));
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t k = 0; k < candidates[i].size(); ++k)
      results.write(ranked_design_file(i, k), to_toml(candidates[i][k]));
  }
  write_sums(results);
  results.write(kPageName, report_page(folder));
}

std::string ranked_design_file(std::size_t candidate, std::size_t region) {
  return region == 0 ? fmt::format("designs/{:02d}.toml", candidate + 1)
                     : fmt::format("designs/{:02d}_{}.toml", candidate + 1, region + 1);
}

}  // namespace papilla::report
