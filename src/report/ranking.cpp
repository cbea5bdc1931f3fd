#include "report/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "base/statistics.h"
#include "base/text.h"
#include "report/json.h"
#include "report/page.h"
#include "report/svg.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const std::string& state_name(FingerState state) {
  return finger_state_names()[static_cast<std::size_t>(state)];
}

// A criterion as a share of its mean over humidity has no unit.
bool is_relative(const Criterion& c) {
  return c.expression.summary == Summary::Variation || c.expression.summary == Summary::Range;
}

// How people read a criterion: its value in SI times `scale` is in `unit`.
struct ShownUnit {
  double scale;
  std::string unit;
};

ShownUnit shown_unit(const Criterion& c) {
  const std::string& unit = c.info().unit;
  if (is_relative(c) || unit.empty()) return {1, ""};
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e9, "nm"};
  if (unit == "m/Pa") return {1e12, "um/MPa"};
  return {1, unit};
}

std::vector<std::string> table_head(const RankOptions& options) {
  std::vector<std::string> head{"rank", "design"};
  for (const Criterion& c : options.criteria) {
    const std::string unit = shown_unit(c).unit;
    head.push_back(c.text() + (unit.empty() ? "" : " " + unit));
  }
  head.push_back("ahead of the next, %");
  if (options.parameters) head.push_back("finger's part");
  for (const char* name : {"p(ahead)", "p(best)", "skins"}) head.push_back(name);
  return head;
}

std::vector<std::string> table_row(const std::string& name, const RankOptions& options,
                                   const RankedCandidate& r, bool last) {
  std::vector<std::string> row{fmt::format("{:>3}{}", r.rank, r.tied_with_next ? "=" : " "), name};
  for (std::size_t c = 0; c < r.metrics.size(); ++c) {
    const double scale = shown_unit(options.criteria[c]).scale;
    row.push_back(fmt::format("{:.4g} ± {:.2g}", r.metrics[c].value * scale,
                              (r.metrics[c].high - r.metrics[c].low) / 2 * scale));
  }
  const Interval& ahead = r.ahead_of_next;
  row.push_back(last ? std::string("-")
                     : fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * ahead.value, 100 * ahead.low,
                                   100 * ahead.high));
  if (options.parameters)
    row.push_back(
        last ? std::string("-")
             : fmt::format("±{:.1f}", 100 * normal_quantile(0.975) * ahead.parameters.value_or(0)));
  row.push_back(last ? std::string("-") : fmt::format("{:.3f}", r.p_ahead));
  row.push_back(fmt::format("{:.3f}", r.p_best));
  row.push_back(fmt::format("{}", r.skins));
  return row;
}

std::string state_table(const std::vector<std::string>& names, const RankOptions& options,
                        const StateRanking& state) {
  std::vector<std::vector<std::string>> rows{table_head(options)};
  for (const RankedCandidate& r : state.candidates)
    rows.push_back(table_row(names[r.index], options, r, &r == &state.candidates.back()));
  std::string out = "finger " + state_name(state.state) + "\n" + aligned_table(rows, 2);
  out += fmt::format("{} patches of skin tried", state.skins);
  if (state.skins < state.equal_skins)
    out += fmt::format(" (more where two designs are close; {} with as many for every design)",
                       state.equal_skins);
  return out + "\n\n";
}

Json interval_json(const Interval& i) {
  return {{"value", json_number(i.value)},
          {"low", json_number(i.low)},
          {"high", json_number(i.high)},
          {"parameters", json_number(i.parameters)}};
}

Json candidate_json(const std::string& name, const RankOptions& options, const RankedCandidate& r) {
  Json metrics = Json::object();
  for (std::size_t c = 0; c < r.metrics.size(); ++c)
    metrics[metric_text(options.criteria[c].expression)] = interval_json(r.metrics[c]);
  return {{"name", name},
          {"index", r.index},
          {"rank", r.rank},
          {"tied_with_next", r.tied_with_next},
          {"score", interval_json(r.score)},
          {"behind_best", interval_json(r.behind_best)},
          {"ahead_of_next", interval_json(r.ahead_of_next)},
          {"p_ahead", r.p_ahead},
          {"p_best", r.p_best},
          {"metrics", metrics},
          {"skins", r.skins}};
}

Json state_json(const std::vector<std::string>& names, const RankOptions& options,
                const StateRanking& state) {
  Json candidates = Json::array();
  for (const RankedCandidate& r : state.candidates)
    candidates.push_back(candidate_json(names[r.index], options, r));
  return {{"state", state_name(state.state)},
          {"candidates", candidates},
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
  if (ranking.directions > 0) {
    out += fmt::format(
        "parameters of the finger in every interval and probability: {} directions of its "
        "covariance, the same for all designs; {} skins, {} pixels. Finger's part: of the lead\n",
        ranking.directions, ranking.step_skins, ranking.step_grid);
  }
  if (options.criteria.size() > 1)
    out +=
        "ahead of the next: by the mean over criteria of what each is better by, in parts of the "
        "candidates' mean size\n";
  int fewest = std::numeric_limits<int>::max();
  for (const StateRanking& state : ranking.states) {
    for (const RankedCandidate& r : state.candidates) fewest = std::min(fewest, r.skins);
  }
  return out +
         fmt::format(
             "read order, leads and probabilities: they are paired, all designs meet the same "
             "skins. The values share the luck of these few ({} at least) and may all be high or "
             "low together, beyond their ±; errors that all designs share (grid, water) are not in "
             "± either: papilla evaluate gives values. ± and [ ] are 95 % intervals over skins; = "
             "marks a tie with the next. {} patches of skin in all, {:.1f} s\n",
             fewest, ranking.skins, ranking.seconds);
}

std::string ranking_json(const std::vector<std::string>& names, const RankOptions& options,
                         const Ranking& ranking) {
  Json states = Json::array(), by = Json::array(), criteria = Json::array();
  for (const StateRanking& state : ranking.states)
    states.push_back(state_json(names, options, state));
  for (const Criterion& c : options.criteria) {
    by.push_back(c.text());
    criteria.push_back({{"metric", metric_text(c.expression)},
                        {"better", c.high ? "high" : "low"},
                        {"unit", is_relative(c) ? "" : c.info().unit}});
  }
  Json conditions = Json::array();
  for (const ConditionDifference& d : ranking.conditions) {
    conditions.push_back(
        {{"key", d.key}, {"designs", {d.first, d.other}}, {"values", {d.value, d.other_value}}});
  }
  Json parameters;
  if (ranking.directions > 0) {
    parameters = {{"directions", ranking.directions},
                  {"skins", ranking.step_skins},
                  {"grid", ranking.step_grid}};
  }
  return Json{{"schema", 1},
              {"by", by},
              {"conditions_differ", conditions},
              {"criteria", criteria},
              {"candidates", states.front()["candidates"]},
              {"states", states},
              {"parameters", parameters},
              {"skins", ranking.skins},
              {"seconds", ranking.seconds}}
      .dump(2);
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
                       kCentre + (kRadius + 26) * std::sin(angle(a)), options.criteria[a].text());
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
                       60 + 22 * static_cast<int>(i), colour, r.rank, names[r.index]);
  }
  return out + "</svg>\n";
}

void write_ranking(const std::string& folder, const std::vector<Regions>& candidates,
                   const std::vector<std::string>& names, const RankOptions& options,
                   const Ranking& ranking) {
  std::error_code error;
  std::filesystem::create_directories(folder + "/designs", error);
  if (error) {
    throw InputError({Problem{folder, 0, 0, "", "no such folder can be made: " + error.message()}});
  }
  write_bytes(folder + "/ranking.txt", ranking_table(names, options, ranking));
  write_bytes(folder + "/ranking.json", ranking_json(names, options, ranking) + "\n");
  if (options.criteria.size() > 2) {
    for (const StateRanking& state : ranking.states)
      write_bytes(folder + "/radar_" + state_name(state.state) + ".svg",
                  radar_svg(names, options, state));
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t k = 0; k < candidates[i].size(); ++k)
      write_design(folder + "/" + ranked_design_file(i, k), candidates[i][k]);
  }
  write_bytes(folder + "/report.html", report_page(folder));
}

std::string ranked_design_file(std::size_t candidate, std::size_t region) {
  return region == 0 ? fmt::format("designs/{:02d}.toml", candidate + 1)
                     : fmt::format("designs/{:02d}_{}.toml", candidate + 1, region + 1);
}

}  // namespace papilla::report
