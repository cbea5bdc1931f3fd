// A test wafer or die: which designs stand where on it, and under which conditions each is to be
// measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"
#include "design/design.h"
#include "fabricate/process.h"

namespace papilla::fabricate {

// The section [wafer].
struct WaferShape {
  std::string title = "papilla test wafer";
  double diameter = 0;                           // 0: a die, as large as its fields
  double edge = 5e-3;                            // of a wafer, free of fields [m]
  int columns = 0, rows = 0;                     // 0: as many as it takes, about a square
  double pad_width = 12e-3, pad_height = 12e-3;  // of a field [m]
  double gap = 3e-3;                             // between pads: labels and marks stand there [m]
  double label = 350e-6;                         // height of letters [m]
  int repeats = 3;                               // of each design: blocks
  int flats = 1, references = 1;                 // controls in each block
  std::string reference;                         // name of the design; "": the first
  int levels = 0;                                // contour lines of a gradual relief; 0: refused
  int seed = 1;
  double facet_error = 2e-9;  // of circles [m]

  bool operator==(const WaferShape&) const = default;
};
void fields(FieldVisitor& v, WaferShape& s);

// The section [conditions]: every combination is measured on every field. Empty: as each design
// says.
struct WaferConditions {
  std::vector<double> load, humidity, voltage, frequency;
  std::string states;  // "clean, natural"

  bool operator==(const WaferConditions&) const = default;
};
void fields(FieldVisitor& v, WaferConditions& s);

// One of [[design]].
struct WaferDesign {
  std::string name;  // on the wafer: capitals, digits, "-", ".", "_" or "+"
  std::string file;
  int repeats = 0;  // 0: as the wafer says

  bool operator==(const WaferDesign&) const = default;
};
void fields(FieldVisitor& v, WaferDesign& s);

// LIST.toml.
struct WaferList {
  int schema_version = 1;
  WaferShape wafer;
  WaferConditions conditions;
  Process process;
  std::string designs_of;  // results or a study whose designs are taken too
  std::vector<WaferDesign> designs;

  bool operator==(const WaferList&) const = default;
};
void fields(FieldVisitor& v, WaferList& s);

// What stands in a field.
struct Treatment {
  std::string name;
  Design design;
  int repeats = 0;
};

enum class FieldKind { Design, Reference, Flat };
const char* field_kind_name(FieldKind kind);  // "design", "reference", "flat"

struct WaferField {
  std::string id;  // "B3": row from the top, column from the left
  int row = 0, column = 0;
  std::size_t treatment = 0;
  FieldKind kind = FieldKind::Design;
  int repeat = 1;  // of its treatment, in the order of the blocks
  int block = 1;
  double x = 0, y = 0;  // middle of the pad, from the middle of the wafer [m]
};

struct WaferPlan {
  WaferList list;
  std::vector<Treatment> treatments;
  std::vector<WaferField> fields;  // in the order of their ids
  int rows = 0, columns = 0;
  double pitch_x = 0, pitch_y = 0;  // of the fields [m]
  double gradient = 0;              // Eq. fabrication.1, of the arrangement that was taken
  std::vector<std::string> notes;
};

// path: LIST.toml with a section [wafer] or designs of its own, a study or design (itself, and each
// number of its texture that varies at both ends), or a folder of results (best and front). Throws
// InputError with every mistake. use: whether what is expected of its designs is worked out too.
WaferPlan plan_wafer(const std::string& path, const std::vector<std::string>& overrides = {},
                     DesignUse use = DesignUse::Simulated);

// A condition that a field is measured under.
struct WaferCondition {
  double load = 0, humidity = 0, voltage = 0, frequency = 0;
  std::optional<FingerState> state = FingerState::Clean;  // nothing: of a pin

  auto operator<=>(const WaferCondition&) const = default;
};
// Of a design, every combination. Throws InputError for states of a pin, which has none.
std::vector<WaferCondition> conditions_of(const WaferConditions& wanted, const Design& design);

}  // namespace papilla::fabricate
