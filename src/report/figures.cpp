#include "report/figures.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "base/text.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

struct Column {
  const char* name;  // in CSV, with its unit
  const char* title;
  FigureValue FigureRow::*value;
  double scale;  // from SI
  std::set<std::string> figures;
};

const std::vector<Column>& columns() {
  static const std::vector<Column> list{
      {"capillary_uN",
       "Fig. 2d: capillary force on a patch, off [uN]",
       &FigureRow::capillary,
       1e6,
       {"2d,e 3d-f", "4d,e"}},
      {"pull_uN",
       "Fig. 2e: electrostatic force on a patch [uN]",
       &FigureRow::pull,
       1e6,
       {"2d,e 3d-f", "4d,e"}},
      {"friction_off_N",
       "Fig. 3d, 4d: friction off [N]",
       &FigureRow::friction_off,
       1,
       {"2d,e 3d-f", "4d,e"}},
      {"friction_on_N",
       "Fig. 3d, 4d: friction on [N]",
       &FigureRow::friction_on,
       1,
       {"2d,e 3d-f", "4d,e"}},
      {"effect_N", "Fig. 3e: ΔF [N]", &FigureRow::effect, 1, {"2d,e 3d-f", "4d,e"}},
      {"modulation", "Fig. 3f, 4e: ΔF/F_off", &FigureRow::modulation, 1, {"2d,e 3d-f", "4d,e"}},
      {"contact_area_mm2",
       "Fig. 4a: real contact area [mm²]",
       &FigureRow::contact_area,
       1e6,
       {"4a"}}};
  return list;
}

const char* preset_name(Preset preset) { return preset == Preset::M3 ? "m3" : "papilla"; }

std::string range_text(const PrintedNumber& p) {
  if (std::isinf(p.high)) return fmt::format("above {:g}", p.low);
  return p.low == p.high ? fmt::format("{:g}", p.low) : fmt::format("{:g} to {:g}", p.low, p.high);
}

std::string model_text(const PrintedNumber& p, const Estimate& model) {
  const std::string value = model.se > 0 ? fmt::format("{:.3g} ± {:.1g}", model.value, model.se)
                                         : fmt::format("{:.3g}", model.value);
  return fmt::format("{} ({:+.0f} %)", value, 100 * p.deviation(model));
}

std::string contradicted(const FigureTables& tables, const ParameterSet& set) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < set.misses.size(); ++i) {
    if (std::abs(set.misses[i]) > kContradicts)
      out.push_back(fmt::format("{} ({:.3g}, printed {})", tables.printed[i].what, set.values[i],
                                range_text(tables.printed[i])));
  }
  return join_names(out, "; ");
}

// One set of parameters beside all printed numbers, of textures and of whole fingers.
std::string sets_text(const FigureTables& tables) {
  std::string out =
      "\n## One set of parameters beside all printed numbers\n\nThe finger, and of each hypothesis "
      "of "
      "its belief the member whose largest miss is the least (drafts). In brackets E over the root "
      "of u_num² + u_D²; what a set misses by more than 2 contradicts what it meets.\n\n";
  std::vector<std::string> head{"claim", "what", "paper"};
  for (const ParameterSet& set : tables.sets) head.push_back(set.name);
  out += markdown_head(head);
  for (std::size_t i = 0; i < tables.printed.size(); ++i) {
    const PrintedNumber& p = tables.printed[i];
    std::vector<std::string> cells{p.claim, p.what, range_text(p)};
    for (const ParameterSet& set : tables.sets)
      cells.push_back(fmt::format("{:.3g} ({:+.1f})", set.values[i], set.misses[i]));
    out += markdown_row(cells);
  }
  bool meets = false;
  out += '\n';
  for (const ParameterSet& set : tables.sets) {
    meets = meets || set.largest() <= kContradicts;
    out += fmt::format("- {}: {}\n", set.name,
                       set.largest() <= kContradicts ? "meets all of them"
                                                     : "misses " + contradicted(tables, set));
  }
  return out + (meets ? "\nOne set of parameters meets all of them.\n"
                      : "\nNo set of parameters meets all of them.\n");
}

// Rows of one quantity: a surface by a preset, over humidity.
std::string quantity_table(const FigureTables& tables, const Column& column) {
  std::set<double> humidities;
  for (const FigureRow& row : tables.rows)
    if (column.figures.count(row.figures)) humidities.insert(row.relative_humidity);
  std::vector<std::string> head{"sample", "finger", "preset"};
  for (const double rh : humidities) head.push_back(fmt::format("{:.0f} % RH", 100 * rh));
  std::string out = fmt::format("\n## {}\n\n", column.title) + markdown_head(head);
  std::vector<std::string> cells;
  const FigureRow* first = nullptr;
  const auto same = [&](const FigureRow& row) {
    return first && row.sample == first->sample && row.state == first->state &&
           row.preset == first->preset;
  };
  for (const FigureRow& row : tables.rows) {
    if (!column.figures.count(row.figures)) continue;
    if (!same(row)) {
      if (!cells.empty()) out += markdown_row(cells);
      first = &row;
      cells = {row.sample, row.state, preset_name(row.preset)};
    }
    const FigureValue& v = row.*column.value;
    cells.push_back(fmt::format("{:.3g} ± {:.1g} [{:.3g}, {:.3g}]", column.scale * v.value.value,
                                column.scale * v.value.se, column.scale * v.low,
                                column.scale * v.high));
  }
  return cells.empty() ? out : out + markdown_row(cells);
}

}  // namespace

std::string figures_csv(const FigureTables& tables) {
  std::string out = "figures,sample,finger,preset,relative_humidity";
  for (const Column& c : columns()) out += fmt::format(",{0},{0}_se,{0}_low,{0}_high", c.name);
  out += '\n';
  for (const FigureRow& row : tables.rows) {
    out += fmt::format("{},{},{},{},{:g}", csv_cell(row.figures), csv_cell(row.sample), row.state,
                       preset_name(row.preset), row.relative_humidity);
    for (const Column& c : columns()) {
      const FigureValue& v = row.*c.value;
      out += fmt::format(",{:.5g},{:.2g},{:.5g},{:.5g}", c.scale * v.value.value,
                         c.scale * v.value.se, c.scale * v.low, c.scale * v.high);
    }
    out += '\n';
  }
  return out;
}

std::string figures_markdown(const FigureTables& tables, const std::string& finger) {
  std::string out = fmt::format(
      "# The figures of the M³ paper\n\nWritten by `papilla reproduce --figures --out` for the "
      "finger \"{}\". Each number is the mean over two volumes of water (two and four thirds of "
      "the finger's: 5 to 10 um³ at 75 % RH as published), six placements of the droplets each, "
      "± one standard error over skins; in brackets the limits over the volumes, the paper's error "
      "bars. The paper prints no values of its curves; what its text prints comes first.\n\n"
      "## Printed numbers\n\n",
      finger);
  out += markdown_head({"claim", "what", "paper", "papilla", "preset m3", "E", "u_num", "u_input",
                        "u_D", "u_val", "\\|E\\|/u_val"});
  const auto digits = [](double v) { return fmt::format("{:.2g}", v); };
  for (const PrintedNumber& p : tables.printed) {
    out +=
        markdown_row({p.claim, p.what, range_text(p), model_text(p, p.papilla), model_text(p, p.m3),
                      fmt::format("{:+.2g}", p.error()), digits(p.papilla.se),
                      p.input_sd ? digits(*p.input_sd) : "no belief", digits(p.published_sd),
                      digits(p.validation_sd()), digits(std::abs(p.error()) / p.validation_sd())});
  }
  out +=
      "\nE: what the finger \"papilla\" misses the nearest printed value by. Its uncertainty u_val "
      "(ASME V&V 20; Eq. accuracy.16) is the root of the squares of u_num (sampling of the "
      "skins), u_input (belief in the finger) and u_D (what the paper's words leave). A claim "
      "whose "
      "numbers the finger was fitted to proves nothing by a small E.\n";
  out += sets_text(tables);
  for (const Column& column : columns()) out += quantity_table(tables, column);
  return out;
}

}  // namespace papilla::report
