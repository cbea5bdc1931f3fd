#include "report/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "config/writer.h"
#include "design/title.h"
#include "report/decision.h"
#include "report/export.h"
#include "report/grounds.h"
#include "report/json.h"
#include "report/limits.h"
#include "report/page.h"
#include "report/receipts.h"
#include "report/recommendation.h"
#include "report/response.h"
#include "report/run_json.h"
#include "report/run_numbers.h"
#include "report/summary.h"
#include "report/sums.h"
#include "report/unstable.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kExportPixels = 512;  // across one patch

Json variable_json(const Variable& v, double value) {
  return v.is_kind() ? Json(variable_text(v, value)) : Json(value);
}

std::string csv_text(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '"' || c == '\n') c = ';';
  }
  return text;
}

class Writer {
 public:
  explicit Writer(const ResultFiles& files) : f_(files), folder_(Folder::made(files.folder)) {}

  void write() {
    folder_.write("history.csv", history());
    folder_.write("pareto.csv", pareto());
    folder_.remove("front");
    folder_.remove("best");
    for (const FinalDesign& d : f_.result.finalists) {
      if (d.on_front) write_design_folder(d, d.folder, d.design, "design.toml");
    }
    if (f_.result.has_best()) {
      write_design_folder(recommended_design(f_.problem, f_.result), "best", built_design(f_),
                          "build.toml");
    }
    folder_.write("sensitivity.json", sensitivity());
    const Json run = run_json(f_);
    const std::string summary = run_summary(f_);
    folder_.write("run.json", as_read(run).dump(1) + "\n");
    folder_.write("summary.md", as_read(summary));
    folder_.remove(kReceiptsName);
    if (!f_.result.interrupted && f_.result.has_best())
      folder_.write(kReceiptsName, receipts_text(receipts_of(f_, run, summary)));
    write_sums(folder_);
  }

 private:
  std::string variable_header() const {
    std::string out;
    for (const Variable& v : f_.study.variables) {
      out += "," + v.path + (v.unit.empty() ? "" : " [" + v.unit + "]");
    }
    return out;
  }
  // Of a flat surface no measures of a texture.
  std::string variable_values(const Point& unit) const {
    std::string out;
    const std::vector<double> values = f_.problem.space().value(unit);
    const Design design = f_.problem.space().design(unit);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Variable& v = f_.study.variables[i];
      out += "," +
             (is_shown(f_.problem, design, i) ? variable_text(v, values[i], true) : std::string());
    }
    return out;
  }

  // Without a drive there is no modulation; of voltages that are found it says nothing.
  std::string worst_text(bool ok, double worst) const {
    return ok && f_.problem.judged_at_amplitude() ? fmt::format("{:.6g}", worst) : std::string();
  }
  Json worst_json(const Score& score) const {
    return score.ok && f_.problem.judged_at_amplitude() ? Json(json_number(score.worst))
                                                        : Json(nullptr);
  }

  std::string history() const {
    const auto& objectives = f_.problem.objectives();
    std::string out = "evaluation" + variable_header();
    for (const StudyObjective& o : objectives) out += "," + csv_text(o.name);
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
      out.append(",").append(worst_text(e.outcome.ok, f_.history.worst[i]));
      out +=
          fmt::format(",{},{:.6g},{}\n", e.outcome.feasible() ? "yes" : "no",
                      f_.result.hypervolumes[i], e.outcome.ok ? "ok" : csv_text(e.outcome.reason));
    }
    return out;
  }

  std::string pareto() const {
    const auto& objectives = f_.problem.objectives();
    std::string out = "design" + variable_header();
    for (const StudyObjective& o : objectives)
      out += fmt::format(",{0},{0} se,{0} model,{0} at search level", csv_text(o.name));
    out += ",worst modulation,breakdown margin";
    for (const Constraint& c : f_.study.constraints) out += ",limit " + csv_text(limit_name(c.on));
    const bool decided = f_.result.decision.made();
    if (decided) out += ",p(best),expected regret,p(every limit)";
    out += ",feasible,on front,status\n";
    const auto row = [&](const std::string& name, const FinalDesign& d) {
      const Score &c = d.confirmed, &searched = d.searched;
      out += name + variable_values(d.unit);
      for (std::size_t k = 0; k < objectives.size(); ++k) {
        out += c.ok ? fmt::format(",{:.6g},{:.3g}", c.values[k], c.errors[k]) : std::string(",,");
        const auto parameters = parameter_error(c, k);
        // That of a look that no parameter moves is its last bits.
        out += parameters
                   ? fmt::format(",{:.3g}", scatters(c.values[k], *parameters) ? *parameters : 0.0)
                   : std::string(",");
        out += k < searched.values.size() ? fmt::format(",{:.6g}", searched.values[k])
                                          : std::string(",");
      }
      out +=
          fmt::format(",{},{}", worst_text(c.ok, c.worst),
                      c.ok && std::isfinite(c.oxide_margin) ? fmt::format("{:.4g}", c.oxide_margin)
                                                            : std::string());
      const std::vector<LimitValue> limits = limit_values(f_.problem, d);
      for (std::size_t i = 0; i < f_.study.constraints.size(); ++i)
        out += "," + (i < limits.size() ? limit_value_text(limits[i].limit, limits[i].value)
                                        : std::string());
      if (decided) out += prospect_text(place_of(d));
      out += fmt::format(",{},{},{}\n", d.feasible ? "yes" : "no", d.on_front ? "yes" : "no",
                         c.ok ? "ok" : csv_text(c.reason));
    };
    for (const FinalDesign& d : f_.result.finalists) {
      row(!d.folder.empty() ? d.folder : d.feasible ? "dominated" : "infeasible", d);
    }
    return out;
  }

  std::string prospect_text(std::size_t finalist) const {
    const std::vector<Prospect>& designs = f_.result.decision.designs;
    if (finalist >= designs.size()) return ",,,";
    const Prospect& p = designs[finalist];
    return fmt::format(",{:.4g},{:.3g},{:.4g}", p.p_best, p.regret, p.p_limits);
  }

  Json score_json(const Score& score) const {
    Json out = Json::object();
    for (std::size_t k = 0; k < score.values.size(); ++k) {
      Json value{{"value", json_number(score.values[k])},
                 {"maximise", f_.problem.objectives()[k].maximise}};
      if (k < score.errors.size()) {
        value["se"] = json_number(score.errors[k]);
        const auto parameters = parameter_error(score, k);
        value["parameters"] = json_number(parameters);
        value["model"] = json_number(parameters);
      }
      out[f_.problem.objectives()[k].name] = value;
    }
    return out;
  }

  // The design less the flat surface, each objective.
  Json differences(const Score& design, const Score& flat) const {
    Json out = Json::object();
    for (std::size_t k = 0; k < design.values.size(); ++k) {
      out[f_.problem.objectives()[k].name] = {
          {"value", json_number(design.values[k] - flat.values[k])},
          {"se", json_number(difference_error(design, flat, k))}};
    }
    return out;
  }

  std::string metrics(const FinalDesign& d) const {
    Json out{{"schema", 1}, {"title", titled(d.design).title}};
    Json variables = Json::object();
    const std::vector<double> values = f_.problem.space().value(d.unit);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Variable& v = f_.study.variables[i];
      if (!d.flat && is_shown(f_.problem, d.design, i))
        variables[v.path] = variable_json(v, values[i]);
      if (d.flat && !v.path.starts_with("texture."))
        variables[v.path] = variable_json(v, values[i]);
    }
    out["variables"] = variables;
    out["objectives"] = score_json(d.confirmed);
    out["objectives_at_search_level"] = score_json(d.searched);
    out["worst_modulation"] = worst_json(d.confirmed);
    out["oxide_breakdown_margin"] = json_number(d.confirmed.oxide_margin);
    out["feasible"] = d.feasible;
    out["limits"] = limits_json(limit_values(f_.problem, d));
    const Stability& stability = f_.result.stability;
    const std::size_t index = place_of(d);
    if (stability.judged(index)) {
      out["stability"] = {{"on_front", stability.times_on_front[index]},
                          {"variants", stability.variants.size()},
                          {"stable", stability.stable(index)},
                          {"why", as_read(unstable_text(f_, index))}};
    }
    if (Json prospect = prospect_json(f_, index); !prospect.is_null())
      out["belief"] = std::move(prospect);
    if (f_.result.flat)
      out["flat"] = {
          // of the film and the finish of what is recommended
          {"finish_of", f_.result.finalists[f_.result.best].folder},
          {"objectives", score_json(*f_.result.flat)},
          {"worst_modulation", worst_json(*f_.result.flat)},
          {"difference", differences(d.confirmed, *f_.result.flat)},
          {"no_better", !d.flat && no_better(f_.problem.objectives(), d.confirmed, *f_.result.flat)
                            ? Json(kNoBetter)
                            : Json(nullptr)}};
    const std::string unknown = f_.problem.parameters_unknown();
    out["parameters"] = {{"status", unknown.empty() ? "ok" : unknown},
                         {"source", f_.problem.model_source()},
                         {"of_the_difference_to_flat", Json::object()}};
    for (std::size_t k = 0; f_.result.flat && k < d.confirmed.values.size(); ++k) {
      const auto part = parameter_error(d.confirmed, *f_.result.flat, k);
      out["parameters"]["of_the_difference_to_flat"][f_.problem.objectives()[k].name] =
          json_number(part);
    }
    out["tasks"] = Json::array();
    for (std::size_t t = 0; t < d.confirmed.reports.size(); ++t) {
      Json task{{"name", f_.problem.tasks()[t].name},
                {"weight", f_.problem.tasks()[t].weight},
                {"response", Json::parse(d.confirmed.reports[t])}};
      if (f_.result.flat) task["flat"] = Json::parse(f_.result.flat->reports[t]);
      out["tasks"].push_back(std::move(task));
    }
    return out.dump(1) + "\n";
  }

  // What the run changed of the study's own design stands in the title.
  Design titled(Design design) const {
    design.title = title_as_changed(f_.study.design, design);
    return design;
  }

  // Among the finalists; beyond them: a surface that is none.
  std::size_t place_of(const FinalDesign& d) const {
    const auto& all = f_.result.finalists;
    const auto same = [&](const FinalDesign& f) { return !d.flat && f.unit == d.unit; };
    return static_cast<std::size_t>(std::find_if(all.begin(), all.end(), same) - all.begin());
  }

  // Maps as `papilla export` writes them, of the design as it is made (in the file of that name),
  // with what `papilla verify` needs.
  void write_design_folder(const FinalDesign& d, const std::string& name, const Design& made,
                           const std::string& made_file) const {
    const Folder folder = folder_.made_below(name);
    folder.write("design.toml", to_toml(titled(d.design)));
    folder.write(made_file, to_toml(titled(made)));
    folder.write("metrics.json", metrics(d));
    Study study;
    study.design = titled(made);
    study.constraints = f_.study.constraints;
    ExportOptions options;
    options.formats = {"exr", "gsf", "png"};
    options.pixels = kExportPixels;
    if (facts(made.texture).relief.present && mask_shows(made.texture, options)) {
      options.formats.push_back("mask");
      options.polarity = Polarity::WhiteDeep;
    }
    export_with_record(study, options, folder.path(), {},
                       {{kDesignFormat, folder.path(made_file)}});
  }

  // How far a number may be off one way, and what ends it.
  static Json tolerance(const Drift& drift) {
    static constexpr std::array kEnds{"loss",       "limit",    "step tried",
                                      "range ends", "no shape", "failed"};
    return {{"most", drift.judged() ? Json(drift.most) : Json()},
            {"end", kEnds[static_cast<std::size_t>(drift.end)]},
            {"limit", drift.limit.empty() ? Json() : Json(drift.limit)}};
  }

  std::string sensitivity() const {
    Json out{{"schema", 1}, {"variables", Json::object()}};
    const auto& objectives = f_.problem.objectives();
    for (const VariableSensitivity& s : f_.result.sensitivity) {
      Json entry{{"step", s.step}, {"change", Json::object()}, {"variance_share", Json::object()}};
      for (std::size_t k = 0; k < s.change.size(); ++k) {
        entry["change"][objectives[k].name] = json_number(s.change[k]);
        entry["variance_share"][objectives[k].name] = json_number(s.share[k]);
      }
      entry["tolerance"] = {{"down", tolerance(s.down)}, {"up", tolerance(s.up)}};
      out["variables"][f_.study.variables[s.variable].path] = entry;
    }
    return out.dump(1) + "\n";
  }

  const ResultFiles& f_;
  const Folder folder_;
};

}  // namespace

std::string FolderWriter::text(const Response& response) const {
  return response_json(response, false);
}

void FolderWriter::write(const ResultFiles& files) const {
  write_results(files);
  if (!files.result.interrupted && files.result.has_best())
    Folder(files.folder).write(kPageName, report_page(files.folder));
}

OptimiseResult optimise_to_folder(const Study& study, OptimiseOptions options) {
  const FolderWriter writer;
  options.writer = &writer;
  return optimise(study, options);
}

namespace {

// What the folder's record of the run says; an empty object where there is none that can be read.
Json record_of_run(const std::string& folder) {
  const Folder results(folder);
  if (!results.has("run.json")) return Json::object();
  Json run = Json::parse(results.read("run.json"), nullptr, false);
  return run.is_object() ? run : Json::object();
}

}  // namespace

std::string recommendation_of(const std::string& folder) {
  return record_of_run(folder).value("recommendation", std::string());
}

std::string build_sheet_text(const std::string& folder) {
  const Json run = record_of_run(folder), build = run.value("build", Json());
  if (run.value("interrupted", Json()) == true)
    return "the run was interrupted before its best design was rounded to the grid of the fab: "
           "these are the numbers as the search left them";
  if (!build.is_object()) return "as the build sheet has it; as the search left it: --unrounded";
  if (run.value("advice", Json()) == "leave flat")
    return "finish and drive are those of the study file, which are not rounded";
  if (run.value("grid", Json()) == 0) return "as the search left it: search.rounding is 0";
  return build.value("on_grid", Json()) == true
             ? "on the grid of the fab as the build sheet has it; as the search left it: "
               "--unrounded"
             : "not all on the grid of the fab: summary.md says why; as the search left it: "
               "--unrounded";
}

void write_results(const ResultFiles& files) { Writer(files).write(); }

}  // namespace papilla::report
