#include "measure/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "base/statistics.h"
#include "estimate/target.h"
#include "metrics/metrics.h"

namespace papilla {
namespace {

struct Quantity {
  const char* name;
  Summary summary;
  const char* metric;
};
constexpr std::array<Quantity, 6> kQuantities{
    {{"modulation", Summary::Mean, "modulation"},
     {"variation", Summary::Variation, "modulation"},
     {"friction", Summary::Mean, "friction"},
     {"contact_area", Summary::Mean, "contact_area"},
     {"capillary_force", Summary::Mean, "capillary_force"},
     {"pull", Summary::Mean, "electrostatic_force"}}};

double pair_work(const Fidelity& f) {
  const double n = square(static_cast<double>(f.grid)), unit = 65536;
  return n * std::log2(n) / (unit * 16);
}

class Sweeper {
 public:
  Sweeper(const Design& design, const AccuracyOptions& options)
      : design_(design), scene_(scene_of(design)), options_(options) {
    base_ = fidelity_level("design");
    base_.grid = options.grid;
    base_.skins = options.skins;
    base_.threads = options.threads;
  }

  std::vector<AccuracyRow> run() {
    for (int grid = 32; grid <= options_.finest; grid *= 2) {
      Fidelity f = base_;
      f.grid = grid;
      add("grid", fmt::format("{} pixels", grid), scene_, f);
    }
    compare("grid");
    for (int skins : {4, 8, 16, 32, 64, 128}) {
      Fidelity f = base_;
      f.skins = skins;
      add("skins", fmt::format("{} skins", skins), scene_, f);
    }
    compare("skins");
    for (int seed = 1; seed <= 6; ++seed) {
      Fidelity f = base_;
      f.seed = static_cast<std::uint64_t>(seed);
      add("seed", fmt::format("seed {}", seed), scene_, f);
    }
    compare("seed", true);
    for (double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8}) {
      Fidelity f = base_;
      f.contact_tolerance = tolerance;
      add("tolerance", fmt::format("{:.0e}", tolerance), scene_, f);
    }
    compare("tolerance");
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
      Fidelity f = base_;
      f.field_tolerance = tolerance;
      add("field", fmt::format("{:.0e}", tolerance), scene_, f);
    }
    compare("field");
    Fidelity load = base_;
    load.estimator = Estimator::Load;
    add("estimator", "load law", scene_, load);
    add("estimator", "solved areas", scene_, base_);
    compare("estimator");
    model();
    if (options_.levels) levels();
    return std::move(rows_);
  }

 private:
  // What the options of [model] move, each against the scene's own; few skins, as the 3-D field is
  // slow.
  void model() {
    Fidelity f = base_;
    f.skins = std::min(base_.skins, 4);
    f.control_skins = 0;
    const auto with = [&](const char* name, const auto& change) {
      Scene scene = scene_;
      change(scene.model);
      if (scene.model != scene_.model) add("model", name, scene, f);
    };
    with("water = threshold", [](ModelOptions& m) { m.water = WaterModel::Threshold; });
    with("field = local", [](ModelOptions& m) { m.field = FieldMethod::Local; });
    with("field = spread", [](ModelOptions& m) { m.field = FieldMethod::Spread; });
    with("field = full", [](ModelOptions& m) { m.field = FieldMethod::Full; });
    with("coupling = self_consistent",
         [](ModelOptions& m) { m.coupling = Coupling::SelfConsistent; });
    with("closure = persson", [](ModelOptions& m) { m.closure = Closure::Persson; });
    with("breakdown_cap", [](ModelOptions& m) { m.breakdown_cap = !m.breakdown_cap; });
    with("no droplet_enhancement", [](ModelOptions& m) { m.droplet_enhancement = false; });
    add("model", "as in the file", scene_, f);
    compare("model");
  }

  void levels() {
    for (const char* name : {"search", "draft", "design"}) level(name);
    const TargetOptions options{.target = 0.05, .threads = options_.threads};
    note("level: target 5 %");
    push("level", "target 5 %", evaluate_to_target(scene_, design_.texture, options));
    level("reference");
    compare("level");
  }

  void level(const char* name) {
    Fidelity f = fidelity_level(name);
    f.threads = options_.threads;
    add("level", name, scene_, f);
  }

  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }

  void add(const std::string& sweep, const std::string& setting, const Scene& scene,
           const Fidelity& fidelity) {
    note(sweep + ": " + setting);
    push(sweep, setting, evaluate(scene, design_.texture, fidelity));
  }

  void push(const std::string& sweep, const std::string& setting, const Response& r) {
    AccuracyRow row{sweep, setting, r.fidelity, {}, {}, {}, r.seconds, r.fft_pairs, 0, "ok"};
    for (const Quantity& q : kQuantities) {
      const auto v = summarise(q.summary, q.metric, r);
      row.value.push_back(v ? v->value : std::numeric_limits<double>::quiet_NaN());
      row.stated.push_back(v ? v->se : std::numeric_limits<double>::quiet_NaN());
    }
    row.work = r.fft_pairs * pair_work(r.fidelity);
    if (const auto troubles = r.troubles(); !troubles.empty()) row.status = text(troubles);
    if (r.accuracy.target > 0) row.status = text(r.accuracy);
    rows_.push_back(std::move(row));
  }

  // Errors of a finished sweep.
  void compare(const std::string& sweep, bool against_mean = false) {
    std::vector<AccuracyRow*> rows;
    for (AccuracyRow& row : rows_) {
      if (row.sweep == sweep) rows.push_back(&row);
    }
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
      double truth = rows.back()->value[q];
      if (against_mean) {
        truth = 0;
        for (const AccuracyRow* row : rows)
          truth += row->value[q] / static_cast<double>(rows.size());
      }
      for (AccuracyRow* row : rows)
        row->error.push_back(truth == 0 ? (row->value[q] == 0 ? 0 : kInfinity)
                                        : row->value[q] / truth - 1);
    }
  }

  const Design& design_;
  Scene scene_;
  const AccuracyOptions& options_;
  Fidelity base_;
  std::vector<AccuracyRow> rows_;
};

// A CSV of this file's own writing: lines of '#' apart, no quotes.
struct Table {
  std::vector<std::string> comments, header;
  std::vector<std::vector<std::string>> rows;

  std::size_t column(const std::string& name) const {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) throw InputError("no column " + name);
    return static_cast<std::size_t>(found - header.begin());
  }
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

Table read_table(const std::string& path) {
  Table table;
  std::istringstream in(read_bytes(path));
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("# ", 0) == 0) {
      table.comments.push_back(line.substr(2));
    } else if (table.header.empty()) {
      table.header = cells(line);
    } else {
      table.rows.push_back(cells(line));
      if (table.rows.back().size() != table.header.size())
        throw InputError({Problem{path, 0, 0, "", "a row of another length than the header"}});
    }
  }
  return table;
}

std::string shown(const std::string& cell, double scale, const char* format) {
  const double v = std::strtod(cell.c_str(), nullptr);
  return cell.empty() ? "–" : fmt::format(fmt::runtime(format), scale * v);
}

const char* sweep_text(const std::string& sweep) {
  if (sweep == "grid")
    return "Pixels along the patch; same skins and droplets; error against the finest";
  if (sweep == "skins") return "Number of skins; error against the most";
  if (sweep == "seed")
    return "Other skins, offsets and droplets; error against the mean of the seeds";
  if (sweep == "tolerance") return "Certificate of the contact solver; error against the tightest";
  if (sweep == "field")
    return "Residual of the potential that spreads in the dielectric; error against the smallest";
  if (sweep == "estimator") return "Load law or solved areas; error against the latter";
  if (sweep == "model")
    return "Options of `[model]`; shift against the file's own (absorbed by the fit of the finger)";
  if (sweep == "level") return "Levels; error against reference";
  return "";
}

using Json = nlohmann::ordered_json;
Json json_number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

}  // namespace

const std::vector<std::string>& accuracy_quantities() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Quantity& q : kQuantities) out.emplace_back(q.name);
    return out;
  }();
  return names;
}

std::vector<AccuracyRow> accuracy_sweeps(const Design& design, const AccuracyOptions& options) {
  return Sweeper(design, options).run();
}

bool CoverageRow::inside() const { return std::abs(value - reference) <= half_width; }

Scene random_scene(int index, Texture& texture) {
  RandomStream random(1, "accuracy scene", static_cast<std::uint64_t>(index));
  const auto log_uniform = [&](double low, double high) {
    return low * std::pow(high / low, random.uniform());
  };
  const double period = random.uniform(3e-6, 6e-6), size = period * random.uniform(0.3, 0.6),
               depth = random.uniform(50e-9, 900e-9);
  switch (index % 4) {
    case 0:
      texture = Texture{HoleArray{.period = period, .diameter = size, .depth = depth}};
      break;
    case 1:
      texture = Texture{PillarArray{.period = period, .diameter = size, .height = depth}};
      break;
    case 2:
      texture = Texture{Grating{.period = period, .width = size, .depth = depth}};
      break;
    default:
      texture = Texture{};
  }
  Scene scene;
  Finger& finger = scene.finger;
  finger.skin.rms = random.uniform(150e-9, 350e-9);
  const double stiff = log_uniform(0.6, 1.6);
  finger.skin.layer_modulus *= stiff;
  finger.skin.bulk_modulus *= stiff;
  const double wet = log_uniform(0.3, 3);
  for (double& v : finger.water.volume) v *= wet;
  scene.surface.contact_angle = random.uniform(0.6, 1.9);
  scene.drive.amplitude = random.uniform(80, 220);
  const double low = random.uniform(0.15, 0.45);
  scene.environment.relative_humidity = {low, low + random.uniform(0.1, 0.3)};
  return scene;
}

Fidelity coverage_reference(const CoverageOptions& options) {
  Fidelity f = fidelity_level(options.tight ? "reference" : "design");
  if (!options.tight) {
    f.grid = options.finer_grid;
    f.skins = options.finer_skins;
  }
  f.threads = options.threads;
  f.first_skin = 1000;  // held out
  f.control_skins = 0;
  return f;
}

std::vector<CoverageRow> coverage(const CoverageOptions& options) {
  std::vector<CoverageRow> rows;
  for (int i = options.first; i < options.first + options.scenes; ++i) {
    Texture texture;
    const Scene scene = random_scene(i, texture);
    // Skins of its own: with common ones the luck of a few would be that of all scenes.
    const auto seed = static_cast<std::uint64_t>(i) + 1;
    const auto level = [&](const char* name) {
      Fidelity f = fidelity_level(name);
      f.threads = options.threads;
      f.seed = seed;
      return f;
    };
    Fidelity fine = coverage_reference(options);
    fine.seed = seed;
    const Response truth = evaluate(scene, texture, fine);
    const auto judge = [&](const std::string& fidelity, const Response& r) {
      for (const Quantity& q : kQuantities) {
        const auto v = summarise(q.summary, q.metric, r), t = summarise(q.summary, q.metric, truth);
        if (!v || !t) continue;  // no mean to divide by
        // The humidities are given: their quadrature is no part of this comparison.
        ErrorParts parts = v->parts;
        parts.humidity.reset();
        rows.push_back({i, texture_name(texture), fidelity, q.name, v->value, 1.96 * parts.total(),
                        t->value, t->parts.sampling, parts});
      }
    };
    const auto judge_target = [&](const char* name, double target) {
      judge(name, evaluate_to_target(scene, texture,
                                     {.target = target, .seed = seed, .threads = options.threads}));
    };
    if (options.tight) {
      judge("design", evaluate(scene, texture, level("design")));
      judge_target("target 2 %", 0.02);
    } else {
      for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
        Fidelity f = level("design");
        f.grid = options.grid;
        f.skins = options.skins;
        f.estimator = estimator;
        judge(fmt::format("{} pixels {} skins {}", f.grid, f.skins,
                          estimator == Estimator::Load ? "load law" : "solved areas"),
              evaluate(scene, texture, f));
      }
      for (const char* name : {"search", "draft"})
        judge(name, evaluate(scene, texture, level(name)));
      judge_target("target 5 %", 0.05);
    }
    if (options.note)
      options.note(fmt::format("scene {} of {}", i - options.first + 1, options.scenes));
  }
  return rows;
}

std::vector<CoverageSummary> coverage_summary(const std::vector<CoverageRow>& rows) {
  std::vector<CoverageSummary> out;
  for (const CoverageRow& first : rows) {
    const auto same = [&](const auto& r) {
      return r.fidelity == first.fidelity && r.quantity == first.quantity;
    };
    if (std::any_of(out.begin(), out.end(), same)) continue;
    std::vector<double> widths, errors;
    int inside = 0, inside_both = 0;
    double squares = 0;
    for (const CoverageRow& row : rows) {
      if (!same(row)) continue;
      widths.push_back(row.half_width);
      errors.push_back(std::abs(row.value - row.reference));
      inside += row.inside() ? 1 : 0;
      inside_both +=
          errors.back() <= std::hypot(row.half_width, 1.96 * row.reference_error) ? 1 : 0;
      squares += square(1.96 * errors.back() / row.half_width);
    }
    const auto n = static_cast<int>(widths.size());
    out.push_back({first.fidelity, first.quantity, n, static_cast<double>(inside) / n,
                   static_cast<double>(inside_both) / n, quantile(widths, 0.5),
                   quantile(errors, 0.95), std::sqrt(squares / n)});
  }
  return out;
}

std::string accuracy_csv(const std::vector<AccuracyRow>& rows, const std::string& provenance) {
  std::string out = provenance + "sweep,setting,grid,skins,estimator,tolerance";
  for (const Quantity& q : kQuantities) out += fmt::format(",{0},{0}_stated,{0}_error", q.name);
  out += ",seconds,fft_pairs,work,status\n";
  const auto number = [](double v) {
    return std::isfinite(v) ? fmt::format("{:.5g}", v) : std::string();
  };
  for (const AccuracyRow& r : rows) {
    out += fmt::format("{},{},{},{},{},{:g}", r.sweep, r.setting, r.fidelity.grid, r.fidelity.skins,
                       r.fidelity.estimator == Estimator::Load ? "load" : "area",
                       r.fidelity.contact_tolerance);
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
      out += fmt::format(",{},{},{}", number(r.value[q]), number(r.stated[q]), number(r.error[q]));
    }
    std::string status = r.status;
    std::replace(status.begin(), status.end(), ',', ';');
    out += fmt::format(",{:.3g},{:.0f},{:.1f},{}\n", r.seconds, r.fft_pairs, r.work, status);
  }
  return out;
}

std::string coverage_csv(const std::vector<CoverageRow>& rows, const std::string& provenance) {
  std::string out = provenance +
                    "scene,texture,fidelity,quantity,value,half_width,reference,reference_error,"
                    "sampling,grid,method,"
                    "solver,inside\n";
  for (const CoverageRow& r : rows) {
    out += fmt::format("{},{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.3g},{:.3g},{:.3g},{:.3g},{}\n",
                       r.scene, r.texture, r.fidelity, r.quantity, r.value, r.half_width,
                       r.reference, r.reference_error, r.parts.sampling, r.parts.grid.value_or(0),
                       r.parts.method.value_or(0), r.parts.solver.value_or(0), r.inside() ? 1 : 0);
  }
  return out;
}

std::string accuracy_json(const std::vector<AccuracyRow>& rows) {
  Json list = Json::array();
  for (const AccuracyRow& r : rows) {
    Json quantities = Json::object();
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
      quantities[kQuantities[q].name] = {{"value", json_number(r.value[q])},
                                         {"se", json_number(r.stated[q])},
                                         {"relative_error", json_number(r.error[q])}};
    }
    list.push_back({{"sweep", r.sweep},
                    {"setting", r.setting},
                    {"quantities", quantities},
                    {"seconds", r.seconds},
                    {"fft_pairs", r.fft_pairs},
                    {"work", r.work},
                    {"status", r.status}});
  }
  return Json{{"schema", 1}, {"sweeps", list}}.dump(2);
}

std::string coverage_json(const std::vector<CoverageRow>& rows) {
  Json list = Json::array();
  for (const CoverageSummary& s : coverage_summary(rows)) {
    list.push_back({{"fidelity", s.fidelity},
                    {"quantity", s.quantity},
                    {"scenes", s.scenes},
                    {"inside", json_number(s.inside)},
                    {"inside_with_reference_error", json_number(s.inside_both)},
                    {"median_half_width", json_number(s.median_half_width)},
                    {"error_quantile", json_number(s.error_quantile)},
                    {"rms_error_over_stated", json_number(s.rms_ratio)}});
  }
  return Json{{"schema", 1}, {"coverage", list}}.dump(2);
}

std::string accuracy_svg(const std::vector<AccuracyRow>& all, const std::string& sweep) {
  static constexpr const char* kColours[] = {"#1b6ca8", "#d1495b", "#555555",
                                             "#3c8d5a", "#8a5fbf", "#c98a1b"};
  std::vector<const AccuracyRow*> rows;
  for (const AccuracyRow& row : all) {
    if (row.sweep == sweep) rows.push_back(&row);
  }
  double low_x = kInfinity, high_x = 0, low_y = kInfinity, high_y = 0;
  for (const AccuracyRow* r : rows) {
    low_x = std::min(low_x, r->work);
    high_x = std::max(high_x, r->work);
    for (double e : r->error) {
      if (std::isfinite(e) && e != 0) {
        low_y = std::min(low_y, std::abs(e));
        high_y = std::max(high_y, std::abs(e));
      }
    }
  }
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"420\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"640\" height=\"420\" "
      "fill=\"white\"/>\n";
  if (!(low_y < high_y) || !(low_x < high_x)) return out + "</svg>\n";
  const double x0 = std::floor(std::log10(low_x)), x1 = std::ceil(std::log10(high_x)),
               y0 = std::floor(std::log10(low_y)), y1 = std::ceil(std::log10(high_y));
  const auto px = [&](double x) { return 70 + 400 * (std::log10(x) - x0) / (x1 - x0); };
  const auto py = [&](double y) { return 360 - 320 * (std::log10(y) - y0) / (y1 - y0); };
  for (double d = x0; d <= x1; ++d) {
    const double x = px(std::pow(10, d));
    out += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"40\" x2=\"{0:.1f}\" y2=\"360\" stroke=\"#ddd\"/>"
        "<text x=\"{0:.1f}\" y=\"376\" text-anchor=\"middle\">1e{1:.0f}</text>\n",
        x, d);
  }
  for (double d = y0; d <= y1; ++d) {
    const double y = py(std::pow(10, d));
    out += fmt::format(
        "<line x1=\"70\" y1=\"{0:.1f}\" x2=\"470\" y2=\"{0:.1f}\" stroke=\"#ddd\"/>"
        "<text x=\"62\" y=\"{0:.1f}\" text-anchor=\"end\">1e{1:.0f}</text>\n",
        y, d);
  }
  out += fmt::format(
      "<text x=\"70\" y=\"24\" font-size=\"14\">{}: relative error against work"
      "</text><text x=\"270\" y=\"400\" text-anchor=\"middle\">FFT pairs of 256 x "
      "256</text>\n",
      sweep);
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    std::string points;
    for (const AccuracyRow* r : rows) {
      if (!std::isfinite(r->error[q]) || r->error[q] == 0) continue;
      const double x = px(r->work), y = py(std::abs(r->error[q]));
      points += fmt::format("{:.1f},{:.1f} ", x, y);
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y,
                         kColours[q]);
    }
    out += fmt::format(
        "<polyline fill=\"none\" stroke=\"{0}\" stroke-width=\"1.5\" points=\"{1}\"/>"
        "<text x=\"484\" y=\"{2}\" fill=\"{0}\">{3}</text>\n",
        kColours[q], points, 60 + 20 * q, kQuantities[q].name);
  }
  return out + "</svg>\n";
}

std::vector<CoverageRow> read_coverage(const std::string& path) {
  const Table scenes = read_table(path);
  std::vector<CoverageRow> rows;
  for (const auto& row : scenes.rows) {
    const auto value = [&](const char* name) {
      return std::strtod(row[scenes.column(name)].c_str(), nullptr);
    };
    rows.push_back({static_cast<int>(value("scene")),
                    row[scenes.column("texture")],
                    row[scenes.column("fidelity")],
                    row[scenes.column("quantity")],
                    value("value"),
                    value("half_width"),
                    value("reference"),
                    value("reference_error"),
                    {}});
  }
  return rows;
}

std::string accuracy_page(const std::string& folder) {
  const Table sweeps = read_table(folder + "/sweeps.csv");
  std::string out =
      "# Speed against error\n\nMade by `papilla accuracy --render results/accuracy` from the "
      "tables "
      "there. What the parts of an error are: docs/theory/accuracy.md.\n\n";
  for (const std::string& line : sweeps.comments) out += "- " + line + "\n";
  std::string current, beyond;  // of the sweep: what its rows state too little for
  const auto end_sweep = [&] {
    if (current.empty() || current == "model") return;  // there are no errors there, but shifts
    out +=
        "\nBeyond two of the standard errors stated: " + (beyond.empty() ? "none" : beyond) + ".\n";
  };
  for (const auto& row : sweeps.rows) {
    const std::string& sweep = row[0];
    if (sweep != current) {
      end_sweep();
      beyond.clear();
      current = sweep;
      out += fmt::format(
          "\n## {}\n\n{}. Error of the value, in brackets the standard error stated "
          "beside it.\n\n![{}](../results/accuracy/{}.svg)\n\n| {} ",
          sweep, sweep_text(sweep), sweep, sweep, "setting");
      for (const Quantity& q : kQuantities) out += fmt::format("| {} ", q.name);
      out += "| mean modulation | FFT pairs | work, pairs of 256² | seconds | status |\n|---";
      for (std::size_t q = 0; q < kQuantities.size() + 5; ++q) out += "|---";
      out += "|\n";
    }
    const auto cell = [&](const std::string& name) { return row[sweeps.column(name)]; };
    const auto number = [&](const std::string& name) {
      return std::strtod(cell(name).c_str(), nullptr);
    };
    out += "| " + cell("setting") + " ";
    for (const Quantity& q : kQuantities) {
      const std::string name = q.name;
      const double value = std::abs(number(name)), stated = number(name + "_stated"),
                   error = number(name + "_error");
      out += "| " + shown(cell(name + "_error"), 100, "{:+.2f} %") + " (" +
             shown(cell(name + "_stated"), value != 0 ? 100 / value : 0, "{:.1f} %") + ") ";
      const double off = std::abs(error / (1 + error)) * value;  // value less truth
      if (off > 2 * stated) {
        beyond += fmt::format("{}{}, {} ({:.1f})", beyond.empty() ? "" : "; ", cell("setting"),
                              name, off / stated);
      }
    }
    out += fmt::format("| {} | {} | {} | {} | {} |\n", shown(cell("modulation"), 1, "{:.4f}"),
                       cell("fft_pairs"), cell("work"), cell("seconds"), cell("status"));
  }
  end_sweep();
  out += "\n## Error bars on held-out scenes\n\n";
  std::vector<CoverageSummary> rows;
  for (const char* name : {"/coverage.csv", "/coverage_tight.csv"}) {
    for (const std::string& line : read_table(folder + name).comments) out += "- " + line + "\n";
    const auto more = coverage_summary(read_coverage(folder + name));
    rows.insert(rows.end(), more.begin(), more.end());
  }
  out +=
      "\n| fidelity | quantity | scenes | reference inside the 95 % interval | with the "
      "reference's own error | median half-width | 95 % quantile of the error | ratio | error over "
      "stated standard error, rms |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const CoverageSummary& s : rows) {
    out += fmt::format(
        "| {} | {} | {} | {:.0f} % | {:.0f} % | {:.4g} | {:.4g} | {:.2f} | {:.2f} |\n", s.fidelity,
        s.quantity, s.scenes, 100 * s.inside, 100 * s.inside_both, s.median_half_width,
        s.error_quantile, s.median_half_width / s.error_quantile, s.rms_ratio);
  }
  return out;
}

}  // namespace papilla
