#include "report/shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "report/tables.h"
#include "search/shared.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kFewest = 5;  // good designs that share something
// Of what a number may be: below, good designs share it; above, it is free.
constexpr double kNarrow = 1.0 / 3, kWide = 2.0 / 3;

SharedRanges shared_of(const ResultFiles& f) { return shared_ranges(f.problem, f.history); }

const Variable* variable_of(const ResultFiles& f, const SharedRange& r) {
  const auto found = std::find_if(f.study.variables.begin(), f.study.variables.end(),
                                  [&](const Variable& v) { return v.path == r.name; });
  return found == f.study.variables.end() ? nullptr : &*found;
}

std::string number_text(const SharedRange& r, double value) {
  return significant(value / find_unit(r.unit)->to_si, 3);
}

// "0.4 to 0.5 um", "1:18 to 1:12", "hole_array, grating".
std::string between(const ResultFiles& f, const SharedRange& r, double low, double high) {
  if (!r.choices.empty()) {
    std::vector<std::string> out;
    for (const double choice : r.choices) out.push_back(variable_text(*variable_of(f, r), choice));
    return join_names(out);
  }
  if (!variable_of(f, r) && r.unit.empty())
    return fmt::format("1:{} to 1:{}", significant(1 / low, 2), significant(1 / high, 2));
  const std::string unit = r.unit.empty() ? "" : " " + r.unit;
  const std::string a = number_text(r, low), b = number_text(r, high);
  return a == b ? a + unit : a + " to " + b + unit;
}

std::string name_text(const SharedRange& r) {
  return r.name == "depth / period" ? "depth of the period" : r.name;
}

// Whether all good designs lie in a small part of what is possible, or in most of it.
bool narrow(const ResultFiles& f, const SharedRange& r) {
  const Variable* v = variable_of(f, r);
  return v && !v->choices.empty() ? r.choices.size() == 1 && v->choices.size() > 1
                                  : r.share() <= kNarrow;
}

std::string said(const ResultFiles& f, const SharedRanges& shared) {
  std::vector<std::string> same, free;
  for (const SharedRange& r : shared.ranges) {
    if (narrow(f, r)) same.push_back(name_text(r) + " " + between(f, r, r.low, r.high));
    if (r.choices.empty() && r.share() >= kWide) free.push_back(name_text(r));
  }
  return fmt::format(
      "{} of {} designs of the search that keep every limit lie within 5 % of {} (at the level of "
      "the search). {}.{}",
      shared.good, shared.feasible, f.problem.objectives().size() > 1 ? "its front" : "its best",
      same.empty() ? "They share no number within a third of what it may be"
                   : "They share " + join_names(same, "; "),
      free.empty() ? "" : " Nearly any value is good of " + join_names(free) + ".");
}

}  // namespace

std::string shared_text(const ResultFiles& f) {
  const SharedRanges shared = shared_of(f);
  if (shared.good < kFewest) return {};
  std::string out = "\n## What all good designs share\n\n" + said(f, shared) + "\n\n" +
                    markdown_head({"number", "good designs", "possible", "share of it", "designs"});
  for (const SharedRange& r : shared.ranges) {
    const bool choices = !r.choices.empty();
    out += markdown_row(
        {r.name, between(f, r, r.low, r.high), choices ? "" : between(f, r, r.from, r.to),
         choices ? "" : fmt::format("{:.0f} %", 100 * r.share()), fmt::format("{}", r.designs)});
  }
  return out;
}

Json shared_json(const ResultFiles& f) {
  const SharedRanges shared = shared_of(f);
  if (shared.good < kFewest) return {};
  Json out{{"good", shared.good},
           {"feasible", shared.feasible},
           {"said", said(f, shared)},
           {"ranges", Json::array()}};
  for (const SharedRange& r : shared.ranges) {
    Json row{{"name", r.name},
             {"unit", r.unit},
             {"designs", r.designs},
             {"text", between(f, r, r.low, r.high)}};
    if (r.choices.empty()) {
      row["low"] = r.low, row["high"] = r.high, row["from"] = r.from, row["to"] = r.to;
      row["possible"] = between(f, r, r.from, r.to);
    }
    out["ranges"].push_back(std::move(row));
  }
  return out;
}

}  // namespace papilla::report
