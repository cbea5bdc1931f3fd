// A Ranking for people (table, radar) and for programs (JSON, schema 1).
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "rank/rank.h"

namespace papilla::report {

// `names`: of the candidates, in the order in which they were given.
std::string ranking_table(const std::vector<std::string>& names, const RankOptions& options,
                          const Ranking& ranking);
std::string ranking_json(const std::vector<std::string>& names, const RankOptions& options,
                         const Ranking& ranking);
// A line per finger state and candidate, SI units.
std::string ranking_csv(const std::vector<std::string>& names, const RankOptions& options,
                        const Ranking& ranking);
// One polygon per candidate over the criteria, for a finger state; larger is better on every axis.
std::string radar_svg(const std::vector<std::string>& names, const RankOptions& options,
                      const StateRanking& state);

// Table, CSV, JSON, radars of more than two criteria, the designs, and the page, in a folder that
// it makes. Throws InputError.
void write_ranking(const std::string& folder, const std::vector<Regions>& candidates,
                   const std::vector<std::string>& names, const RankOptions& options,
                   const Ranking& ranking);
// Where write_ranking leaves a design of a candidate, from 0, in its folder.
std::string ranked_design_file(std::size_t candidate, std::size_t region);

}  // namespace papilla::report
