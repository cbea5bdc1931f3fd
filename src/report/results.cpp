#include "report/results.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "config/writer.h"
#include "geometry/io/files.h"
#include "report/page.h"
#include "report/response.h"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kExportPixels = 512;  // across one patch
constexpr const char* kNoBetter =
    "The best design is no better than its surface without texture: no objective gains more than "
    "the error of the difference.";

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json variable_json(const Variable& v, double value) {
  return v.is_kind() ? Json(variable_text(v, value)) : Json(value);
}

std::string csv_text(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '"' || c == '\n') c = ';';
  }
  return text;
}

// "0.612 ± 0.014 (0.051)": its own error, in brackets the one that parameters leave.
std::string with_errors(const Score& score, std::size_t k) {
  std::string out = fmt::format("{:.3f} ± {:.3f}", score.values[k], score.errors[k]);
  if (const auto parameters = parameter_error(score, k))
    out += fmt::format(" ({:.3f})", *parameters);
  return out;
}

class Writer {
 public:
  explicit Writer(const ResultFiles& files) : f_(files) {}

  void write() {
    write_bytes(f_.folder + "/history.csv", history());
    write_bytes(f_.folder + "/pareto.csv", pareto());
    std::error_code ignored;
    fs::remove_all(f_.folder + "/front", ignored);
    fs::remove_all(f_.folder + "/best", ignored);
    for (const FinalDesign& d : f_.result.finalists) {
      if (d.on_front) write_design_folder(d, f_.folder + "/" + d.folder);
    }
    if (f_.result.has_best())
      write_design_folder(f_.result.finalists[f_.result.best], f_.folder + "/best");
    write_bytes(f_.folder + "/sensitivity.json", sensitivity());
    write_bytes(f_.folder + "/summary.md", summary());
  }

 private:
  std::string variable_header() const {
    std::string out;
    for (const Variable& v : f_.study.variables) {
      out += "," + v.path + (v.unit.empty() ? "" : " [" + v.unit + "]");
    }
    return out;
  }
  std::string variable_values(const Point& unit) const {
    std::string out;
    const std::vector<double> values = f_.problem.space().value(unit);
    for (std::size_t i = 0; i < values.size(); ++i)
      out.append(",").append(variable_text(f_.study.variables[i], values[i], true));
    return out;
  }

  std::string history() const {
    const auto& objectives = f_.problem.objectives();
    std::string out = "evaluation" + variable_header();
    for (const StudyObjective& o : objectives) out += "," + o.name;
    out += ",worst modulation,feasible,hypervolume,status\n";
    for (std::size_t i = 0; i < f_.history.size(); ++i) {
      const Evaluation& e = f_.history.evaluations[i];
      out += std::to_string(i + 1) + variable_values(e.unit);
      for (std::size_t k = 0; k < objectives.size(); ++k) {
        out += e.outcome.ok
                   ? fmt::format(",{:.6g}", objectives[k].maximise ? -e.outcome.objectives[k]
                                                                   : e.outcome.objectives[k])
                   : std::string(",");
      }
      out += e.outcome.ok ? fmt::format(",{:.6g}", f_.history.worst[i]) : std::string(",");
      out += fmt::format(",{},{:.6g},{}\n", e.outcome.feasible() ? "yes" : "no",
                         f_.result.hypervolumes[i],
                         e.outcome.ok ? "ok" : csv_text(e.outcome.reason));
    }
    return out;
  }

  std::string pareto() const {
    const auto& objectives = f_.problem.objectives();
    std::string out = "design" + variable_header();
    for (const StudyObjective& o : objectives)
      out += fmt::format(",{0},{0} se,{0} parameters,{0} at search level", o.name);
    out += ",worst modulation,breakdown margin,feasible,on front,status\n";
    const auto row = [&](const std::string& name, const Point& unit, const Score& c,
                         const Score& searched, bool feasible, bool front) {
      out += name + variable_values(unit);
      for (std::size_t k = 0; k < objectives.size(); ++k) {
        out += c.ok ? fmt::format(",{:.6g},{:.3g}", c.values[k], c.errors[k]) : std::string(",,");
        const auto parameters = parameter_error(c, k);
        out += parameters ? fmt::format(",{:.3g}", *parameters) : std::string(",");
        out += k < searched.values.size() ? fmt::format(",{:.6g}", searched.values[k])
                                          : std::string(",");
      }
      out += fmt::format(",{:.6g},{},{},{},{}\n", c.worst,
                         std::isfinite(c.oxide_margin) ? fmt::format("{:.4g}", c.oxide_margin) : "",
                         feasible ? "yes" : "no", front ? "yes" : "no",
                         c.ok ? "ok" : csv_text(c.reason));
    };
    for (const FinalDesign& d : f_.result.finalists) {
      row(!d.folder.empty() ? d.folder
          : d.feasible      ? "dominated"
                            : "infeasible",
          d.unit, d.confirmed, d.searched, d.feasible, d.on_front);
    }
    return out;
  }

  Json score_json(const Score& score) const {
    Json out = Json::object();
    for (std::size_t k = 0; k < score.values.size(); ++k) {
      Json value{{"value", number(score.values[k])},
                 {"maximise", f_.problem.objectives()[k].maximise}};
      if (k < score.errors.size()) {
        value["se"] = number(score.errors[k]);
        const auto parameters = parameter_error(score, k);
        value["parameters"] = parameters ? number(*parameters) : Json(nullptr);
      }
      out[f_.problem.objectives()[k].name] = value;
    }
    return out;
  }

  // The design less the flat surface, each objective.
  Json differences(const Score& design, const Score& flat) const {
    Json out = Json::object();
    for (std::size_t k = 0; k < design.values.size(); ++k) {
      out[f_.problem.objectives()[k].name] = {{"value", number(design.values[k] - flat.values[k])},
                                              {"se", number(difference_error(design, flat, k))}};
    }
    return out;
  }

  std::string metrics(const FinalDesign& d) const {
    Json out{{"schema", 1}, {"title", d.design.title}};
    Json variables = Json::object();
    const std::vector<double> values = f_.problem.space().value(d.unit);
    for (std::size_t i = 0; i < values.size(); ++i)
      variables[f_.study.variables[i].path] = variable_json(f_.study.variables[i], values[i]);
    out["variables"] = variables;
    out["objectives"] = score_json(d.confirmed);
    out["objectives_at_search_level"] = score_json(d.searched);
    out["worst_modulation"] = number(d.confirmed.worst);
    out["oxide_breakdown_margin"] = number(d.confirmed.oxide_margin);
    out["feasible"] = d.feasible;
    const Stability& stability = f_.result.stability;
    const auto index = static_cast<std::size_t>(&d - f_.result.finalists.data());
    if (index < stability.times_on_front.size()) {
      out["stability"] = {{"on_front", stability.times_on_front[index]},
                          {"variants", stability.variants.size()},
                          {"stable", stability.stable(index)}};
    }
    if (f_.result.flat)
      out["flat"] = {{"objectives", score_json(*f_.result.flat)},
                     {"worst_modulation", number(f_.result.flat->worst)},
                     {"difference", differences(d.confirmed, *f_.result.flat)},
                     {"no_better", no_better(f_.problem.objectives(), d.confirmed, *f_.result.flat)
                                       ? Json(kNoBetter)
                                       : Json(nullptr)}};
    const std::string unknown = f_.problem.parameters_unknown();
    out["parameters"] = {{"status", unknown.empty() ? "ok" : unknown},
                         {"of_the_difference_to_flat", Json::object()}};
    for (std::size_t k = 0; f_.result.flat && k < d.confirmed.values.size(); ++k) {
      const auto part = parameter_error(d.confirmed, *f_.result.flat, k);
      out["parameters"]["of_the_difference_to_flat"][f_.problem.objectives()[k].name] =
          part ? number(*part) : Json(nullptr);
    }
    out["tasks"] = Json::array();
    for (std::size_t t = 0; t < d.confirmed.reports.size(); ++t) {
      Json task{{"name", f_.problem.tasks()[t].name},
                {"response", Json::parse(d.confirmed.reports[t])}};
      if (f_.result.flat) task["flat"] = Json::parse(f_.result.flat->reports[t]);
      out["tasks"].push_back(std::move(task));
    }
    return out.dump(1) + "\n";
  }

  void write_design_folder(const FinalDesign& d, const std::string& folder) const {
    fs::create_directories(folder);
    write_design(folder + "/design.toml", d.design);
    write_bytes(folder + "/metrics.json", metrics(d));
    const Heightmap h = generate(d.design.texture, patch_grid(d.design.texture, kExportPixels));
    FileInfo info;
    info.title = d.design.title.empty() ? f_.study.name : d.design.title;
    write_exr(folder + "/heightmap.exr", h, info);
    write_gsf(folder + "/heightmap.gsf", h, info);
    write_mask_tiff(folder + "/mask.tif", h, Polarity::WhiteDeep, info);
    write_png(folder + "/preview.png", h);
  }

  std::string summary() const {
    const OptimiseResult& r = f_.result;
    std::string out =
        "# " + (f_.study.design.title.empty() ? f_.study.name : f_.study.design.title) + "\n\n";
    if (r.interrupted) {
      return out + fmt::format("Interrupted after {}; continue with --resume.\n",
                               counted(r.evaluations, "evaluation"));
    }
    out +=
        fmt::format("Search: {} ({}). {}", r.method, r.why, counted(r.evaluations, "evaluation"));
    if (r.refused) out += fmt::format(", {} refused by the fabrication limits", r.refused);
    if (r.failures) out += fmt::format(", **{} failed** (history.csv says why)", r.failures);
    out += ".\n\n";
    if (r.finalists.empty()) {
      return out +
             "**No design could be evaluated**: every one failed; history.csv says why for each.\n";
    }
    if (!r.any_feasible) {
      out += "**No design keeps every constraint**: " + infeasible_text(r) +
             ". The one that violates them least is shown; loosen a constraint or widen the design "
             "space.\n\n";
    }
    out += result_table(f_.study, r);
    const FinalDesign& best = r.finalists[r.best];
    if (best.on_front) out += best_text(best);
    if (r.flat && best.confirmed.ok) out += gain_text(best);
    out += stability_text();
    out += sensitivity_text();
    out += r.has_best()
               ? "\nFiles: report.html (all of this with charts), pareto.csv (finalists), "
                 "history.csv (every evaluation), front/ and best/ (design.toml, metrics.json, "
                 "heightmap.exr, heightmap.gsf, mask.tif (white is deep), preview.png), "
                 "sensitivity.json, "
                 "resolved.toml (every value and where it came from), plan.txt, journal.\n"
               : "\nFiles: pareto.csv (finalists), history.csv (every evaluation), resolved.toml "
                 "(every value and where it came from), plan.txt, journal.\n";
    return out;
  }

  std::string best_text(const FinalDesign& best) const {
    const OptimiseResult& r = f_.result;
    return fmt::format(
        "\n`best/` is {}: {}{}.\n", best.folder,
        f_.pick.empty() || f_.pick == "worst"
            ? "the highest worst modulation over fingers and humidity"
            : "picked by \"" + f_.pick + "\"",
        r.stability.stable(r.best)
            ? ""
            : "; under other choices of the model its neighbours beat it, see below");
  }

  // The step from the study's own flat surface to the best design, split into the part of the
  // finish (and drive) and the part of the texture.
  std::string gain_text(const FinalDesign& best) const {
    const OptimiseResult& r = f_.result;
    const auto& objectives = f_.problem.objectives();
    std::string out = "\n## What the texture does, and what the finish does\n\n| surface |";
    std::string rule = "|---|";
    for (const auto& o : objectives) {
      out += " " + o.name + " |";
      rule += "---|";
    }
    out += " worst modulation |\n" + rule + "---|\n";
    const auto row = [&](const char* name, const Score& s) {
      out += fmt::format("| {} |", name);
      for (std::size_t k = 0; k < objectives.size(); ++k)
        out += fmt::format(" {} |", with_errors(s, k));
      out += fmt::format(" {:.3f} |\n", s.worst);
    };
    if (no_better(objectives, best.confirmed, *r.flat))
      out = "\n**" + std::string(kNoBetter) + "**\n" + out;
    if (r.flat_before) row("flat, finish and drive of the study file", *r.flat_before);
    row(r.flat_before ? "flat, finish and drive of the best design" : "flat", *r.flat);
    row("best design", best.confirmed);
    out += "| difference made by the texture |";
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      out += fmt::format(" {:+.3f} ± {:.3f}", best.confirmed.values[k] - r.flat->values[k],
                         difference_error(best.confirmed, *r.flat, k));
      if (const auto part = parameter_error(best.confirmed, *r.flat, k))
        out += fmt::format(" ({:.3f})", *part);
      out += " |";
    }
    out +=
        " |\n\n± of the difference is from both on the same skins, droplets and grid, skin by "
        "skin: what moves both alike is not in it (the larger of both where their numbers of skins "
        "differ).\n";
    if (r.flat_before) {
      out +=
          "\nFrom the first row to the second is the finish (and drive), from the second to the "
          "third the texture.\n";
    }
    return out;
  }

  std::string sensitivity() const {
    Json out{{"schema", 1}, {"variables", Json::object()}};
    const auto& objectives = f_.problem.objectives();
    for (const VariableSensitivity& s : f_.result.sensitivity) {
      Json entry{{"step", s.step}, {"change", Json::object()}, {"variance_share", Json::object()}};
      for (std::size_t k = 0; k < s.change.size(); ++k) {
        entry["change"][objectives[k].name] = number(s.change[k]);
        entry["variance_share"][objectives[k].name] = number(s.share[k]);
      }
      entry["tolerance"] = {{"down", s.down},
                            {"down_at_least", s.down_beyond},
                            {"up", s.up},
                            {"up_at_least", s.up_beyond}};
      out["variables"][f_.study.variables[s.variable].path] = entry;
    }
    return out.dump(1) + "\n";
  }

  std::string sensitivity_text() const {
    if (f_.result.sensitivity.empty()) return {};
    const auto& objectives = f_.problem.objectives();
    std::string out =
        "\n## What the best design is sensitive to\n\nEach continuous variable alone, by 5 % of "
        "its "
        "range (128 pixels, 12 skins, common random numbers). Share: of the objective's variance "
        "if every "
        "variable scattered so. Tolerance: the drift that costs no objective more than 5 % of its "
        "value.\n\n| variable | step";
    for (const StudyObjective& o : objectives) out += " | " + o.name + ", share";
    out += " | tolerance down | up |\n|---|---";
    for (std::size_t k = 0; k < objectives.size(); ++k) out += "|---";
    out += "|---|---|\n";
    for (const VariableSensitivity& s : f_.result.sensitivity) {
      const Variable& v = f_.study.variables[s.variable];
      const double unit = find_unit(v.unit)->to_si;
      const auto rounded = [](double value, int digits) {  // 2000 where {:.3g} writes 2e+03
        return format_number(std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr));
      };
      out += fmt::format("| {} | {} {}", v.path, rounded(s.step / unit, 3), v.unit);
      for (std::size_t k = 0; k < objectives.size(); ++k) {
        out += k < s.change.size()
                   ? fmt::format(" | {:+.4f}, {:.0f} %", s.change[k], 100 * s.share[k])
                   : std::string(" | -");
      }
      const auto drift = [&](double value, bool beyond) {
        return value > 0 ? fmt::format("{}{} {}", beyond ? "at least " : "",
                                       rounded(value / unit, 2), v.unit)
                         : std::string("at its bound");
      };
      out += " | " + drift(s.down, s.down_beyond) + " | " + drift(s.up, s.up_beyond) + " |\n";
    }
    return out;
  }

  // How the finalists fare on each finger alone and under other choices of the model.
  std::string stability_text() const {
    const Stability& s = f_.result.stability;
    const auto& objectives = f_.problem.objectives();
    const std::size_t judged = s.times_on_front.size();
    if (s.variants.empty() || judged < 2) return {};
    std::string out =
        "\n## Does the order hold?\n\nEach design of the front on each finger alone, then on the "
        "first finger "
        "with one choice of the model changed (128 pixels, 12 skins, common random numbers; " +
        objectives.front().name + (objectives.size() > 1 ? ", " + objectives[1].name : "") +
        "; * on the front of these designs):\n\n|";
    for (std::size_t i = 0; i < judged; ++i)
      out += " | " + (f_.result.finalists[i].folder.empty() ? "(dominated)"
                                                            : f_.result.finalists[i].folder);
    out += " |\n|---";
    for (std::size_t i = 0; i < judged; ++i) out += "|---";
    out += "|\n";
    for (const StabilityVariant& v : s.variants) {
      out += "| " + v.name;
      for (std::size_t i = 0; i < v.values.size(); ++i) {
        out += " |";
        for (std::size_t k = 0; k < std::min<std::size_t>(2, v.values[i].size()); ++k)
          out += fmt::format("{}{:.3f}", k == 0 ? " " : ", ", v.values[i][k]);
        out += v.on_front[i] ? " *" : "";
      }
      out += " |\n";
    }
    out += "| **on the front** |";
    for (std::size_t i = 0; i < judged; ++i) {
      out += fmt::format(" {} of {}{} |", s.times_on_front[i], s.variants.size(),
                         s.stable(i) ? "" : ", **unstable**");
    }
    return out + "\n";
  }

  const ResultFiles& f_;
};

}  // namespace

std::string result_table(const Study& study, const OptimiseResult& result) {
  const StudyProblem problem(study);
  const auto& objectives = problem.objectives();
  std::string out = "Finalists, confirmed on fresh skins at level \"" +
                    study.design.accuracy.level_name() + "\":\n\n| design";
  for (const Variable& v : study.variables) out += " | " + v.path;
  for (const StudyObjective& o : objectives)
    out += fmt::format(" | {} {}", o.maximise ? "max" : "min", o.name);
  out += " | worst modulation |\n|";
  for (std::size_t i = 0; i < study.variables.size() + objectives.size() + 2; ++i) out += "---|";
  out += "\n";
  for (const FinalDesign& d : result.finalists) {
    out += "| " + (!d.folder.empty() ? d.folder : d.feasible ? "(dominated)" : "(infeasible)");
    if (!d.folder.empty() && !d.feasible) out += " (infeasible)";
    const std::vector<double> values = problem.space().value(d.unit);
    for (std::size_t i = 0; i < values.size(); ++i) {
      out.append(" | ").append(variable_text(study.variables[i], values[i]));
    }
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      out += fmt::format(" | {}", d.confirmed.ok ? with_errors(d.confirmed, k) : "failed");
    }
    out += fmt::format(" | {:.3f} |\n", d.confirmed.worst);
  }
  const std::string unknown = problem.parameters_unknown();
  if (!unknown.empty())
    return out + fmt::format("\nWhat the fit of the finger leaves open is in no ±: {}.\n", unknown);
  out += fmt::format(
      "\n± is one standard error of skins, droplets, grid and method. In brackets{} what the fit "
      "of "
      "the finger leaves open, one standard deviation, common to all designs",
      study.design.accuracy.parameters
          ? ""
          : ", of the best design (all: `[accuracy] parameters = true`),");
  // Common is not cancelled: a design may answer to the finger as its flat surface does not.
  std::vector<std::string> better, worse;
  for (std::size_t k = 0; result.has_best() && result.flat && k < objectives.size(); ++k) {
    const Score& best = result.finalists[result.best].confirmed;
    const auto own = parameter_error(best, k), flat = parameter_error(*result.flat, k),
               both = parameter_error(best, *result.flat, k);
    if (both) (*both < std::min(*own, *flat) ? better : worse).push_back(objectives[k].name);
  }
  if (!better.empty())
    out += "; it leaves the difference from flat better known than the values in " +
           join_names(better);
  if (!worse.empty())
    out += fmt::format("; {} it leaves the difference from flat no better known than the values",
                       "in " + join_names(worse));
  return out + ".\n";
}

std::string infeasible_text(const OptimiseResult& result) {
  std::string names;
  for (const std::string& name : result.never_kept) names += (names.empty() ? "" : ", nor ") + name;
  return names.empty() ? "each is kept by some design that was tried, but not all by one"
                       : "no design of the space that was tried keeps " + names;
}

std::string FolderWriter::text(const Response& response) const {
  return response_json(response, false);
}

void FolderWriter::write(const ResultFiles& files) const {
  write_results(files);
  if (!files.result.interrupted && files.result.has_best())
    write_bytes(files.folder + "/report.html", report_page(files.folder));
}

OptimiseResult optimise_to_folder(const Study& study, OptimiseOptions options) {
  const FolderWriter writer;
  options.writer = &writer;
  return optimise(study, options);
}

void write_results(const ResultFiles& files) { Writer(files).write(); }

}  // namespace papilla
