#include "study/reference.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "config/describe.h"
#include "metrics/metrics.h"
#include "study/design.h"
#include "study/drive_case.h"
#include "study/mean_field.h"

namespace papilla {
namespace {

struct Row {
  std::string key, meaning;
};

const char* about(const std::string& section) {
  if (section == "texture") return "The shape of the surface: `type` chooses the kind.";
  if (section == "surface") return "The finish: wetting, dielectric layers, optics, stiffness.";
  if (section == "view") return "How the texture is looked at: haze, transmittance, gloss, colour.";
  if (section == "finger") return "The finger; usually `base = \"../fingers/reference.toml\"`.";
  if (section == "environment") return "The humidities at which a design is judged.";
  if (section == "drive") return "The electrical drive; without an amplitude nothing is driven.";
  if (section == "model") {
    return "Model options. The default of each is what the finger was fitted with "
           "(`finger.calibrated_for`).";
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
  return "";
}

std::string render(const std::vector<FieldRow>& rows, ReferenceFormat format) {
  return format == ReferenceFormat::Text ? reference_text(rows) : reference_markdown(rows);
}

std::string render(const std::vector<Row>& rows, ReferenceFormat format) {
  std::string out = format == ReferenceFormat::Markdown ? "| key | meaning |\n|---|---|\n" : "";
  for (const Row& row : rows) {
    out += format == ReferenceFormat::Markdown
               ? fmt::format("| `{}` | {} |\n", row.key, row.meaning)
               : fmt::format("{:<36} {}\n", row.key, row.meaning);
  }
  return out;
}

std::string heading(const std::string& text, ReferenceFormat format) {
  return format == ReferenceFormat::Markdown ? "\n## " + text + "\n\n" : "\n" + text + "\n";
}

std::string texture_reference(ReferenceFormat format) {
  std::string out;
  for (const std::string& kind : texture_kinds()) {
    Document document = parse_document("type = \"" + kind + "\"", "reference");
    Texture texture;
    read_section(document, "", texture);
    out += heading(kind, format) + render(field_rows(texture, "texture"), format);
  }
  return out;
}

std::string study_reference(ReferenceFormat format) {
  std::vector<Row> rows{
      {"base",
       "another file that lies below this one; found beside it, then in the designs folder"},
      {"design_space.\"PATH\" = [low, high]",
       "the search may change this number; PATH is any number of the design, e.g. texture.depth"},
      {"design_space.\"PATH\" = { choice = [...] }", "the same, one of the listed values"},
      {"objective.maximise, objective.minimise",
       "a metric over humidity, e.g. \"mean(modulation)\", \"worst(modulation)\", "
       "\"variation(modulation)\"; two in all make a Pareto front"},
      {"design_space.\"texture.type\" = { choice = [...] }",
       "which kinds of texture compete; the other variables act where a kind has them: a depth is "
       "a pillar's height, a diameter a groove's width"},
      {"design_space.\"texture.levels\" = { choice = [...] }",
       "how many parts of a stack there are, the first ones"},
      {"objective.target",
       "{ METRIC = value }: what a metric should be at every humidity, e.g. { modulation = 0.8 }; "
       "its root mean square distance is minimised"},
      {"objective.risk",
       "how fingers, scenarios and scatter are put together: \"mean\", \"mean - 2 std\", "
       "\"cvar 20 %\", \"worst\""},
      {"scatter.\"PATH\"",
       "fabrication misses this number by up to so much either way; two more evaluations each"},
      {"population.fingers", "finger files; load and state of the study's [finger] hold for all"},
      {"scenarios",
       "states that count beside each other: name, weight, set = { \"PATH\" = value }"},
  };
  for (const ConstraintKind& kind : constraint_kinds()) {
    rows.push_back({"constraints." + kind.name,
                    fmt::format("{} ({}{})", kind.doc, kind.at_least ? "at least" : "at most",
                                kind.unit.empty() ? "" : ", in " + kind.unit)});
  }
  rows.push_back(
      {"constraints.\"METRIC\"",
       "a metric over humidity, limited on its bad side: \"worst(modulation)\" = 0.3 (at "
       "least), \"worst(voltage_for(modulation = 0.5))\" = \"150 V\" (at most)"});
  return render(rows, format) + heading("search", format) +
         render(field_rows(Search{}, "search"), format);
}

std::string metrics_reference(ReferenceFormat format) {
  std::vector<Row> rows;
  for (const MetricInfo& metric : metric_list()) {
    rows.push_back(
        {metric.name, fmt::format("{}{}{}{}", metric.doc,
                                  metric.unit.empty() ? "" : fmt::format(" [{}]", metric.unit),
                                  metric.better == Better::Higher  ? "; higher is better"
                                  : metric.better == Better::Lower ? "; lower is better"
                                                                   : "",
                                  metric.needs_drive ? "; driven designs only" : "")});
  }
  return render(rows, format);
}

}  // namespace

std::vector<std::string> reference_sections() {
  return {"texture", "surface",  "view",  "finger",  "environment", "drive",
          "model",   "accuracy", "study", "metrics", "persson",     "circuit"};
}

std::string reference_section(const std::string& section, ReferenceFormat format) {
  const std::string top = format == ReferenceFormat::Markdown
                              ? fmt::format("# {}\n\n{}\n\n", section, about(section))
                              : fmt::format("{}: {}\n\n", section, about(section));
  if (section == "texture") return top + texture_reference(format);
  if (section == "surface") return top + render(field_rows(Surface{}, section), format);
  if (section == "view") return top + render(field_rows(View{}, section), format);
  if (section == "finger") return top + render(field_rows(Finger{}, section), format);
  if (section == "environment") return top + render(field_rows(Environment{}, section), format);
  if (section == "drive") return top + render(field_rows(Drive{}, section), format);
  if (section == "model") return top + render(field_rows(ModelOptions{}, section), format);
  if (section == "accuracy") return top + render(field_rows(AccuracySettings{}, section), format);
  if (section == "persson") return top + render(field_rows(MeanFieldCase{}, ""), format);
  if (section == "circuit") return top + render(field_rows(DriveCase{}, ""), format);
  if (section == "metrics") return top + metrics_reference(format);
  if (section == "study") return top + study_reference(format);
  const std::string near = nearest_name(section, reference_sections());
  throw InputError(
      near.empty()
          ? fmt::format("no section `{}`; known: {}", section, join_names(reference_sections()))
          : fmt::format("no section `{}`, did you mean `{}`?", section, near));
}

}  // namespace papilla
