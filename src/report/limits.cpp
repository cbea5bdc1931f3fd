#include "report/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/folder.h"
#include "base/text.h"
#include "report/json.h"
#include "report/recommendation.h"
#include "report/run_numbers.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kOfALimit = "held against its limit as it is";

// The limit itself, as a text has it.
std::string asked_limit(const Constraint& limit, const std::string& text) {
  return stated(bare_number("limit of " + limit_name(limit.on), limit.limit, "SI", kAsked, {}),
                text);
}

std::string built_limit_text(const LimitValue& v) {
  return limit_stated(v, limit_name(v.limit.on) + " of what is built");
}

}  // namespace

std::string limit_stated(const LimitValue& v, const std::string& words) {
  return stated(bare_number(words, v.value, "SI", kOfALimit,
                            {Stage::Confirm, Stage::Rounding, Stage::Stability}),
                limit_value_text(v.limit, v.value));
}

std::string limit_asked(const Constraint& limit) {
  return limit_name(limit.on) + " " + asked_limit(limit, limit_text(limit));
}

std::string limit_broken(const LimitValue& v) {
  return fmt::format("{} is {}, {} your limit of {}", limit_name(v.limit.on),
                     limit_stated(v, limit_name(v.limit.on) + " where it is broken"),
                     v.limit.at_least ? "below" : "above",
                     asked_limit(v.limit, limit_value_text(v.limit, v.limit.limit)));
}

// Of what is built, where that was judged; else as far as they are known before.
std::vector<LimitValue> built_limits(const ResultFiles& f) {
  const StudyConstraints& constraints = f.problem.constraints();
  if (!f.result.build) {
    const FinalDesign design = recommended_of(f);
    return constraints.values(design.design, design.confirmed);
  }
  const FinalDesign& made = f.result.build->made;
  if (made.confirmed.ok) return constraints.values(made.design, made.confirmed);
  std::vector<LimitValue> out = constraints.values(made.design, recommended_of(f).confirmed);
  std::erase_if(out, [](const LimitValue& v) {
    return std::holds_alternative<MetricLimit>(v.limit.on) ||
           std::holds_alternative<YieldLimit>(v.limit.on);
  });
  return out;
}

std::string limits_table(const std::vector<LimitValue>& limits) {
  if (limits.empty()) return {};
  std::string out = "\n" + markdown_head({"limit", "asked for", "as built"});
  for (const LimitValue& v : limits) {
    out += markdown_row({limit_name(v.limit.on), asked_limit(v.limit, limit_text(v.limit)),
                         built_limit_text(v) + (v.kept() ? "" : ", **broken**")});
  }
  return out;
}

Json limits_json(const std::vector<LimitValue>& limits) {
  Json out = Json::array();
  for (const LimitValue& v : limits) {
    out.push_back({{"name", limit_name(v.limit.on)},
                   {"at_least", v.limit.at_least},
                   {"limit", json_number(v.limit.limit)},
                   {"value", json_number(v.value)},
                   {"text", limit_value_text(v.limit, v.value)},
                   {"asked", limit_text(v.limit)},
                   {"kept", v.kept()}});
  }
  return out;
}

// What the page shows of the limits.
Json built_limits_json(const std::vector<LimitValue>& limits) {
  Json out = limits_json(limits);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    out[i]["text"] = built_limit_text(limits[i]);
    out[i]["asked"] = asked_limit(limits[i].limit, limit_text(limits[i].limit));
  }
  return out;
}

std::string none_keeps_text(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {};
  const Folder folder(path);
  if (!folder.has("run.json")) return {};
  const Json run = Json::parse(folder.read("run.json"), nullptr, false);
  if (!run.is_object() || !run.contains("limits") || run.value("feasible", Json()) != false)
    return {};
  std::vector<std::string> broken;
  for (const Json& limit : run["limits"]) {
    if (limit.value("kept", Json()) == false)
      broken.push_back(fmt::format("{} {} (it has {})", limit.value("name", "a limit"),
                                   limit.value("asked", ""), limit.value("text", "")));
  }
  return fmt::format("{}: build none of these: no design of the run keeps every limit{}", path,
                     broken.empty() ? "" : "; what it shows breaks " + join_names(broken));
}

}  // namespace papilla::report
