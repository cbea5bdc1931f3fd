#include "report/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "calibrate/calibration_file.h"
#include "cases/contact_statistics.h"
#include "cases/drive.h"
#include "cases/persson.h"
#include "config/describe.h"
#include "design/study.h"
#include "design/words.h"
#include "fabricate/formats.h"
#include "fabricate/wafer.h"
#include "metrics/metrics.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// A table of a section; `plain`: keys and meanings alone.
struct Part {
  std::string heading;
  std::vector<FieldRow> rows;
  bool plain = false;
};

FieldRow key(std::string path, std::string doc) {
  FieldRow row;
  row.path = std::move(path);
  row.doc = std::move(doc);
  return row;
}

const char* about(const std::string& section) {
  if (section == "texture") return "The shape of the surface: `type` chooses the kind.";
  if (section == "surface") return "The finish: wetting, dielectric layers, optics, stiffness.";
  if (section == "view")
    return "How the texture is looked at: haze, transmittance, gloss, distinctness of image, "
           "sparkle, colour.";
  if (section == "finger") return "The finger; usually `base = \"../fingers/reference.toml\"`.";
  if (section == "counterface")
    return "What touches the surface, where it is no finger: a pin or a pen; `type` chooses.";
  if (section == "statistics") return "A case of `papilla solve contact`.";
  if (section == "environment") return "The humidities at which a design is judged.";
  if (section == "drive") return "The electrical drive; without an amplitude nothing is driven.";
  if (section == "model") {
    return "Model options. The default of each is what the finger was fitted with "
           "(`finger.calibrated_for`); shown are those of `designs/fingers/reference.toml`.";
  }
  if (section == "accuracy") return "Speed against error.";
  if (section == "metrics") {
    return "What a design is judged by, at one humidity. Over humidity: mean, variation (standard "
           "deviation / mean), range ((max - min) / mean), std, worst, best, first, last; written "
           "`mean(modulation)`.";
  }
  if (section == "persson") return "A case of `papilla solve persson`.";
  if (section == "circuit") return "A case of `papilla solve drive`.";
  if (section == "study") return "The sections that only a study has.";
  if (section == "search") return "How a study is searched, and for how long.";
  if (section == "design_space") return "What the search may change.";
  if (section == "objective") return "What is wanted.";
  if (section == "constraints") return "What a design has to keep.";
  if (section == "population") return "The fingers that a design is judged on.";
  if (section == "scenarios") return "States of the product that count beside each other.";
  if (section == "scatter") return "How far fabrication may miss.";
  if (section == "base") return "Another file below this one.";
  if (section == "wafer") {
    return "A list of designs for `papilla wafer`, LIST.toml; of a study or of results every key "
           "by "
           "`--set wafer.repeats=5`.";
  }
  if (section == "calibration") {
    return "CALIBRATION.toml of `papilla calibrate`: what a finger is fitted to, what may change "
           "and what is known of it before.";
  }
  if (section == "export") {
    return "The files of `papilla export`, by the names that `--format` takes. Without it: those "
           "that need nothing that is missing.";
  }
  return "";
}

std::string render(const Part& part, ReferenceFormat format) {
  const bool markdown = format == ReferenceFormat::Markdown;
  std::string out;
  if (!part.heading.empty())
    out = markdown ? "\n## " + part.heading + "\n\n" : "\n" + part.heading + "\n";
  if (!part.plain)
    return out + (markdown ? reference_markdown(part.rows) : reference_text(part.rows));
  if (markdown) out += "| key | meaning |\n|---|---|\n";
  for (const FieldRow& row : part.rows) {
    out += markdown ? fmt::format("| `{}` | {} |\n", row.path, row.doc)
                    : fmt::format("{:<36} {}\n", row.path, row.doc);
  }
  return out;
}

std::vector<Part> texture_reference() {
  std::vector<Part> out;
  for (const std::string& kind : texture_kinds()) {
    Document document = parse_document("type = \"" + kind + "\"", "reference");
    Texture texture;
    read_section(document, "", texture);
    out.push_back({kind, field_rows(texture, "texture")});
  }
  return out;
}

std::vector<Part> study_reference() {
  std::vector<FieldRow> rows{
      key("base",
          "another file that lies below this one; found beside it, then in the designs folder"),
      key("title",
          "a line for reports, of a design too; behind it stands what `--set` of `evaluate`, "
          "`explain`, `rank` and `export` makes another design: \"Holes; texture.depth 300 nm\""),
      key("design_space.\"PATH\" = [low, high]",
          "the search may change this number; PATH is a number of what is built, e.g. "
          "texture.depth"),
      key("design_space.\"PATH\" = { choice = [...] }", "the same, one of the listed values"),
      key("design_space.\"PATH\" = { range = [low, high], exclude = [[from, to]] }",
          "the same, without the values between from and to, any number of such pairs"),
      key("objective.maximise, objective.minimise",
          "a metric over humidity, e.g. \"mean(modulation)\", \"worst(modulation)\", "
          "\"variation(modulation)\"; two in all make a Pareto front"),
      key("design_space.\"texture.type\" = { choice = [...] }",
          "which kinds of texture compete; the other variables act where a kind has them: a depth "
          "is "
          "a pillar's height, a diameter a groove's width"),
      key("design_space.\"texture.levels\" = { choice = [...] }",
          "how many parts of a stack there are, the first ones"),
      key("objective.target",
          "{ METRIC = value }: what a metric should be at every humidity, e.g. { modulation = 0.8 "
          "}; "
          "its root mean square distance is minimised"),
      key("objective.risk",
          "how fingers, scenarios and scatter are put together: \"mean\", \"mean - 2 std\", "
          "\"cvar 20 %\", \"worst\""),
      key("scatter.\"PATH\"",
          "fabrication misses this number by up to so much either way; two more evaluations each"),
      key("scatter.\"PATH\" = { sigma = ... }", "the same, normal with this standard deviation"),
      key("scatter.correlation",
          "of two of them: [{ between = [\"PATH\", \"PATH\"], value = 0.6 }]; the others are "
          "independent"),
      key("population.fingers",
          "finger files; load, state, touch_time and belief hold for all where the study itself "
          "says them in [finger] (not by the file that [finger] is based on)"),
      key("population.shared",
          "which of these hold for all, as a resolved file names them: [\"load\", \"state\"]"),
      key("scenarios",
          "states that count beside each other: name, weight, set = { \"PATH\" = value }"),
  };
  for (const ConstraintKind& kind : constraint_kinds()) {
    rows.push_back(key("constraints." + kind.name,
                       fmt::format("{} ({}{})", kind.doc, kind.at_least ? "at least" : "at most",
                                   kind.unit.empty() ? "" : ", in " + kind.unit)));
  }
  rows.push_back(
      key("constraints.\"METRIC\"",
          "a metric over humidity, limited on its bad side: \"worst(modulation)\" = 0.3 (at "
          "least), \"worst(voltage_for(modulation = 0.5))\" = \"150 V\" (at most)"));
  return {{"", rows, true},
          {"risk", field_rows(StudyRisk{}, "risk")},
          {"search", field_rows(Search{}, "search")}};
}

// The sections that only a study has, by themselves.
constexpr std::array kStudySections{"design_space", "objective", "constraints",
                                    "population",   "scenarios", "scatter",
                                    "risk",         "search",    "base"};

// One of them; empty for another name.
std::vector<Part> study_section(const std::string& section) {
  if (std::find(kStudySections.begin(), kStudySections.end(), section) == kStudySections.end())
    return {};
  std::vector<Part> out;
  for (Part part : study_reference()) {
    part.heading.clear();
    std::erase_if(part.rows, [&](const FieldRow& row) {
      return row.path != section && !row.path.starts_with(section + ".");
    });
    if (!part.rows.empty()) out.push_back(std::move(part));
  }
  return out;
}

std::vector<Part> metrics_reference() {
  std::vector<FieldRow> rows;
  for (const MetricInfo& metric : metric_list()) {
    rows.push_back(
        key(metric.name, fmt::format("{}{}{}{}", metric.doc,
                                     metric.unit.empty() ? "" : fmt::format(" [{}]", metric.unit),
                                     metric.better == Better::Higher  ? "; higher is better"
                                     : metric.better == Better::Lower ? "; lower is better"
                                                                      : "",
                                     metric.needs_drive ? "; driven designs only" : "")));
  }
  return {{"", rows, true}};
}

std::vector<Part> export_reference() {
  std::vector<FieldRow> rows;
  for (const ExportFormat& format : export_format_table()) {
    std::vector<std::string> needs;
    if (format.needs_polarity) needs.push_back("a polarity (`--polarity`)");
    if (format.needs_outline) needs.push_back("a relief");
    if (format.needs_dose_curve) needs.push_back("a dose curve (`--dose-curve`)");
    rows.push_back(
        key(format.name, fmt::format("`{}`: {}{}{}", format.file, format.holds,
                                     needs.empty() ? "" : "; needs " + join_names(needs, " and "),
                                     format.asked_only ? "; only where it is asked for" : "")));
  }
  return {{"", rows, true}};
}

std::vector<Part> wafer_reference() {
  std::vector<FieldRow> head{
      key("schema_version", "of this file: 1"),
      key("designs_of",
          "folder of results, whose front is taken, or a study: its design as it is "
          "written and with each number of its design space at either end")};
  return {{"", head, true},
          {"wafer", field_rows(WaferShape{}, "wafer")},
          {"conditions", field_rows(WaferConditions{}, "conditions")},
          {"process", field_rows(Process{}, "process")},
          {"design: a list, [[design]]", field_rows(WaferDesign{}, "design")}};
}

std::vector<Part> calibration_reference() {
  const Calibration standard;
  std::vector<FieldRow> head{
      key("schema_version", "of this file: 1"),
      key("title", "a text, and the name of the fitted finger"),
      key("finger", "the file where the fit starts, e.g. \"fingers/reference.toml\"; required"),
      key("data",
          "a table of measured frictions, a CSV with a line a measurement: design (a file), "
          "relative_humidity, amplitude_V, frequency_Hz, load_N, F_off_N, F_off_sd_N, F_on_N, "
          "F_on_sd_N, state (clean, natural, wet; empty: the design's); forces of the whole finger "
          "[N], "
          "sd: one standard deviation"),
      key("data_finger",
          "whose rows of the table are taken, by its column finger; needed where it has several"),
      key("fit",
          "what is fitted, e.g. [\"M1\", \"C_gap\"]: published claims, and of numbers that are no "
          "claim C_gap and friction; this or `data`"),
      key("hold_out", "claims that are judged with the fitted finger alone"),
      key("iterations",
          fmt::format("of the fit; 0 leaves the finger as it is; {}", standard.iterations)),
      key("profiles",
          "whether intervals are walked along the misfit; false: by the slopes; not walked where "
          "the fitted finger does not explain the data"),
      key("sampling",
          "where the fit is computed: level, skins, first_skin, grid; frictions are corrected to "
          "the level of `check`"),
      key("check", "the same, of the judgement and of the correction"),
      key("parameters.\"PATH\" = { low = ..., high = ..., prior = ..., factor = ... }",
          "the fit may change this number of the finger (`papilla describe finger`), or "
          "\"water.scale\", which multiplies all water volumes; known before within a factor, by a "
          "prior between its bounds"),
      key("parameters.\"PATH\" = { low = ..., high = ..., prior = ..., sd = ... }",
          "the same, known within this standard deviation; without a prior: the bounds alone"),
      key("parameters.\"PATH\".start", "where the fit begins; the finger's own where left out"),
      key("hypothesis",
          "a list [[hypothesis]] beside [belief]: name, set = { \"PATH\" = value } (choices of "
          "the model, e.g. \"model.air_limit\" = \"emission\"), start = { \"PATH\" = value }"),
  };
  return {{"", head, true},
          {"belief: what the data leave open is carried by every answer",
           field_rows(BeliefSettings{}, "belief")}};
}

std::vector<Part> parts_of(const std::string& section);

// "texture.depth" for "depth": the first key that ends so; empty: none does.
std::string key_named(const std::string& name) {
  for (const std::string& section : reference_sections()) {
    for (const Part& part : parts_of(section)) {
      for (const FieldRow& row : part.rows) {
        if (row.path.ends_with("." + name)) return row.path;
      }
    }
  }
  return {};
}

// Throws InputError, with a "did you mean", for an unknown section.
std::vector<Part> parts_of(const std::string& section) {
  if (section == "texture") return texture_reference();
  if (section == "surface") return {{"", field_rows(Surface{}, section)}};
  if (section == "view") {
    View with_film;  // by itself there is none
    with_film.films.resize(1);
    return {{"", field_rows(with_film, section)}};
  }
  if (section == "finger") return {{"", field_rows(Finger{}, section)}};
  if (section == "counterface") return {{"", field_rows(Counterface{}, section)}};
  if (section == "environment") return {{"", field_rows(Environment{}, section)}};
  if (section == "drive") return {{"", field_rows(Drive{}, section)}};
  if (section == "model") return {{"", field_rows(Finger{}.calibrated_for, section)}};
  if (section == "accuracy") return {{"", field_rows(AccuracySettings{}, section)}};
  if (section == "persson") return {{"", field_rows(MeanFieldCase{}, "")}};
  if (section == "circuit") return {{"", field_rows(DriveCase{}, "")}};
  if (section == "statistics") return {{"", field_rows(StatisticsCase{}, "")}};
  if (section == "metrics") return metrics_reference();
  if (section == "study") return study_reference();
  if (section == "export") return export_reference();
  if (section == "wafer") return wafer_reference();
  if (section == "calibration") return calibration_reference();
  if (auto parts = study_section(section); !parts.empty()) return parts;
  std::vector<std::string> known = reference_sections();
  for (const char* name : kStudySections) known.emplace_back(name);
  const std::string word = key_for_word(section, "");
  const std::string meant = word.empty() ? key_named(section) : word;
  const std::string near = meant.empty() ? nearest_name(section, known) : meant;
  throw InputError(near.empty()
                       ? fmt::format("no section `{}`; known: {}", section, join_names(known))
                       : fmt::format("no section `{}`, did you mean `{}`?", section, near));
}

// The parts of a section with the rows of one key, or of a section's section, alone.
std::vector<Part> parts_of_key(const std::string& key) {
  std::vector<Part> out;
  std::vector<std::string> names;
  const std::string section = key.substr(0, key.find('.'));
  for (Part part : parts_of(section)) {
    for (const FieldRow& row : part.rows) names.push_back(row.path);
    std::erase_if(part.rows, [&](const FieldRow& row) {
      return row.path != key && !row.path.starts_with(key + ".");
    });
    if (!part.rows.empty()) out.push_back(std::move(part));
  }
  if (!out.empty()) return out;
  const std::string meant = key_for_word(key.substr(key.rfind('.') + 1), section);
  const std::string near = meant.empty() ? nearest_name(key, names) : meant;
  throw InputError(near.empty()
                       ? fmt::format("no key `{}`; `papilla describe {}` lists them", key, section)
                       : fmt::format("no key `{}`, did you mean `{}`?", key, near));
}

}  // namespace

std::vector<std::string> reference_sections() {
  return {"texture", "surface",    "view",     "finger", "counterface", "environment",
          "drive",   "model",      "accuracy", "study",  "metrics",     "persson",
          "circuit", "statistics", "export",   "wafer",  "calibration"};
}

std::string reference_section(const std::string& section, ReferenceFormat format) {
  std::string out;
  if (section.find('.') != std::string::npos) {
    for (const Part& part : parts_of_key(section)) out += render(part, format);
    return out;
  }
  for (const Part& part : parts_of(section)) out += render(part, format);
  return (format == ReferenceFormat::Markdown
              ? fmt::format("# {}\n\n{}\n\n", section, about(section))
              : fmt::format("{}: {}\n\n", section, about(section))) +
         out;
}

std::string reference_json(const std::vector<std::string>& sections) {
  Json list = Json::array();
  for (const std::string& section : sections) {
    Json tables = Json::array();
    const bool key = section.find('.') != std::string::npos;
    for (const Part& part : key ? parts_of_key(section) : parts_of(section)) {
      Json keys = Json::array();
      for (const FieldRow& row : part.rows) {
        Json item{{"key", row.path}, {"meaning", row.doc}};
        if (!part.plain) {
          item["kind"] = row.kind;
          item["range"] = row.range;
          item["default"] = row.default_value;
          item["source"] = row.source;
          item["reference"] = row.reference;
          item["required"] = row.required;
        }
        keys.push_back(std::move(item));
      }
      tables.push_back({{"name", part.heading}, {"keys", keys}});
    }
    list.push_back({{"section", section}, {"about", about(section)}, {"tables", tables}});
  }
  return Json{{"schema", 1}, {"sections", list}}.dump(2);
}

}  // namespace papilla::report
