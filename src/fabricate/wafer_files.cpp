#include "fabricate/wafer_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/folder.h"
#include "base/text.h"
#include "base/units.h"
#include "config/writer.h"
#include "estimate/evaluation.h"
#include "geometry/io/drawing.h"

namespace papilla::fabricate {
namespace {

constexpr const char* kGds = "wafer.gds";
constexpr const char* kOasis = "wafer.oas";

std::string design_file(const Treatment& treatment) {
  return "designs/" + treatment.name + ".toml";
}

// --- the manifest ---

std::string millimetres(double metres) {
  return fmt::format("{:.6f}", metres == 0 ? 0.0 : 1e3 * metres);
}

std::string number_cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

constexpr const char* kManifestHead =
    "field,row,column,design,name,kind,repeat,block,x_mm,y_mm,pad_width_mm,pad_height_mm,load_N,"
    "humidity_percent,voltage_V,frequency_Hz,state";
constexpr const char* kExpectedHead =
    ",expected_modulation,expected_modulation_error,expected_friction_off_N,"
    "expected_friction_off_error_N";

std::string state_cell(std::optional<FingerState> state) {
  return state ? finger_state_names()[static_cast<std::size_t>(*state)] : "";
}

std::string condition_cells(const WaferCondition& c) {
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{}", c.load, 100 * c.humidity, c.voltage,
                     c.frequency, state_cell(c.state));
}

std::string expected_cells(const Expected& e) {
  return fmt::format(",{},{},{},{}", number_cell(e.modulation), number_cell(e.modulation_error),
                     number_cell(e.friction_off), number_cell(e.friction_error));
}

// One line a field and condition, without what is expected of it.
std::vector<std::string> manifest_rows(const WaferPlan& plan, const WaferField& field) {
  const Treatment& treatment = plan.treatments[field.treatment];
  const WaferShape& shape = plan.list.wafer;
  const std::string place =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},", field.id, field.row + 1, field.column + 1,
                  design_file(treatment), treatment.name, field_kind_name(field.kind), field.repeat,
                  field.block, millimetres(field.x), millimetres(field.y),
                  millimetres(shape.pad_width), millimetres(shape.pad_height));
  std::vector<std::string> out;
  for (const WaferCondition& c : conditions_of(plan.list.conditions, treatment.design))
    out.push_back(place + condition_cells(c));
  return out;
}

std::string manifest_text(const WaferPlan& plan, const Expectations& expected) {
  std::string out = kManifestHead;
  if (!expected.empty()) out += kExpectedHead;
  out += '\n';
  for (const WaferField& field : plan.fields) {
    const std::vector<std::string> rows = manifest_rows(plan, field);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      out += rows[k];
      if (!expected.empty()) out += expected_cells(expected[field.treatment][k]);
      out += '\n';
    }
  }
  return out;
}

// --- the record ---

// The list that makes this folder again: of the designs beside it.
std::string record_text(const WaferPlan& plan) {
  WaferList list = plan.list;
  list.designs_of.clear();
  list.designs.clear();
  for (std::size_t i = 0; i + 1 < plan.treatments.size(); ++i) {
    const Treatment& t = plan.treatments[i];
    list.designs.push_back({t.name, design_file(t), t.repeats});
  }
  return to_toml(list);
}

// --- layouts against each other ---

// What of a cell's polygons is not as drawn.
std::string polygons_fault(const LayoutCell& wanted, const LayoutCell& found) {
  if (wanted.polygons == found.polygons) return {};
  if (wanted.polygons.size() != found.polygons.size()) {
    return fmt::format("{} polygons, drawn {}", found.polygons.size(), wanted.polygons.size());
  }
  double most = 0;
  for (std::size_t i = 0; i < wanted.polygons.size(); ++i) {
    const LayoutPolygon &w = wanted.polygons[i], &f = found.polygons[i];
    if (w.layer != f.layer) return fmt::format("layer {}, drawn {}", f.layer, w.layer);
    if (w.outline.x.size() != f.outline.x.size())
      return fmt::format("a polygon of {} corners, drawn {}", f.outline.x.size(),
                         w.outline.x.size());
    for (std::size_t k = 0; k < w.outline.x.size(); ++k) {
      most = std::max(most, std::hypot(1.0 * w.outline.x[k] - f.outline.x[k],
                                       1.0 * w.outline.y[k] - f.outline.y[k]));
    }
  }
  return fmt::format("its corners are up to {:.4g} nm off", most);
}

bool same_reference(const LayoutReference& a, const LayoutReference& b) {
  const auto steps = [](const LayoutReference& r) {
    return std::tuple(r.columns > 1 ? r.step_x : 0, r.rows > 1 ? r.step_y : 0);
  };
  return std::tie(a.cell, a.x, a.y, a.columns, a.rows) ==
             std::tie(b.cell, b.x, b.y, b.columns, b.rows) &&
         steps(a) == steps(b);
}

std::string references_fault(const LayoutCell& wanted, const LayoutCell& found) {
  if (wanted.references.size() != found.references.size()) {
    return fmt::format("{} references to cells, drawn {}", found.references.size(),
                       wanted.references.size());
  }
  for (std::size_t i = 0; i < wanted.references.size(); ++i) {
    const LayoutReference &w = wanted.references[i], &f = found.references[i];
    if (same_reference(w, f)) continue;
    return fmt::format("{} x {} of {} at ({}, {}) um, drawn {} x {} of {} at ({}, {}) um",
                       f.columns, f.rows, f.cell, 1e-3 * f.x, 1e-3 * f.y, w.columns, w.rows, w.cell,
                       1e-3 * w.x, 1e-3 * w.y);
  }
  return {};
}

std::vector<std::string> layout_faults(const Layout& wanted, const Layout& found) {
  std::vector<std::string> out;
  std::map<std::string, const LayoutCell*> cells;
  for (const LayoutCell& cell : found.cells) cells[cell.name] = &cell;
  for (const LayoutCell& cell : wanted.cells) {
    const auto at = cells.find(cell.name);
    if (at == cells.end()) {
      out.push_back("cell " + cell.name + " is missing");
      continue;
    }
    for (const std::string& fault :
         {polygons_fault(cell, *at->second), references_fault(cell, *at->second)}) {
      if (!fault.empty()) out.push_back("cell " + cell.name + ": " + fault);
    }
    cells.erase(at);
  }
  for (const auto& [name, cell] : cells) out.push_back("cell " + name + " was not drawn");
  if (found.layers != wanted.layers) out.push_back("names or labels of layers are not as drawn");
  return out;
}

// Lines of the manifest that are not of this plan; what is expected is not judged.
std::vector<std::string> manifest_faults(const WaferPlan& plan, const std::string& text) {
  std::vector<std::string> lines = split(text, '\n'), wanted;
  for (const WaferField& field : plan.fields) {
    for (std::string& row : manifest_rows(plan, field)) wanted.push_back(std::move(row));
  }
  if (!lines.empty() && lines.back().empty()) lines.pop_back();
  if (lines.empty() || !lines.front().starts_with(kManifestHead))
    return {"its first line does not name the columns of a manifest"};
  if (lines.size() != wanted.size() + 1) {
    return {fmt::format("{} lines of fields and conditions, the wafer's {}", lines.size() - 1,
                        wanted.size())};
  }
  std::size_t off = 0, first = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string& line = lines[i + 1];
    if (line == wanted[i] || line.starts_with(wanted[i] + ",")) continue;
    if (off++ == 0) first = i;
  }
  if (off == 0) return {};
  return {fmt::format("{} lines are not the wafer's, the first `{}`, there `{}`", off,
                      lines[first + 1], wanted[first])};
}

// Designs beside those of the wafer, as of a larger one that was written into the folder before.
std::vector<std::string> designs_of_no_field(const std::string& folder, const WaferPlan& plan) {
  std::set<std::string> files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/designs", missing)) {
    if (entry.path().extension() == ".toml")
      files.insert("designs/" + entry.path().filename().string());
  }
  for (const Treatment& t : plan.treatments) files.erase(design_file(t));
  std::vector<std::string> out;
  for (const std::string& file : files) out.push_back(folder + "/" + file);
  return out;
}

FileVerdict judged(const std::string& path, const std::function<std::vector<std::string>()>& work) {
  if (!std::filesystem::exists(path)) return {path, FileState::Missing, {"is missing"}};
  try {
    std::vector<std::string> faults = work();
    const FileState state = faults.empty() ? FileState::Sound : FileState::Differs;
    return {path, state, std::move(faults)};
  } catch (const InputError& error) {
    return {path, FileState::Unreadable, {error.what()}};
  }
}

// --- what is expected ---

// Conditions that one evaluation answers: all humidities.
struct Scenery {
  double load, voltage, frequency;
  std::optional<FingerState> state;

  auto operator<=>(const Scenery&) const = default;
};

Scenery scenery_of(const WaferCondition& c) { return {c.load, c.voltage, c.frequency, c.state}; }

std::string scenery_text(const Scenery& s) {
  std::string out = format_quantity(s.load, "N") + ", " + format_quantity(s.voltage, "V");
  if (s.voltage > 0) out += ", " + format_quantity(s.frequency, "Hz");
  if (s.state) out += ", " + state_cell(s.state);
  return out;
}

// The humidities that a design meets under each.
std::map<Scenery, std::set<double>> sceneries_of(const WaferConditions& wanted,
                                                 const Design& design) {
  std::map<Scenery, std::set<double>> out;
  for (const WaferCondition& c : conditions_of(wanted, design))
    out[scenery_of(c)].insert(c.humidity);
  return out;
}

Design design_under(Design design, const Scenery& scenery, const std::set<double>& humidities) {
  design.environment = {};
  design.environment.relative_humidity.assign(humidities.begin(), humidities.end());
  Counterface& touch = design.counterface;
  if (touch.in_place())
    (touch.type == CounterfaceType::Pin ? touch.pin : touch.pen).load = scenery.load;
  else
    design.finger.load = scenery.load;
  if (scenery.state) design.finger.state = *scenery.state;
  design.drive.control = DriveControl::Voltage;
  design.drive.amplitude = scenery.voltage;
  if (scenery.voltage > 0) design.drive.frequency = scenery.frequency;
  design.accuracy = {};
  design.accuracy.level = AccuracyLevel::Draft;
  return design;
}

// What readings may be off the expectation by: the computation's part, and the model's where belief
// was asked, which a wafer is there to lower.
double whole_error(const Measured& number) {
  return std::hypot(number.se(), number.parts.model.value_or(0));
}

Expected expected_at(const ResponsePoint& point, bool driven) {
  const double nothing = std::nan("");
  Expected out{nothing, nothing, nothing, nothing, point.oxide_margin, point.bridged_margin};
  if (point.knows_undriven())
    out.friction_off = point.friction_off.value,
    out.friction_error = whole_error(point.friction_off);
  if (driven && point.knows_driven())
    out.modulation = point.modulation.value, out.modulation_error = whole_error(point.modulation);
  return out;
}

std::vector<Expected> expected_of(const Treatment& treatment, const WaferConditions& wanted,
                                  bool model) {
  std::map<Scenery, std::map<double, Expected>> answers;
  for (const auto& [scenery, humidities] : sceneries_of(wanted, treatment.design)) {
    EvaluationOptions options;
    options.model = model;
    const Response response =
        evaluate_design(design_under(treatment.design, scenery, humidities), options);
    std::size_t k = 0;
    for (const double humidity : humidities)
      answers[scenery][humidity] = expected_at(response.points.at(k++), response.driven);
  }
  std::vector<Expected> out;
  for (const WaferCondition& c : conditions_of(wanted, treatment.design))
    out.push_back(answers.at(scenery_of(c)).at(c.humidity));
  return out;
}

}  // namespace

void check_conditions(const WaferPlan& plan, DesignUse use) {
  std::vector<Problem> problems;
  for (std::size_t i = 0; i + 1 < plan.treatments.size(); ++i) {  // the flat one has no own
    const Treatment& t = plan.treatments[i];
    std::set<std::pair<std::string, std::string>> said;  // of the first condition alone
    for (const auto& [scenery, humidities] : sceneries_of(plan.list.conditions, t.design)) {
      const Design under = design_under(t.design, scenery, humidities);
      for (const DesignProblem& p : design_problems(under, use)) {
        if (!said.insert({p.path, p.message}).second) continue;
        problems.push_back({"", 0, 0, p.path,
                            fmt::format("{} at {}: {}", t.name, scenery_text(scenery), p.message)});
      }
    }
  }
  if (!problems.empty()) throw InputError(problems);
}

Expectations expect(const WaferPlan& plan, bool model, const FileProgress& progress) {
  Expectations out;
  for (const Treatment& treatment : plan.treatments) {
    if (progress) {
      progress("what is expected of " + treatment.name,
               static_cast<double>(out.size()) / static_cast<double>(plan.treatments.size()));
    }
    out.push_back(expected_of(treatment, plan.list.conditions, model));
  }
  return out;
}

std::vector<std::string> breakdown_lines(const WaferPlan& plan, const Expectations& expected) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Treatment& t = plan.treatments[i];
    const std::vector<WaferCondition> conditions = conditions_of(plan.list.conditions, t.design);
    struct Margins {
      double solved = kInfinity, bridged = kInfinity;
    };
    std::map<double, Margins> margins;  // the least at each voltage
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      Margins& least = margins[conditions[k].voltage];
      least.solved = std::min(least.solved, expected[i][k].oxide_margin);
      least.bridged = std::min(least.bridged, expected[i][k].bridged_margin);
    }
    for (const auto& [voltage, margin] : margins) {
      const double holds = std::min(margin.solved, margin.bridged);
      if (holds >= 1) continue;
      out.push_back(fmt::format(
          "{} at {}: the dielectric {}, at most {} V hold{}", t.name, format_quantity(voltage, "V"),
          margin.solved < 1
              ? fmt::format("breaks down: the field in a layer is {:.3g} times its strength",
                            1 / margin.solved)
              : fmt::format("is at risk: under a bridge or a contact on its thinnest place the "
                            "field is {:.3g} times its strength",
                            1 / margin.bridged),
          significant(holds * voltage, 3), margin.solved < 1 ? "; no modulation is expected" : ""));
    }
  }
  return out;
}

std::vector<std::string> write_wafer(const WaferPlan& plan, const WaferDrawing& drawing,
                                     const Expectations& expected, const std::string& path) {
  const Folder folder = Folder::made(path);
  const Folder designs = folder.made_below("designs");
  std::vector<std::string> out;
  const auto named = [&](const std::string& name) {
    out.push_back(path + "/" + name);
    return out.back();
  };
  for (const Treatment& treatment : plan.treatments)
    write_design(named(design_file(treatment)), treatment.design);
  folder.write(kManifest, manifest_text(plan, expected));
  named(kManifest);
  folder.write(kWaferRecord, record_text(plan));
  named(kWaferRecord);
  write_gds(named(kGds), drawing.layout);
  write_oasis(named(kOasis), drawing.layout);
  return out;
}

bool holds_wafer(const std::string& folder) {
  return std::filesystem::is_directory(folder) &&
         std::filesystem::exists(std::filesystem::path(folder) / kWaferRecord);
}

std::vector<WaferMade> made_of_wafer(const WaferDrawing& drawing, const Layout& layout,
                                     const Process& process) {
  std::vector<WaferMade> out;
  for (const DrawnArray& array : drawing.arrays) {
    const auto cell = std::find_if(layout.cells.begin(), layout.cells.end(),
                                   [&](const LayoutCell& c) { return c.name == array.cell; });
    if (cell == layout.cells.end() || cell->polygons.empty()) continue;  // said of the file
    out.push_back(
        {array.design, array.cell, made_of(array.masked, around_centre(array, *cell), process)});
  }
  return out;
}

WaferVerdict verify_wafer(const std::string& folder, const FileProgress& progress) {
  const WaferPlan plan = plan_wafer(folder + "/" + kWaferRecord, {}, DesignUse::Drawn);
  const WaferDrawing drawing = draw_wafer(plan);
  WaferVerdict out;
  std::optional<Layout> found;
  const auto at = [&](const char* name) { return folder + "/" + name; };
  out.files.push_back(judged(at(kGds), [&] {
    found = read_gds(at(kGds));
    return layout_faults(drawing.layout, *found);
  }));
  out.files.push_back(
      judged(at(kOasis), [&] { return layout_faults(drawing.layout, read_oasis(at(kOasis))); }));
  out.files.push_back(judged(at(kManifest), [&] {
    constexpr std::size_t kMost = std::size_t{1} << 28;
    return manifest_faults(plan, read_bytes(at(kManifest), kMost));
  }));
  for (const Treatment& t : plan.treatments) {
    const std::string path = folder + "/" + design_file(t);
    out.files.push_back(judged(path, [&]() -> std::vector<std::string> {
      if (read_study(path, {}, DesignUse::Drawn).design == t.design) return {};
      return {"is another design than stands on the wafer"};
    }));
  }
  for (const std::string& path : designs_of_no_field(folder, plan))
    out.files.push_back({path, FileState::Differs, {"is of no field: an earlier wafer's?"}});
  if (progress) progress("what the process makes of " + at(kGds), 0);
  if (found) out.made = made_of_wafer(drawing, *found, plan.list.process);
  return out;
}

}  // namespace papilla::fabricate
