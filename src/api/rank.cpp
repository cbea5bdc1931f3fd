#include "rank/rank.h"

#include <algorithm>

#include "api/inside.h"
#include "base/text.h"
#include "base/watch.h"
#include "papilla/rank.h"
#include "report/ranking.h"

namespace papilla::api {
namespace {

rooms::RankOptions inner(const std::vector<rooms::Design>& designs, const RankOptions& options) {
  rooms::RankOptions out;
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
    if (inside.names.empty()) {
      for (const rooms::Design& design : candidates) inside.names.push_back(design.title);
    }
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
