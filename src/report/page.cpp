#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/sha256.h"
#include "base/text.h"
#include "design/study.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "rank/rank.h"
#include "report/svg.h"
#include "search/pick.h"

namespace papilla {

// The files of src/report/page and the two libraries, embedded at build time.
extern const std::string_view kPageHtml, kPageStyle, kPageScript, kChartScript, kThreeScript;
extern const std::string_view kOptimizeHtml, kOptimizeScript, kRankHtml, kRankScript;
extern const std::string_view kCalibrateHtml, kCalibrateScript;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kPicturePixels = 128;  // across one picture, at most

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    unsigned v = 0;
    for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= left ? kDigits[v >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// Values as bytes between low and high, averaged down to kPicturePixels.
Json picture(const Grid& grid, const std::vector<double>& values) {
  const int step = std::max(1, (std::max(grid.nx, grid.ny) + kPicturePixels - 1) / kPicturePixels);
  const int nx = grid.nx / step, ny = grid.ny / step;
  std::vector<double> mean;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      double sum = 0;
      for (int k = 0; k < step * step; ++k)
        sum += values[grid.index(x * step + k % step, y * step + k / step)];
      mean.push_back(sum / (step * step));
    }
  }
  const auto [low, high] = std::minmax_element(mean.begin(), mean.end());
  const double span = *high - *low;
  std::vector<std::uint8_t> bytes;
  for (double v : mean) {
    bytes.push_back(span > 0 ? static_cast<std::uint8_t>(std::lround(255 * (v - *low) / span)) : 0);
  }
  return {
      {"nx", nx},    {"ny", ny},      {"lx", nx * step * grid.dx()}, {"ly", ny * step * grid.dy()},
      {"low", *low}, {"high", *high}, {"bytes", base64(bytes)}};
}

// What the charts need of a response.
Json trimmed(const Json& response) {
  Json points = Json::array();
  for (const Json& p : response.at("points")) {
    Json point;
    for (const char* key : {"relative_humidity", "weight", "F_off", "F_on", "modulation",
                            "capillary_force", "electrostatic_force", "status"}) {
      point[key] = p.at(key);
    }
    points.push_back(std::move(point));
  }
  return points;
}

Json design_json(const fs::path& folder, bool with_flat) {
  const Json metrics = Json::parse(read_bytes(folder / "metrics.json"));
  Json out;
  for (const char* key : {"variables", "objectives", "worst_modulation", "oxide_breakdown_margin",
                          "feasible", "stability", "flat", "parameters"}) {
    if (metrics.contains(key)) out[key] = metrics[key];
  }
  out["tasks"] = Json::array();
  for (const Json& task : metrics.at("tasks")) {
    Json t{{"name", task.at("name")}, {"points", trimmed(task.at("response"))}};
    if (with_flat && task.contains("flat")) t["flat"] = trimmed(task["flat"]);
    out["tasks"].push_back(std::move(t));
  }
  if (with_flat) {
    const Json& response = metrics["tasks"][0]["response"];
    out["plan"] = response.at("plan");
  }
  out["toml"] = read_bytes(folder / "design.toml");
  const Heightmap h = read_heightmap(folder / "heightmap.gsf");
  out["heights"] = picture(h.grid, h.z);
  return out;
}

Json field_json(const Design& design) {
  Json out = Json::array();
  for (const double humidity : design.environment.relative_humidity) {
    const PatchPicture patch =
        picture_patch(scene_of(design), design.texture, fidelity_of(design), humidity);
    const Grid& grid = patch.texture.grid;
    Json maps = Json::array();
    const auto add = [&](const char* name, const char* unit, double scale,
                         std::vector<double> values) {
      if (values.size() != grid.size()) return;
      for (double& v : values) v *= scale;
      Json map = picture(grid, values);
      map["name"] = name;
      map["unit"] = unit;
      maps.push_back(std::move(map));
    };
    add("gap, drive off", "nm", 1e9, patch.fields.off.gap);
    add("contact pressure, drive off", "MPa", 1e-6, patch.fields.off.pressure);
    if (design.drive.driven()) {
      add("contact pressure, drive on", "MPa", 1e-6, patch.fields.on.pressure);
      add("pull of the field", "MPa", 1e-6, patch.fields.pull.value);
    }
    const auto& water = patch.fields.wetting_off.bridged;
    add("water that bridges the gap", "", 1, std::vector<double>(water.begin(), water.end()));
    out.push_back({{"relative_humidity", humidity}, {"maps", maps}});
  }
  return out;
}

Json file_list(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).generic_string();
    // The page itself, the lock, and what holds clock times.
    if (!entry.is_regular_file() || name == "report.html" || name == "timing.json" ||
        name.front() == '.') {
      continue;
    }
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  Json out = Json::array();
  for (const std::string& name : names) {
    const std::string bytes = read_bytes(folder / name);
    out.push_back({{"name", name}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}});
  }
  return out;
}

// No text of a design can end the script element that holds the numbers.
std::string script_text(std::string text) {
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return text;
}

// A CSV table of one line a row without quoted cells, as `papilla optimize` writes.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  bool has(const std::string& name) const {
    return std::find(names.begin(), names.end(), name) != names.end();
  }
  std::vector<std::string> texts(const std::string& name) const {
    const auto column =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    std::vector<std::string> out;
    for (const auto& row : rows) out.push_back(column < row.size() ? row[column] : "");
    return out;
  }
  // NaN where a cell is no number.
  std::vector<double> numbers(const std::string& name) const {
    std::vector<double> out;
    for (const std::string& cell : texts(name)) {
      char* end = nullptr;
      const double v = std::strtod(cell.c_str(), &end);
      out.push_back(end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : v);
    }
    return out;
  }
};

Columns read_columns(const fs::path& file) {
  Columns out;
  for (const std::string& line : split(read_bytes(file), '\n')) {
    if (line.empty() || line.front() == '#') continue;
    if (out.names.empty())
      out.names = split(line, ',');
    else
      out.rows.push_back(split(line, ','));
  }
  return out;
}

// The headings, paragraphs and tables of Markdown as this program writes it.
std::string plain_html(const std::string& markdown) {
  std::string out;
  bool in_table = false;
  for (std::string line : split(markdown, '\n')) {
    for (const char* mark : {"**", "`"}) {
      for (std::size_t at = 0; (at = line.find(mark, at)) != std::string::npos;)
        line.erase(at, std::string_view(mark).size());
    }
    const bool row = line.starts_with('|');
    if (in_table != row) out += row ? "<div class=\"scroll\"><table>\n" : "</table></div>\n";
    const bool first = row && !in_table;
    in_table = row;
    if (line.empty() || line.starts_with("# ") || line.starts_with("|-")) continue;
    if (line.starts_with("## ")) {
      out += "<h2>" + markup_text(line.substr(3)) + "</h2>\n";
    } else if (!row) {
      out += "<p>" + markup_text(line) + "</p>\n";
    } else {
      std::vector<std::string> cells = split(line.substr(1), '|');
      if (!cells.empty()) cells.pop_back();
      out += "<tr>";
      for (const std::string& cell : cells)
        out.append(first ? "<th>" : "<td>")
            .append(markup_text(cell))
            .append(first ? "</th>" : "</td>");
      out += "</tr>\n";
    }
  }
  return out + (in_table ? "</table></div>\n" : "");
}

// What a browser without scripts shows in place of the sections that they fill.
std::string without_scripts(const fs::path& folder) {
  std::string text;
  for (const char* name : {"summary.md", "fit.md"}) {
    if (fs::exists(folder / name)) text = plain_html(read_bytes(folder / name));
  }
  if (fs::exists(folder / "ranking.txt"))
    text = "<pre>" + markup_text(read_bytes(folder / "ranking.txt")) + "</pre>\n";
  return "<noscript><style>main > section, nav, .choice, #lead { display: none; }</style>\n" +
         text + "</noscript>\n";
}

// One kind of page: what it holds beside the common frame.
struct PageKind {
  std::string_view body, script, solid;
};

// `data` gets the version and the list of the folder's files, as every page has them.
std::string page_text(const fs::path& folder, std::string title, const PageKind& kind, Json data) {
  if (title.empty()) title = fs::absolute(folder).lexically_normal().filename().string();
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
  put("{{data}}", script_text(data.dump()));
  put("{{three}}", kind.solid);
  put("{{chart}}", kChartScript);
  put("{{body}}", kind.body);
  put("{{plain}}", without_scripts(folder));
  put("{{heading}}", markup_text(title));
  put("{{style}}", kPageStyle);
  put("{{title}}", markup_text(title));
  return page;
}

Json parsed(const fs::path& file) {
  try {
    return Json::parse(read_bytes(file));
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{} is damaged: {}", file.string(), e.what()));
  }
}

// A finished `papilla optimize`; `design` is the folder of the one the page is about.
std::string optimize_page(const fs::path& root, const fs::path& design) {
  for (const char* name : {"pareto.csv", "history.csv", "plan.txt", "summary.md",
                           "best/metrics.json", "best/design.toml", "best/heightmap.gsf"}) {
    if (!fs::exists(root / name)) {
      throw InputError(fmt::format("{} has no {}: not the folder of a finished `papilla optimize`",
                                   root.string(), name));
    }
  }
  Json data = Json::object(), designs = Json::object();
  std::vector<std::string> front;
  if (fs::exists(root / "front")) {
    for (const auto& entry : fs::directory_iterator(root / "front"))
      front.push_back("front/" + entry.path().filename().string());
  }
  std::sort(front.begin(), front.end());
  std::string title;
  try {
    title = parsed(design / "metrics.json").at("title").get<std::string>();
    designs["best"] = design_json(design, true);
    for (const std::string& name : front) designs[name] = design_json(root / name, false);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: metrics.json is damaged: {}", root.string(), e.what()));
  }
  data["designs"] = std::move(designs);
  data["fields"] = field_json(read_study((design / "design.toml").string()).design);
  data["pareto"] = read_bytes(root / "pareto.csv");
  data["history"] = read_bytes(root / "history.csv");
  data["plan"] = read_bytes(root / "plan.txt");
  data["summary"] = read_bytes(root / "summary.md");
  return page_text(root, title, {kOptimizeHtml, kOptimizeScript, kThreeScript}, std::move(data));
}

std::string rank_page(const fs::path& root) {
  Json ranking = parsed(root / "ranking.json"), candidates = Json::array();
  std::vector<std::string> names;
  try {
    names.resize(ranking.at("candidates").size());
    for (const Json& c : ranking["candidates"])
      names.at(c.at("index").get<std::size_t>()) = c.at("name").get<std::string>();
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: ranking.json is damaged: {}", root.string(), e.what()));
  }
  ranking.erase("seconds");
  ranking.erase("candidates");  // the first of the states again
  for (std::size_t i = 0; i < names.size(); ++i) {
    const fs::path file = root / ranked_design_file(i, 0);
    const Texture texture = read_design(file.string()).texture;
    const Heightmap h = generate(texture, patch_grid(texture, kPicturePixels));
    candidates.push_back(
        {{"name", names[i]}, {"toml", read_bytes(file)}, {"heights", picture(h.grid, h.z)}});
  }
  return page_text(root, "", {kRankHtml, kRankScript, ""},
                   {{"ranking", std::move(ranking)}, {"candidates", std::move(candidates)}});
}

std::string calibrate_page(const fs::path& root) {
  Json fit = parsed(root / "fit.json");
  if (!fit.contains("check_skins") || !fit.contains("parameters")) {
    throw InputError(root.string() +
                     ": fit.json is of another version; run `papilla calibrate` again");
  }
  std::string title = fit.value("title", "");
  return page_text(root, title, {kCalibrateHtml, kCalibrateScript, ""}, {{"fit", std::move(fit)}});
}

}  // namespace

std::string report_page(const std::string& folder, const std::string& pick) {
  const fs::path root(folder);
  const bool ranked = fs::exists(root / "ranking.json"), fitted = fs::exists(root / "fit.json");
  if (!ranked && !fitted)
    return optimize_page(root, fs::path(picked_design_file(folder, pick)).parent_path());
  if (!pick.empty()) throw InputError("--pick is for a folder of `papilla optimize`");
  return ranked ? rank_page(root) : calibrate_page(root);
}

std::string front_svg(const std::string& folder) {
  const fs::path root(folder);
  const Columns front = read_columns(root / "pareto.csv");
  std::vector<std::string> objectives;
  for (const std::string& name : front.names) {
    if (front.has(name + " se")) objectives.push_back(name);
  }
  if (objectives.size() < 2)
    throw InputError(folder + "/pareto.csv: a picture of a front needs two objectives");
  const bool searched = fs::exists(root / "history.csv");
  const Columns history = searched ? read_columns(root / "history.csv") : Columns{};
  std::vector<SvgPlot> plots;
  for (std::size_t k = 1; k < objectives.size(); ++k) {
    const std::string &x = objectives[k], &y = objectives[0];
    SvgPlot plot{.title = y + " against " + x, .x = x, .y = y, .series = {}};
    if (searched && history.has(x) && history.has(y)) {
      plot.series.push_back({.name = "searched",
                             .colour = "#b9c0ca",
                             .x = history.numbers(x),
                             .y = history.numbers(y),
                             .ex = {},
                             .ey = {},
                             .radius = 2.5});
    }
    for (const bool on_front : {false, true}) {
      SvgSeries s{.name = on_front ? "front, confirmed" : "confirmed, dominated",
                  .colour = on_front ? "#1f6f9f" : "#7a4fa3",
                  .x = {},
                  .y = {},
                  .ex = {},
                  .ey = {},
                  .radius = 4.5};
      const auto take = [&](const std::string& name, std::vector<double>& to) {
        const std::vector<double> all = front.numbers(name);
        const std::vector<std::string> flags = front.texts("on front");
        for (std::size_t i = 0; i < all.size(); ++i) {
          if ((flags[i] == "yes") == on_front) to.push_back(all[i]);
        }
      };
      take(x, s.x);
      take(y, s.y);
      take(x + " se", s.ex);
      take(y + " se", s.ey);
      if (!s.x.empty()) plot.series.push_back(std::move(s));
    }
    plots.push_back(std::move(plot));
  }
  return svg_picture(plots);
}

}  // namespace papilla
