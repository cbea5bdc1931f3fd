#include "report/front.h"

#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/folder.h"
#include "report/svg.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

SvgSeries points(const char* name, const char* colour, double radius) {
  SvgSeries s{.name = name, .colour = colour, .x = {}, .y = {}, .ex = {}, .ey = {}};
  s.radius = radius;
  return s;
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
  std::vector<SvgPlot> plots;
  for (std::size_t k = 1; k < objectives.size(); ++k) {
    const std::string &x = objectives[k], &y = objectives[0];
    SvgPlot plot{.title = y + " against " + x, .x = x, .y = y, .series = {}};
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
    plots.push_back(std::move(plot));
  }
  return svg_picture(plots);
}

}  // namespace papilla::report
