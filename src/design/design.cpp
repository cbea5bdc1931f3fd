#include "design/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <optional>

#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/writer.h"
#include "design/families.h"
#include "metrics/metrics.h"
#include "scene/uncertainty.h"

namespace papilla {
namespace {
namespace fs = std::filesystem;
}

const std::vector<std::string>& accuracy_level_names() {
  static const std::vector<std::string> names{"draft", "design", "reference"};
  return names;
}

std::string AccuracySettings::level_name() const {
  return accuracy_level_names()[static_cast<std::size_t>(level)];
}

void fields(FieldVisitor& v, AccuracySettings& s) {
  v.choice({"level", "grid, samples and tolerances by name"}, accuracy_level_names(), s.level);
  v.integer(
      {"grid",
       "pixels along 12 um of the patch, for features finer than eight pixels; a longer patch "
       "has at most this many a side, or 1024; 0: by level"},
      0, 4096, s.grid);
  v.number({"target", "%", 0, 100, "instead of a level: standard error of the modulation; 0: none"},
           s.target);
  v.flag({"parameters",
          "also the error that the finger's fitted numbers leave (its `uncertainty`); optimize "
          "states it of the best design, and with this of all confirmed ones"},
         s.parameters);
  v.integer(
      {"seed",
       "which skins, offsets and droplets, the same for all designs; searches take search.seed"},
      0, 1 << 30, s.seed);
  v.integer({"droplet_seeds", "placements of the droplets on each skin, averaged (M3: 6)"}, 1, 64,
            s.droplet_seeds);
}

void fields(FieldVisitor& v, Design& s) {
  v.integer(
      {"schema_version", "version of the file format", Source::Choice, "", Presence::Required}, 1,
      1, s.schema_version);
  v.text({"title", "a line for reports"}, s.title);
  v.section({"texture", "the shape of the surface"}, s.texture);
  v.section({"surface", "the finish of the surface"}, s.surface);
  v.section({"view", "how the texture is looked at (optics only)"}, s.view);
  v.section({"finger", "the finger that touches it"}, s.finger);
  v.section({"environment", "the air"}, s.environment);
  v.section({"drive", "the voltage"}, s.drive);
  if (v.reading()) s.model = s.finger.calibrated_for;
  v.section({"model", "model options; default: those that the finger was fitted with"}, s.model);
  v.section({"accuracy", "speed against error"}, s.accuracy);
}

void fields(FieldVisitor& v, Search& s) {
  int method =
      static_cast<int>(std::find(search_methods().begin(), search_methods().end(), s.method) -
                       search_methods().begin());
  v.choice({"method", "search method"}, search_methods(), method);
  s.method = search_methods()[static_cast<std::size_t>(method)];
  v.integer({"seed", "of the search's random numbers"}, 0, 1 << 30, s.seed);
  v.integer({"evaluations", "largest number of evaluated designs; 0: the method's default"}, 0,
            100000000, s.evaluations);
  v.integer({"drafts", "cheap evaluations that steer the bayesian search"}, 0, 10000, s.drafts);
  v.number({"time", "min", 0, 1e6, "largest wall-clock time; 0: no limit"}, s.time);
  v.integer({"jobs", "evaluations at a time; 0: one a processor"}, 0, 4096, s.jobs);
}

const std::vector<std::string>& search_methods() {
  static const std::vector<std::string> names{"auto",   "bayesian", "nsga2",  "cmaes",
                                              "bobyqa", "sbplx",    "direct", "least_squares"};
  return names;
}

const std::vector<ConstraintKind>& constraint_kinds() {
  static const std::vector<ConstraintKind> kinds{
      {"min_hole", "um", true, "smallest hole or gap between features"},
      {"min_wall", "um", true, "smallest wall or feature"},
      {"aspect_ratio", "", false, "largest depth / smallest width of a hole"},
      {"oxide_breakdown_margin", "", true,
       "breakdown field of the dielectric / largest field in it"},
      {"haze", "%", false, "share of the transmitted light beyond 2.5 deg"},
      {"transmittance", "%", true, "undeviated share of the light on the plate"},
      {"gloss", "%", true, "specular reflection at 60 deg over that of flat glass"},
      {"colour_shift", "", false, "CIE 1976 u'v' distance of the undeviated light"},
  };
  return kinds;
}

std::vector<DesignProblem> design_problems(const Design& design) {
  std::vector<DesignProblem> out;
  const auto problem = [&](const char* path, std::string message) {
    out.push_back({path, std::move(message)});
  };
  for (const auto& [key, message] : problems(design.texture)) {
    out.push_back({"texture." + key, message});
  }
  const Environment& air = design.environment;
  if (air.relative_humidity.empty()) {
    problem("environment.relative_humidity", "expected at least one humidity");
  }
  for (std::size_t i = 1; i < air.relative_humidity.size(); ++i) {
    if (air.relative_humidity[i] <= air.relative_humidity[i - 1]) {
      problem("environment.relative_humidity", "expected rising values");
      break;
    }
  }
  if (!air.weights.empty()) {
    if (air.weights.size() != air.relative_humidity.size()) {
      problem("environment.weights", fmt::format("expected {} weights, one a humidity, got {}",
                                                 air.relative_humidity.size(), air.weights.size()));
    } else if (*std::max_element(air.weights.begin(), air.weights.end()) <= 0) {
      problem("environment.weights", "expected at least one weight above 0");
    }
  }
  const SkinWater& water = design.finger.water;
  if (water.volume.empty() || water.volume.size() != water.relative_humidity.size()) {
    problem("finger.water.volume",
            fmt::format("expected {} volumes, one a humidity of finger.water.relative_humidity, "
                        "got {}",
                        water.relative_humidity.size(), water.volume.size()));
  }
  for (std::size_t i = 1; i < water.relative_humidity.size(); ++i) {
    if (water.relative_humidity[i] <= water.relative_humidity[i - 1]) {
      problem("finger.water.relative_humidity", "expected rising values");
      break;
    }
  }
  if (design.accuracy.grid > 0 && design.accuracy.grid < 16)
    problem("accuracy.grid", "expected 0 (by level) or at least 16 pixels");
  if (design.finger.load <= 0) problem("finger.load", "expected a force above 0 N");
  if (design.finger.saturation.rest_low == design.finger.saturation.rest_high) {
    problem("finger.saturation.rest_high", "expected another angle than rest_low");
  }
  if (design.finger.skin.map.empty() && design.finger.skin.cutoff >= design.finger.skin.roll_off) {
    problem("finger.skin.cutoff", "expected a shorter wavelength than roll_off");
  }
  if (!design.finger.skin.map.empty() && design.model.closure == Closure::Persson) {
    problem("finger.skin.map",
            "the Persson closure takes the spectrum of the skin; use model.closure = \"uniform\" "
            "with a map");
  }
  const Drive& drive = design.drive;
  if (drive.control == DriveControl::Current) {
    problem("drive.control",
            "a texture is judged at a voltage; what a current source makes of it: `papilla solve "
            "drive` with gap.design");
  }
  if (drive.waveform == Waveform::Am && drive.driven() && drive.modulation_frequency <= 0) {
    problem("drive.modulation_frequency", "expected a frequency above 0 Hz for am");
  }
  if (drive.source_compliance > 0 && drive.amplitude > drive.source_compliance) {
    problem("drive.amplitude",
            fmt::format("{} is above source_compliance, {}", format_quantity(drive.amplitude, "V"),
                        format_quantity(drive.source_compliance, "V")));
  }
  if (drive.driven() && design.surface.equivalent_thickness() <= 0) {
    problem("surface.dielectric", "a driven surface needs a dielectric layer thicker than 0");
  }
  if (design.view.angles.empty()) problem("view.angles", "expected at least one angle");
  if (design.view.fill_index > design.surface.refractive_index) {
    problem("view.fill_index", "expected at most surface.refractive_index");
  }
  return out;
}

Scene scene_of(const Design& design) {
  return {design.surface, design.finger, design.environment, design.drive, design.model};
}

Fidelity fidelity_of(const Design& design) {
  Fidelity out = fidelity_level(design.accuracy.level_name());
  if (design.accuracy.grid > 0) out.grid = design.accuracy.grid;
  out.seed = static_cast<std::uint64_t>(design.accuracy.seed);
  out.droplet_seeds = design.accuracy.droplet_seeds;
  return out;
}

Optics appearance_of(const Design& design) {
  return appearance(design.texture, design.surface.refractive_index, design.view);
}

std::vector<std::string> calibration_mismatch(const Design& design) {
  const Node now = to_table(design.model), fitted = to_table(design.finger.calibrated_for);
  std::vector<std::string> out;
  for (const Node& option : fitted.children) {
    const Node& used = *now.find(option.key);
    if (describe(used) != describe(option)) {
      out.push_back(fmt::format("model.{} is {}, the finger \"{}\" was fitted with {}", option.key,
                                describe(used), design.finger.name, describe(option)));
    }
  }
  return out;
}

Design with_settings(Design design, const std::vector<Setting>& settings) {
  const std::vector<NumberField> known = number_fields(design);
  for (const Setting& setting : settings) {
    const std::string path = path_in(known, setting.path);
    if (!path.empty() || !setting.path.starts_with("texture."))
      *find_number_field(known, path.empty() ? setting.path : path).value = setting.value;
  }
  return design;
}

std::string variable_text(const Variable& variable, double value, bool plain) {
  if (variable.is_kind()) return texture_kinds()[static_cast<std::size_t>(value)];
  const double shown = value / find_unit(variable.unit)->to_si;
  if (plain) return fmt::format("{:.6g}", shown);
  return fmt::format("{:.3g}{}", shown, variable.unit.empty() ? "" : " " + variable.unit);
}

std::vector<std::string> design_roots() {
  std::vector<std::string> roots;
  std::error_code error;
  const char* named = std::getenv("PAPILLA_DESIGNS");
  for (const char* folder : {named, PAPILLA_DESIGNS_DIR, PAPILLA_INSTALLED_DESIGNS_DIR}) {
    if (folder && fs::is_directory(folder, error)) roots.emplace_back(folder);
  }
  return roots;
}

std::string find_design(const std::string& name) {
  for (const std::string& root : design_roots()) {
    const std::string path = root + "/" + name;
    if (std::filesystem::exists(path)) return path;
  }
  throw InputError(name + " is in no designs folder; set PAPILLA_DESIGNS to the one that has it");
}

namespace {

// "texture.diameter" = ... and texture.diameter = ... mean the same: members by full path.
void flatten(const Node& table, const std::string& path, bool stop_at_choice,
             std::vector<std::pair<std::string, const Node*>>& out) {
  for (const Node& child : table.children) {
    const std::string full = path.empty() ? child.key : path + "." + child.key;
    const bool leaf = !child.is_table() || (stop_at_choice && child.find("choice"));
    if (leaf) {
      out.emplace_back(full, &child);
    } else {
      flatten(child, full, stop_at_choice, out);
    }
  }
}

class StudyReader {
 public:
  StudyReader(Document& document, Study& study) : document_(document), study_(study) {}

  void read() {
    read_section(document_, "", study_.design);
    if (document_.problems().empty()) {  // else values may stand for ones that could not be read
      for (const DesignProblem& p : design_problems(study_.design)) {
        document_.problem_at(p.path, p.message);
      }
      if (const std::string wrong = uncertainty_problem(study_.design.finger); !wrong.empty())
        document_.problem_at("finger.uncertainty", wrong);
    }
    numbers_ = number_fields(study_.design);
    read_variables();
    read_scatter();
    read_objective();
    read_constraints();
    read_population();
    read_scenarios();
    read_section(document_, "search", study_.search);
    if (study_.is_study()) {
      study_.study_sections.set("search", to_table(study_.search, &document_.origins(), "search"));
    }
    check_whole();
  }

 private:
  const Node* table(const std::string& path) {
    const Node* node = document_.take(path);
    if (!node) return nullptr;
    if (!node->is_table()) {
      document_.problem(node->place, path,
                        fmt::format("expected a section [{}], got {}", path, describe(*node)));
      return nullptr;
    }
    keep(path);
    return node;
  }

  void keep(const std::string& path) {
    if (const Node* node = document_.take(path)) study_.study_sections.set(path, *node);
  }

  const NumberField* number_field(const std::string& path, const Node& node,
                                  const std::string& where) {
    for (const NumberField& field : numbers_) {
      if (field.path == path) return &field;
    }
    std::vector<std::string> names;
    for (const NumberField& field : numbers_) names.push_back(field.path);
    const std::string near = nearest_name(path, names);
    document_.problem(
        node.key_place, where,
        near.empty()
            ? fmt::format("`{}` is no number of this design", path)
            : fmt::format("`{}` is no number of this design, did you mean `{}`?", path, near));
    return nullptr;
  }

  bool value(const NumberField& field, const Node& node, const std::string& where, double& si) {
    return document_.number(node, where,
                            {field.path.c_str(), field.unit, field.low, field.high, ""}, si);
  }

  void read_variables() {
    const Node* space = table("design_space");
    if (!space) return;
    std::vector<std::pair<std::string, const Node*>> members;
    flatten(*space, "", true, members);
    read_kinds(members);
    for (const auto& [path, node] : members) {
      const std::string where = "design_space." + path;
      if (path == "texture.type" || path == "texture.levels") continue;
      const NumberField* field = number_field(path, *node, "design_space");
      if (!field) continue;
      Variable variable{path, field->unit, 0, 0, {}};
      const Node* choice = node->is_table() ? node->find("choice") : nullptr;
      const Node& list = choice ? *choice : *node;
      if (!list.is_array() || (!choice && list.children.size() != 2) || list.children.empty()) {
        document_.problem(
            list.place, where,
            fmt::format("expected [low, high] or {{ choice = [...] }}, got {}", describe(list)));
        continue;
      }
      if (choice && node->children.size() > 1) {
        document_.problem(node->place, where, "expected `choice` alone");
      }
      std::vector<double> values(list.children.size());
      bool good = true;
      for (std::size_t i = 0; i < values.size(); ++i) {
        good &= value(*field, list.children[i], where, values[i]);
      }
      if (!good) continue;
      variable.low = *std::min_element(values.begin(), values.end());
      variable.high = *std::max_element(values.begin(), values.end());
      if (choice) {
        variable.choices = values;
      } else if (values[0] >= values[1]) {
        document_.problem(list.place, where, "expected low < high");
        continue;
      }
      study_.variables.push_back(std::move(variable));
    }
  }

  // The texture's kind and number of parts; then the numbers of every kind may be varied.
  void read_kinds(const std::vector<std::pair<std::string, const Node*>>& members) {
    for (const auto& [path, node] : members) {
      if (path != "texture.type" && path != "texture.levels") continue;
      const std::string where = "design_space." + path;
      const Node* choice = node->is_table() ? node->find("choice") : nullptr;
      const bool kind = path == "texture.type";
      const int parts = texture_levels(study_.design.texture);
      const std::string expected =
          kind ? "expected { choice = [...] } of texture types"
               : fmt::format("expected {{ choice = [...] }} of numbers of parts, 1 to {}", parts);
      if (!choice || !choice->is_array() || choice->children.empty()) {
        document_.problem(node->place, where, expected + ", got " + describe(*node));
        continue;
      }
      Variable variable{path, "", 0, 0, {}};
      const auto& kinds = texture_kinds();
      for (const Node& item : choice->children) {
        const auto found =
            std::find(kinds.begin(), kinds.end(), item.is_text() ? item.text : std::string());
        if (kind && found != kinds.end() &&
            numbers_alone(static_cast<std::size_t>(found - kinds.begin()))) {
          variable.choices.push_back(static_cast<double>(found - kinds.begin()));
          for (const NumberField& field :
               number_fields(kind_copies_.emplace_back(of_kind(study_.design.texture, item.text)),
                             "texture")) {
            if (std::none_of(numbers_.begin(), numbers_.end(),
                             [&](const NumberField& known) { return known.path == field.path; }))
              numbers_.push_back(field);
          }
        } else if (!kind && item.kind == Node::Kind::Integer && item.integer >= 1 &&
                   item.integer <= parts) {
          variable.choices.push_back(static_cast<double>(item.integer));
        } else {
          document_.problem(item.place, where, expected + ", got " + describe(item));
        }
      }
      if (variable.choices.empty()) continue;
      variable.low = *std::min_element(variable.choices.begin(), variable.choices.end());
      variable.high = *std::max_element(variable.choices.begin(), variable.choices.end());
      study_.variables.push_back(std::move(variable));
    }
  }

  void read_scatter() {
    const Node* section = table("scatter");
    if (!section) return;
    std::vector<std::pair<std::string, const Node*>> members;
    flatten(*section, "", false, members);
    for (const auto& [path, node] : members) {
      const NumberField* field = number_field(path, *node, "scatter");
      if (!field) continue;
      const std::string where = "scatter." + path;
      double tolerance = 0;
      if (!document_.number(*node, where, {path.c_str(), field->unit, 0, 1e9, ""}, tolerance))
        continue;
      if (tolerance > 0) {
        study_.scatter.push_back({path, tolerance});
      } else {
        document_.problem(node->place, where, "expected a tolerance above 0");
      }
    }
  }

  std::vector<std::string> texts(const Node& section, const char* key, const std::string& path) {
    const Node* node = section.find(key);
    std::vector<std::string> out;
    if (!node) return out;
    const auto add = [&](const Node& item) {
      if (item.is_text()) {
        out.push_back(item.text);
      } else {
        document_.problem(item.place, path + "." + key,
                          "expected a text or a list of texts, got " + describe(item));
      }
    };
    if (node->is_array()) {
      for (const Node& item : node->children) add(item);
    } else {
      add(*node);
    }
    return out;
  }

  void only(const Node& section, const std::string& path, const std::vector<std::string>& names) {
    for (const Node& child : section.children) {
      if (std::find(names.begin(), names.end(), child.key) != names.end()) continue;
      const std::string near = nearest_name(child.key, names);
      document_.problem(child.key_place, path,
                        fmt::format("unknown key `{}`{}", child.key,
                                    near.empty() ? "; known here: " + join_names(names)
                                                 : fmt::format(", did you mean `{}`?", near)));
    }
  }

  std::vector<std::string> metrics(const Node& section, const char* key) {
    std::vector<std::string> out = texts(section, key, "objective");
    for (const std::string& text : out) {
      try {
        parse_metric(text);
      } catch (const InputError& error) {
        document_.problem(section.find(key)->place, std::string("objective.") + key,
                          error.problems().front().message);
      }
    }
    return out;
  }

  void read_objective() {
    const Node* section = table("objective");
    if (!section) return;
    only(*section, "objective", {"maximise", "minimise", "target", "risk"});
    study_.objective.maximise = metrics(*section, "maximise");
    study_.objective.minimise = metrics(*section, "minimise");
    if (const Node* target = section->find("target")) read_targets(*target);
    const std::vector<std::string> risk = texts(*section, "risk", "objective");
    if (!risk.empty()) study_.objective.risk = risk.front();
  }

  // A key such as "worst(modulation)", limited on its bad side.
  std::optional<ConstraintKind> metric_constraint(const Node& child) {
    if (child.key.find('(') == std::string::npos) return std::nullopt;
    try {
      const MetricExpression expression = parse_metric(child.key);
      const Better better = better_direction(expression);
      if (better != Better::Neither) {
        const bool relative =
            expression.summary == Summary::Variation || expression.summary == Summary::Range;
        return ConstraintKind{metric_text(expression),
                              relative ? "" : find_metric(expression.metric)->unit,
                              better == Better::Higher, ""};
      }
      document_.problem(child.key_place, "constraints",
                        "\"" + child.key + "\" has no better direction to be limited in");
    } catch (const InputError& error) {
      document_.problem(child.key_place, "constraints", error.problems().front().message);
    }
    return ConstraintKind{child.key, "", true, ""};
  }

  void read_targets(const Node& section) {
    if (!section.is_table()) {
      document_.problem(
          section.place, "objective.target",
          "expected { METRIC = value }, e.g. { modulation = 0.8 }, got " + describe(section));
      return;
    }
    for (const Node& item : section.children) {
      const MetricInfo* metric = find_metric(item.key);
      if (!metric || metric->appearance) {
        document_.problem(item.key_place, "objective.target",
                          fmt::format("no metric over humidity is called \"{}\"", item.key));
        continue;
      }
      double value = 0;
      if (document_.number(item, "objective.target." + item.key,
                           {metric->name.c_str(), metric->unit.c_str(), -1e9, 1e9, ""}, value))
        study_.objective.targets.push_back({metric->name, value});
    }
  }

  void read_constraints() {
    const Node* section = table("constraints");
    if (!section) return;
    std::vector<std::string> names;
    for (const ConstraintKind& kind : constraint_kinds()) names.push_back(kind.name);
    std::vector<std::string> keys = names;
    for (const Node& child : section->children) {
      std::optional<ConstraintKind> kind = metric_constraint(child);
      if (kind) {
        keys.push_back(child.key);
      } else if (const auto at = std::find(names.begin(), names.end(), child.key);
                 at != names.end()) {
        kind = constraint_kinds()[static_cast<std::size_t>(at - names.begin())];
      } else {
        continue;
      }
      double limit = 0;
      if (document_.number(child, "constraints." + child.key,
                           {kind->name.c_str(), kind->unit.c_str(), 0, 1e9, ""}, limit)) {
        study_.constraints.push_back({kind->name, limit, kind->at_least});
      }
    }
    only(*section, "constraints", keys);
  }

  void read_population() {
    const Node* section = table("population");
    if (!section) return;
    only(*section, "population", {"fingers"});
    const Node* list = section->find("fingers");
    if (!list || !list->is_array() || list->children.empty()) {
      document_.problem(list ? list->place : section->place, "population.fingers",
                        "expected a list of finger files");
      return;
    }
    std::vector<Node> files;  // absolute, for resolved.toml in another folder
    for (const Node& item : list->children) {
      const std::string file =
          item.is_text() ? find_beside(item.text, item.place.file, design_roots()) : "";
      if (file.empty()) {
        document_.problem(item.place, "population.fingers",
                          item.is_text() ? fmt::format("no file \"{}\" beside this file or in the "
                                                       "designs folder",
                                                       item.text)
                                         : "expected the name of a file, got " + describe(item));
        continue;
      }
      try {
        Finger finger = read_finger(file);
        // What the study says of the touch itself holds for everyone.
        if (document_.origins().count("finger.load")) finger.load = study_.design.finger.load;
        if (document_.origins().count("finger.state")) finger.state = study_.design.finger.state;
        study_.population.push_back(std::move(finger));
        files.push_back(text_node(fs::absolute(file).lexically_normal().string()));
      } catch (const InputError& error) {
        for (const Problem& p : error.problems()) {
          document_.problem({p.file, p.line, p.column}, p.key, p.message);
        }
      }
    }
    study_.study_sections.find("population")->set("fingers", array_node(std::move(files)));
  }

  void read_scenarios() {
    const Node* list = document_.take("scenarios");
    if (!list) return;
    keep("scenarios");
    if (!list->is_array()) {
      document_.problem(list->place, "scenarios",
                        "expected a list of sections [[scenarios]], got " + describe(*list));
      return;
    }
    for (std::size_t i = 0; i < list->children.size(); ++i) {
      const Node& item = list->children[i];
      const std::string path = fmt::format("scenarios.{}", i);
      if (!item.is_table()) {
        document_.problem(item.place, path, "expected a section { ... }, got " + describe(item));
        continue;
      }
      only(item, path, {"name", "weight", "set"});
      Scenario scenario;
      const Node* name = item.find("name");
      if (!name || !name->is_text()) {
        document_.problem(name ? name->place : item.place, path, "missing `name` (a text)");
      } else {
        scenario.name = name->text;
      }
      if (const Node* weight = item.find("weight")) {
        document_.number(*weight, path + ".weight", {"weight", "", 0, 1e6, ""}, scenario.weight);
      }
      if (const Node* set = item.find("set"); set && set->is_table()) {
        std::vector<std::pair<std::string, const Node*>> members;
        flatten(*set, "", false, members);
        for (const auto& [key, node] : members) {
          const NumberField* field = number_field(key, *node, path + ".set");
          double si = 0;
          if (field && value(*field, *node, path + ".set." + key, si)) {
            scenario.set.push_back({key, si});
          }
        }
      } else if (set) {
        document_.problem(set->place, path + ".set",
                          "expected a section, e.g. { \"surface.contact_angle\" = \"80 deg\" }");
      }
      study_.scenarios.push_back(std::move(scenario));
    }
  }

  void check_whole() {
    if (!study_.variables.empty() && study_.objective.maximise.empty() &&
        study_.objective.minimise.empty() && study_.objective.targets.empty()) {
      document_.problem_at("objective",
                           "a study needs `maximise`, `minimise` or `target`, e.g. maximise = "
                           "\"mean(modulation)\"");
    }
  }

  Document& document_;
  Study& study_;
  std::vector<NumberField> numbers_;
  std::list<Texture> kind_copies_;  // that numbers_ point into
};

std::string study_name(const std::string& path) {
  const fs::path file(path);
  const std::string stem = file.stem().string();
  if (stem != "study" && stem != "resolved" && stem != "design") return stem;
  const std::string folder =
      fs::absolute(file).lexically_normal().parent_path().filename().string();
  return folder.empty() ? stem : folder;
}

}  // namespace

Study read_study(const std::string& path, const std::vector<std::string>& overrides) {
  Document document = load_document(path, overrides, design_roots());
  Study study;
  study.file = path;
  study.name = study_name(path);
  study.study_sections = table_node();
  StudyReader(document, study).read();
  finish(document);
  study.origins = document.origins();
  return study;
}

Design read_design(const std::string& path, const std::vector<std::string>& overrides) {
  return read_study(path, overrides).design;
}

Finger read_finger(const std::string& path) {
  Document document = load_document(path, {}, design_roots());
  document.take("schema_version");
  Finger finger;
  read_section(document, "", finger);
  if (const std::string wrong = uncertainty_problem(finger); !wrong.empty())
    document.problem_at("uncertainty", wrong);
  finish(document);
  return finger;
}

void write_design(const std::string& path, const Design& design) {
  write_bytes(path, to_toml(design));
}

void write_finger(const std::string& path, const Finger& finger, const std::string& comment) {
  write_bytes(path, (comment.empty() ? "" : "# " + comment + "\n") + "schema_version = 1\n" +
                        to_toml(finger));
}

std::string resolved_toml(const Study& study) {
  Node table = to_table(study.design, &study.origins);
  for (const Node& section : study.study_sections.children) table.set(section.key, section);
  return write_toml(table);
}

}  // namespace papilla
