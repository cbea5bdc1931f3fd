#include "report/front.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/folder.h"
#include "metrics/shown.h"
#include "report/svg.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

SvgSeries points(const char* name, const char* colour, double radius) {
  SvgSeries s{.name = name, .colour = colour, .x = {}, .y = {}, .ex = {}, .ey = {}};
  s.radius = radius;
  return s;
}

// What people read the objectives in, by their columns, as the run said it: a run that did not has
// them in SI.
std::map<std::string, ShownUnit> shown_units(const Folder& root) {
  std::map<std::string, ShownUnit> out;
  if (!root.has("run.json")) return out;
  const auto run = nlohmann::ordered_json::parse(root.read("run.json"), nullptr, false);
  if (!run.is_object() || !run.contains("shown") || !run["shown"].is_object()) return out;
  for (const auto& [name, unit] : run["shown"].items()) {
    if (unit.is_object() && unit.contains("scale") && unit["scale"].is_number() &&
        unit.contains("unit") && unit["unit"].is_string())
      out[csv_cell(name)] = {unit["scale"].get<double>(), unit["unit"].get<std::string>()};
  }
  return out;
}

void scale_all(std::vector<double>& values, double by) {
  for (double& v : values) v *= by;
}

// The confirmed designs that are, or are not, on the front.
SvgSeries confirmed(const CsvTable& front, const std::string& x, const std::string& y,
                    bool on_front) {
  SvgSeries s = on_front ? points("front, confirmed", "#1f6f9f", 4.5)
                         : points("confirmed, dominated", "#7a4fa3", 4.5);
  const std::vector<std::string> flags = front.texts("on front");
  const auto take = [&](const std::string& name, std::vector<double>& to) {
    const std::vector<double> all = front.numbers(name);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((flags[i] == "yes") == on_front) to.push_back(all[i]);
    }
  };
  take(x, s.x);
  take(y, s.y);
  take(x + " se", s.ex);
  take(y + " se", s.ey);
  return s;
}

}  // namespace

std::string front_svg(const std::string& folder) {
  const Folder root(folder);
  const CsvTable front = read_csv(root, "pareto.csv");
  std::vector<std::string> objectives;
  for (const std::string& name : front.header) {
    if (front.has(name + " se")) objectives.push_back(name);
  }
  if (objectives.size() < 2)
    throw InputError(folder + "/pareto.csv: a picture of a front needs two objectives");
  std::optional<CsvTable> history;
  if (root.has("history.csv")) history = read_csv(root, "history.csv");
  std::map<std::string, ShownUnit> shown = shown_units(root);
  std::vector<SvgPlot> plots;
  for (std::size_t k = 1; k < objectives.size(); ++k) {
    const std::string &x = objectives[k], &y = objectives[0];
    SvgPlot plot{.title = y + " against " + x,
                 .x = name_with_unit(x, shown[x].unit),
                 .y = name_with_unit(y, shown[y].unit),
                 .series = {}};
    if (history && history->has(x) && history->has(y)) {
      SvgSeries searched = points("searched", "#b9c0ca", 2.5);
      searched.x = history->numbers(x);
      searched.y = history->numbers(y);
      plot.series.push_back(std::move(searched));
    }
    for (const bool on_front : {false, true}) {
      SvgSeries s = confirmed(front, x, y, on_front);
      if (!s.x.empty()) plot.series.push_back(std::move(s));
    }
    for (SvgSeries& s : plot.series) {
      for (auto* values : {&s.x, &s.ex}) scale_all(*values, shown[x].scale);
      for (auto* values : {&s.y, &s.ey}) scale_all(*values, shown[y].scale);
    }
    plots.push_back(std::move(plot));
  }
  return svg_picture(plots);
}

}  // namespace papilla::report
