#include "report/fit_belief.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// Below it weighted means stand on too little.
constexpr double kFewSamples = 10;

std::string hypothesis_row(const HypothesisFit& h) {
  if (!h.failed.empty()) return fmt::format("| {} | – | – | – | – | 0 | {} |\n", h.name, h.failed);
  std::string valleys;
  for (const Valley& v : h.posterior.valleys)
    valleys +=
        fmt::format("{}{:.4g} ({:.0f} %)", valleys.empty() ? "" : ", ", v.sum, 100 * v.share);
  return fmt::format("| {} | {} | {} | {:.2f} | {:.2f} ± {:.2f} | {:.3f} | {} |\n", h.name, valleys,
                     h.posterior.asked, h.posterior.guess_error, h.score, h.score_error, h.weight,
                     h.least_effective < kFewSamples
                         ? fmt::format("a group left out stands on {:.1f} draws", h.least_effective)
                         : "");
}

}  // namespace

std::string belief_section(const Calibration& calibration, const BeliefFit& fit) {
  std::string out =
      "\n## Belief: what the data leave open\n\n"
      "| hypothesis | valleys: χ² with priors (share) | samples | guess missed by | log predictive "
      "score | weight | |\n|---|---|---|---|---|---|---|\n";
  for (const HypothesisFit& h : fit.hypotheses) out += hypothesis_row(h);
  out += fmt::format(
      "\nSamples are answers of the model where the posterior is high; all rows are learnt from "
      "them "
      "as quadratics of the parameters, and what those leave open counts as an error of the row. "
      "\"Guess missed by\": root mean square of what later answers missed the guess by, in its own "
      "standard deviations (1: it knows its error). Weights of hypotheses: by what each predicts "
      "of "
      "{} groups of rows ({}) left out one at a time, not by χ². Sums of squares are divided by "
      "{:.3g}, common to all.\n",
      fit.groups.size(), join_names(fit.groups), fit.variance_factor);
  const Belief& b = fit.belief;
  out += fmt::format(
      "\n`belief.toml` has {} members (worth {:.1f} equal ones) of draws that are worth {:.0f}, by "
      "{:.0f} "
      "samples. In every row and parameter ({} and {}) their weighted mean is within {:.2f} "
      "standard "
      "deviations of the samples' and their standard deviation {:.2f} to {:.2f} times it, "
      "widened for what they are worth.\n",
      b.members.size(), b.effective_members(), b.effective_samples, b.samples,
      fit.hypotheses.front().posterior.samples.front().misses.size(), calibration.parameters.size(),
      fit.largest_mean, fit.least_spread, fit.largest_spread);
  if (b.effective_samples < kFewSamples)
    out += fmt::format(
        "\n**The draws are worth fewer than {:.0f}**: more samples (`[belief] samples`), or wider "
        "standard deviations of the data, before much is made of this belief.\n",
        kFewSamples);
  return out;
}

Json belief_fit_json(const BeliefFit& fit) {
  Json hypotheses = Json::array();
  for (const HypothesisFit& h : fit.hypotheses) {
    Json valleys = Json::array(), scores = Json::object();
    for (const Valley& v : h.posterior.valleys)
      valleys.push_back({{"chi2_with_priors", json_number(v.sum)}, {"share", v.share}});
    for (std::size_t g = 0; g < h.scores.size(); ++g)
      scores[fit.groups[g]] = json_number(h.scores[g]);
    hypotheses.push_back({{"name", h.name},
                          {"weight", h.weight},
                          {"valleys", std::move(valleys)},
                          {"samples", h.posterior.asked},
                          {"guess_missed_by", json_number(h.posterior.guess_error)},
                          {"effective_samples", h.posterior.effective},
                          {"log_predictive_score", json_number(h.score)},
                          {"log_predictive_score_se", json_number(h.score_error)},
                          {"of_groups", std::move(scores)},
                          {"least_effective_left_out", h.least_effective},
                          {"status", h.failed.empty() ? "ok" : h.failed}});
  }
  return {{"hypotheses", std::move(hypotheses)},
          {"variance_factor", fit.variance_factor},
          {"members", fit.belief.members.size()},
          {"samples", fit.belief.samples},
          {"effective_samples", fit.belief.effective_samples},
          {"effective_members", fit.belief.effective_members()},
          {"agreement",
           {{"largest_mean", fit.largest_mean},
            {"least_spread", fit.least_spread},
            {"largest_spread", fit.largest_spread}}}};
}

}  // namespace papilla::report
