#include "fabricate/wafer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/folder.h"
#include "base/random.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/reader.h"
#include "design/study.h"
#include "fabricate/wafer_marks.h"
#include "geometry/io/glyphs.h"

namespace papilla::fabricate {
namespace {

constexpr int kMostRows = 26, kMostColumns = 99;  // A to Z

// --- which designs ---

// Ends of a variable, or all of its choices.
std::vector<double> ends_of(const Variable& variable) {
  if (!variable.choices.empty()) return variable.choices;
  return {variable.low, variable.high};
}

// A design that has no name yet, and what is said of it by its name.
struct Unnamed {
  Design design;
  std::string note;
};

// The design of a study as it is written, and with each of its numbers at either end.
std::vector<Unnamed> of_study(const Study& study, std::vector<std::string>& notes) {
  std::vector<Unnamed> out{{study.design, ""}};
  std::string left_out;
  for (const Variable& variable : study.variables) {
    // One wafer has one finish, one finger and one drive: textures alone differ between fields.
    if (variable.is_kind() || variable.is_levels() || !variable.path.starts_with("texture.")) {
      left_out += (left_out.empty() ? "" : ", ") + variable.path;
      continue;
    }
    for (const double value : ends_of(variable)) {
      Design design = with_settings(study.design, {{variable.path, value}});
      if (!problems(design.texture).empty() || design == study.design) continue;
      out.push_back({std::move(design),
                     fmt::format("{} = {}", variable.path, variable_text(variable, value))});
    }
  }
  if (!left_out.empty()) notes.push_back("not varied on the wafer: " + left_out);
  return out;
}

// The front of a run, of the design that is built the build sheet's rounded numbers; else its best.
std::vector<Unnamed> of_results(const std::string& path, DesignUse use) {
  const Folder folder(path);
  std::vector<Unnamed> out;
  const auto design_of = [&](const std::string& file) {
    return folder.has(file) ? std::optional(read_study(folder.file(file), {}, use).design)
                            : std::nullopt;
  };
  const std::optional<Design> best = design_of("best/design.toml"),
                              rounded = design_of("best/build.toml");
  const auto take = [&](const Design& design) {
    const bool built = best && rounded && design.texture == best->texture &&
                       design.surface == best->surface && design.drive == best->drive;
    out.push_back({built ? *rounded : design, ""});
  };
  for (int i = 1; const auto found = design_of(fmt::format("front/{:02}/design.toml", i)); ++i)
    take(*found);
  if (out.empty() && best) take(*best);
  if (out.empty())
    throw InputError(path + ": no front/01 and no best/: not the folder of `papilla optimize`");
  return out;
}

std::vector<Unnamed> designs_behind(const std::string& path, DesignUse use,
                                    std::vector<std::string>& notes) {
  if (std::filesystem::is_directory(path)) return of_results(path, use);
  return of_study(read_study(path, {}, use), notes);
}

// D01 and so on from a number on, the first that no other design has.
std::string free_name(std::size_t number, std::set<std::string>& names) {
  for (;; ++number) {
    const std::string name = fmt::format("D{:02}", number);
    if (names.insert(name).second) return name;
  }
}

void check_name(const std::string& name, std::set<std::string>& taken) {
  constexpr std::size_t kMostLetters = 12;
  const bool known =
      std::all_of(name.begin(), name.end(), [](char c) { return c != ' ' && has_glyph(c); });
  if (name.empty() || name.size() > kMostLetters || !known || name == "FLAT") {
    throw InputError(
        fmt::format("design.name: \"{}\": 1 to {} of A to Z, 0 to 9, - . _ +, and not FLAT", name,
                    kMostLetters));
  }
  if (!taken.insert(name).second)
    throw InputError("design.name: two designs are called \"" + name + "\"");
}

std::vector<Treatment> treatments_of(const WaferList& list, DesignUse use,
                                     std::vector<std::string>& notes) {
  std::vector<Treatment> out;
  std::set<std::string> names;  // those that are given go before those that are counted
  for (const WaferDesign& d : list.designs) names.insert(d.name);
  Mistakes mistakes;
  for (const WaferDesign& d : list.designs) {
    mistakes.of([&] {
      const std::string name = d.name.empty() ? free_name(out.size() + 1, names) : d.name;
      out.push_back({name, read_study(d.file, {}, use).design, d.repeats});
    });
  }
  mistakes.tell();
  if (!list.designs_of.empty()) {
    std::vector<std::string> others;
    std::size_t number = 0;
    for (Unnamed& d : designs_behind(list.designs_of, use, others)) {
      const std::string name = free_name(++number, names);
      if (!d.note.empty()) notes.push_back(name + ": " + d.note);
      // A run or a study may say that a surface is flat by a kind of texture without depth.
      if (!facts(d.design.texture).relief.present) {
        d.design.texture = Texture{};
        notes.push_back(name + " has no texture: its fields are flat, as those of FLAT are");
      }
      out.push_back({name, std::move(d.design), 0});
    }
    notes.insert(notes.end(), others.begin(), others.end());
  }
  if (out.empty()) throw InputError("no design: give [[design]] or designs_of");
  std::set<std::string> taken;
  for (Treatment& t : out) {
    check_name(t.name, taken);
    if (t.repeats == 0) t.repeats = list.wafer.repeats;
    if (t.design.surface == out.front().design.surface) continue;
    notes.push_back(
        fmt::format("{} has another finish ([surface]) than {}: one wafer has one, what is "
                    "expected of it is of "
                    "its own",
                    t.name, out.front().name));
  }
  return out;
}

// --- where each stands ---

struct Slot {
  int row, column;
  double x, y;  // from the middle
};

// Places of fields, row by row and back again, so that neighbours in the list are neighbours on the
// wafer.
std::vector<Slot> slots_of(const WaferShape& shape, int rows, int columns, double pitch_x,
                           double pitch_y) {
  std::vector<Slot> out;
  for (int row = 0; row < rows; ++row) {
    for (int k = 0; k < columns; ++k) {
      const int column = row % 2 == 0 ? k : columns - 1 - k;
      const Slot slot{row, column, (column - 0.5 * (columns - 1)) * pitch_x,
                      (0.5 * (rows - 1) - row) * pitch_y};
      const double far =
          std::hypot(std::abs(slot.x) + 0.5 * pitch_x, std::abs(slot.y) + 0.5 * pitch_y);
      if (shape.diameter == 0 || far <= 0.5 * shape.diameter - shape.edge) out.push_back(slot);
    }
  }
  return out;
}

// What a field of a block holds.
struct Planned {
  std::size_t treatment;
  FieldKind kind;
};

std::vector<std::vector<Planned>> blocks_of(const WaferPlan& plan, std::size_t flat,
                                            std::size_t reference) {
  const WaferShape& shape = plan.list.wafer;
  int count = shape.repeats;
  for (const Treatment& t : plan.treatments) count = std::max(count, t.repeats);
  std::vector<std::vector<Planned>> out(static_cast<std::size_t>(count));
  for (std::size_t b = 0; b < out.size(); ++b) {
    for (std::size_t i = 0; i < flat; ++i) {
      if (static_cast<std::size_t>(plan.treatments[i].repeats) > b)
        out[b].push_back({i, FieldKind::Design});
    }
    out[b].insert(out[b].end(), static_cast<std::size_t>(shape.flats), {flat, FieldKind::Flat});
    out[b].insert(out[b].end(), static_cast<std::size_t>(shape.references),
                  {reference, FieldKind::Reference});
  }
  return out;
}

// What a gradient over the wafer, along x, along y or outwards, does to the means of the
// treatments. Eq. fabrication.1
double gradient_of(const std::vector<Planned>& order, const std::vector<Slot>& slots,
                   std::size_t treatments) {
  struct Sums {
    double n = 0, x = 0, y = 0, r = 0;
  };
  std::vector<Sums> sums(treatments);
  Sums all;
  double reach = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    reach = std::max(reach, std::hypot(slots[i].x, slots[i].y));
  if (reach == 0) return 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double x = slots[i].x / reach, y = slots[i].y / reach, r = x * x + y * y;
    for (Sums* s : {&sums[order[i].treatment], &all}) s->n += 1, s->x += x, s->y += y, s->r += r;
  }
  double out = 0;
  for (const Sums& s : sums) {
    if (s.n == 0) continue;
    const auto off = [&](double own, double whole) {
      const double miss = own / s.n - whole / all.n;
      return s.n * miss * miss;
    };
    out += off(s.x, all.x) + off(s.y, all.y) + off(s.r, all.r);
  }
  return out / all.n;
}

// Each block in a random order of its own; of many such arrangements the one that gradients touch
// least.
std::vector<Planned> arranged(const std::vector<std::vector<Planned>>& blocks,
                              const std::vector<Slot>& slots, std::size_t treatments, int seed,
                              double& gradient) {
  constexpr std::uint64_t kDraws = 500;
  std::vector<Planned> best;
  gradient = std::numeric_limits<double>::infinity();
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    RandomStream random(static_cast<std::uint64_t>(seed), "wafer", draw);
    std::vector<Planned> order;
    for (std::vector<Planned> block : blocks) {
      for (std::size_t i = block.size(); i > 1; --i)
        std::swap(block[i - 1], block[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
      order.insert(order.end(), block.begin(), block.end());
    }
    const double found = gradient_of(order, slots, treatments);
    if (found < gradient) gradient = found, best = std::move(order);
  }
  return best;
}

// Rows and columns that hold so many fields. Throws InputError.
void choose_size(WaferPlan& plan, std::size_t count) {
  const WaferShape& shape = plan.list.wafer;
  const auto n = static_cast<double>(count);
  if (shape.diameter > 0) {
    const double side = shape.diameter - 2 * shape.edge;
    plan.columns = shape.columns > 0 ? shape.columns : static_cast<int>(side / plan.pitch_x);
    plan.rows = shape.rows > 0 ? shape.rows : static_cast<int>(side / plan.pitch_y);
  } else {
    plan.columns = shape.columns > 0 ? shape.columns
                   : shape.rows > 0
                       ? static_cast<int>(std::ceil(n / shape.rows))
                       : static_cast<int>(std::ceil(std::sqrt(n * plan.pitch_y / plan.pitch_x)));
    plan.rows =
        shape.rows > 0 ? shape.rows : static_cast<int>(std::ceil(n / std::max(1, plan.columns)));
  }
  if (plan.columns > kMostColumns || plan.rows > kMostRows) {
    throw InputError(fmt::format("{} x {} fields: at most {} columns and {} rows", plan.columns,
                                 plan.rows, kMostColumns, kMostRows));
  }
  constexpr double kMost = 0.45;  // [m]: less than the 2.1 m of 32 bits, more than any wafer
  if (plan.columns * plan.pitch_x > kMost || plan.rows * plan.pitch_y > kMost)
    throw InputError("the fields take more than 450 mm; fewer, or smaller ones");
}

void place_fields(WaferPlan& plan, std::size_t flat, std::size_t reference) {
  const std::vector<std::vector<Planned>> wanted = blocks_of(plan, flat, reference);
  std::size_t count = 0;
  for (const auto& block : wanted) count += block.size();
  choose_size(plan, count);
  const std::vector<Slot> slots =
      slots_of(plan.list.wafer, plan.rows, plan.columns, plan.pitch_x, plan.pitch_y);
  if (slots.size() < count) {
    throw InputError(fmt::format(
        "{} fields are wanted (wafer.repeats of each design, and controls), {} have a place; fewer "
        "repeats, smaller pads, or a larger wafer",
        count, slots.size()));
  }
  // Places that are left hold more controls, shared out among the blocks.
  std::vector<std::vector<Planned>> blocks = wanted;
  for (std::size_t k = 0; k + count < slots.size(); ++k) {
    const bool is_flat = k / blocks.size() % 2 == 0;  // both kinds in every block
    blocks[k % blocks.size()].push_back(
        {is_flat ? flat : reference, is_flat ? FieldKind::Flat : FieldKind::Reference});
  }
  const std::vector<Planned> order =
      arranged(blocks, slots, plan.treatments.size(), plan.list.wafer.seed, plan.gradient);
  std::map<std::size_t, int> repeats;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t k = 0; k < blocks[b].size(); ++k, ++at) {
      const Slot& s = slots[at];
      plan.fields.push_back({fmt::format("{}{}", static_cast<char>('A' + s.row), s.column + 1),
                             s.row, s.column, order[at].treatment, order[at].kind,
                             ++repeats[order[at].treatment], static_cast<int>(b) + 1, s.x, s.y});
    }
  }
  std::sort(plan.fields.begin(), plan.fields.end(), [](const WaferField& a, const WaferField& b) {
    return std::tie(a.row, a.column) < std::tie(b.row, b.column);
  });
}

std::size_t reference_of(const WaferPlan& plan) {
  const std::string& name = plan.list.wafer.reference;
  if (name.empty()) return 0;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < plan.treatments.size(); ++i) {
    if (plan.treatments[i].name == name) return i;
    known.push_back(plan.treatments[i].name);
  }
  throw InputError(
      fmt::format("wafer.reference: no design \"{}\"; there are {}", name, join_names(known)));
}

// What is written below a pad ends before the marks at the crossing of streets on its right. The
// sizes stand at one crossing, but which field is beside it is for the arrangement to choose.
void check_labels(const WaferPlan& plan) {
  const WaferShape& shape = plan.list.wafer;
  const double room = shape.pad_width + 0.5 * shape.gap - 1e-9 * kSizesReach;
  for (const WaferField& f : plan.fields) {
    const std::size_t letters = f.id.size() + 1 + plan.treatments[f.treatment].name.size();
    const double width = static_cast<double>(letters) * kGlyphAdvance * shape.label / kGlyphRows;
    if (width <= room) continue;
    throw InputError(fmt::format(
        "wafer.label: \"{} {}\" is {:.4g} um wide, more than the {:.4g} um below its pad that "
        "leave room for the marks; smaller letters, shorter names or wider pads",
        f.id, plan.treatments[f.treatment].name, 1e6 * width, 1e6 * room));
  }
}

// Letters stand below the pads, and marks between their corners.
void check_shape(const WaferShape& shape) {
  if (shape.label > shape.gap / 4) {
    throw InputError(fmt::format(
        "wafer.label: letters of {:.4g} um do not fit below a pad with a gap of {:.4g} um; at most "
        "a quarter of it",
        1e6 * shape.label, 1e6 * shape.gap));
  }
}

// A condition that stands twice would give each field two equal lines of the manifest.
void repeated_conditions(Document& document, const WaferConditions& conditions) {
  const auto once = [&](const std::string& key, const std::vector<std::string>& values) {
    std::set<std::string> known;
    for (const std::string& value : values) {
      if (!known.insert(value).second)
        document.problem_at("conditions." + key, value + " stands twice: name it once");
    }
  };
  const auto shown = [](const std::vector<double>& values, const char* unit) {
    std::vector<std::string> out;
    for (const double v : values)
      out.push_back(fmt::format("{:.12g} {}", v / find_unit(unit)->to_si, unit));
    return out;
  };
  once("load", shown(conditions.load, "N"));
  once("humidity", shown(conditions.humidity, "%"));
  once("voltage", shown(conditions.voltage, "V"));
  once("frequency", shown(conditions.frequency, "Hz"));
  once("states", split(conditions.states, ','));
}

// A list of its own, where the file has one of its keys; else an empty one over the file.
WaferList read_list(const std::string& given, const std::vector<std::string>& overrides) {
  const std::string path = own_or_shipped(given);
  WaferList list;
  const bool folder = std::filesystem::is_directory(path);
  bool own = false;
  if (!folder) {
    const Document file = load_document(path, {}, design_roots());
    own = file.has("wafer") || file.has("design") || file.has("designs_of");
  }
  Document document = own ? load_document(path, overrides, design_roots())
                          : parse_document("schema_version = 1", path, overrides);
  read_section(document, "", list);
  repeated_conditions(document, list.conditions);
  finish(document);
  if (!own) list.designs_of = path;
  if (own && !list.designs_of.empty()) {
    list.designs_of = (std::filesystem::path(path).parent_path() / list.designs_of).string();
    if (!std::filesystem::exists(list.designs_of))
      throw InputError(
          {Problem{path, 0, 0, "designs_of", "no such file or folder: " + list.designs_of}});
  }
  return list;
}

std::vector<std::optional<FingerState>> states_of(const WaferConditions& wanted,
                                                  const Design& design) {
  const Pin* pin = design.counterface.in_place();
  if (pin && !wanted.states.empty()) {
    throw InputError(fmt::format(
        "conditions.states: \"{}\" stands in place of the finger and has none; leave them out",
        pin->name));
  }
  if (pin) return {std::nullopt};
  if (wanted.states.empty()) return {design.finger.state};
  const std::vector<std::string>& known = finger_state_names();
  std::vector<std::optional<FingerState>> out;
  for (const std::string& name : split(wanted.states, ',')) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw InputError(
          fmt::format("conditions.states: \"{}\" is none of {}", name, join_names(known)));
    }
    out.push_back(static_cast<FingerState>(found - known.begin()));
  }
  return out;
}

}  // namespace

void fields(FieldVisitor& v, WaferShape& s) {
  v.text({"title", "of the wafer"}, s.title);
  v.number({"diameter", "mm", 0, 450, "of a wafer; 0: a die as large as its fields"}, s.diameter);
  v.number({"edge", "mm", 0, 50, "of a wafer, free of fields"}, s.edge);
  v.integer({"columns", "fields beside each other; 0: as many as it takes"}, 0, kMostColumns,
            s.columns);
  v.integer({"rows", "of fields; 0: as many as it takes"}, 0, kMostRows, s.rows);
  v.number({"pad_width", "mm", 0.05, 150, "of the texture in a field", Source::Choice,
            "a fingertip and its way"},
           s.pad_width);
  v.number({"pad_height", "mm", 0.05, 150, "of the texture in a field"}, s.pad_height);
  v.number({"gap", "mm", 1.2, 50, "between pads: labels and marks stand there"}, s.gap);
  v.number({"label", "um", 20, 5000, "height of letters"}, s.label);
  v.integer({"repeats", "of each design: so many blocks"}, 1, 99, s.repeats);
  v.integer({"flats", "fields without texture in each block"}, 0, 99, s.flats);
  v.integer({"references", "more fields of the reference design in each block"}, 0, 99,
            s.references);
  v.text({"reference", "name of the reference design; empty: the first"}, s.reference);
  v.integer({"levels", "masks of a gradual relief, as contour lines; 0: such designs are refused"},
            0, 8, s.levels);
  v.integer({"seed", "of the arrangement"}, 0, 1000000, s.seed);
  v.number({"facet_error", "nm", 0.1, 1000, "of circles drawn as polygons"}, s.facet_error);
}

void fields(FieldVisitor& v, WaferConditions& s) {
  v.numbers({"load", "N", 0.001, 20, "normal forces; empty: that of each design's finger or pin"},
            s.load);
  v.numbers({"humidity", "%", 0, 100, "relative; empty: those of each design"}, s.humidity);
  v.numbers({"voltage", "V", 0, 2000, "peak; empty: that of each design; 0: undriven"}, s.voltage);
  v.numbers({"frequency", "Hz", 0, 1e6, "of the drive; empty: that of each design"}, s.frequency);
  v.text({"states", "of the finger, clean, natural or wet, between commas; empty: as designs say"},
         s.states);
}

void fields(FieldVisitor& v, WaferDesign& s) {
  v.text({"name", "on the wafer: A to Z, 0 to 9, - . _ +; empty: D01 and so on"}, s.name);
  v.path({"file", "design or study file", Source::Choice, "", Presence::Required}, s.file);
  v.integer({"repeats", "of this design; 0: as the wafer says"}, 0, 99, s.repeats);
}

void fields(FieldVisitor& v, WaferList& s) {
  v.integer({"schema_version", "of this file"}, 1, 1, s.schema_version);
  v.section({"wafer", "its fields"}, s.wafer);
  v.section({"conditions", "to measure every field under"}, s.conditions);
  v.section({"process", "what making it does, and the mask undoes"}, s.process);
  v.text({"designs_of", "folder of results or study whose designs are taken too, beside this file"},
         s.designs_of);
  v.list({"design", "designs"}, s.designs);
}

const char* field_kind_name(FieldKind kind) {
  switch (kind) {
    case FieldKind::Design:
      return "design";
    case FieldKind::Reference:
      return "reference";
    case FieldKind::Flat:
      return "flat";
  }
  return "";
}

WaferPlan plan_wafer(const std::string& path, const std::vector<std::string>& overrides,
                     DesignUse use) {
  WaferPlan plan;
  plan.list = read_list(path, overrides);
  check_shape(plan.list.wafer);
  plan.treatments = treatments_of(plan.list, use, plan.notes);
  plan.pitch_x = plan.list.wafer.pad_width + plan.list.wafer.gap;
  plan.pitch_y = plan.list.wafer.pad_height + plan.list.wafer.gap;
  const std::size_t reference = reference_of(plan), flat = plan.treatments.size();
  Treatment control{"FLAT", plan.treatments[reference].design, 0};
  control.design.texture = Texture{};
  control.design.title = "flat control";
  plan.treatments.push_back(std::move(control));
  place_fields(plan, flat, reference);
  check_labels(plan);
  return plan;
}

std::vector<WaferCondition> conditions_of(const WaferConditions& wanted, const Design& design) {
  const Drive& drive = design.drive;
  if (wanted.voltage.empty() && drive.driven() && drive.control == DriveControl::Current) {
    throw InputError(
        "conditions.voltage: a design is driven by a current; give voltages to measure");
  }
  const auto or_own = [](const std::vector<double>& list, double own) {
    return list.empty() ? std::vector<double>{own} : list;
  };
  const std::vector<double> humidities =
      wanted.humidity.empty() ? design.environment.relative_humidity : wanted.humidity;
  const double own_load = scene_of(design).finger.load;
  std::vector<WaferCondition> out;
  for (const std::optional<FingerState> state : states_of(wanted, design)) {
    for (const double load : or_own(wanted.load, own_load)) {
      for (const double voltage : or_own(wanted.voltage, drive.amplitude)) {
        const std::vector<double> frequencies =
            voltage > 0 ? or_own(wanted.frequency, drive.frequency) : std::vector<double>{0};
        for (const double frequency : frequencies) {
          for (const double humidity : humidities)
            out.push_back({load, humidity, voltage, frequency, state});
        }
      }
    }
  }
  return out;
}

}  // namespace papilla::fabricate
