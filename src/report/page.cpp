#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "design/study.h"
#include "geometry/measured_map.h"
#include "geometry/texture.h"
#include "report/markup.h"
#include "report/page_data.h"
#include "report/page_parts.h"
#include "report/ranking.h"
#include "report/recommendation.h"
#include "report/sums.h"
#include "search/pick.h"
#include "search/records.h"

namespace papilla::report {

// The files of src/report/page that no other page has, embedded at build time.
extern const std::string_view kPageHtml, kPageScript;
extern const std::string_view kOptimizeHtml, kOptimizeScript, kRankHtml, kRankScript;
extern const std::string_view kCalibrateHtml, kCalibrateScript;
extern const std::string_view kUnfinishedHtml, kUnfinishedScript;

namespace {

using Json = nlohmann::ordered_json;

// What a finished run says in words, as HTML.
std::string told_by(const Folder& folder) {
  if (folder.has("ranking.txt"))
    return "<pre>" + markup_text(folder.read("ranking.txt")) + "</pre>\n";
  for (const char* name : {"fit.md", "summary.md"}) {
    if (folder.has(name)) return markdown_html(folder.read(name));
  }
  return {};
}

// What a browser without scripts shows in place of the sections that they fill.
std::string without_scripts(const std::string& text) {
  return "<noscript><style>main > section, nav, .choice, #lead, #facts { display: none; "
         "}</style>\n" +
         text + "</noscript>\n";
}

// Modules as one script: what they take of each other is there already, what they give stays
// inside.
std::string joined(const std::vector<std::string_view>& modules) {
  constexpr std::string_view kGives = "export ";
  std::string out;
  for (const std::string_view module : modules) {
    for (std::size_t begin = 0; begin < module.size();) {
      const std::size_t end = std::min(module.find('\n', begin), module.size() - 1) + 1;
      std::string_view line = module.substr(begin, end - begin);
      if (line.starts_with(kGives)) line.remove_prefix(kGives.size());
      if (!line.starts_with("import ")) out += line;
      begin = end;
    }
  }
  return out;
}

// The plots of all pages; only a page with a solid has the one for that.
std::string plots(bool solid) {
  std::vector<std::string_view> modules{kLookModule,   kNumbersModule, kTablesModule,
                                        kMapsModule,   kChartsModule,  kDimensionsModule,
                                        kCurvesModule, kFoundModule,   kParallelModule};
  if (solid) modules.push_back(kSolidModule);
  return joined(modules);
}

// What the page is made of may have been changed since the run wrote it.
std::string notice(const Folder& folder) {
  const std::vector<std::string> changed = changed_files(folder);
  if (changed.empty()) return "";
  return "<p class=\"notice\" role=\"alert\">Not as the run wrote them, or not to be read: " +
         markup_text(visible(join_names(changed))) +
         ". This page shows them as they are; it is no report of that run.</p>\n";
}

// What of the page is not about the design that was picked for it.
std::string picked_text(const Json& data) {
  if (!data.contains("picked")) return "";
  return "<p class=\"notice\" role=\"alert\">This page shows " +
         markup_text(visible(design_name(data["picked"].get<std::string>()))) +
         ", which was picked for it. The recommendation, what to build, its limits and what they "
         "rest on are of the design that the run recommends; <code>papilla optimize --resume "
         "--pick</code> makes them of another.</p>\n";
}

// One kind of page: what it holds beside the common frame.
struct PageKind {
  std::string_view body, script, solid;
};

// `data` gets the version and the list of the folder's files, as every page has them. told: what
// the page says without its scripts, as HTML.
std::string page_text(const Folder& folder, std::string title, const PageKind& kind, Json data,
                      const std::string& told) {
  if (title.empty())
    title =
        visible(std::filesystem::absolute(folder.path()).lexically_normal().filename().string());
  data["schema"] = 1;
  data["version"] = PAPILLA_VERSION;
  data["files"] = file_list(folder);
  std::string page(kPageHtml);
  const auto put = [&page](const std::string& mark, std::string_view text) {
    const std::size_t at = page.find(mark);
    page.replace(at, mark.size(), text);
  };
  // Last marks first: what is put in is never searched. The body has the marks of the heading and,
  // below it, of what is shown without scripts.
  put("{{script}}", kind.script);
  put("{{common}}", kPageScript);
  put("{{plots}}", plots(!kind.solid.empty()));
  put("{{data}}", script_text(data.dump()));
  put("{{three}}", kind.solid);
  put("{{chart}}", kChartScript);
  put("{{body}}", kind.body);
  put("{{notice}}", notice(folder) + picked_text(data));
  put("{{plain}}", without_scripts(told));
  put("{{heading}}", markup_text(title));
  put("{{style}}", kPageStyle);
  put("{{title}}", markup_text(title));
  return page;
}

Json parsed(const Folder& folder, const std::string& name) {
  try {
    return Json::parse(folder.read(name));
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{} is damaged: {}", folder.path(name), e.what()));
  }
}

// A finished `papilla optimize`; `design` is the folder of the one the page is about.
std::string optimize_page(const Folder& root, std::string design) {
  for (const char* name : {"pareto.csv", "history.csv", "plan.txt", "summary.md", "run.json",
                           "best/metrics.json", "best/design.toml", "best/heightmap.gsf"}) {
    if (!root.has(name)) {
      throw InputError(
          fmt::format("{} has no {}: not the folder of a finished `papilla optimize`{}",
                      root.path(), name, search::unfinished_hint(root)));
    }
  }
  Json data = Json::object(), designs = Json::object();
  Json run = parsed(root, "run.json");
  if (run.contains("design") && run["design"] == design) design = "best";
  if (design != "best") data["picked"] = design;
  std::vector<std::string> front;
  if (root.has_folder("front")) {
    for (const std::string& name : root.below("front").folders()) front.push_back("front/" + name);
  }
  std::string title;
  try {
    title = parsed(root, design + "/metrics.json").at("title").get<std::string>();
    designs["best"] = design_json(root.below(design), true);
    for (const std::string& name : front) designs[name] = design_json(root.below(name), false);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: metrics.json is damaged: {}", root.path(), e.what()));
  }
  data["designs"] = std::move(designs);
  data["fields"] = field_json(read_study(root.file(design + "/design.toml")).design);
  data["pareto"] = root.read("pareto.csv");
  data["history"] = root.read("history.csv");
  data["plan"] = root.read("plan.txt");
  data["summary"] = root.read("summary.md");
  data["run"] = std::move(run);
  return page_text(root, title, {kOptimizeHtml, kOptimizeScript, kThreeScript}, std::move(data),
                   told_by(root));
}

// Which part of a map that is larger a picture is of; "" where it shows all there is.
std::string shown_part(const Texture& texture, const Grid& shown) {
  const auto* alone = std::get_if<Measured3d>(&texture.kind);
  for (const ScanSource& source : facts(texture).scans) {
    const ScanChanges map = changes_of_map(source);
    const double least = 1 - 1e-9;
    if (shown.lx >= least * map.width && shown.ly >= least * map.height) continue;
    std::string where;  // of a stack, whose parts may each have their place, it is not said
    if (alone && (alone->at_x != 0 || alone->at_y != 0)) {
      where = fmt::format(" round ({:.4g}, {:.4g}) um from the middle", 1e6 * alone->at_x,
                          1e6 * alone->at_y);
    } else if (alone) {
      where = " in the middle";
    }
    return fmt::format("{:.4g} x {:.4g} um{} of its map of {:.4g} x {:.4g} um", 1e6 * shown.lx,
                       1e6 * shown.ly, where, 1e6 * map.width, 1e6 * map.height);
  }
  return {};
}

std::string rank_page(const Folder& root) {
  Json ranking = parsed(root, "ranking.json"), candidates = Json::array();
  std::vector<std::string> names, by;
  try {
    names.resize(ranking.at("candidates").size());
    for (const Json& c : ranking["candidates"])
      names.at(c.at("index").get<std::size_t>()) = c.at("name").get<std::string>();
    for (const Json& c : ranking.at("criteria")) by.push_back(c.at("metric").get<std::string>());
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: ranking.json is damaged: {}", root.path(), e.what()));
  }
  ranking.erase("seconds");
  ranking.erase("candidates");  // the first of the states again
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string file = ranked_design_file(i, 0);
    const Texture texture = read_design(root.file(file)).texture;
    const Heightmap h = generate(texture, patch_grid(texture, kPicturePixels));
    Json candidate{
        {"name", names[i]}, {"toml", root.read(file)}, {"heights", picture_json(h.grid, h.z)}};
    if (std::string shown = shown_part(texture, h.grid); !shown.empty())
      candidate["shown"] = std::move(shown);
    candidates.push_back(std::move(candidate));
  }
  const std::string title = fmt::format("{} designs by {}", names.size(), join_names(by, ", "));
  return page_text(root, title, {kRankHtml, kRankScript, ""},
                   {{"ranking", std::move(ranking)}, {"candidates", std::move(candidates)}},
                   told_by(root));
}

std::string calibrate_page(const Folder& root) {
  Json fit = parsed(root, "fit.json");
  if (!fit.contains("check_skins") || !fit.contains("parameters")) {
    throw InputError(root.path() +
                     ": fit.json is of another version; run `papilla calibrate` again");
  }
  std::string title = fit.value("title", "");
  return page_text(root, title, {kCalibrateHtml, kCalibrateScript, ""}, {{"fit", std::move(fit)}},
                   told_by(root));
}

// How far a search is that has not finished; below that its errors, each in its line.
std::string progress_text(const Json& search) {
  const std::string state = search.value("state", ""), trouble = search.value("trouble", "");
  return fmt::format(
      "Not finished: {} of {} designs were judged. The search {} {}. No design here is confirmed, "
      "none was compared with the surface without texture, and none has its tolerances yet: the "
      "report of the finished search has that.{}",
      search.value("done", 0), search.value("total", 0), state == "failed" ? "has" : "is", state,
      trouble.empty() ? "" : "\n" + trouble);
}

// What its designs are worth so far.
std::string level_text(const Json& search) {
  const Json front = search.value("front", Json::array());
  if (front.empty())
    return search.value("done", 0) > 0 ? "No design that was judged has an answer yet."
                                       : "No design was judged yet.";
  const bool feasible = search.at("points").at(front[0].get<std::size_t>()).at("feasible");
  return std::string(feasible ? "" : "No design keeps every limit yet: the nearest is shown. ") +
         "Designs at the cheap level of the search: compare them with each other only; the best "
         "look better than they are.";
}

// Its front so far, best first, as a table of Markdown; empty: none.
std::string front_table(const Json& search) {
  auto front = search.value("front", std::vector<std::size_t>{});  // as they were judged
  if (front.empty()) return {};
  const Json &objectives = search.at("objectives"), &points = search.at("points");
  const double sign = objectives.at(0).at("maximise").get<bool>() ? 1 : -1;
  const auto better = [&](std::size_t a, std::size_t b) {
    const auto first = [&](std::size_t i) {
      return points.at(i).at("objectives").at(0).get<double>();
    };
    return sign * (first(a) - first(b)) > 0;
  };
  std::stable_sort(front.begin(), front.end(), better);
  std::string out = "|";
  const auto cell = [&out](const std::string& text) { out += " " + text + " |"; };
  for (const Json& o : objectives) {
    const std::string unit = o.at("unit");
    cell(o.at("name").get<std::string>() + (unit.empty() ? "" : " [" + unit + "]"));
  }
  for (const Json& v : search.at("variables")) cell(v.at("path"));
  for (const std::size_t at : front) {
    out += "\n|";
    const Json& point = points.at(at);
    const Json& reached = point.at("objectives");  // SI; none of a design without an answer
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      const bool known = k < reached.size() && reached[k].is_number();
      cell(known
               ? significant(reached[k].get<double>() * objectives[k].at("scale").get<double>(), 3)
               : "");
    }
    for (const Json& value : point.at("values")) cell(value);
  }
  return out + "\n";
}

}  // namespace

std::string report_page(const std::string& folder, const std::string& pick) {
  const Folder root(folder);
  const bool ranked = root.has("ranking.json"), fitted = root.has("fit.json");
  if (!ranked && !fitted) return optimize_page(root, picked_design(root, pick));
  if (!pick.empty()) throw InputError("--pick is for a folder of `papilla optimize`");
  return ranked ? rank_page(root) : calibrate_page(root);
}

std::string unfinished_page(const std::string& folder, const Json& search) {
  const Folder root(folder);
  const std::string study = root.read("study.toml"), progress = progress_text(search),
                    level = level_text(search);
  const std::string told = markdown_html(progress + "\n## So far\n" + level + "\n" +
                                         front_table(search) + "## What is looked for\n") +
                           "<pre>" + markup_text(study) + "</pre>\n";
  return page_text(root, read_study(root.file("study.toml")).design.title,
                   {kUnfinishedHtml, kUnfinishedScript, ""},
                   {{"search", search}, {"study", study}, {"progress", progress}, {"level", level}},
                   told);
}

}  // namespace papilla::report
