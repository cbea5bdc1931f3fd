#include "rank/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "api/inside.h"
#include "base/text.h"
#include "base/watch.h"
#include "estimate/evaluation.h"
#include "papilla/rank.h"
#include "report/ranking.h"

namespace papilla::api {
namespace {

// Titles that are no two alike: "Holes (1)", "Holes (2)"; a design without a title is called by its
// place, "design 1" the first.
std::vector<std::string> names_by_title(const std::vector<rooms::Design>& designs) {
  std::vector<std::string> out;
  std::map<std::string, std::size_t> all, so_far;
  for (const rooms::Design& design : designs) {
    out.push_back(design.title.empty() ? fmt::format("design {}", out.size() + 1) : design.title);
    ++all[out.back()];
  }
  for (std::string& name : out) {
    if (all[name] == 1) continue;
    std::string numbered;
    do {
      numbered = fmt::format("{} ({})", name, ++so_far[name]);
    } while (all.count(numbered) > 0);  // another's title
    name = numbered;
  }
  return out;
}

rooms::RankOptions inner(const std::vector<rooms::Design>& designs, const RankOptions& options) {
  rooms::RankOptions out;
  require_threads(options.threads);
  if (!options.names.empty() && options.names.size() != designs.size()) {
    throw wrong("names", fmt::format("expected one for each of {} designs, got {}", designs.size(),
                                     options.names.size()));
  }
  if (options.max_skins < out.batch || options.max_skins > rooms::kMostSkins) {
    throw wrong("max_skins",
                fmt::format("expected {}, the first step of every design, to {}, got {}", out.batch,
                            rooms::kMostSkins, options.max_skins));
  }
  const bool driven = std::all_of(designs.begin(), designs.end(),
                                  [](const rooms::Design& d) { return d.drive.driven(); });
  out.criteria = parse_criteria(!options.by.empty() ? options.by
                                : driven            ? "modulation:high"
                                                    : "friction:low,adhesion:low");
  const std::vector<std::string>& names = finger_state_names();
  const auto states =
      options.states.empty() ? std::vector<std::string>{} : split(options.states, ',');
  for (const std::string& name : states) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw rooms::InputError("states: expected some of " + join_names(names) + ", got " + name);
    out.states.push_back(static_cast<FingerState>(found - names.begin()));
  }
  out.max_skins = options.max_skins;
  out.threads = options.threads;
  out.weights = options.weights;
  out.parameters = options.parameters;
  out.any_conditions = options.any_conditions;
  out.names = options.names;
  out.note = options.progress;
  return out;
}

}  // namespace

Ranking rank(const std::vector<Design>& designs, const RankOptions& options) {
  return across([&] {
    if (designs.size() < 2) throw rooms::InputError("name two designs at least");
    std::vector<rooms::Design> candidates;
    for (const Design& design : designs) candidates.push_back(design.inside().design());
    rooms::RankOptions inside = inner(candidates, options);
    if (inside.felt()) {
      for (const Design& design : designs) design.require_simulated();
    }
    if (inside.felt() && !options.force) require_fitted_model(candidates, "", "set `force`");
    if (inside.names.empty()) inside.names = names_by_title(candidates);
    std::vector<Regions> regions;
    for (const rooms::Design& design : candidates) regions.push_back({design});
    if (inside.states.empty()) inside.states = {common_state(regions)};
    inside.parameters = inside.parameters || parameters_unknown(regions).empty();
    Watch watch({}, options.stop);
    const rooms::Ranking ranking = rooms::ranking_of(regions, inside);
    Ranking out;
    for (const StateRanking& state : ranking.states) {
      out.states.emplace_back();
      for (const RankedCandidate& c : state.candidates)
        out.states.back().push_back(
            {c.index, c.rank, c.p_best_by, c.score.value, c.score.low, c.score.high, c.p_best});
    }
    out.table = ranking_table(inside.names, inside, ranking);
    out.json = ranking_json(inside.names, inside, ranking);
    return out;
  });
}

}  // namespace papilla::api
