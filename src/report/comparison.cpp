#include "report/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/folder.h"
#include "base/text.h"
#include "design/study.h"
#include "metrics/shown.h"
#include "optim/pareto.h"
#include "report/markup.h"
#include "report/page_parts.h"
#include "report/svg.h"
#include "report/tables.h"
#include "search/problem.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostSettings = 80;  // rows of a table that somebody still reads
constexpr std::array kSideColours{"#1f6f9f", "#c2571a"};

struct Side {
  std::string name;
  Study study;
  std::vector<StudyObjective> objectives;
  Json run;  // run.json

  const Json& finalists() const { return run.at("finalists"); }
  // Of run.json; null: the run recommends none of its front.
  const Json* recommended() const {
    for (const Json& f : finalists()) {
      if (run.contains("design") && run["design"].is_string() && f.at("folder") == run["design"])
        return &f;
    }
    return nullptr;
  }
};

Side side_of(const std::string& path) {
  const Folder folder(path);
  if (!folder.has("run.json") || !folder.has("resolved.toml"))
    throw InputError({Problem{path, 0, 0, "", "expected a folder that `papilla optimize` wrote"}});
  Side out;
  out.name = visible(std::filesystem::absolute(path).lexically_normal().filename().string());
  if (out.name.empty()) out.name = visible(path);
  try {
    out.run = Json::parse(folder.read("run.json"));
    if (out.run.at("interrupted").get<bool>())
      throw InputError({Problem{path, 0, 0, "", "the run was interrupted: resume it first"}});
    out.study = read_study(folder.file("resolved.toml"));
    out.objectives = StudyProblem(out.study).objectives();
    for (const Json& f : out.finalists()) {
      if (f.at("values").size() != out.study.variables.size() ||
          (f.at("confirmed").at("ok").get<bool>() &&
           f.at("confirmed").at("values").size() != out.objectives.size()))
        throw InputError({Problem{path + "/run.json", 0, 0, "finalists",
                                  "are not of the study in resolved.toml"}});
    }
  } catch (const Json::exception&) {
    throw InputError({Problem{path + "/run.json", 0, 0, "",
                              "is not as this version writes it: run the study again"}});
  }
  return out;
}

std::string value_text(Node node) {
  node.comment.clear();
  Node table = table_node();
  table.set("x", std::move(node));
  const std::string text = write_toml(table);
  return text.substr(std::string("x = ").size(), text.find('\n') - std::string("x = ").size());
}

void flatten(const std::string& prefix, const Node& node, std::map<std::string, std::string>& out) {
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const Node& child = node.children[i];
    const std::string path =
        prefix + (prefix.empty() ? "" : ".") + (node.is_array() ? std::to_string(i) : child.key);
    const bool tables = child.is_array() && !child.children.empty() &&
                        std::all_of(child.children.begin(), child.children.end(),
                                    [](const Node& item) { return item.is_table(); });
    if (child.is_table() || tables)
      flatten(path, child, out);
    else
      out[path] = value_text(child);
  }
}

std::map<std::string, std::string> settings_of(const Side& side) {
  std::map<std::string, std::string> out;
  flatten("", parse_toml(resolved_toml(side.study), "resolved.toml"), out);
  return out;
}

std::string settings_table(const Side& first, const Side& second) {
  const auto a = settings_of(first), b = settings_of(second);
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& key) {
    const auto in = [&](const std::map<std::string, std::string>& all) {
      const auto found = all.find(key);
      return found == all.end() ? std::string("not set") : visible(found->second);
    };
    if (in(a) != in(b)) rows.push_back({visible(key), in(a), in(b)});
  };
  for (const auto& [key, value] : a) add(key);
  for (const auto& [key, value] : b) {
    if (!a.contains(key)) add(key);
  }
  if (rows.empty()) return "Nothing: both runs have the same settings.\n";
  std::string out = markdown_head({"setting", first.name, second.name});
  for (std::size_t i = 0; i < std::min(rows.size(), kMostSettings); ++i)
    out += markdown_row(rows[i]);
  if (rows.size() > kMostSettings)
    out += fmt::format("\n{} more settings differ.\n", rows.size() - kMostSettings);
  return out;
}

struct Common {
  StudyObjective objective;
  std::size_t first = 0, second = 0;  // places among the objectives of each side
};

std::vector<Common> common_objectives(const Side& first, const Side& second) {
  std::vector<Common> out;
  for (std::size_t i = 0; i < first.objectives.size(); ++i) {
    for (std::size_t k = 0; k < second.objectives.size(); ++k) {
      const StudyObjective &a = first.objectives[i], &b = second.objectives[k];
      if (a.name == b.name && a.maximise == b.maximise) out.push_back({a, i, k});
    }
  }
  if (out.empty())
    throw InputError("the runs have no objective in common: there is nothing to compare");
  return out;
}

enum class CommonSkins { None, Some, All };

// On which skins both runs judged their designs: these are drawn by the seed of the search, of the
// fingers' numbers, as many as the accuracy and the number of tasks ask for; where the time of a
// run is limited it may give up skins and pixels.
CommonSkins common_skins(const Study& a, const Study& b) {
  const auto alike = [](Finger one, Finger other) {
    one.belief.clear(), other.belief.clear();  // where a file lies is no number of the skin
    return one == other;
  };
  const bool drawn_alike = a.search.seed == b.search.seed &&
                           alike(a.design.finger, b.design.finger) &&
                           std::equal(a.population.begin(), a.population.end(),
                                      b.population.begin(), b.population.end(), alike);
  if (!drawn_alike) return CommonSkins::None;
  const auto scenarios = [](const Study& study) {  // that are tasks
    const auto counted = std::count_if(study.scenarios.begin(), study.scenarios.end(),
                                       [](const Scenario& s) { return s.weight > 0; });
    return study.scenarios.empty() ? 1 : counted;
  };
  const bool as_many = a.design.accuracy == b.design.accuracy && scenarios(a) == scenarios(b) &&
                       a.scatter.size() == b.scatter.size() && a.search.time == 0 &&
                       b.search.time == 0;
  return as_many ? CommonSkins::All : CommonSkins::Some;
}

// What ± of a difference is made of.
std::string errors_text(const Side& first, const Side& second) {
  switch (common_skins(first.study, second.study)) {
    case CommonSkins::All:
      return "Both runs have the same seed, accuracy and fingers: their designs were judged on "
             "the same skins, and what these do to both alike is not in the difference. So its "
             "±, of standard errors that add in squares, is an upper bound: more may be apart "
             "than is said. Apart: by more than two of it.";
    case CommonSkins::Some:
      return "Both runs have the same seed and fingers, but perhaps not as many skins and pixels "
             "(by their accuracy, scenarios, scatter, or a limit on their time): their designs "
             "were judged on partly the same skins, and some of what these do to both alike is "
             "not in the difference. Its ± is of standard errors that add in squares: more may be "
             "apart than is said. Apart: by more than two of it.";
    case CommonSkins::None:
      break;
  }
  return "The runs are independent: their standard errors add in squares. Apart: by more than two "
         "of them.";
}

double number(const Json& finalist, const char* what, std::size_t place) {
  const Json& all = finalist.at("confirmed").at(what);
  return place < all.size() && all[place].is_number() ? all[place].get<double>()
                                                      : std::numeric_limits<double>::quiet_NaN();
}

std::string recommended_table(const Side& first, const Side& second,
                              const std::vector<Common>& common) {
  const Json *a = first.recommended(), *b = second.recommended();
  if (!a && !b)
    return fmt::format("Neither {} nor {} recommends a design of its front.\n", first.name,
                       second.name);
  if (!a || !b)
    return fmt::format("{} recommends no design of its front.\n", (a ? second : first).name);
  std::string out =
      markdown_head({"objective", first.name, second.name, second.name + " less " + first.name});
  for (const Common& c : common) {
    const double va = number(*a, "values", c.first), vb = number(*b, "values", c.second),
                 ea = number(*a, "errors", c.first), eb = number(*b, "errors", c.second);
    const MetricExpression& e = c.objective.expression;
    const std::string unit = shown_unit(e).unit;
    const auto text = [&](double value, double error, bool sign) {
      return shown_with_error(e, value, error, sign) + (unit.empty() ? "" : " " + unit);
    };
    const double error = std::hypot(ea, eb);
    const bool apart = std::abs(vb - va) > 2 * error;
    const bool better = (vb > va) == c.objective.maximise;
    // On the same skins one design has one number, which no error tells from itself.
    const bool same = va == vb && common_skins(first.study, second.study) == CommonSkins::All;
    out += markdown_row({c.objective.name, text(va, ea, false), text(vb, eb, false),
                         same ? std::string("none: the same number")
                              : text(vb - va, error, true) + (!apart   ? ", not told apart"
                                                              : better ? ", better"
                                                                       : ", worse")});
  }
  std::vector<std::string> paths;
  const auto shown = [](const Side& side, const Json& finalist, const std::string& path) {
    for (std::size_t i = 0; i < side.study.variables.size(); ++i) {
      if (side.study.variables[i].path == path)
        return variable_text(side.study.variables[i], finalist.at("values")[i].get<double>());
    }
    return std::string("as in its study");
  };
  for (const Side* side : {&first, &second}) {
    for (const Variable& v : side->study.variables) {
      if (std::find(paths.begin(), paths.end(), v.path) == paths.end()) paths.push_back(v.path);
    }
  }
  for (const std::string& path : paths)
    out += markdown_row({path, shown(first, *a, path), shown(second, *b, path), ""});
  return out;
}

bool on_front(const Json& finalist) {
  return finalist.at("folder").get<std::string>().starts_with("front/");
}

// Of the common objectives, minimised.
std::vector<std::vector<double>> front_points(const Side& side, const std::vector<Common>& common,
                                              std::size_t Common::*place) {
  std::vector<std::vector<double>> out;
  for (const Json& f : side.finalists()) {
    if (!on_front(f)) continue;
    std::vector<double> point;
    for (const Common& c : common) {
      const double v = number(f, "values", c.*place);
      point.push_back(c.objective.maximise ? -v : v);
    }
    out.push_back(std::move(point));
  }
  return out;
}

// How much of what both fronts reach together each reaches alone, of two objectives or more.
std::string reach_text(const Side& first, const Side& second, const std::vector<Common>& common) {
  const auto a = front_points(first, common, &Common::first),
             b = front_points(second, common, &Common::second);
  if (a.empty() && b.empty())
    return fmt::format("Neither {} nor {} has a front.\n", first.name, second.name);
  if (a.empty() || b.empty())
    return fmt::format("{} has no front.\n", (a.empty() ? first : second).name);
  auto all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::vector<double> worst = all[0], best = all[0];
  for (const auto& point : all) {
    for (std::size_t k = 0; k < worst.size(); ++k) {
      worst[k] = std::max(worst[k], point[k]);
      best[k] = std::min(best[k], point[k]);
    }
  }
  // A tenth of the range beyond the worst, so that the ends of a front count too.
  for (std::size_t k = 0; k < worst.size(); ++k) worst[k] += 0.1 * (worst[k] - best[k]);
  const double whole = hypervolume(all, worst);
  if (!(whole > 0))
    return "There is no hypervolume to compare: in one of the objectives all designs of both "
           "fronts have the same number.\n";
  return fmt::format(
      "Of the hypervolume that both fronts reach together, {} reaches {:.0f} % and {} {:.0f} % "
      "(reference: a tenth of the range beyond the worst of both).\n",
      first.name, 100 * hypervolume(a, worst) / whole, second.name,
      100 * hypervolume(b, worst) / whole);
}

SvgSeries front_series(const Side& side, const std::vector<Common>& common,
                       std::size_t Common::*place, const char* colour) {
  SvgSeries out{.name = side.name, .colour = colour, .x = {}, .y = {}, .ex = {}, .ey = {}};
  out.radius = 4.5;
  const auto shown = [&](const Json& finalist, const char* what, const Common& of) {
    return shown_unit(of.objective.expression).scale * number(finalist, what, of.*place);
  };
  for (const Json& f : side.finalists()) {
    if (!on_front(f)) continue;
    out.x.push_back(shown(f, "values", common[1]));
    out.ex.push_back(shown(f, "errors", common[1]));
    out.y.push_back(shown(f, "values", common[0]));
    out.ey.push_back(shown(f, "errors", common[0]));
  }
  return out;
}

std::string fronts_svg(const Side& first, const Side& second, const std::vector<Common>& common) {
  const auto axis = [](const StudyObjective& o) {
    return name_with_unit(o.name, shown_unit(o.expression).unit);
  };
  return svg_picture(
      {{.title = "both fronts, confirmed",
        .x = axis(common[1].objective),
        .y = axis(common[0].objective),
        .series = {front_series(first, common, &Common::first, kSideColours[0]),
                   front_series(second, common, &Common::second, kSideColours[1])}}});
}

std::string said(const Side& side) {
  return fmt::format("**{}** ({}): {}\n\n", side.name,
                     counted(side.run.value("evaluations", 0), "evaluation"),
                     visible(side.run.value("recommendation", "it recommends nothing.")));
}

std::string markdown(const Side& first, const Side& second, const std::vector<Common>& common) {
  return fmt::format("# {} and {}\n\n", first.name, second.name) + "## What each recommends\n\n" +
         said(first) + said(second) + recommended_table(first, second, common) + "\n" +
         errors_text(first, second) + "\n" +
         (common.size() < 2 ? "" : "\n## Their fronts\n\n" + reach_text(first, second, common)) +
         "\n## What was asked differently\n\n" + settings_table(first, second);
}

}  // namespace

std::string comparison_markdown(const std::string& first, const std::string& second) {
  const Side a = side_of(first), b = side_of(second);
  return markdown(a, b, common_objectives(a, b));
}

std::string comparison_page(const std::string& first, const std::string& second) {
  const Side a = side_of(first), b = side_of(second);
  const std::vector<Common> common = common_objectives(a, b);
  std::string body = markdown_html(markdown(a, b, common));
  if (common.size() > 1) {
    const std::size_t at = body.find("<h2>What was asked differently");
    body.insert(at == std::string::npos ? body.size() : at,
                "<figure>" + fronts_svg(a, b, common) + "</figure>\n");
  }
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'\">\n<title>" +
         markup_text(a.name + " and " + b.name) + "</title>\n<style>" + std::string(kPageStyle) +
         "</style></head>\n<body><header><p class=\"kicker\">Papilla report: two runs</p><h1>" +
         markup_text(a.name + " and " + b.name) + "</h1></header>\n<main>\n" + body +
         "</main></body></html>\n";
}

}  // namespace papilla::report
